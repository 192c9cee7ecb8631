"""One room from the walls that several photos see."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import DetectedObject
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.multiview.joint_room import SeenRoom, joint_room, with_open_doorways
from diorama_core.scene.types import Architecture, Plane
from tests.multiview.rooms import camera

TOP_M = 2.5


def wall(name: str, left, right, confidence: float = 0.6) -> Plane:
    """A wall whose foot runs from left to right as seen from the room."""
    (ax, ay), (bx, by) = left, right
    corners = [[ax, ay, 0], [bx, by, 0], [bx, by, TOP_M], [ax, ay, TOP_M]]
    return Plane(name, "wall", np.array(corners, dtype=float), confidence=confidence)


def floor(x0: float, y0: float, x1: float, y1: float) -> Plane:
    corners = np.array([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]], dtype=float)
    return Plane("floor", "floor", corners, confidence=0.6)


def room(*planes: Plane) -> Architecture:
    return Architecture(planes)


NORTH = SeenRoom(
    room(floor(-2.6, -2.4, 2.6, 2.0), wall("wall_1", (-2.6, 2.0), (2.0, 2.0)), wall("wall_2", (2.0, 2.0), (2.0, -2.0))),
    camera(-0.6, -1.6, (0.3, 2.0)),
)
"""Sees the north and the east wall of a room from -2 to 2; its floor goes on to the west."""
WEST = SeenRoom(
    room(
        floor(-2.0, -2.6, 2.4, 2.04),
        wall("wall_1", (-2.0, -2.6), (-2.0, 2.04)),
        wall("wall_2", (-2.0, 2.04), (1.0, 2.04)),
    ),
    camera(1.4, -0.6, (-2.0, 0.6)),
)


def sides(architecture: Architecture) -> list[tuple[float, ...]]:
    return sorted(tuple(np.round(w.normal[:2], 3) + 0.0) for w in architecture.by_role("wall") if w.is_seen)


def test_walls_that_only_another_photo_sees_are_the_rooms() -> None:
    found = joint_room([NORTH, WEST], [])
    assert sides(found) == [(-1.0, 0.0), (0.0, -1.0), (1.0, 0.0)]
    outline = found.by_role("floor")[0].polygon
    assert outline[:, 0].min() == pytest.approx(-2.0, abs=0.05)
    assert outline[:, 0].max() == pytest.approx(2.0, abs=0.05)
    assert 1.95 < outline[:, 1].max() < 2.1, "the north wall is one line of both photos"
    assert len({w.id for w in found.planes}) == len(found.planes)


def test_walls_look_into_the_room_and_stand_on_its_outline() -> None:
    found = joint_room([NORTH, WEST], [])
    outline = found.by_role("floor")[0].polygon[:, :2]
    for plane in found.by_role("wall"):
        middle = plane.polygon[:2, :2].mean(axis=0)
        assert is_in_polygon((middle + 0.1 * plane.normal[:2])[None], outline).all()
        assert not is_in_polygon((middle - 0.1 * plane.normal[:2])[None], outline).any()
        assert plane.polygon[:2, 2] == pytest.approx(0.0)
        assert plane.polygon[2:, 2] == pytest.approx(TOP_M)


def test_without_a_seen_wall_the_first_room_stays() -> None:
    bare = SeenRoom(room(floor(-1, -1, 1, 1), wall("wall_1", (-1, 1), (1, 1), confidence=0.15)), camera(0.0, -0.5))
    assert joint_room([bare, bare], []) is bare.architecture


def test_an_open_doorway_cuts_the_wall_for_all_photos() -> None:
    joint = joint_room([NORTH, WEST], [])
    corners = np.array([[x, 2.0, z] for x in (-0.3, 0.5) for z in (0.0, 2.0)])
    pixels = NORTH.camera.project(corners)
    (x1, y1), (x2, y2) = pixels.min(axis=0).tolist(), pixels.max(axis=0).tolist()
    mark = DetectedObject("gap", "door", "open doorway", (x1, y1, x2, y2), np.zeros((480, 640), bool), 1, 0.9)
    photos = (SeenRoom(NORTH.architecture, NORTH.camera, (mark,)), WEST)
    cut, marks = with_open_doorways(joint, photos)
    assert marks == (("gap",), ())
    notched = [w for w in cut.by_role("wall") if len(w.polygon) > 4]
    assert len(notched) == 1
    assert notched[0].normal == pytest.approx([0.0, -1.0, 0.0], abs=1e-3)
