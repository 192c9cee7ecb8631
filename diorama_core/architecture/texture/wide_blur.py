"""Gaussian blurs of any width for about the same time: what is blurred widely is the same on a coarse grid."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float32

MIN_COARSE_SIGMA = 6.0
"""The grid is so fine that the blur's sigma has so many cells: linear interpolation then hardly shows."""


def wide_blur(picture: Float32[np.ndarray, "h w *c"], sigma_px: float) -> Float32[np.ndarray, "h w *c"]:
    """The picture blurred by a Gaussian.

    Args:
        picture: Of up to four channels.
        sigma_px: Its standard deviation.
    """
    height, width = picture.shape[:2]
    step = int(sigma_px / MIN_COARSE_SIGMA)
    if step < 2:
        return cv2.GaussianBlur(picture, (0, 0), sigma_px)
    cells = (max(width // step, 1), max(height // step, 1))
    coarse = cv2.resize(picture, cells, interpolation=cv2.INTER_AREA)
    # Averaging over cells and interpolating between them blur a little, too.
    sigmas = [_remaining(sigma_px * n / size) for n, size in zip(cells, (width, height), strict=True)]
    edge = cv2.BORDER_REFLECT  # mirrors at the picture's edge, as the default does on a fine grid
    coarse = cv2.GaussianBlur(coarse, (0, 0), sigmaX=sigmas[0], sigmaY=sigmas[1], borderType=edge)
    return cv2.resize(coarse, (width, height), interpolation=cv2.INTER_LINEAR)


def _remaining(sigma_cells: float) -> float:
    return float(np.sqrt(max(sigma_cells**2 - 1 / 12 - 1 / 6, 0.25)))
