from __future__ import annotations

import numpy as np

from diorama_core.appearance.light import Shade, estimate_light
from diorama_core.scene.types import RoomLight

NORMALS = np.array([[0.0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, -1, 0], [0, 1, 0]])


def shade(albedo: float, b: tuple[float, float, float], normals: np.ndarray = NORMALS) -> Shade:
    light = 1 + normals @ np.array(b)
    return Shade(normals, albedo * light, np.full(len(normals), 1 / len(normals)))


def test_light_from_the_side_is_found() -> None:
    true = (0.4, -0.2, 0.4)
    found = estimate_light([shade(a, true) for a in (0.1, 0.2, 0.3, 0.5, 0.6, 0.7, 0.4, 0.8)])
    np.testing.assert_allclose(np.array(found.direction) * found.strength, true, atol=0.12)


def test_flat_objects_say_nothing_of_light() -> None:
    one = shade(0.5, (0.4, 0, 0), NORMALS[:1])
    assert estimate_light([one] * 5) == RoomLight()


def test_shadows_below_things_are_no_light_from_below() -> None:
    below = estimate_light([shade(a, (0.0, 0.0, -0.5), NORMALS) for a in (0.2, 0.5, 0.8)])
    assert below.direction[2] > 0


def test_walls_and_a_window_tell_the_side_where_objects_say_nothing() -> None:
    walls = shade(0.7, (0.4, 0.0, 0.3), np.array([[1.0, 0, 0], [0, -1, 0]]))
    assert estimate_light([], walls).direction[0] > 0.3
    window = estimate_light([], None, np.array([0.0, -0.8, 0.6]))
    assert window.direction[1] < -0.3
    assert window.direction[2] > 0.3
