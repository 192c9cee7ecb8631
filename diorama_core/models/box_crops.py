"""Boxes of a picture as networks look at them: cut out and scaled, and described by where they are."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8

CROP_SIDE = 96
MARGIN = 0.12
"""Share of the box's size on every side of a crop: what a thing stands on tells what it is."""
FILL = 114


def box_crop(
    rgb: UInt8[np.ndarray, "h w 3"],
    box: Float[np.ndarray, "4"],
    margin: float = MARGIN,
    side: int = CROP_SIDE,
    squeeze: float = 0.0,
) -> UInt8[np.ndarray, "side side 3"]:
    """The box with a margin as a square picture, grey outside the photo.

    Args:
        rgb: the photo.
        box: x1, y1, x2, y2 in its pixels; may reach beyond it.
        margin: of the box's size, on every side.
        side: of the square, pixels.
        squeeze: how far the shorter side may be stretched to fill the square: 0 keeps proportions, 1 fills it.
    """
    x1, y1, x2, y2 = (float(v) for v in box)
    longer = max(x2 - x1, y2 - y1)
    spans = [max(v, longer * (1 - squeeze)) * (1 + 2 * margin) for v in (x2 - x1, y2 - y1)]
    sx, sy = (side / max(span, 1e-3) for span in spans)
    cx, cy = (x1 + x2) / 2, (y1 + y2) / 2
    left, top = (max(0, int(c - 0.5 * side / s - 2)) for c, s in ((cx, sx), (cy, sy)))
    right, bottom = (int(c + 0.5 * side / s + 2) + 1 for c, s in ((cx, sx), (cy, sy)))
    part = rgb[top:bottom, left:right]
    if min(sx, sy) < 0.5:  # linear interpolation alone would skip pixels
        part = cv2.GaussianBlur(part, (0, 0), 0.4 / min(sx, sy))
    M = np.array([[sx, 0, side / 2 - sx * (cx - left)], [0, sy, side / 2 - sy * (cy - top)]], np.float32)
    return cv2.warpAffine(part, M, (side, side), flags=cv2.INTER_LINEAR, borderValue=(FILL, FILL, FILL))


def box_geometry(box: Float[np.ndarray, "4"], width: int, height: int) -> Float32[np.ndarray, "6"]:
    """Where a box is and how large: middle, lower edge, logarithms of size and proportions; the picture has width 1."""
    x1, y1, x2, y2 = np.asarray(box, dtype=np.float64) / width
    w, h = max(x2 - x1, 1e-3), max(y2 - y1, 1e-3)
    tall = height / width
    return np.array(
        [(x1 + x2) / 2 - 0.5, (y1 + y2) / (2 * tall) - 0.5, y2 / tall - 0.5, np.log(w), np.log(h), np.log(w / h)],
        np.float32,
    )
