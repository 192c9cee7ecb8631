"""Wall things touch their wall and look the same in the photo. Objects with unseen feet come before the walls behind
them, and still look the same.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.along_sight import (
    MAX_SCALE,
    MIN_CONFIDENCE,
    MIN_SCALE,
    REACH_M,
    move_in_front_of_walls,
    snap_to_ceiling,
    snap_to_walls,
)
from diorama_core.artefacts import ArchitectureEstimate, Cuboid, ObjectGeometry
from diorama_core.provenance import RoomMethod, RoomSource, ScaleSource
from diorama_core.scene.types import Architecture, Plane, Support
from tests.synthetic_rooms import box_room, cuboid, look

CAMERA = look(10, 5)
ROOM = box_room(-2.0, 2.0, 4.0, 2.6)


def hung(item, relation="mounted on", parent="back", source=ScaleSource.OBJECT_SIZES):
    edge = Support(item.object_id, parent, relation)
    geometry = ObjectGeometry(CAMERA, (item,), (edge,), source)
    (found,) = snap_to_walls(
        geometry, ArchitectureEstimate(Architecture(ROOM), (edge,), 1.0, RoomSource(RoomMethod.GIVEN))
    ).cuboids
    return found


@pytest.mark.parametrize("y", [3.2, 3.6, 4.5])
def test_touches_the_wall_and_projects_alike(y):
    picture = cuboid("picture", (0.3, y, 1.4), (0.04, 0.8, 0.5), yaw_deg=-90)
    found = hung(picture)
    assert found.corners_world[:, 1].max() == pytest.approx(4.0, abs=1e-9)
    np.testing.assert_allclose(CAMERA.project(found.corners_world), CAMERA.project(picture.corners_world), atol=1e-6)


def test_does_not_grow_beyond_belief():
    picture = cuboid("picture", (0.1, 1.0, 1.6), (0.04, 0.4, 0.3), yaw_deg=-90)
    np.testing.assert_allclose(hung(picture).size_m, MAX_SCALE * picture.size_m)


def test_what_was_measured_far_before_the_wall_stays_there():
    cup, picture = (cuboid("cup", (0.3, y, 1.0), (0.1, 0.1, 0.1)) for y in (2.0, 3.7))
    np.testing.assert_array_equal(hung(cup, source=ScaleSource.DEPTH).centre, cup.centre)
    assert hung(picture, source=ScaleSource.DEPTH).corners_world[:, 1].max() == pytest.approx(4.0, abs=1e-9)


def test_a_door_stays_on_the_floor():
    door = cuboid("door", (0.3, 3.0, 0.0), (0.06, 0.85, 2.03), yaw_deg=-90)
    assert hung(door).corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("base", [0.0, 0.05])
def test_a_low_thing_is_not_brought_below_the_floor(base):
    radiator = cuboid("radiator", (0.3, 3.0, base), (0.1, 1.0, 0.3), yaw_deg=-90)
    found = hung(radiator)
    assert found.corners_world[:, 2].min() > -1e-9
    assert found.size_m[2] >= radiator.size_m[2] - 1e-9


def test_standing_objects_stay():
    chair = cuboid("chair", (0.3, 3.0, 0.0), (0.5, 0.5, 0.9))
    assert hung(chair, "placed on", "floor") == chair


@pytest.mark.parametrize("z", [1.9, 2.2, 2.5])
def test_a_lamp_reaches_the_ceiling_inside_the_room(z):
    lamp = cuboid("lamp", (0.1, 2.6, z), (0.4, 0.4, 0.3))
    edge = Support("lamp", "ceiling", "mounted on")
    geometry = ObjectGeometry(CAMERA, (lamp,), (edge,), ScaleSource.GIVEN)
    room = ArchitectureEstimate(Architecture(ROOM), (edge,), 1.0, RoomSource(RoomMethod.GIVEN))
    (found,) = snap_to_ceiling(geometry, room).cuboids
    assert found.corners_world[:, 2].max() == pytest.approx(2.6, abs=1e-9)
    assert found.corners_world[:, 1].max() < 4.0
    assert (found.size_m <= 1.8 * MAX_SCALE * lamp.size_m).all()


def test_a_lamp_rises_past_a_wall_that_ends_beside_its_line_of_sight():
    lamp = cuboid("lamp", (-1.0, 2.6, 1.9), (0.4, 0.4, 0.3))
    edge = Support("lamp", "ceiling", "mounted on")
    geometry = ObjectGeometry(CAMERA, (lamp,), (edge,), ScaleSource.GIVEN)
    corners = np.array([[0.8, 3.0, 0.0], [2.0, 3.0, 0.0], [2.0, 3.0, 2.6], [0.8, 3.0, 2.6]])

    def depth(*more: Plane) -> float:
        room = Architecture((*ROOM, *more))
        estimate = ArchitectureEstimate(room, (edge,), 1.0, RoomSource(RoomMethod.GIVEN))
        return float(snap_to_ceiling(geometry, estimate).cuboids[0].centre[1])

    beside = Plane("fold", "wall", corners)
    before = Plane("fold", "wall", corners - np.array([2.4, 0.0, 0.0]))
    assert depth(beside) == pytest.approx(depth())
    assert depth() > 3.0
    assert depth(before) < 3.0


SURE_ROOM = tuple(replace(p, confidence=0.8) for p in box_room(-2.0, 2.0, 4.0, 2.6))
DRESSER = replace(cuboid("dresser", (0.3, 4.3, 0.0), (0.5, 1.0, 0.8), yaw_deg=-90), foot_seen=False)
VASE = cuboid("vase", (0.2, 4.3, 0.8), (0.15, 0.15, 0.3))


def drawn(*cuboids: Cuboid, planes=SURE_ROOM) -> dict[str, Cuboid]:
    floor = next(p.id for p in planes if p.role == "floor")
    edges = (Support("dresser", floor, "placed on"), Support("vase", "dresser", "placed on"))
    geometry = ObjectGeometry(CAMERA, cuboids, edges, ScaleSource.GIVEN)
    room = ArchitectureEstimate(Architecture(planes), edges, 1.0, RoomSource(RoomMethod.GIVEN))
    return {c.object_id: c for c in move_in_front_of_walls(geometry, room).cuboids}


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
    guessed = tuple(replace(p, confidence=0.5 * MIN_CONFIDENCE) for p in SURE_ROOM)
    assert drawn(DRESSER, planes=guessed)["dresser"] == DRESSER
    far = replace(DRESSER, centre=DRESSER.centre + np.array([0.0, 6.0, 0.0]))
    distance = [np.linalg.norm(c.centre[:2] - CAMERA.position[:2]) for c in (drawn(far)["dresser"], far)]
    assert distance[0] == pytest.approx(MIN_SCALE * distance[1])
