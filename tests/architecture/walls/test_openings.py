"""Doorways and windows are cut where a measured wall is seen through; mirrors, corridors: `test_degenerate`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.architecture.walls.openings import WallOpening, with_openings
from diorama_core.artefacts import DetectedObject
from diorama_core.evaluation.metrics.architecture import plane_points
from diorama_core.geometry.casting import camera_rays, cast_plane
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod
from diorama_core.scene import edits
from diorama_core.scene.types import Architecture, Plane, Scene
from tests.synthetic_rooms import box_room, floor, look, shoot, wall

SIZE = (320, 240)
DOORWAY, WINDOW = WallOpening(0.6, 1.5, 0.0, 2.05), WallOpening(2.4, 3.4, 0.9, 2.0)


def wall_with(*openings):
    plain = wall("back", (-2.0, 4.0), (2.0, 4.0), 2.6)
    return replace(plain, polygon=with_openings(plain.polygon, openings))


def reconstruct(shot):
    return PlanarRoom().reconstruct(shot.inputs, (), shot.geometry, Progress())


def opened_room(*openings):
    room = {p.id: p for p in box_room(-2.0, 2.0, 4.0, 2.6)}
    room["back"] = wall_with(*openings)
    beyond = (
        wall("far", (-4, 7), (4, 7), 2.6),
        Plane("yard", "floor", floor((-4, 4), (4, 4), (4, 7), (-4, 7)).polygon),
    )
    return shoot(look(0, 6, fov_deg=70, size=SIZE), (*room.values(), *beyond))


def test_a_wall_with_openings_is_one_polygon_of_the_right_area():
    plane = wall_with(DOORWAY, WINDOW)
    assert len(plane_points((plane,), 0.02)) * 0.02**2 == pytest.approx(4 * 2.6 - 0.9 * 2.05 - 1.1, abs=0.03)
    np.testing.assert_allclose(plane.normal, [0, -1, 0], atol=1e-12)
    origin = np.array([0.0, 0.0, 1.5])
    targets = np.array([[-0.9, 4, 1.5], [0.9, 4, 1.5], [-1.8, 4, 1.5], [0.9, 4, 0.5]])
    np.testing.assert_array_equal(np.isfinite(cast_plane(origin, targets - origin, plane)), [False, False, True, True])


def test_a_doorway_and_a_window_are_found_where_they_are():
    estimate = reconstruct(opened_room(DOORWAY, WINDOW))
    assert (estimate.source.doorways, estimate.source.windows) == (1, 1)
    found = next(p for p in estimate.architecture.by_role("wall") if abs(p.offset + 4.0) < 0.05 and p.normal[1] < -0.9)
    camera = look(0, 6, fov_deg=70, size=SIZE)
    origin, rays = camera_rays(camera, 2)
    ours, truth = (np.isfinite(cast_plane(origin, rays, p)) for p in (found, wall_with(DOORWAY, WINDOW)))
    assert (ours & truth).sum() / (ours | truth).sum() > 0.93


def test_a_closed_wall_has_none():
    source = reconstruct(opened_room()).source
    assert (source.doorways, source.windows) == (0, 0)


@pytest.mark.parametrize("pitch", [-80, -45, 80])
def test_views_of_ceiling_or_floor_alone_give_a_room_with_a_reason(pitch):
    estimate = reconstruct(shoot(look(0, pitch, size=SIZE), box_room(-2.0, 2.0, 4.0, 2.6)))
    assert estimate.architecture.floor is not None
    assert estimate.architecture.by_role("wall")
    assert estimate.source.method is RoomMethod.DEPTH_PLANES
    assert estimate.source.floor_found == (pitch > 0)


def test_depth_that_is_no_number_counts_as_missing():
    shot = shoot(look(0, 6, size=SIZE), box_room(-2.0, 2.0, 4.0, 2.6))
    depth = shot.inputs.depth_m.copy()
    depth[:60], depth[60:90] = np.nan, np.inf
    walls = reconstruct(replace(shot, inputs=replace(shot.inputs, depth_m=depth))).architecture.by_role("wall")
    assert any(abs(w.offset + 4.0) < 0.05 for w in walls)


def test_raising_the_ceiling_leaves_doors_and_windows_as_they_are():
    before = wall_with(DOORWAY, WINDOW)
    after = edits.set_ceiling_height(Scene(architecture=Architecture((before,))), 3.0).plane("back")
    changed = np.abs(after.polygon - before.polygon).max(axis=1) > 1e-9
    np.testing.assert_array_equal(changed, before.polygon[:, 2] > 2.5)


@pytest.mark.parametrize(("label", "expected"), [("doorway", ("it",)), ("window", ()), ("french doors", ())])
def test_what_is_seen_through_is_a_hole_and_only_a_doorway_is_no_object(label, expected):
    shot = opened_room(DOORWAY)
    left, right, top = -2.0 + DOORWAY.left, -2.0 + DOORWAY.right, DOORWAY.top
    pixels = shot.camera.project(np.array([[x, 4.0, z] for x in (left, right) for z in (0.0, top)]))
    box = (*(float(v) for v in pixels.min(axis=0)), *(float(v) for v in pixels.max(axis=0)))
    rows, columns = np.indices(shot.inputs.depth_m.shape)
    mask = (columns >= box[0]) & (columns < box[2]) & (rows >= box[1]) & (rows < box[3])
    found = DetectedObject("it", "door", label, box, mask, 1, 1.0)
    estimate = PlanarRoom().reconstruct(shot.inputs, (found,), shot.geometry, Progress())
    assert estimate.openings == expected
    assert estimate.source.doorways == 1
