"""Which object is seen at every pixel of a grid while one after another moves, and how far that agrees with masks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32, Int

from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.layout.refinement.pixel_grid import PixelGrid, Window


@dataclass(frozen=True, eq=False)
class Look:
    """One object in several poses among the others as they are."""

    index: int
    window: Window
    """Where the object is seen in any of the poses."""
    depth_m: Float32[np.ndarray, "p h w"]
    """Of the object alone there."""
    pixels: Int[np.ndarray, "p n"]
    """That show each object."""
    right: Int[np.ndarray, "p n"]
    """Those of them that its mask covers, too."""
    agreement: Float[np.ndarray, "p n"]
    """Intersection over union of every object's pixels and its mask."""
    bounds_px: Float[np.ndarray, "p 4"]
    """x1, y1, x2, y2 of the object in the photo, what others hide included; NaN outside the photo."""


@dataclass(eq=False)
class PosedPicture:
    """The picture of posed objects. It changes when one of them does: a new one for every try would cost too much."""

    grid: PixelGrid
    wanted: Int[np.ndarray, "h w"]
    """Index of the object that the photo shows, -1 for none."""
    casters: Sequence[ShapeCaster]
    """Of every object."""
    depth_m: Float32[np.ndarray, "n h w"]
    """Of every object alone; infinite where it is not."""

    @classmethod
    def of(
        cls, grid: PixelGrid, wanted: Int[np.ndarray, "h w"], casters: Sequence[ShapeCaster], poses: PoseBatch
    ) -> PosedPicture:
        """The picture of objects in these poses, one each."""
        depth = np.full((len(casters), *wanted.shape), np.inf, np.float32)
        for i, caster in enumerate(casters):
            own = poses[np.array([i])]
            window = grid.window(caster.bounds_px(grid.camera, own))
            if window is not None:
                depth[i][window] = _cast(grid, caster, window, own)[0]
        return cls(grid, wanted, casters, depth)

    def __post_init__(self) -> None:
        self._wanted_pixels = self._counts(self.wanted)
        shown = _nearest(self.depth_m, np.arange(len(self.casters)))[1]
        self._pixels, self._right = self._counts(shown), self._counts(shown[shown == self.wanted])

    @property
    def wanted_pixels(self) -> Int[np.ndarray, " n"]:
        """Pixels of each object's mask."""
        return self._wanted_pixels

    def look(self, i: int, poses: PoseBatch) -> Look | None:
        """What is seen of object i in several poses, of which the first is its present one; None where nothing is."""
        bounds = self.casters[i].bounds_px(self.grid.camera, poses)
        window = self.grid.window(bounds)
        if window is None:
            return None
        depth = _cast(self.grid, self.casters[i], window, poses)
        nearest, behind, pixels, right = self._without(i, window)
        wanted = self.wanted[window]
        pixels, right = np.tile(pixels, (len(poses), 1)), np.tile(right, (len(poses), 1))
        for k, covered in enumerate(depth < nearest):
            lost = behind[covered]
            pixels[k] -= self._counts(lost)
            right[k] -= self._counts(lost[lost == wanted[covered]])
            pixels[k, i], right[k, i] = len(lost), np.count_nonzero(wanted[covered] == i)
        agreement = right / np.maximum(pixels + self.wanted_pixels - right, 1)
        return Look(i, window, depth, pixels, right, agreement, bounds)

    def replace(self, look: Look, chosen: int) -> None:
        """Let the object of a look be seen in one of its poses from now on."""
        i = look.index
        self.depth_m[i] = np.inf
        self.depth_m[i][look.window] = look.depth_m[chosen]
        self._pixels, self._right = look.pixels[chosen], look.right[chosen]

    def _counts(self, labels: Int[np.ndarray, "*s"]) -> Int[np.ndarray, " n"]:
        return np.bincount(labels[labels >= 0], minlength=len(self.casters))

    def _without(self, i: int, window: Window) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """What is seen without object i, which is seen within the window only.

        Returns:
            In the window the depth of the nearest other (infinite for none) and its index (-1), and in the whole
            picture the pixels and the right pixels of every object.
        """
        others = np.flatnonzero(np.arange(len(self.casters)) != i)
        here, wanted = self.depth_m[(slice(None), *window)], self.wanted[window]
        depth, behind = _nearest(here[others], others)
        shown = np.where(here[i] < depth, i, behind)
        pixels = self._pixels - self._counts(shown) + self._counts(behind)
        right = self._right - self._counts(shown[shown == wanted]) + self._counts(behind[behind == wanted])
        return depth, behind, pixels, right


def _cast(grid: PixelGrid, caster: ShapeCaster, window: Window, poses: PoseBatch) -> Float32[np.ndarray, "p h w"]:
    rays = grid.rays[window]
    hits = caster.cast(grid.camera.position, rays.reshape(-1, 3), poses)
    return hits.depth_m.astype(np.float32).reshape(len(poses), *rays.shape[:2])


def _nearest(
    depth_m: Float32[np.ndarray, "m h w"], indices: Int[np.ndarray, " m"]
) -> tuple[Float32[np.ndarray, "h w"], Int[np.ndarray, "h w"]]:
    """Depth and index of the nearest object at every pixel: infinite and -1 where there is none."""
    if not len(depth_m):
        return np.full(depth_m.shape[1:], np.inf, np.float32), np.full(depth_m.shape[1:], -1)
    nearest = depth_m.min(axis=0)
    return nearest, np.where(np.isfinite(nearest), indices[depth_m.argmin(axis=0)], -1)
