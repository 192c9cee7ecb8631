from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.scene.types import Pose, Scene
from diorama_core.synthesis.light import room_light
from tests.primitives import PrimitiveLibrary, box_room, place

LIBRARY = PrimitiveLibrary()


def window(name: str, size=(0.06, 1.2, 1.3), yaw: float = -np.pi / 2):
    item = place(LIBRARY, name, "print", (0.0, 4.97, 1.5))
    scale = np.array(size) / np.array(item.shape_size_m)
    return replace(item, category="window", pose=Pose.upright((0.0, 4.97, 1.5), yaw, scale))


def test_light_comes_through_the_largest_window_into_the_room() -> None:
    scene = Scene(architecture=box_room(), objects=(window("small", (0.06, 0.5, 0.5)), window("large")))
    light = room_light(scene)
    np.testing.assert_allclose(light.inward, [0, -1, 0], atol=1e-9)
    np.testing.assert_allclose(light.window_centre, [0.0, 4.85, 1.5], atol=1e-9)
    half = np.linalg.norm(light.window_edges, axis=1)
    np.testing.assert_allclose(half, [0.6, 0.65], rtol=1e-6)
    assert np.abs(light.window_edges @ light.inward).max() < 1e-9


def test_without_a_window_a_lamp_hangs_in_the_middle_below_the_ceiling() -> None:
    light = room_light(Scene(architecture=box_room(4.0, 5.0, 2.6)))
    np.testing.assert_allclose(light.window_centre, [0.0, 2.5, 2.35])
    assert light.window_edges[:, 2].tolist() == [0.0, 0.0]
    assert light.window_irradiance[0] > light.window_irradiance[2], "lamps are warm"
