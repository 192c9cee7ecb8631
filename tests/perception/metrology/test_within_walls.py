"""Objects whose feet are hidden are measured anew where the walls leave no room for them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import ArchitectureEstimate, Cuboid, Inputs, ObjectGeometry, Photo
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.floor import place_on_floor, solve_all
from diorama_core.perception.metrology.placement import readings_of
from diorama_core.perception.metrology.problem import View
from diorama_core.perception.metrology.within_walls import measured_within_walls
from diorama_core.provenance import RoomMethod, RoomSource, ScaleSource
from diorama_core.scene.types import Architecture, Camera, Support, yaw_rotation
from tests.perception.metrology.test_metrology import K, RequestedObject, rotation, seen
from tests.synthetic_rooms import box_room

HEIGHT_M, R = 1.5, rotation(12.0)
SOFA = RequestedObject("sofa", (-1.54, 3.4, 0.42), (0.9, 1.9, 0.84), 0.0)
PILLOW = RequestedObject("pillow", (-1.7, 3.7, 0.62), (0.2, 0.48, 0.38), 0.0)
CHEST = RequestedObject("chest", (-0.85, 2.2, 0.3), (0.5, 1.4, 0.6))
ROOM = tuple(replace(p, confidence=0.8) for p in box_room(-2.0, 2.0, 6.0, 2.6))
INPUTS = Inputs(Photo(np.zeros((480, 640, 3), np.uint8), "synthetic", (640, 480)))


def moved(foot: np.ndarray, *, foot_seen: bool = False, behind: float = 1.4) -> tuple[ObjectGeometry, ObjectGeometry]:
    """The geometry with the sofa and its pillow beyond the left wall, and what is measured within the walls."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, [*foot[:2], HEIGHT_M]
    camera = Camera(K, T)
    objects = seen((SOFA, PILLOW, CHEST), R, HEIGHT_M)
    hidden_below = (*objects[0].box[:3], objects[2].box[1] + 4.0)
    objects = (replace(objects[0], box=hidden_below), *objects[1:])
    eye = np.array([0.0, 0.0, HEIGHT_M])
    cuboids = []
    for item, found, factor in zip((SOFA, PILLOW, CHEST), objects, (behind, behind, 1.0), strict=True):
        centre, size = eye + factor * (np.array(item.centre) - eye), factor * np.array(item.size)
        yaw = yaw_rotation(item.yaw)
        cuboids.append(Cuboid(found.id, yaw, centre + foot, size, 0.5, foot_seen=foot_seen or item is not SOFA))
    sofa, pillow, chest = (o.id for o in objects)
    edges = (Support(sofa, "floor"), Support(pillow, sofa), Support(chest, "floor"))
    planes = tuple(replace(p, polygon=p.polygon + foot) for p in ROOM)
    room = ArchitectureEstimate(Architecture(planes), edges, 1.0, RoomSource(RoomMethod.GIVEN))
    geometry = ObjectGeometry(camera, tuple(cuboids), edges, ScaleSource.OBJECT_SIZES)
    return geometry, measured_within_walls(geometry, room, objects, INPUTS)


@pytest.mark.parametrize("foot", [np.zeros(3), np.array([3.0, -2.0, 0.0])])
def test_a_sofa_that_would_stand_behind_the_wall_is_measured_before_it(foot: np.ndarray) -> None:
    before, after = moved(foot)
    sofa, pillow, chest = after.cuboids
    assert before.cuboids[0].corners_world[:, 0].min() < foot[0] - 2.2
    assert sofa.corners_world[:, 0].min() > foot[0] - 2.1
    np.testing.assert_allclose(np.sort(sofa.size_m), np.sort(SOFA.size), rtol=0.2)
    np.testing.assert_allclose(sofa.centre - foot, SOFA.centre, atol=0.35)
    np.testing.assert_allclose(pillow.centre - foot, PILLOW.centre, atol=0.35)
    np.testing.assert_allclose(chest.centre, before.cuboids[2].centre, atol=1e-12)


def test_what_is_seen_to_stand_there_and_what_is_before_the_walls_stays() -> None:
    for given in ({"foot_seen": True}, {"behind": 1.0}):
        before, after = moved(np.zeros(3), **given)
        for one, same in zip(before.cuboids, after.cuboids, strict=True):
            np.testing.assert_array_equal(same.corners_world, one.corners_world)


SIDEBOARD = RequestedObject("sideboard", (1.77, 3.4, 0.4), (0.46, 1.5, 0.8), 0.0)


def beside_the_wall(cuboid: Cuboid | None = None) -> tuple[ObjectGeometry, ObjectGeometry]:
    """A sideboard along the right wall as it was measured before and within the walls.

    Without a cuboid it was measured as the cheapest reading of its box that shows its front to the camera.
    """
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, [0.0, 0.0, HEIGHT_M]
    objects = seen((SIDEBOARD,), R, HEIGHT_M)
    if cuboid is None:
        observations, view = gather(objects, K.width, K.height), View(K, R)
        readings = readings_of(solve_all(place_on_floor(observations, 0, HEIGHT_M), view), observations, view)[0]
        row = next(k for k, yaw in enumerate(readings.boxes.yaw_rad) if abs(np.sin(yaw)) > 0.9)
        boxes = readings.boxes
        cuboid = Cuboid("", yaw_rotation(-np.pi / 2), boxes.centre[row], boxes.size_m[row], 0.5)
    cuboid = replace(cuboid, object_id=objects[0].id)
    edges = (Support(cuboid.object_id, "floor"),)
    room = ArchitectureEstimate(Architecture(ROOM), edges, 1.0, RoomSource(RoomMethod.GIVEN))
    geometry = ObjectGeometry(Camera(K, T), (cuboid,), edges, ScaleSource.OBJECT_SIZES)
    return geometry, measured_within_walls(geometry, room, objects, INPUTS)


def test_a_sideboard_that_seems_to_show_its_front_stands_with_its_back_at_the_wall() -> None:
    before, after = beside_the_wall()
    (old,), (new,) = before.cuboids, after.cuboids
    assert abs(old.R_world_object[0, 0]) < 0.1 < 0.9 < abs(new.R_world_object[0, 0])
    np.testing.assert_allclose(new.corners_world[:, 0].max(), 2.0, atol=0.25)
    assert new.size_m[1] > 1.5 * new.size_m[0]


def test_what_no_reading_of_its_box_explains_keeps_its_place() -> None:
    before, after = beside_the_wall(Cuboid("", np.eye(3), np.array([1.0, 1.9, 1.0]), np.full(3, 2.0), 0.5))
    np.testing.assert_array_equal(after.cuboids[0].corners_world, before.cuboids[0].corners_world)
