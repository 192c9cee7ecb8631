"""The camera model: corners, exposure, noise, white balance and development, each by what it should do to light."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.scene.types import Intrinsics
from diorama_core.synthesis.photograph import (
    CameraResponse,
    develop,
    falloff,
    middle_tone,
    noisy,
    photograph,
    white_gains,
)

K = Intrinsics(64, 48, 50.0, 50.0, 32.0, 24.0)
GREY = np.ones(3)
QUIET = CameraResponse(vignetting=0.0, full_well_e=1e9, read_noise_e=0.0, blur_px=0.0)


def test_exposure_does_not_depend_on_the_unit_of_light() -> None:
    light = np.random.default_rng(0).uniform(0.2, 1.0, (48, 64, 3))
    dim, bright = (photograph(light * unit, K, GREY, QUIET).astype(int) for unit in (0.01, 100.0))
    assert np.abs(dim - bright).max() <= 1


def test_the_meter_ignores_a_small_lamp() -> None:
    wall = np.full((48, 64, 3), 0.4)
    lamp = wall.copy()
    lamp[:2, :2] = 400.0
    assert middle_tone(wall) == pytest.approx(0.4)
    assert middle_tone(lamp) < 1.1 * middle_tone(wall)


def test_corners_are_darker_than_the_axis_and_only_as_far_as_asked() -> None:
    lens = falloff(K, 1.0)
    assert lens[24, 32] == pytest.approx(1.0, abs=1e-3)
    x, y = (0.5 - K.cx) / K.fx, (0.5 - K.cy) / K.fy
    assert lens[0, 0] == pytest.approx((1 + x * x + y * y) ** -2)
    assert (falloff(K, 0.0) == 1.0).all()
    assert lens[0, 0] < falloff(K, 0.5)[0, 0] < 1.0


def test_noise_is_that_of_photons_and_of_reading() -> None:
    camera = CameraResponse(full_well_e=1000.0, read_noise_e=5.0)
    for brightness in (0.01, 0.5):
        read = noisy(np.full((200, 200, 3), brightness), camera, seed=1)
        assert read.mean() == pytest.approx(brightness, rel=0.01)
        expected = np.sqrt(1000.0 * brightness + 25.0) / 1000.0
        assert read.std() == pytest.approx(expected, rel=0.02)


def test_the_same_seed_takes_the_same_photo() -> None:
    light = np.full((48, 64, 3), 0.3)
    first, again, other = (photograph(light, K, GREY, seed=seed) for seed in (1, 1, 2))
    assert (first == again).all()
    assert (first != other).any()


def test_white_balance_makes_the_rooms_light_white() -> None:
    warm = np.array([1.0, 0.8, 0.6])
    light = np.broadcast_to(warm * 0.5, (48, 64, 3)).copy()
    neutral = photograph(light, K, warm, replace(QUIET, balance=1.0)).reshape(-1, 3).mean(axis=0)
    assert np.ptp(neutral) < 1.0
    partly = photograph(light, K, warm, replace(QUIET, balance=0.5)).reshape(-1, 3).mean(axis=0)
    assert partly[0] > partly[1] > partly[2]
    assert white_gains(warm, 0.0) == pytest.approx(np.ones(3))


def test_highlights_keep_their_order_and_never_pass_white() -> None:
    light = np.linspace(0.0, 3.0, 300).reshape(1, -1, 1).repeat(3, axis=2)
    shown = develop(light, CameraResponse())[0, :, 0].astype(int)
    assert (np.diff(shown) >= 0).all()
    assert shown[0] == 0
    assert 200 < shown[99] < 255  # brightness 1 is bright, and not yet burnt out


@pytest.mark.parametrize("wrong", [-1.0, np.nan, np.inf])
def test_what_is_no_light_is_refused(wrong: float) -> None:
    light = np.full((48, 64, 3), 0.5)
    light[0, 0, 0] = wrong
    with pytest.raises(ValueError, match="finite and at least 0"):
        photograph(light, K, GREY)


def test_a_picture_of_another_size_is_refused() -> None:
    with pytest.raises(ValueError, match="radiance is"):
        photograph(np.ones((10, 10, 3)), K, GREY)
