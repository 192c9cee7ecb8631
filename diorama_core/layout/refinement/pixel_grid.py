"""Every so many pixels of the photo: enough to compare masks with, and exactly where the masks have theirs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.scene.types import Camera

Window = tuple[slice, slice]
"""Rows and columns of the grid."""


@dataclass(frozen=True, eq=False)
class PixelGrid:
    """Pixels in the middle of equal cells of the photo."""

    camera: Camera
    """In the size of the photo."""
    step: int
    """Photo pixels from one to the next, both ways."""

    @classmethod
    def of(cls, camera: Camera, width: int, height: int, long_side: int = 320) -> PixelGrid:
        """The grid of a photo of this size, with about so many pixels along the longer side.

        Args:
            camera: that of the photo, in any size.
            width: of the photo, pixels.
            height: likewise.
            long_side: of the grid.
        """
        sized = camera.resize(width, height)
        return cls(sized, max(1, round(max(width, height) / long_side)))

    @cached_property
    def rows(self) -> Int[np.ndarray, " h"]:
        """Rows of the photo."""
        return np.arange(self.step // 2, self.camera.intrinsics.height, self.step)

    @cached_property
    def columns(self) -> Int[np.ndarray, " w"]:
        """Columns of the photo."""
        return np.arange(self.step // 2, self.camera.intrinsics.width, self.step)

    @cached_property
    def rays(self) -> Float[np.ndarray, "h w 3"]:
        """World directions of unit depth."""
        y, x = np.meshgrid(self.rows + 0.5, self.columns + 0.5, indexing="ij")
        return self.camera.rays(np.column_stack([x.ravel(), y.ravel()])).reshape(*x.shape, 3)

    def sample(self, mask: Bool[np.ndarray, "H W"]) -> Bool[np.ndarray, "h w"]:
        """A mask of the photo at these pixels."""
        return mask[np.ix_(self.rows, self.columns)]

    def labels(self, masks: Sequence[Bool[np.ndarray, "H W"] | None]) -> Int[np.ndarray, "h w"]:
        """Index of the mask at every pixel, -1 where there is none; of masks that overlap, the smaller one's."""
        labels = np.full((len(self.rows), len(self.columns)), -1)
        sampled = [None if mask is None else self.sample(mask) for mask in masks]
        largest_first = sorted((-int(m.sum()), i) for i, m in enumerate(sampled) if m is not None)
        for _, i in largest_first:
            labels[sampled[i]] = i
        return labels

    def window(self, bounds_px: Float[np.ndarray, "p 4"], margin: int = 2) -> Window | None:
        """What contains boxes of the photo (x1, y1, x2, y2; NaN for none), with a margin; None outside the photo."""
        known = bounds_px[np.isfinite(bounds_px).all(axis=1)] / self.step
        if not len(known):
            return None
        x1, y1 = np.floor(known[:, :2].min(axis=0)).astype(int) - margin
        x2, y2 = np.ceil(known[:, 2:].max(axis=0)).astype(int) + margin
        rows = slice(max(int(y1), 0), min(int(y2), len(self.rows)))
        columns = slice(max(int(x1), 0), min(int(x2), len(self.columns)))
        return (rows, columns) if rows.start < rows.stop and columns.start < columns.stop else None
