"""Thumbnails: whole, centred, transparent around, and made once."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import LibraryError
from diorama_core.render.views import StudioView, render_shape, studio_camera, thumbnail
from diorama_core.scene.types import box_corners
from tests.primitives import PrimitiveLibrary

LIBRARY = PrimitiveLibrary()


@pytest.mark.parametrize("shape_id", ["table", "chair", "ball", "print"])
def test_thumbnail_is_whole_and_fills_its_square(shape_id: str) -> None:
    image = Image.open(io.BytesIO(thumbnail(LIBRARY, shape_id, 96)))
    assert image.size == (96, 96)
    assert image.mode == "RGBA"
    opaque = np.asarray(image)[..., 3] > 250
    rows, columns = np.nonzero(opaque)
    assert rows.min() >= 1
    assert columns.min() >= 1
    assert max(rows.max(), columns.max()) <= 94
    assert max(np.ptp(rows), np.ptp(columns)) > 70


def test_there_is_a_soft_shadow_and_nothing_at_the_border() -> None:
    alpha = np.asarray(Image.open(io.BytesIO(thumbnail(LIBRARY, "chair", 96))))[..., 3]
    assert ((alpha > 20) & (alpha < 200)).sum() > 100
    border = np.concatenate([alpha[0], alpha[-1], alpha[:, 0], alpha[:, -1]])
    assert border.max() < 8


def test_made_once() -> None:
    assert thumbnail(LIBRARY, "ball", 64) is thumbnail(LIBRARY, "ball", 64)
    assert len(thumbnail(LIBRARY, "ball", 32)) < len(thumbnail(LIBRARY, "ball", 64))


def test_the_front_is_seen_from_the_front() -> None:
    front = render_shape(LIBRARY, "print", (64, 64), StudioView(0.0, 0.1))
    back = render_shape(LIBRARY, "print", (64, 64), StudioView(np.pi, 0.1))
    assert front[32, 20, :3].argmax() == 0
    assert front[32, 44, :3].argmax() == 1
    assert back[32, 20, :3].max() < 120


def test_camera_frames_the_box_from_any_side() -> None:
    corners = box_corners(LIBRARY.shape("table").size_m)
    for yaw in np.linspace(-3, 3, 7):
        for elevation in (-0.2, 0.3, 1.2):
            camera = studio_camera(corners, StudioView(float(yaw), elevation), 120, 80)
            pixels = camera.project(corners)
            assert (pixels >= -0.01).all()
            assert (pixels <= np.array([120.01, 80.01])).all()


def test_unknown_shape_is_named() -> None:
    with pytest.raises(LibraryError, match="gone"):
        thumbnail(LIBRARY, "gone")
