"""A small regular grid over a part of the photo, at which masks, depth and rendered shapes are compared."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from jaxtyping import Bool, Float, Shaped


@dataclass(frozen=True)
class Window:
    """`cells` x `cells` equal cells over the rectangle x1, y1, x2, y2 (pixels), which may leave the photo."""

    bounds_px: tuple[float, float, float, float]
    cells: int

    @classmethod
    def from_box(cls, box: tuple[float, float, float, float], margin: float, cells: int) -> Window:
        """The window of a box widened on every side by `margin` of its size (at least two pixels).

        Args:
            box: x1, y1, x2, y2 in pixels.
            margin: share of the box's width and height that is added on either side.
            cells: of the window, along each side.
        """
        x1, y1, x2, y2 = box
        dx, dy = max(margin * (x2 - x1), 2.0), max(margin * (y2 - y1), 2.0)
        return cls((x1 - dx, y1 - dy, x2 + dx, y2 + dy), cells)

    @cached_property
    def centres_px(self) -> Float[np.ndarray, "n 2"]:
        """Centres of the cells, row by row."""
        x1, y1, x2, y2 = self.bounds_px
        steps = (np.arange(self.cells) + 0.5) / self.cells
        x, y = np.meshgrid(x1 + (x2 - x1) * steps, y1 + (y2 - y1) * steps)
        return np.stack([x.ravel(), y.ravel()], axis=1)

    def is_in_photo(self, width: int, height: int) -> Bool[np.ndarray, "n"]:
        """True for cells whose centre lies in a photo of this size."""
        x, y = self.centres_px.T
        return (x >= 0) & (x < width) & (y >= 0) & (y < height)

    def coverage(self, mask: Bool[np.ndarray, "h w"]) -> Float[np.ndarray, "n"]:
        """Share of every cell's area that the mask covers, exactly; nothing outside the photo is covered."""
        if not mask[self._pixels(*mask.shape)].any():
            return np.zeros(self.cells**2)
        return np.clip(self.means(mask.astype(np.uint8)), 0.0, 1.0)

    def means(self, image: Shaped[np.ndarray, "h w *c"]) -> Float[np.ndarray, "n *c"]:
        """The mean of an image of numbers over every cell's area, exactly; outside the photo it is 0."""
        part = rows, columns = self._pixels(*image.shape[:2])
        if rows.start == rows.stop or columns.start == columns.stop:
            return np.zeros((self.cells**2, *image.shape[2:]))
        x1, y1, x2, y2 = self.bounds_px
        total = cv2.integral(np.ascontiguousarray(image[part]), sdepth=cv2.CV_64F)
        lines = np.linspace(0.0, 1.0, self.cells + 1)
        sums = _sample_bilinear(total, y1 + (y2 - y1) * lines - rows.start, x1 + (x2 - x1) * lines - columns.start)
        areas = np.diff(np.diff(sums, axis=0), axis=1)
        cell = (x2 - x1) * (y2 - y1) / self.cells**2
        return areas.reshape(self.cells**2, *image.shape[2:]) / max(cell, 1e-12)

    def _pixels(self, height: int, width: int) -> tuple[slice, slice]:
        """Rows and columns of a photo of this size of which any part lies in the window."""
        x1, y1, x2, y2 = self.bounds_px
        left, top = int(np.clip(np.floor(x1), 0, width)), int(np.clip(np.floor(y1), 0, height))
        right, bottom = int(np.clip(np.ceil(x2), left, width)), int(np.clip(np.ceil(y2), top, height))
        return slice(top, bottom), slice(left, right)

    def sample(self, image: Shaped[np.ndarray, "h w *c"]) -> Shaped[np.ndarray, "n *c"]:
        """The image's pixel under every cell's centre; the nearest one where the centre is outside."""
        height, width = image.shape[:2]
        x = np.clip(np.floor(self.centres_px[:, 0]).astype(int), 0, width - 1)
        y = np.clip(np.floor(self.centres_px[:, 1]).astype(int), 0, height - 1)
        return image[y, x]


def _sample_bilinear(integral: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """The integral image between its samples (bilinear), for every row and column."""
    rows = np.clip(rows, 0, integral.shape[0] - 1)
    columns = np.clip(columns, 0, integral.shape[1] - 1)
    i = np.minimum(rows.astype(int), integral.shape[0] - 2)
    j = np.minimum(columns.astype(int), integral.shape[1] - 2)
    shape = (1,) * (integral.ndim - 2)
    u, v = (rows - i).reshape(-1, 1, *shape), (columns - j).reshape(1, -1, *shape)
    top = integral[np.ix_(i, j)] * (1 - v) + integral[np.ix_(i, j + 1)] * v
    low = integral[np.ix_(i + 1, j)] * (1 - v) + integral[np.ix_(i + 1, j + 1)] * v
    return top * (1 - u) + low * u


def soft_iou(
    seen: Float[np.ndarray, "n"],
    rendered: Float[np.ndarray, "p n"],
    weight: Float[np.ndarray, "n"] | Float[np.ndarray, "p n"],
) -> Float[np.ndarray, "p"]:
    """Weighted intersection over union of coverages in 0..1; zero where neither covers anything."""
    both = (np.minimum(seen, rendered) * weight).sum(axis=-1)
    either = (np.maximum(seen, rendered) * weight).sum(axis=-1)
    return np.where(either > 1e-9, both / np.maximum(either, 1e-9), 0.0)
