"""Boxes cut out of pictures."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.models.box_crops import FILL, box_crop

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
