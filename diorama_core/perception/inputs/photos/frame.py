"""How the photo's pixels come from the file's: turned by its header, reduced, and without plain borders: instant
pictures, scanned prints, letterboxes of films and messengers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Shaped, UInt8

from diorama_core.errors import InputError

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
    rows, columns = off[top : height - bottom], off[:, left : width - right]
    lines = (rows[:, left:].T, columns[top:], rows[:, : width - right].T[::-1], columns[: height - bottom][::-1])
    left, top, right, bottom = (m + (_count_mixed_lines(inner) if m else 0) for m, inner in zip(margins, lines))
    return left, top, right, bottom


def _count_mixed_lines(off: np.ndarray) -> int:
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


ASPECT_TOLERANCE = 0.02
"""Relative difference of proportions up to which a map lies over the photo."""
_TURNS = {2: (0, True), 3: (2, False), 4: (2, True), 5: (1, True), 6: (3, False), 7: (3, True), 8: (1, False)}
"""EXIF orientation: quarter turns to the left that make the stored pixels upright, and whether they are mirrored
(left and right exchanged) before."""

Size = tuple[int, int]


@dataclass(frozen=True)
class PhotoFrame:
    """Where the photo's pixels are in its file."""

    full_size: Size
    """Width and height of the upright file."""
    margins: tuple[int, int, int, int] = (0, 0, 0, 0)
    """Left, top, right and bottom of a border that was cut off, pixels of the upright file."""
    orientation: int = 1
    """The header's EXIF orientation."""
    half_turned: bool = False
    """Whether the upright file is upside down all the same, and everything is turned by 180 degrees at the end."""

    @property
    def inner_size(self) -> Size:
        """Width and height of the upright file without its border."""
        left, top, right, bottom = self.margins
        return self.full_size[0] - left - right, self.full_size[1] - top - bottom

    @property
    def stored_size(self) -> Size:
        """Width and height of the file's pixels as they are stored."""
        width, height = self.full_size
        return (height, width) if self.orientation >= 5 else (width, height)

    def upright(self, stored: Shaped[np.ndarray, "h w *c"]) -> Shaped[np.ndarray, "h2 w2 *c"]:
        """A map of the stored pixels turned as the header says."""
        quarters, mirrored = _TURNS.get(self.orientation, (0, False))
        return np.rot90(stored[:, ::-1] if mirrored else stored, quarters)

    def upright_box(self, box: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
        """A box in stored pixels, in upright ones."""
        width, height = self.stored_size
        quarters, mirrored = _TURNS.get(self.orientation, (0, False))
        x1, y1, x2, y2 = box
        if mirrored:
            x1, x2 = width - x2, width - x1
        for _ in range(quarters):
            x1, y1, x2, y2 = y1, width - x2, y2, width - x1
            width, height = height, width
        return x1, y1, x2, y2

    def align_map(
        self, name: str, what: str, values: Shaped[np.ndarray, "h w *c"]
    ) -> tuple[Shaped[np.ndarray, "h2 w2 *c"], tuple[str, ...]]:
        """A map as it lies over the photo without its border, whether it came with it, or unturned; and what was done.

        Raises:
            InputError: its proportions are neither those of the photo nor of its stored pixels.
        """
        laid, notes = self._align_map(name, what, values)
        return (laid[::-1, ::-1] if self.half_turned else laid), notes

    def _align_map(
        self, name: str, what: str, values: Shaped[np.ndarray, "h w *c"]
    ) -> tuple[Shaped[np.ndarray, "h2 w2 *c"], tuple[str, ...]]:
        height, width = values.shape[:2]
        size = (width, height)
        bordered = any(self.margins) and size != self.inner_size
        if bordered and _alike(size, self.full_size):
            return self._cut(values), ()
        if _alike(size, self.inner_size):
            return values, ()
        if self.orientation >= 5 and _alike(size, self.stored_size):
            turned = self._cut(self.upright(values))
            return turned, (f"the {what} was turned like the photo, whose header has orientation {self.orientation}",)
        shown = self.inner_size
        turned_size = _alike((height, width), shown)
        advice = "turn it upright like the photo" if turned_size else f"give the {what} of this very photo"
        raise InputError(
            f"{name}: the {what} is {width} x {height}, the upright photo is {shown[0]} x {shown[1]}; {advice}"
        )

    def _cut(self, values: Shaped[np.ndarray, "h w *c"]) -> Shaped[np.ndarray, "h2 w2 *c"]:
        height, width = values.shape[:2]
        sx, sy = width / self.full_size[0], height / self.full_size[1]
        left, top, right, bottom = self.margins
        return values[round(top * sy) : height - round(bottom * sy), round(left * sx) : width - round(right * sx)]


def _alike(size: Size, other: Size) -> bool:
    ratio = (size[0] / size[1]) / (other[0] / other[1])
    return abs(ratio - 1.0) <= ASPECT_TOLERANCE
