"""Cameras of stored pictures, turned with the pictures that are shown upright."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.artefacts import FurtherPhoto, Inputs, Photo
from diorama_core.multiview.camera_changes import following, quarters_of, upright_camera
from diorama_core.scene.types import Camera, Intrinsics, rigid
from tests.multiview.rooms import CAMERAS

PHOTO = Photo(np.zeros((4, 6, 3), np.uint8), "p.png", (6, 4))
FURTHER = (
    FurtherPhoto("p", Inputs(PHOTO), CAMERAS[1], (("chair_1", (0.0, 0.0, 2.0, 2.0)),)),
    FurtherPhoto("q", Inputs(PHOTO)),
    FurtherPhoto("sphere", Inputs(PHOTO), T_world_sphere=CAMERAS[1].T_world_camera),
)


def scaled(camera: Camera, factor: float) -> Camera:
    return Camera(camera.intrinsics, rigid(camera.T_world_camera[:3, :3], factor * camera.position))


def test_the_same_camera_changes_nothing() -> None:
    assert following(FURTHER, CAMERAS[0], CAMERAS[0]) == FURTHER


def test_a_scaled_scene_takes_the_photos_along() -> None:
    now = following(FURTHER, CAMERAS[0], scaled(CAMERAS[0], 1.5))
    assert now[0].camera == scaled(CAMERAS[1], 1.5)
    assert now[0].seen == FURTHER[0].seen
    assert now[1].camera is None
    assert now[2].T_world_sphere == pytest.approx(scaled(CAMERAS[1], 1.5).T_world_camera)


def test_a_scene_built_anew_lets_them_go() -> None:
    for after in (CAMERAS[2], None):
        now = following(FURTHER, CAMERAS[0], after)
        assert not any(p.is_placed for p in now)
        assert now[0].seen == ()
        assert now[0].inputs is FURTHER[0].inputs


@pytest.mark.parametrize(("tag", "quarters"), [(1, 0), (6, 1), (3, 2), (8, 3)])
def test_a_point_is_seen_where_the_turned_picture_shows_it(tmp_path: Path, tag: int, quarters: int) -> None:
    exif = Image.Exif()
    exif[0x0112] = tag
    Image.new("RGB", (40, 30)).save(tmp_path / "a.jpg", exif=exif)
    assert quarters_of(tmp_path / "a.jpg") == quarters
    stored = Camera(Intrinsics(40, 30, 50.0, 48.0, 21.0, 14.0), np.eye(4))
    upright = upright_camera(stored, quarters)
    u, v = stored.project(np.array([0.1, 0.2, 1.5]))
    turned = {0: (u, v), 1: (30 - v, u), 2: (40 - u, 30 - v), 3: (v, 40 - u)}[quarters]
    assert upright.project(np.array([0.1, 0.2, 1.5])) == pytest.approx(turned)
    assert (upright.intrinsics.width > upright.intrinsics.height) == (quarters % 2 == 0)
