from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.feasible.visible_points import (
    select_tracked_points,
    turn_points,
    visible_points,
)
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.settings import LAYOUT
from diorama_core.progress import Progress
from diorama_core.scene.types import Pose, box_corners
from tests.layout.feasible.test_photo_observations import boxed, looking_north, outline
from tests.layout.small_rooms import Room

BOX = "box_24"


def test_points_are_on_the_side_that_the_camera_sees(room: Room) -> None:
    size = np.array(room.library.shape(BOX).size_m)
    box = room.put(BOX, (0.0, 1.0, 0.15), yaw=-np.pi / 2, scale=(1.0, 2.0, 1.0))
    scene = room.scene(camera=looking_north())
    points = visible_points(scene, room.library)[box]
    assert LAYOUT.min_points <= len(points) <= 2 * LAYOUT.max_points
    on_a_face = np.isclose(np.abs(points), size / 2, atol=2e-3)
    assert on_a_face.any(axis=1).all()
    # Turned to the camera is its front; of its top and its front something is seen, of its back and its foot nothing.
    assert points[:, 0].min() > -size[0] / 2 - 1e-3
    assert not np.isclose(points[:, 2], -size[2] / 2, atol=1e-3).all()


def test_what_is_hidden_has_no_points(room: Room) -> None:
    far = room.put(BOX, (0.0, 1.5, 0.15))
    room.put(BOX, (0.0, 0.5, 0.15), scale=(4.0, 4.0, 6.0))
    assert len(visible_points(room.scene(camera=looking_north(1.0)), room.library)[far]) == 0


def test_without_a_camera_nothing_is_seen(room: Room) -> None:
    room.put(BOX, (0.0, 1.5, 0.15))
    assert visible_points(room.scene(), room.library) == {}


def test_tracked_points_are_where_the_camera_sees_them(room: Room) -> None:
    box = room.put(BOX, (0.2, 1.0, 0.15), yaw=0.3, scale=(1.0, 2.0, 1.5))
    scene = room.scene(camera=looking_north())
    problem = build_problem(scene, room.library)
    bounds = np.array([outline(scene, box)])
    (tracked,) = select_tracked_points(
        problem, scene.camera, bounds, bounds + 30.0, visible_points(scene, room.library)
    )
    assert tracked.seen
    x1, y1, x2, y2 = bounds[0]
    assert (tracked.pixels > [x1 - 2, y1 - 2]).all()
    assert (tracked.pixels < [x2 + 2, y2 + 2]).all()
    world = scene.object(box).pose.apply(tracked.points)
    np.testing.assert_allclose(tracked.depth_m, scene.camera.to_camera(world)[:, 2])


def test_corners_stand_for_what_is_not_seen_and_follow_its_bounds(room: Room) -> None:
    box = room.put(BOX, (0.2, 1.0, 0.15))
    scene = room.scene(camera=looking_north())
    problem = build_problem(scene, room.library)
    bounds = np.array([outline(scene, box)])
    (tracked,) = select_tracked_points(problem, scene.camera, bounds, bounds + 30.0, {})
    assert not tracked.seen
    np.testing.assert_allclose(tracked.pixels.min(axis=0), bounds[0, :2] + 30.0, atol=1.5)


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_points_in_the_picture_stay_when_a_box_is_turned_by_quarters(turns: int) -> None:
    size = np.array([0.5, 1.0, 2.0])
    after = size[[1, 0, 2]] if turns % 2 else size
    seen = Pose.upright((0.0, 0.0, 0.0), 0.1).R_world_object
    turned = Pose.upright((0.0, 0.0, 0.0), 0.05 + turns * np.pi / 2).R_world_object
    before = box_corners(size)
    same = turn_points(before, size, seen, turned) * (after / size)
    assert np.abs(before @ seen.T - same @ turned.T).max() < 0.1


def test_an_end_that_is_outside_the_picture_does_not_hold_an_object_back(room: Room) -> None:
    """What is seen of a long cabinet stays where it was seen when its wall moves it, whatever its far end does."""
    size = room.library.shape("cabinet_10").size_m
    at = (2.0, 2.5 - size[0] / 2 - 0.2, 0.4)
    cabinet = room.put("cabinet_10", at, yaw=-np.pi / 2, scale=(1.0, 1.5, 1.0), adheres_to=("wall_2",))
    scene = boxed(room.scene(camera=looking_north()))
    points = visible_points(scene, room.library)[cabinet]
    moved, _ = FeasibleRecipe(room.library).optimise(scene, Progress())
    before = scene.camera.project(scene.object(cabinet).pose.apply(points))
    after = scene.camera.project(moved.object(cabinet).pose.apply(points))
    pushed = scene.camera.project(
        replace(scene.object(cabinet).pose, position=np.array([2.0, at[1] + 0.2, 0.4])).apply(points)
    )
    assert np.abs(after - before).mean() < 0.6 * np.abs(pushed - before).mean()
