"""The place of a photo among boxes that were measured."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from shapely.geometry import Point, box

from diorama_core.artefacts import CameraEstimate, CameraHypothesis
from diorama_core.multiview.camera_in_room import MeasuredThing, camera_in_room
from diorama_core.multiview.rooms import photo_world
from diorama_core.provenance import CameraSource
from diorama_core.scene.types import Camera
from tests.multiview.rooms import CAMERAS, THINGS, Thing, photo, turn_off_deg

FLOOR = box(-3.0, -3.2, 3.0, 2.4)
FURTHER = (
    *THINGS,
    Thing("window", (-2.95, -0.5, 1.5), (0.06, 1.4, 1.2)),
    Thing("desk", (2.5, 1.7, 0.37), (0.7, 1.4, 0.74), np.pi),
)


def measured(things: tuple[Thing, ...] = FURTHER, off_m: float = 0.02) -> list[MeasuredThing]:
    rng = np.random.default_rng(4)
    return [
        MeasuredThing(frozenset({t.kind}), np.array(t.centre) + rng.normal(0, off_m, 3), t.yaw_rad, np.array(t.size_m))
        for t in things
    ]


def read_alone(camera: Camera, focal: float = 1.0) -> CameraEstimate:
    """What a photo tells by itself: gravity, the room's axes up to quarter turns, and a focal length."""
    k = replace(camera.intrinsics, fx=focal * camera.intrinsics.fx, fy=focal * camera.intrinsics.fy)
    R = np.linalg.inv(photo_world(camera))[:3, :3] @ camera.T_world_camera[:3, :3]
    return CameraEstimate((CameraHypothesis(k, R, 1.0),), 1.0, CameraSource.exact())


@pytest.mark.parametrize(("number", "focal"), [(0, 1.0), (1, 1.04)])
def test_the_camera_is_where_boxes_look_as_in_the_photo(number: int, focal: float) -> None:
    camera = CAMERAS[number]
    seen, whose = photo(camera, FURTHER)
    found = camera_in_room(measured(), FLOOR, read_alone(camera, focal), seen.boxes.observations)
    assert found is not None
    assert np.linalg.norm(found.camera.position - camera.position) < 0.2
    assert turn_off_deg(found.camera, camera) < 3.0
    assert {(whose[b], t) for t, b in found.met} == {(whose[b], whose[b]) for _, b in found.met}
    assert len(found.met) == len(whose)


def test_a_photo_of_other_furniture_has_no_place() -> None:
    other = (
        Thing("sofa", (1.9, -0.4, 0.42), (0.95, 2.0, 0.84), np.pi),
        Thing("armchair", (0.0, 1.9, 0.45), (0.85, 0.8, 0.9), -1.6),
        Thing("armchair", (-0.3, -0.9, 0.45), (0.85, 0.8, 0.9), 1.1),
        Thing("bookshelf", (0.9, 2.1, 0.9), (0.32, 0.9, 1.8), -np.pi / 2),
        Thing("desk", (-1.9, 0.9, 0.37), (0.7, 1.4, 0.74)),
    )
    seen, _ = photo(CAMERAS[0], other)
    assert camera_in_room(measured(), FLOOR, read_alone(CAMERAS[0]), seen.boxes.observations) is None


def test_two_things_do_not_tell_a_place() -> None:
    seen, _ = photo(CAMERAS[0], THINGS[:2])
    assert camera_in_room(measured(), FLOOR, read_alone(CAMERAS[0]), seen.boxes.observations) is None
    seen, _ = photo(CAMERAS[0], FURTHER)
    assert camera_in_room(measured(THINGS[:2]), FLOOR, read_alone(CAMERAS[0]), seen.boxes.observations) is None


def test_a_camera_outside_the_room_has_no_place() -> None:
    T = CAMERAS[0].T_world_camera.copy()
    T[:3, 3] += [0.0, -2.5, 0.0]
    far = Camera(CAMERAS[0].intrinsics, T)
    seen, _ = photo(far, FURTHER)
    found = camera_in_room(measured(), FLOOR, read_alone(far), seen.boxes.observations)
    assert found is None or FLOOR.buffer(0.31).contains(Point(found.camera.position[:2]))
