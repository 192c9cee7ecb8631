from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.appearance.irradiance import irradiance_map
from diorama_core.scene.types import RoomLight
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()


def test_light_from_one_side_falls_on_that_side() -> None:
    scene = furnished_room(LIBRARY)
    assert scene.camera is not None
    even, left, right = (
        irradiance_map(replace(scene, light=RoomLight((x, 0.0, 0.4), strength)), scene.camera, LIBRARY)
        for x, strength in ((0.0, 0.0), (-0.9, 0.8), (0.9, 0.8))
    )
    assert even.shape == (scene.camera.intrinsics.height, scene.camera.intrinsics.width, 3)
    assert even.std() < 0.6 * left.std()
    assert np.abs(left - right).mean() > 0.1


def test_an_even_light_is_about_one() -> None:
    scene = furnished_room(LIBRARY)
    assert scene.camera is not None
    found = irradiance_map(replace(scene, light=RoomLight((0.0, 0.0, 1.0), 0.1)), scene.camera, LIBRARY)
    assert 0.6 < float(np.median(found)) < 1.2
