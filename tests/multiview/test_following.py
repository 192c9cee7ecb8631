from __future__ import annotations

import numpy as np

from diorama_core.artefacts import FurtherPhoto, Inputs, Photo
from diorama_core.multiview.following import following
from diorama_core.scene.types import Camera
from tests.multiview.rooms import CAMERAS

PHOTO = Photo(np.zeros((4, 6, 3), np.uint8), "p.png", (6, 4))
FURTHER = (
    FurtherPhoto("p", Inputs(PHOTO), CAMERAS[1], (("chair_1", (0.0, 0.0, 2.0, 2.0)),)),
    FurtherPhoto("q", Inputs(PHOTO)),
)


def scaled(camera: Camera, factor: float) -> Camera:
    T = camera.T_world_camera.copy()
    T[:3, 3] *= factor
    return Camera(camera.intrinsics, T)


def test_the_same_camera_changes_nothing() -> None:
    assert following(FURTHER, CAMERAS[0], CAMERAS[0]) == FURTHER


def test_a_scaled_scene_takes_the_photos_along() -> None:
    now = following(FURTHER, CAMERAS[0], scaled(CAMERAS[0], 1.5))
    assert now[0].camera == scaled(CAMERAS[1], 1.5)
    assert now[0].seen == FURTHER[0].seen
    assert now[1].camera is None


def test_a_scene_built_anew_lets_them_go() -> None:
    for after in (CAMERAS[2], None):
        now = following(FURTHER, CAMERAS[0], after)
        assert [p.camera for p in now] == [None, None]
        assert now[0].seen == ()
        assert now[0].inputs is FURTHER[0].inputs
