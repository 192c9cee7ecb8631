"""How the photo's pixels come from the file's: turned by its header, without its border, reduced."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Shaped

from diorama_core.errors import InputError

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

    def laid_over(
        self, name: str, what: str, values: Shaped[np.ndarray, "h w *c"]
    ) -> tuple[Shaped[np.ndarray, "h2 w2 *c"], tuple[str, ...]]:
        """A map as it lies over the photo without its border, whether it came with it, or unturned; and what was done.

        Args:
            name: of the file, for messages.
            what: the map is, for messages.
            values: h rows and w columns, in any number of channels.

        Raises:
            InputError: its proportions are neither those of the photo nor of its stored pixels.
        """
        laid, notes = self._laid_over(name, what, values)
        return (laid[::-1, ::-1] if self.half_turned else laid), notes

    def _laid_over(
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
