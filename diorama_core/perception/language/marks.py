"""Set-of-mark pictures: every object outlined, with its number on it (Yang et al. 2023), legible at any size."""

from __future__ import annotations

import io
from collections.abc import Sequence

import cv2
import numpy as np
from jaxtyping import Bool, UInt8
from PIL import Image, ImageDraw, ImageFont

SMALLEST_SIDE_PX, LARGEST_SIDE_PX = 896, 1568
"""Longer sides between which pictures are sent: numbers stay legible, tokens stay few."""
_COLOURS = (
    (230, 25, 75), (60, 180, 75), (0, 110, 220), (245, 130, 48), (145, 30, 180), (0, 150, 160), (200, 0, 150),
    (120, 80, 20), (90, 120, 0), (20, 20, 120), (170, 0, 0), (0, 100, 60),
)  # fmt: skip
_FONT_SHARE = 0.024
_SMALLEST_FONT_PX = 20
_NAME_FONT_PX = 13
"""Names are longer than numbers; read at the size at which the picture is seen."""


def draw_marks(
    rgb: UInt8[np.ndarray, "h w 3"], masks: Sequence[Bool[np.ndarray, "h w"]], numbers: Sequence[int | str]
) -> UInt8[np.ndarray, "H W 3"]:
    """The photo with tinted outlines and numbers, or names; small photos are enlarged first, large ones reduced."""
    factor = _factor(*rgb.shape[:2])
    size = (round(rgb.shape[1] * factor), round(rgb.shape[0] * factor))
    canvas = np.asarray(Image.fromarray(rgb).resize(size, Image.Resampling.LANCZOS)).copy()
    scaled = [cv2.resize(m.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST).astype(bool) for m in masks]
    line = max(2, round(0.002 * max(size)))
    for index, mask in enumerate(scaled):
        colour = _COLOURS[index % len(_COLOURS)]
        outlines, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        cv2.drawContours(canvas, outlines, -1, colour, line)
    return _draw_numbers(canvas, scaled, numbers)


def _factor(height: int, width: int) -> float:
    side = max(height, width)
    return SMALLEST_SIDE_PX / side if side < SMALLEST_SIDE_PX else min(1.0, LARGEST_SIDE_PX / side)


def _draw_numbers(
    canvas: UInt8[np.ndarray, "h w 3"], masks: Sequence[np.ndarray], numbers: Sequence[int | str]
) -> UInt8[np.ndarray, "h w 3"]:
    picture = Image.fromarray(canvas)
    draw = ImageDraw.Draw(picture)
    named = any(isinstance(n, str) for n in numbers)
    size_px = _NAME_FONT_PX if named else max(_SMALLEST_FONT_PX, round(_FONT_SHARE * max(picture.size)))
    font = ImageFont.load_default(size_px)
    free = np.ones(canvas.shape[:2], dtype=bool)
    # Small objects choose first: a large one has room elsewhere.
    for index in sorted(range(len(masks)), key=lambda i: int(masks[i].sum())):
        text = str(numbers[index])
        left, top, right, bottom = (int(v) for v in draw.textbbox((0, 0), text, font=font))
        width, height = right - left + size_px // 2, bottom - top + size_px * 2 // 5
        x, y = _spot(masks[index], free, width, height)
        draw.rectangle((x, y, x + width, y + height), fill=_COLOURS[index % len(_COLOURS)], outline=(255, 255, 255))
        draw.text((x + size_px // 4 - left, y + size_px // 5 - top), text, fill=(255, 255, 255), font=font)
        free[max(0, y) : y + height + 1, max(0, x) : x + width + 1] = False
    return np.asarray(picture)


def _spot(mask: np.ndarray, free: np.ndarray, width: int, height: int) -> tuple[int, int]:
    """Upper left corner of a label: deep inside the mask, off other labels, within the picture."""
    rows, columns = mask.shape
    inside = cv2.distanceTransform(np.pad(mask & free, 1).astype(np.uint8), cv2.DIST_L2, 5)[1:-1, 1:-1]
    if not inside.any():
        inside = mask.astype(np.float32)
    y, x = np.unravel_index(int(inside.argmax()), mask.shape)
    left = min(max(int(x) - width // 2, 0), max(columns - width - 1, 0))
    top = min(max(int(y) - height // 2, 0), max(rows - height - 1, 0))
    # Of all places where no other label is, the nearest one.
    taken = cv2.integral((~free).astype(np.uint8))
    high, wide = height + 1, width + 1
    covered = taken[high:, wide:] - taken[:-high, wide:] - taken[high:, :-wide] + taken[:-high, :-wide]
    tops, lefts = np.nonzero(covered == 0)
    if not len(tops):
        return left, top
    nearest = int(np.argmin((tops - top) ** 2 + (lefts - left) ** 2))
    return int(lefts[nearest]), int(tops[nearest])


def picture_bytes(rgb: UInt8[np.ndarray, "h w 3"]) -> bytes:
    """As JPEG, the same bytes for the same picture."""
    buffer = io.BytesIO()
    Image.fromarray(rgb).save(buffer, "JPEG", quality=90)
    return buffer.getvalue()
