"""Models with fewer triangles: still the same thing, still a GLB that others read."""

from __future__ import annotations

import io

import numpy as np
import pytest
import trimesh

from diorama_app.viewport.mesh_assets import ShapeBytes
from diorama_core.library.catalogue import BuiltInLibrary, built_in_library
from diorama_core.library.simplify import simplify_glb


@pytest.fixture(scope="module")
def library() -> BuiltInLibrary:
    return built_in_library()


def scene_of(glb: bytes) -> trimesh.Scene:
    return trimesh.load_scene(io.BytesIO(glb), file_type="glb")


def triangles(scene: trimesh.Scene) -> int:
    return sum(len(g.faces) for g in scene.geometry.values())


def test_a_bed_keeps_its_size_materials_and_pictures(library: BuiltInLibrary) -> None:
    heavy = library.glb("bed-channel-green")
    before, after = scene_of(heavy), scene_of(simplify_glb(heavy, 600))
    assert triangles(before) > 8000
    assert triangles(after) < 0.2 * triangles(before)
    np.testing.assert_allclose(after.bounds, before.bounds, atol=0.03)
    names = [{g.visual.material.name for g in s.geometry.values()} for s in (before, after)]
    assert names[0] == names[1]
    for mesh in after.geometry.values():
        assert mesh.visual.uv is not None
        assert mesh.visual.material.baseColorTexture is not None


def test_thin_rods_of_metal_beds_stay(library: BuiltInLibrary) -> None:
    """Every part keeps most of its surface, at the fewest triangles that a crowded room leaves a bed."""
    beds = [s.id for s in library.in_category("bed") if "metal" in s.caption or "iron" in s.caption]
    assert beds, "the library has beds with frames of metal"
    for shape in beds:
        heavy = library.glb(shape)
        before, after = scene_of(heavy), scene_of(simplify_glb(heavy, 400))
        assert set(before.geometry) == set(after.geometry)
        for name, part in after.geometry.items():
            assert part.area > 0.75 * before.geometry[name].area, f"{shape}: {name}"


def pieces(scene: trimesh.Scene) -> np.ndarray:
    """Middle and extents of every connected piece."""
    found = []
    for mesh in scene.geometry.values():
        whole = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
        whole.merge_vertices(merge_tex=True, merge_norm=True)
        found += [[*p.bounds.mean(axis=0), *np.ptp(p.bounds, axis=0)] for p in whole.split(only_watertight=False)]
    return np.array(found)


@pytest.mark.parametrize("shape", ["bed-iron", "chair-wire-black"])
def test_every_rail_and_wire_stays(library: BuiltInLibrary, shape: str) -> None:
    """A part keeps most of its surface even where some of its rails vanish: each piece is looked at."""
    heavy = library.glb(shape)
    before, after = pieces(scene_of(heavy)), pieces(scene_of(simplify_glb(heavy, 400)))
    gone = [p for p in before if np.abs(after - p).max(axis=1).min() > 0.04]
    assert len(before) > 20
    assert gone == []


def test_what_is_light_enough_stays_as_it_is(library: BuiltInLibrary) -> None:
    light = library.glb("bed-channel-green")
    assert simplify_glb(light, 50_000) is light


def test_models_with_parts_it_does_not_know_stay_as_they_are() -> None:
    points = trimesh.Scene(trimesh.PointCloud(np.random.default_rng(0).normal(size=(5000, 3))))
    data = bytes(points.export(file_type="glb"))
    assert simplify_glb(data, 100) is data


def test_shapes_are_sent_lighter_when_asked_and_the_fewer_the_finer(library: BuiltInLibrary) -> None:
    full, light = ShapeBytes(library), ShapeBytes(library, light=True)
    whole = triangles(scene_of(full.glb("bed-channel-green")))
    counts = []
    for objects in (6, 20, 200):
        light.expect(objects)
        counts.append(triangles(scene_of(light.glb("bed-channel-green"))))
    assert whole > counts[0] > counts[1] > counts[2] > 300
    full.expect(200)
    assert triangles(scene_of(full.glb("bed-channel-green"))) == whole
