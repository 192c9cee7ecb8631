from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.sphere import directions, directions_at, level_axes, perspective, sample, sphere_pixels
from diorama_core.scene.types import Camera, Intrinsics

ANGLES = st.floats(-3.1, 3.1)


@given(st.floats(0.0, 0.999), st.floats(0.01, 0.99))
def test_pixels_and_directions_are_each_other_s_inverse(x: float, y: float) -> None:
    pixel = np.array([x * 800, y * 400])
    assert sphere_pixels(3.0 * directions_at(pixel, (800, 400)), 800) == pytest.approx(pixel, abs=1e-6)


def test_the_middle_looks_along_minus_y_and_columns_go_to_the_right() -> None:
    assert directions_at(np.array([400.0, 200.0]), (800, 400)) == pytest.approx([0, -1, 0], abs=1e-12)
    assert directions_at(np.array([200.0, 200.0]), (800, 400)) == pytest.approx([1, 0, 0], abs=1e-12)
    assert directions_at(np.array([0.0, 0.0]), (800, 400)) == pytest.approx([0, 0, 1], abs=1e-12)


@given(ANGLES, st.floats(-1.5, 1.5))
def test_level_cameras_are_upright_and_look_where_they_are_turned(azimuth: float, elevation: float) -> None:
    R = level_axes(azimuth, elevation)
    assert pytest.approx(np.eye(3), abs=1e-9) == R.T @ R
    assert np.linalg.det(R) == pytest.approx(1.0)
    assert R[2, 0] == 0.0
    assert R[2, 1] <= 0.0
    assert R[2, 2] == pytest.approx(np.sin(elevation))


@given(ANGLES)
def test_a_view_shows_each_direction_as_the_sphere_does(azimuth: float) -> None:
    """A picture whose colours are directions stays so in a view, also across the seam."""
    away = directions(256)
    picture = np.rint(127.5 + 127.5 * away).astype(np.uint8)
    k, T = Intrinsics(40, 30, 22.0, 22.0, 20.0, 12.0), np.eye(4)
    T[:3, :3] = level_axes(azimuth, 0.2)
    seen = perspective(picture, T[:3, :3], k)
    x, y = np.meshgrid(np.arange(40) + 0.5, np.arange(30) + 0.5)
    rays = Camera(k, T).rays(np.stack([x, y], axis=-1))
    true = 127.5 + 127.5 * rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    assert np.abs(seen - true).max() < 4.0
    assert np.abs(sample(picture, away).astype(int) - picture).max() <= 1
