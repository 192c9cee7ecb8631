"""Objects with unseen feet come before the walls behind them, and still look the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.before_walls import MIN_CONFIDENCE, REACH_M, drawn_before_walls
from diorama_core.architecture.mounting import MIN_SCALE
from diorama_core.artefacts import ArchitectureEstimate, Cuboid, ObjectGeometry
from diorama_core.provenance import RoomMethod, RoomSource, ScaleSource
from diorama_core.scene.types import Architecture, Support
from tests.synthetic_rooms import box_room, cuboid, look

CAMERA = look(10, 5)
ROOM = tuple(replace(p, confidence=0.8) for p in box_room(-2.0, 2.0, 4.0, 2.6))
DRESSER = replace(cuboid("dresser", (0.3, 4.3, 0.0), (0.5, 1.0, 0.8), yaw_deg=-90), foot_seen=False)
VASE = cuboid("vase", (0.2, 4.3, 0.8), (0.15, 0.15, 0.3))


def drawn(*cuboids: Cuboid, planes=ROOM) -> dict[str, Cuboid]:
    floor = next(p.id for p in planes if p.role == "floor")
    edges = (Support("dresser", floor, "placed on"), Support("vase", "dresser", "placed on"))
    geometry = ObjectGeometry(CAMERA, cuboids, edges, ScaleSource.GIVEN)
    room = ArchitectureEstimate(Architecture(planes), edges, 1.0, RoomSource(RoomMethod.GIVEN))
    return {c.object_id: c for c in drawn_before_walls(geometry, room).cuboids}


def test_an_object_whose_foot_is_hidden_comes_before_the_wall_and_reaches_the_floor():
    found = drawn(DRESSER)["dresser"]
    assert found.corners_world[:, 1].max() == pytest.approx(4.0, abs=1e-9)
    assert found.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    upper = DRESSER.corners_world[:, 2] > 0.1
    seen = [CAMERA.project(c.corners_world[upper]) for c in (found, DRESSER)]
    np.testing.assert_allclose(*seen, atol=1e-6)
    assert found.size_m[2] > DRESSER.size_m[2]
    assert found.size_m[1] < DRESSER.size_m[1]


def test_what_it_carries_comes_along_and_looks_the_same():
    found = drawn(DRESSER, VASE)
    np.testing.assert_allclose(
        CAMERA.project(found["vase"].corners_world), CAMERA.project(VASE.corners_world), atol=1e-6
    )
    top, base = found["dresser"].corners_world[:, 2].max(), found["vase"].corners_world[:, 2].min()
    assert base == pytest.approx(top, abs=1e-9)


def test_what_is_seen_to_stand_there_stays_and_so_does_what_is_before_the_wall():
    seen = replace(DRESSER, foot_seen=True)
    assert drawn(seen, VASE) == {"dresser": seen, "vase": VASE}
    before = replace(DRESSER, centre=DRESSER.centre - [0.0, 0.55 - 0.5 * REACH_M, 0.0])
    assert drawn(before)["dresser"] == before


def test_a_guessed_wall_draws_nothing_and_none_draws_beyond_belief():
    guessed = tuple(replace(p, confidence=0.5 * MIN_CONFIDENCE) for p in ROOM)
    assert drawn(DRESSER, planes=guessed)["dresser"] == DRESSER
    far = replace(DRESSER, centre=DRESSER.centre + np.array([0.0, 6.0, 0.0]))
    distance = [np.linalg.norm(c.centre[:2] - CAMERA.position[:2]) for c in (drawn(far)["dresser"], far)]
    assert distance[0] == pytest.approx(MIN_SCALE * distance[1])
