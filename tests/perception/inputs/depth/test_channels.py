"""Depth in the bytes of colours."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from diorama_core.perception.inputs.depth.channels import depth_of_colours
from tests.perception.inputs.depth.rooms import room

DEPTH, _ = room()


def in_bytes(values: np.ndarray, *channels: int) -> np.ndarray:
    """Whole numbers in the bytes of the given channels, highest first."""
    colours = np.zeros((*values.shape, 3), np.uint8)
    for place, channel in enumerate(reversed(channels)):
        colours[..., channel] = (values.astype(np.int64) >> 8 * place) & 255
    return colours


@pytest.mark.parametrize(
    ("per_metre", "channels"), [(1000, (0, 1)), (1000, (1, 0)), (5000, (1, 2)), (16777.215, (2, 1, 0))]
)
def test_bytes_of_one_number_are_put_together(per_metre: float, channels: tuple[int, ...]) -> None:
    values = np.round(DEPTH * per_metre).astype(np.int64)
    found = depth_of_colours(in_bytes(values, *channels))
    assert (found[0] == values).all()
    words = ", ".join(["red", "green", "blue"][k] for k in channels)
    assert words in found[1][0]


def test_colours_for_the_eye_are_none() -> None:
    grey = np.clip(255 / DEPTH, 0, 255).astype(np.uint8)
    assert depth_of_colours(cv2.applyColorMap(grey, cv2.COLORMAP_JET)) is None
    noise = np.random.default_rng(1).integers(0, 256, (60, 80, 3), dtype=np.uint8)
    assert depth_of_colours(noise) is None
    assert depth_of_colours(np.repeat(grey[..., None], 3, axis=2))[1] == ()
