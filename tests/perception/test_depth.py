"""Rendered and measured depth against exact ray casting."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import ArchitectureEstimate
from diorama_core.perception.depth import MeasuredDepth, RenderedDepth, fill_depth
from diorama_core.progress import Progress
from diorama_core.provenance import DepthSource, RoomMethod, RoomSource
from diorama_core.scene.types import Architecture
from tests.synthetic_rooms import box_room, cuboid, look, shoot

ITEMS = (cuboid("a", (-0.8, 2.5, 0), (0.6, 1.0, 0.8), 20), cuboid("b", (0.5, 2.0, 0), (0.5, 0.5, 0.9)))


@pytest.fixture(scope="module")
def shot():
    return shoot(look(15, 12), box_room(-1.8, 2.2, 4.0, 2.6), ITEMS)


def run(stage, shot):
    room = ArchitectureEstimate(Architecture(shot.planes), (), 1.0, RoomSource(RoomMethod.GIVEN))
    return stage.depth(shot.inputs, shot.objects, shot.geometry, room, Progress())


def test_rendered_depth_is_exact(shot):
    found = run(RenderedDepth(), shot)
    assert np.abs(found.depth_m - shot.inputs.depth_m).max() < 1e-3
    assert found.source is DepthSource.RENDERED


@pytest.mark.parametrize("stage", [RenderedDepth(), MeasuredDepth()])
def test_normals_are_unit_and_face_the_camera(shot, stage):
    found = run(stage, shot)
    rays = shot.camera.rays(np.stack(np.meshgrid(np.arange(640) + 0.5, np.arange(480) + 0.5), axis=-1))
    np.testing.assert_allclose(np.linalg.norm(found.normals_world, axis=-1), 1.0, atol=1e-4)
    assert ((found.normals_world * rays).sum(axis=-1) < 1e-3).mean() > 0.999


def test_pixels_of_a_mask_that_miss_the_cuboid_get_its_depth(shot):
    grown = replace(shot.objects[0], mask=np.roll(shot.objects[0].mask, -40, axis=1) | shot.objects[0].mask)
    found = run(RenderedDepth(), replace(shot, objects=(grown,)))
    centre_depth = shot.camera.to_camera(ITEMS[0].centre)[2]
    extra = found.depth_m[grown.mask & ~shot.objects[0].mask]
    assert np.abs(extra - centre_depth).max() < 0.8


def test_measured_depth_keeps_measurements_and_fills_holes(shot):
    holed = shot.inputs.depth_m.copy()
    holed[100:200, 300:420] = 0
    found = run(MeasuredDepth(), replace(shot, inputs=replace(shot.inputs, depth_m=holed)))
    assert (found.depth_m[holed > 0] == holed[holed > 0]).all()
    assert np.abs(found.depth_m - shot.inputs.depth_m)[holed == 0].max() < 0.01


def test_measured_normals_are_right_on_walls(shot):
    found = run(MeasuredDepth(), shot)
    exact = run(RenderedDepth(), shot)
    agree = (found.normals_world * exact.normals_world).sum(axis=-1)
    assert np.quantile(agree, 0.1) > 0.99


def test_without_planes_unknown_is_zero(shot):
    found = run(RenderedDepth(), replace(shot, planes=()))
    outside = ~np.any([o.mask for o in shot.objects], axis=0)
    assert (found.depth_m[outside] == 0).all()
    assert (found.normals_world[outside] == 0).all()


def test_measured_needs_depth(shot):
    with pytest.raises(ValueError, match="measured depth"):
        run(MeasuredDepth(), replace(shot, inputs=replace(shot.inputs, depth_m=None)))


def test_holes_of_depth_and_of_normals_are_filled_one_by_one(shot):
    rendered = np.full((1, 3), 2.0, np.float32), np.tile(np.array([0, 0, 1], np.float32), (1, 3, 1))
    depth = np.array([[1.0, 0.0, 1.0]], np.float32)
    toward = np.array([[[0, 0, -1.0], [0, 0, -1.0], [0, 0, 0]]])
    found = fill_depth(depth, toward, shot.camera, rendered, DepthSource.MEASURED)
    back = -shot.camera.T_world_camera[:3, 2]
    np.testing.assert_allclose(found.depth_m, [[1, 2, 1]])
    np.testing.assert_allclose(found.normals_world, [[back, back, [0, 0, 1]]], atol=1e-6)
