"""Masses, centres of mass and inertia against solids whose own are known."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.export.physics import enclosed_m3, friction_of, inertia_of, plausible_mass_kg, substance_of
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import Shape, record_of
from diorama_core.render.appearance import Material, Surface, shape_surfaces


def surface(mesh: trimesh.Trimesh, name: str, **material: float) -> Surface:
    mesh = mesh.copy()
    mesh.unmerge_vertices()
    return Surface(
        np.asarray(mesh.vertices, np.float32),
        np.asarray(mesh.vertex_normals, np.float32),
        np.asarray(mesh.faces, np.int32),
        Material(name=name, **material),
    )


def box(size: tuple[float, float, float], at: tuple[float, float, float] = (0, 0, 0)) -> trimesh.Trimesh:
    return trimesh.creation.box(size, trimesh.transformations.translation_matrix(at))


def test_a_thin_board_weighs_its_volume() -> None:
    board = surface(box((1.0, 0.5, 0.018)), "oak")
    inertia = inertia_of((board,), np.ones(3))
    assert inertia.mass_kg == pytest.approx(620 * 0.5 * 0.018, rel=1e-3)
    np.testing.assert_allclose(inertia.centre, 0, atol=1e-6)


def test_a_thick_block_of_wood_is_hollow() -> None:
    inertia = inertia_of((surface(box((1.0, 0.5, 0.8)), "oak"),), np.ones(3))
    assert inertia.mass_kg == pytest.approx(620 * 0.018 * 2 * (0.5 + 0.8 + 0.4), rel=1e-3)


def test_an_open_sheet_encloses_nothing() -> None:
    cube = box((1, 1, 1))
    opened = trimesh.Trimesh(cube.vertices, cube.faces[2:])
    assert enclosed_m3(surface(cube, "oak")) == pytest.approx(1.0)
    assert enclosed_m3(surface(opened, "oak")) == 0.0


def test_the_heavy_part_draws_the_centre_of_mass() -> None:
    foot, shade = surface(box((0.2, 0.2, 0.02)), "steel"), surface(box((0.4, 0.4, 0.3), (0, 0, 1.2)), "linen cloth")
    inertia = inertia_of((foot, shade), np.ones(3))
    masses = 7800 * min(0.2 * 0.2 * 0.02, 0.0012 * (0.08 + 0.016)), 60 * 0.4 * 0.4 * 0.3
    assert inertia.centre[2] == pytest.approx(1.2 * masses[1] / sum(masses), rel=1e-2)


def test_moments_of_a_hollow_box() -> None:
    """Against trimesh: a thin shell is the difference of two solid boxes."""
    a, t = 0.6, 0.004
    mesh = box((a, a, a)).subdivide().subdivide().subdivide()
    inertia = inertia_of((surface(mesh, "plastic"),), np.ones(3)).weighing(1.0)
    outer, inner = a**3, (a - 2 * t) ** 3
    expected = (outer * a**2 - inner * (a - 2 * t) ** 2) / 6 / (outer - inner)
    moments, axes = inertia.principal
    np.testing.assert_allclose(moments, expected, rtol=0.03)
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_masses_stay_near_the_usual_ones() -> None:
    chair = Shape("c", "chair", "chair", (0.5, 0.5, 0.9), mass_kg=6.0)
    assert plausible_mass_kg(100.0, np.ones(3), chair) == 7.5
    assert plausible_mass_kg(0.1, np.ones(3), chair) == 4.8
    assert plausible_mass_kg(7.0, np.ones(3), chair) == 7.0


def test_things_weigh_what_people_know() -> None:
    """Solid models of hollow things, and thin ones of heavy things, are told by the usual mass of their kind."""
    library = built_in_library()
    for category, low, high in (("office chair", 9.5, 20.0), ("picture", 0.2, 7.0), ("keyboard", 0.2, 1.0)):
        for shape in library.in_category(category)[:6]:
            mass = inertia_of(shape_surfaces(library, shape.id), np.ones(3)).mass_kg
            assert low < plausible_mass_kg(mass, np.ones(3), record_of(library, shape.id)) < high, shape.id


def test_materials_are_known_by_name_else_by_look() -> None:
    assert substance_of(Material(name="light oak 2")).name == "wood"
    assert substance_of(Material(name="brushed steel")).name == "steel"
    assert substance_of(Material(name="mat_017", metallic=1.0)).name == "steel"
    assert substance_of(Material(name="mat_018", alpha=0.3)).name == "glass"
    assert friction_of((surface(box((1, 1, 1)), "rubber"), surface(box((0.1, 0.1, 0.1)), "oak"))) == 0.9
