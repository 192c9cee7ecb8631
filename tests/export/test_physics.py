"""Masses, centres of mass and inertia against solids whose own are known."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.export.physics import friction_of, inertia_of, plausible_mass_kg, substance_of, surface_volume_m3
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.record import Shape
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
    assert surface_volume_m3(surface(cube, "oak")) == pytest.approx(1.0)
    assert surface_volume_m3(surface(opened, "oak")) == 0.0


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


WEIGHED_KG = {
    "chair": 7,
    "office chair": 12,
    "armchair": 27,
    "recliner": 51,
    "sofa": 42,
    "bed": 91,
    "night stand": 14,
    "chest": 11,
    "bookshelf": 21,
    "cabinet": 43,
    "dresser": 27,
    "desk": 27,
    "vanity table": 34,
    "tv stand": 17,
    "sideboard": 35,
    "coffee table": 14,
    "table": 29,
    "wardrobe": 55,
    "grandfather clock": 64,
}
"""Means of what re-use organisations in the United Kingdom weighed: list of the Furniture Re-use Network, published by
the Merseyside Recycling and Waste Authority; of two entries the larger where ours are large."""
SAID_KG = {
    "refrigerator": (30, 150),
    "dishwasher": (27, 50),
    "washing machine": (45, 90),
    "microwave": (9, 20),
    "laptop": (1, 3),
    "monitor": (2.5, 9),
    "keyboard": (0.3, 1.2),
    "picture": (0.5, 7),
}
"""Between these lie the masses that makers state."""


def masses_kg(category: str) -> list[float]:
    """The masses of a kind's shapes as files have them."""
    library = built_in_library()
    return [
        plausible_mass_kg(inertia_of(shape_surfaces(library, s.id), np.ones(3)).mass_kg, np.ones(3), s)
        for s in library.in_category(category)[:6]
    ]


@pytest.mark.parametrize("category", WEIGHED_KG)
def test_furniture_weighs_as_much_as_what_was_weighed(category: str) -> None:
    """The median within a factor of two, since what was weighed has no sizes."""
    assert abs(np.log2(np.median(masses_kg(category)) / WEIGHED_KG[category])) < 1.0


@pytest.mark.parametrize("category", SAID_KG)
def test_devices_weigh_as_much_as_makers_say(category: str) -> None:
    low, high = SAID_KG[category]
    assert low < np.median(masses_kg(category)) < high


def test_materials_are_known_by_name_else_by_look() -> None:
    assert substance_of(Material(name="light oak 2")).name == "wood"
    assert substance_of(Material(name="brushed steel")).name == "steel"
    assert substance_of(Material(name="mat_017", metallic=1.0)).name == "steel"
    assert substance_of(Material(name="mat_018", alpha=0.3)).name == "glass"
    assert friction_of((surface(box((1, 1, 1)), "rubber"), surface(box((0.1, 0.1, 0.1)), "oak"))) == 0.9
