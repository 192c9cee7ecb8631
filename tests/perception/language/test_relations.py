"""Where a language model says a thing faces is where its front is turned, as far as the picture does not tell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import SceneGraph
from diorama_core.perception.language.relations import with_graph
from diorama_core.pose import RenderAndCompare
from diorama_core.progress import Progress
from tests.pose.rooms import LIBRARY, Room, camera_at, standing

HEADINGS = {"toward camera": -90.0, "away from camera": 90.0, "left": 180.0, "right": 0.0}
"""Degrees from +X, for a thing straight ahead of a camera that looks along +Y."""


def _room() -> Room:
    return Room(camera_at(), (standing("carton", 0.0, 3.0, 0.0),), (0,))


def _graph(room: Room, direction: str) -> SceneGraph:
    return SceneGraph(room.geometry.supports, (1.0,), facing=(("o0", direction),))


def _off_deg(heading_rad: float, wanted_deg: float) -> float:
    return float(abs((np.rad2deg(heading_rad) - wanted_deg + 180.0) % 360.0 - 180.0))


@pytest.mark.parametrize("direction", HEADINGS)
def test_a_named_direction_turns_the_front_of_the_pose(direction: str) -> None:
    room = _room()
    geometry = with_graph(room.geometry, _graph(room, direction))
    cuboid = geometry.cuboids[0]
    assert cuboid.front_known
    front = cuboid.R_world_object[:2, 0]
    assert _off_deg(float(np.arctan2(front[1], front[0])), HEADINGS[direction]) < 1.0
    corners = [np.sort(g.cuboids[0].corners_world.round(6), axis=0) for g in (room.geometry, geometry)]
    np.testing.assert_allclose(corners[0], corners[1], atol=1e-5)
    posed = RenderAndCompare(LIBRARY).pose(
        room.inputs, room.objects, geometry, room.depth(measured=False), room.ranked(), Progress()
    )
    assert _off_deg(posed[0].candidates[0].pose.yaw_rad, HEADINGS[direction]) < 15.0


@pytest.mark.parametrize("direction", ["unknown", "upwards"])
def test_other_words_turn_nothing(direction: str) -> None:
    room = _room()
    assert with_graph(room.geometry, _graph(room, direction)).cuboids == room.geometry.cuboids


def test_a_front_that_is_known_already_stays() -> None:
    room = _room()
    known = replace(room.geometry, cuboids=(replace(room.geometry.cuboids[0], front_known=True),))
    assert with_graph(known, _graph(room, "left")).cuboids == known.cuboids
