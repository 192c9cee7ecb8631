from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.editing.clearances import clear_of_walls
from diorama_core.editing.plan_edits import empty_room
from diorama_core.scene.types import Pose
from tests.editing.objects import item

ROOM = empty_room(4.0, 6.0, 2.5)
SIZE = (0.6, 1.0, 0.8)


@pytest.mark.parametrize(
    ("place", "yaw"),
    [((1.95, 0.0), 0.0), ((1.99, 1.0), 0.7), ((1.9, 2.9), 0.3), ((-1.95, -2.95), 1.2), ((2.05, 0.0), 0.0)],
)
def test_what_is_put_at_a_wall_is_inside_the_room(place: tuple[float, float], yaw: float) -> None:
    put = item("cabinet", SIZE, *place, yaw)
    corners = replace(put, pose=clear_of_walls(ROOM, put)).corners_world[:, :2]
    assert (np.abs(corners) <= np.array([2.0, 3.0]) + 1e-6).all()


def test_what_is_free_stays() -> None:
    put = item("cabinet", SIZE, 0.3, 0.4, 0.5)
    assert clear_of_walls(ROOM, put) == put.pose


def test_walls_that_are_elsewhere_push_nothing() -> None:
    """Behind a wall's end: the wall of another part of the room is in line with it."""
    plane = next(p for p in ROOM.architecture.by_role("wall") if p.normal[0] < -0.9)
    short = replace(plane, polygon=plane.polygon * np.array([1.0, 0.3, 1.0]))
    room = replace(ROOM, architecture=replace(ROOM.architecture, planes=(short,)))
    put = item("cabinet", SIZE, 1.95, 2.5)
    assert clear_of_walls(room, put) == Pose.upright(put.pose.position, 0.0)
