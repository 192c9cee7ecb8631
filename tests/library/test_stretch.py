from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from diorama_core.library import furniture
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.furniture.model import built, mesh_of, scene_of
from diorama_core.library.part_notes import KEY, PartNotes
from diorama_core.library.stretch import EVEN, MIN_UNEVEN, AxisMap, local_growth, relative_scale, stretch_parts

factors = st.floats(0.6, 1.7)


def table(thick: float = 0.06, inset: float = 0.01) -> trimesh.Scene:
    """A top on four square legs, one welded mesh a part."""
    top = trimesh.creation.box((0.8, 1.4, 0.04))
    top.apply_translation((0, 0, 0.36))
    scene = trimesh.Scene({"top": top})
    for x in (-1, 1):
        for y in (-1, 1):
            leg = trimesh.creation.box((thick, thick, 0.72))
            leg.apply_translation((x * (0.4 - inset - thick / 2), y * (0.7 - inset - thick / 2), -0.02))
            scene.add_geometry(leg, geom_name=f"leg {x} {y}")
    return scene


def merged(scene: trimesh.Scene) -> trimesh.Trimesh:
    return trimesh.util.concatenate([scene.geometry[n] for n in scene.geometry])


def test_a_longer_table_has_no_thicker_legs() -> None:
    factor = 1.5
    stretched = stretch_parts(table(), (1.0, factor, 1.0))
    for name, mesh in stretched.geometry.items():
        thickness = np.ptp(mesh.bounds, axis=0) * (1.0, factor, 1.0)
        if name.startswith("leg"):
            np.testing.assert_allclose(thickness[:2], [0.06, 0.06], rtol=0.02)
        else:
            np.testing.assert_allclose(thickness, [0.8, 1.4 * factor, 0.04], atol=1e-6)


def test_a_part_stretches_along_the_sides_that_its_author_names() -> None:
    parts = {}
    for place, (name, stretches) in enumerate((("left", None), ("middle", (True, False, True)), ("right", None))):
        parts[name] = trimesh.creation.box((0.5, 0.5, 0.5))
        parts[name].apply_translation((0.0, 0.55 * (place - 1), 0.0))
        parts[name].metadata = {KEY: PartNotes(name, None, stretches).as_json()}
    stretched = stretch_parts(trimesh.Scene(parts), (1.0, 2.0, 1.0))
    widths = {name: 2.0 * float(np.ptp(mesh.bounds[:, 1])) for name, mesh in stretched.geometry.items()}
    assert widths["middle"] == pytest.approx(0.5, rel=0.05)
    assert widths["left"] == pytest.approx(widths["right"], rel=0.01)
    assert widths["left"] > 0.9


@settings(max_examples=15)
@given(
    factor=st.floats(0.7, 2.0).filter(lambda f: abs(np.log(f)) > MIN_UNEVEN),
    thick=st.floats(0.04, 0.12),
    inset=st.floats(0.0, 0.15),
)
def test_an_imported_table_of_one_mesh_keeps_its_legs_within_two_percent(
    factor: float, thick: float, inset: float
) -> None:
    whole = trimesh.boolean.union(list(table(thick, inset).geometry.values()), engine="manifold")
    assert whole.is_watertight
    scale = np.array([1.0, factor, 1.0])
    stretched = merged(stretch_parts(trimesh.Scene({"all": whole}), relative_scale(scale)))
    assert stretched.is_watertight
    np.testing.assert_allclose(stretched.bounds, whole.bounds, atol=1e-9)
    low = stretched.vertices[stretched.vertices[:, 2] < -0.3] * scale
    right = low[low[:, 1] > 0]
    np.testing.assert_allclose(np.ptp(right[:, 1]), thick, rtol=0.02)
    np.testing.assert_allclose(np.ptp(right[right[:, 0] > 0][:, 0]), thick, rtol=0.02)


def test_where_all_is_thin_the_shape_is_stretched_as_a_whole() -> None:
    np.testing.assert_allclose(local_growth(np.ones(50), 1.4), np.full(50, 1.4), atol=1e-6)
    np.testing.assert_allclose(local_growth(np.zeros(50), 0.6), np.full(50, 0.6), atol=1e-6)


@given(st.lists(st.floats(0, 1), min_size=2, max_size=40), st.floats(0.25, 4.0))
def test_slices_together_grow_as_the_whole_does_and_none_folds(thin: list[float], factor: float) -> None:
    grown = local_growth(np.array(thin), factor)
    assert grown.mean() == pytest.approx(factor, rel=1e-3)
    assert (grown > 0).all()


def test_handles_keep_their_form() -> None:
    front, handle = trimesh.creation.box((0.02, 0.8, 0.6)), trimesh.creation.box((0.004, 0.1, 0.02))
    handle.apply_translation((0.008, 0.3, 0.0))
    stretched = stretch_parts(trimesh.Scene({"front": front, "handle": handle}), (1.0, 1.5, 1.0))
    assert np.ptp(stretched.geometry["handle"].bounds, axis=0)[1] * 1.5 == pytest.approx(0.1, abs=1e-6)


@settings(max_examples=15)
@given(st.tuples(factors, factors, factors), st.sampled_from(["table", "chair", "bookshelf", "picture", "armchair"]))
def test_the_bounding_box_stays_and_nothing_folds(scale: tuple[float, float, float], category: str) -> None:
    design = next(d for d in furniture.designs() if d.category == category)
    parts = scene_of(built(design))
    relative = relative_scale(np.array(scale))
    before, after = merged(parts), merged(stretch_parts(parts, relative))
    np.testing.assert_allclose(after.bounds, before.bounds, atol=1e-4)
    assert np.isfinite(after.vertices).all()
    assert after.faces.shape == before.faces.shape


def test_it_is_nearer_than_a_plain_stretch_to_what_the_design_is_at_that_size() -> None:
    near, plain = [], []
    for design in [d for d in furniture.designs() if d.category in ("table", "wardrobe")][::9]:
        factor = np.array([1.0, 1.4, 1.0])
        truth = mesh_of(built(replace(design, size_m=tuple(np.array(design.size_m) * factor))))
        base = scene_of(built(design))
        for found, off in ((stretch_parts(base, relative_scale(factor)), near), (base, plain)):
            mesh = merged(found)
            mesh.apply_scale(factor)
            sampled = cKDTree(trimesh.sample.sample_surface(truth, 50_000, seed=0)[0])
            off.append(float(sampled.query(trimesh.sample.sample_surface(mesh, 4_000, seed=1)[0])[0].mean()))
    assert np.mean(near) < 0.9 * np.mean(plain)


def test_nearly_even_scales_share_the_shape() -> None:
    assert relative_scale(np.array([1.3, 1.3, 1.35])) == EVEN
    assert relative_scale(np.array([1.0, 1.5, 1.0])) != EVEN
    parts = built_in_library().parts("picture-hills-oak")
    assert stretch_parts(parts, EVEN) is parts


STEPS = st.lists(st.floats(0.1, 5.0), min_size=3, max_size=3)


@given(STEPS, STEPS)
def test_ends_stay_and_lengths_grow_by_the_slope(widths: list[float], grown: list[float]) -> None:
    knots = np.concatenate([[0.0], np.cumsum(widths)]) / sum(widths)
    values = np.concatenate([[0.0], np.cumsum(grown)]) / sum(grown)
    axis = AxisMap(knots, values)
    np.testing.assert_allclose(axis(np.array([0.0, 1.0])), [0.0, 1.0], atol=1e-12)
    middle = (knots[:-1] + knots[1:]) / 2
    short = np.diff(knots) / 10
    np.testing.assert_allclose(axis(middle + short) - axis(middle), axis.slope(middle) * short, atol=1e-12)
    assert (np.diff(axis(np.linspace(0, 1, 50))) > 0).all()
