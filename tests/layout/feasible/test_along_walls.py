"""What goes through a wall with its length is turned along it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.layout.feasible.along_walls import turned_along_walls
from diorama_core.layout.feasible.photo_observations import photo_observations
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north, outline
from tests.layout.small_rooms import Room

LIBRARY = box_library()
WALL_X = -3.0


def turned(room: Room, before_wall_m: float, hidden: str = "") -> tuple[Problem, Problem]:
    """A cabinet whose width goes through the left wall but for so much; its box in the photo ends at the border where
    a side is hidden; before and after.
    """
    width = LIBRARY.shape("cabinet_10").size_m[1]
    cabinet = room.put("cabinet_10", (WALL_X + before_wall_m - width / 2, 1.0, 0.4), yaw=np.pi / 2)
    camera = looking_north(4.0)
    scene = room.scene(camera=camera)
    x1, y1, x2, y2 = outline(scene, cabinet)
    box = (0.0 if hidden == "left" else x1, y1, 640.0 if hidden == "right" else x2, y2)
    problem = build_problem(replace(scene, objects=(replace(scene.objects[0], box_px=box),)), LIBRARY)
    return problem, turned_along_walls(problem, photo_observations(problem, camera, depth_weight=0.3))


def reach(problem: Problem, axis: int) -> tuple[float, float]:
    half = 0.5 * float((np.abs(problem.R[0]) @ (problem.shape_size[0] * problem.scale[0]))[axis])
    return float(problem.p[0, axis]) - half, float(problem.p[0, axis]) + half


def test_its_back_is_at_the_wall_and_its_front_where_it_was_seen(room: Room) -> None:
    seen = float(LIBRARY.shape("cabinet_10").size_m[0])
    before, after = turned(room, seen)
    np.testing.assert_allclose(after.R[0][:, 0], [1.0, 0.0, 0.0], atol=1e-9)
    assert reach(after, 0) == pytest.approx((WALL_X, WALL_X + seen), abs=1e-6)
    low, high = reach(after, 1)
    assert high - low == pytest.approx(before.shape_size[0, 1])


def test_it_goes_on_to_where_its_end_was_not_seen(room: Room) -> None:
    seen = float(LIBRARY.shape("cabinet_10").size_m[0])
    # What is nearer to the camera is farther left in its picture.
    before, after = turned(room, seen, hidden="left")
    assert reach(after, 1)[1] == pytest.approx(reach(before, 1)[1])
    assert reach(after, 1)[0] < reach(before, 1)[0] - 0.3


def test_what_is_mostly_before_the_wall_stays(room: Room) -> None:
    before, after = turned(room, 0.8 * float(LIBRARY.shape("cabinet_10").size_m[1]))
    np.testing.assert_array_equal(after.R, before.R)
    np.testing.assert_array_equal(after.p, before.p)
