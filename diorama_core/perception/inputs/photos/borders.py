"""Plain borders around a photo: instant pictures, scanned prints, letterboxes of films and messengers."""

from __future__ import annotations

import numpy as np
from jaxtyping import UInt8

Margins = tuple[int, int, int, int]
"""Left, top, right and bottom, pixels."""

MIN_SHARE = 0.015
"""Smallest border, as a share of the side: narrower ones are left by rectification and are treated as lines."""
MAX_SHARE = 0.45
"""Largest border, as a share of the side: most of the picture must remain."""
COLOUR_TOLERANCE = 14.0
"""Levels by which a border's pixels may differ from its colour: JPEG's noise."""
PLAIN_SHARE = 0.985
"""Share of a border line's pixels that have the border's colour."""
INNER_SHARE = 0.6
"""Share of the first inner line that differs: a photo ends there, not an object before a plain background."""
BLUR_PX = 3
"""Lines between border and photo that mix both."""


def plain_borders(rgb: UInt8[np.ndarray, "h w 3"]) -> Margins | None:
    """The margins of a border of one colour on two opposite sides or all around; None where there is none.

    A border is as plain as paint, as wide as the picture, and ends along a straight line, within which the photo
    differs from it nearly everywhere.
    """
    if not any(_is_plain(line) for line in (rgb[0], rgb[:, 0])):
        return None
    import cv2  # the editor opens without it

    corner = np.trunc(np.median(rgb[:4, :4].reshape(-1, 3), axis=0))
    off = cv2.inRange(rgb, corner - COLOUR_TOLERANCE, corner + COLOUR_TOLERANCE) == 0
    top, bottom = _plain_lines(off), _plain_lines(off[::-1])
    height, width = off.shape
    if top + bottom >= height:
        return None
    inside = off[top : height - bottom]
    left, right = _plain_lines(inside.T), _plain_lines(inside.T[::-1])
    if left + right >= width:
        return None
    sides = ((top, bottom, height), (left, right, width))
    wide = [min(a, b) >= max(MIN_SHARE * n, 2) for a, b, n in sides]
    if not any(wide) or any(a + b > 2 * MAX_SHARE * n for a, b, n in sides):
        return None
    if not wide[0]:
        top = bottom = 0
    if not wide[1]:
        left = right = 0
    margins = _without_blur(off, (left, top, right, bottom))
    return margins if _ends_straight(off, margins) else None


def _is_plain(line: UInt8[np.ndarray, "n 3"]) -> bool:
    """Whether one line at the side has one colour: most photos are told by it at once."""
    off = np.abs(line.astype(np.int16) - np.median(line, axis=0).astype(np.int16)).max(axis=1)
    return bool((off <= COLOUR_TOLERANCE).mean() >= PLAIN_SHARE)


def _plain_lines(off: np.ndarray) -> int:
    """How many lines from the top have the border's colour."""
    plain = off.mean(axis=1) <= 1.0 - PLAIN_SHARE
    return len(plain) if plain.all() else int(np.argmin(plain))


def _without_blur(off: np.ndarray, margins: Margins) -> Margins:
    """The margins with the mixed lines where border and photo meet, of the sides that have a border."""
    height, width = off.shape
    left, top, right, bottom = margins
    mixed = [
        _mixed_lines(off[top:, left : width - right]) if top else 0,
        _mixed_lines(off[: height - bottom, left : width - right][::-1]) if bottom else 0,
        _mixed_lines(off[top : height - bottom, left:].T) if left else 0,
        _mixed_lines(off[top : height - bottom, : width - right].T[::-1]) if right else 0,
    ]
    return left + mixed[2], top + mixed[0], right + mixed[3], bottom + mixed[1]


def _mixed_lines(off: np.ndarray) -> int:
    shares = off[: BLUR_PX + 1].mean(axis=1)
    return int(np.argmax(shares >= INNER_SHARE)) if (shares >= INNER_SHARE).any() else 0


def _ends_straight(off: np.ndarray, margins: Margins) -> bool:
    """Whether the first lines within differ from the border nearly everywhere."""
    left, top, right, bottom = margins
    inner = off[top : off.shape[0] - bottom, left : off.shape[1] - right]
    if min(inner.shape) < 2 * BLUR_PX:
        return False
    edges = [
        line for m, line in ((top, inner[0]), (bottom, inner[-1]), (left, inner[:, 0]), (right, inner[:, -1])) if m
    ]
    return bool(edges) and min(float(e.mean()) for e in edges) >= INNER_SHARE
