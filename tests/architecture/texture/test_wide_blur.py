from __future__ import annotations

import cv2
import numpy as np
import pytest

from diorama_core.architecture.texture.wide_blur import wide_blur


@pytest.mark.parametrize("sigma_px", [2.0, 13.0, 40.0, 130.0])
@pytest.mark.parametrize("size", [(240, 517), (480, 300)])
def test_as_a_gaussian_blur_to_within_a_level_or_two(size: tuple[int, int], sigma_px: float) -> None:
    rng = np.random.default_rng(3)
    picture = rng.uniform(0.0, 255.0, (*size, 3)).astype(np.float32)
    picture[: size[0] // 3, : size[1] // 3] = 20.0
    exact = cv2.GaussianBlur(picture, (0, 0), sigma_px)
    inner = (slice(size[0] // 8, -size[0] // 8), slice(size[1] // 8, -size[1] // 8))
    off = np.abs(wide_blur(picture, sigma_px) - exact)
    assert off[inner].max() < 1.5
    assert off.mean() < 0.5


def test_an_even_picture_stays_even_and_one_channel_stays_one() -> None:
    even = np.full((90, 70), 37.0, np.float32)
    blurred = wide_blur(even, 300.0)
    assert blurred.shape == even.shape
    np.testing.assert_allclose(blurred, even, rtol=1e-5)
