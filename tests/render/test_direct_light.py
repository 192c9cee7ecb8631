from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.ray_scene import RayScene
from diorama_core.render.direct_light import DirectLight, LampLight, SunLight

NOTHING = RayScene(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32))
LID = RayScene(
    np.array([[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.int32)
)
UP = np.array([[0, 0, 1]], np.float32)
ORIGIN = np.zeros((1, 3), np.float32)
MIDDLE = np.full((1, 2), 0.5, np.float32)


def falling(light: DirectLight, normal: np.ndarray = UP) -> np.ndarray:
    return light.falling(ORIGIN, normal, MIDDLE)[0]


def test_the_sun_shines_by_the_cosine_where_nothing_is_in_the_way() -> None:
    toward = np.array([0.0, 0.6, 0.8])
    assert falling(SunLight(toward, np.array([2.0, 1.0, 0.5]), NOTHING)) == pytest.approx([1.6, 0.8, 0.4])
    assert not falling(SunLight(toward, np.ones(3), LID)).any()
    assert not falling(SunLight(toward, np.ones(3), NOTHING), -UP).any()


def test_a_lamp_shines_by_the_square_of_its_distance() -> None:
    def at(height: float, blockers: RayScene = NOTHING) -> float:
        return float(falling(LampLight(np.array([0.0, 0.0, height]), np.ones(3), 0.001, blockers))[0])

    assert at(2.0) == pytest.approx(0.25, rel=0.01)
    assert at(0.5) == pytest.approx(4.0, rel=0.02)
    assert at(2.0, LID) == 0.0
    assert at(0.5, LID) == pytest.approx(4.0, rel=0.02), "below the lid"
