from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from diorama_core.models.images import (
    CLIP_MEAN,
    CLIP_STD,
    FILL,
    antialias,
    box_crop,
    enlarge,
    normalise,
    pad_square,
    resize,
)


@pytest.fixture
def picture(rng) -> np.ndarray:
    return rng.integers(0, 255, (30, 40, 3), dtype=np.uint8)


def test_resizing_is_pillows(picture) -> None:
    expected = np.asarray(Image.fromarray(picture).resize((20, 16), Image.Resampling.BICUBIC))
    np.testing.assert_array_equal(resize(picture, (16, 20), Image.Resampling.BICUBIC), expected)
    np.testing.assert_array_equal(resize(picture[:, ::-1], (30, 40)), picture[:, ::-1])


def test_normalisation_is_per_channel_and_channels_come_first(picture) -> None:
    found = normalise(picture, CLIP_MEAN, CLIP_STD)
    assert found.shape == (1, 3, 30, 40)
    assert found.dtype == np.float32
    for channel in range(3):
        expected = (picture[..., channel] / 255 - CLIP_MEAN[channel]) / CLIP_STD[channel]
        np.testing.assert_allclose(found[0, channel], expected, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(normalise(picture / 255.0, CLIP_MEAN, CLIP_STD), found, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("shape", [(30, 40, 3), (40, 30, 3), (5, 5, 3)])
def test_squares_are_padded_right_and_below(shape, rng) -> None:
    picture = rng.integers(1, 255, shape, dtype=np.uint8)
    square = pad_square(picture)
    side = max(shape[:2])
    assert square.shape == (side, side, 3)
    np.testing.assert_allclose(square[: shape[0], : shape[1]], picture / 255.0, rtol=1e-6)
    assert square.sum() == pytest.approx(float((picture / 255.0).sum()), rel=1e-4)


def test_reduction_is_smooth_and_within_the_pictures_values(rng) -> None:
    noise = rng.random((96, 96, 3)).astype(np.float32)
    small = antialias(noise, 16)
    assert small.shape == (16, 16, 3)
    assert noise.min() <= small.min()
    assert small.max() <= noise.max()
    assert small.std() < 0.3 * noise.std()
    ramp = np.broadcast_to(np.linspace(0, 1, 96, dtype=np.float32)[None, :, None], (96, 96, 3)).copy()
    centres = (np.arange(16) + 0.5) * 6 - 0.5
    np.testing.assert_allclose(antialias(ramp, 16)[8, 2:-2, 0], centres[2:-2] / 95, atol=0.01)


def test_masks_are_enlarged_by_pixel_centres() -> None:
    small = np.array([[0.0, 1.0]], np.float32)
    np.testing.assert_allclose(enlarge(small, (1, 4)), [[0.0, 0.25, 0.75, 1.0]])
    assert enlarge(small, (6, 8)).shape == (6, 8)


GREEN = (0, 200, 0)


def boxed() -> np.ndarray:
    """A picture with a green box, four times as tall as wide."""
    rgb = np.zeros((120, 160, 3), np.uint8)
    rgb[20:100, 40:60] = GREEN
    return rgb


@pytest.mark.parametrize(("squeeze", "share"), [(0.0, 0.25), (0.5, 0.5), (1.0, 1.0)])
def test_a_long_box_is_stretched_as_far_as_asked(squeeze: float, share: float) -> None:
    crop = box_crop(boxed(), np.array([40.0, 20.0, 60.0, 100.0]), 0.0, 64, squeeze)
    assert crop.shape == (64, 64, 3)
    assert np.mean(crop[32, :, 1] > 100) == pytest.approx(share, abs=0.05)
    assert np.mean(crop[:, 32, 1] > 100) > 0.95


def test_what_is_outside_the_photo_is_grey() -> None:
    crop = box_crop(boxed(), np.array([-80.0, 0.0, 0.0, 80.0]), 0.0, 32)
    assert np.all(crop[:, :30] == FILL)
