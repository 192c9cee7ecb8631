"""Cameras of stored pictures, turned with the pictures that are shown upright."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_core.multiview.turned_cameras import quarters_of, upright_camera
from diorama_core.scene.types import Camera, Intrinsics


def pixel(camera: Camera, point: np.ndarray) -> np.ndarray:
    local = np.linalg.inv(camera.T_world_camera) @ np.append(point, 1.0)
    k = camera.intrinsics
    return np.array([k.fx * local[0] / local[2] + k.cx, k.fy * local[1] / local[2] + k.cy])


@pytest.mark.parametrize(("tag", "quarters"), [(1, 0), (6, 1), (3, 2), (8, 3)])
def test_a_point_is_seen_where_the_turned_picture_shows_it(tmp_path: Path, tag: int, quarters: int) -> None:
    exif = Image.Exif()
    exif[0x0112] = tag
    Image.new("RGB", (40, 30)).save(tmp_path / "a.jpg", exif=exif)
    assert quarters_of(tmp_path / "a.jpg") == quarters
    stored = Camera(Intrinsics(40, 30, 50.0, 48.0, 21.0, 14.0), np.eye(4))
    upright = upright_camera(stored, quarters)
    u, v = pixel(stored, np.array([0.1, 0.2, 1.5]))
    turned = {0: (u, v), 1: (30 - v, u), 2: (40 - u, 30 - v), 3: (v, 40 - u)}[quarters]
    assert pixel(upright, np.array([0.1, 0.2, 1.5])) == pytest.approx(turned)
    assert (upright.intrinsics.width > upright.intrinsics.height) == (quarters % 2 == 0)
