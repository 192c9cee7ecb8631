from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.evaluation.metrics.light import light_error_deg, main_light
from diorama_core.render.lighting import room_lighting
from diorama_core.scene.types import RoomLight
from tests.pose.rooms import camera_at

BOUNDS = np.array([[-2.0, -2.0, 0.0], [2.0, 2.0, 2.5]])


@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), (0.8, 0.0, 0.6), (0.0, -0.6, 0.8)])
def test_the_main_light_of_pictures_is_the_one_they_were_made_with(direction: tuple[float, float, float]) -> None:
    found = main_light(room_lighting(BOUNDS, RoomLight(direction, 0.5)), BOUNDS.mean(axis=0)[None])
    assert np.degrees(np.arccos(found @ np.array(direction) / np.linalg.norm(found))) < 8.0


def test_directions_are_compared_as_the_photo_sees_them() -> None:
    camera = camera_at()
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    T = camera.T_world_camera.copy()
    T[:3, :3] = turn @ T[:3, :3]
    turned = replace(camera, T_world_camera=T)
    true, found = np.array([0.6, 0.0, 0.8]), RoomLight((0.0, 0.6, 0.8), 0.4)
    assert light_error_deg(true, camera, found, turned) == pytest.approx(0.0, abs=1e-4)
    assert light_error_deg(true, camera, found, camera) == pytest.approx(50.2, abs=0.1)
    assert light_error_deg(true, camera, None, camera) is None
