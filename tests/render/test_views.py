"""Studio views: seen from the right side, framed whole."""

from __future__ import annotations

import numpy as np

from diorama_core.render.views import StudioView, render_shape, studio_camera
from diorama_core.scene.types import box_corners
from tests.primitives import PrimitiveLibrary

LIBRARY = PrimitiveLibrary()


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
