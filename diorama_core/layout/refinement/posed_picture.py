"""Which object is seen at every pixel of a grid while one after another moves, and how far that agrees with masks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.layout.refinement.pixel_grid import PixelGrid, Window
from diorama_core.layout.settings import REFINEMENT, RefinementSettings


@dataclass(frozen=True, eq=False)
class Rest:
    """What is seen without one object."""

    window: Window
    """Where that object is seen."""
    depth_m: Float32[np.ndarray, "h w"]
    """Depth of the nearest other there; infinite for none."""
    index: Int[np.ndarray, "h w"]
    """Which one that is; -1 for none."""
    pixels: Int[np.ndarray, " n"]
    """That show each object, in the whole picture."""
    right: Int[np.ndarray, " n"]
    """Those of them that its mask covers, too."""


@dataclass(frozen=True, eq=False)
class TriedPoses:
    """One object in several poses among the others as they are."""

    index: int
    poses: PoseBatch
    rest: Rest
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
    """Casters of every object."""
    depth_m: Float32[np.ndarray, "n h w"]
    """Depth of every object alone; infinite where it is not."""
    settings: RefinementSettings = REFINEMENT

    @classmethod
    def of(
        cls,
        grid: PixelGrid,
        wanted: Int[np.ndarray, "h w"],
        casters: Sequence[ShapeCaster],
        poses: PoseBatch,
        settings: RefinementSettings = REFINEMENT,
    ) -> PosedPicture:
        """The picture of objects in these poses, one each; arguments as the fields.

        Args:
            grid: pixels that are compared.
            wanted: index of the object that the photo shows, -1 for none.
            casters: of every object.
            poses: one each.
            settings: numbers to work with.
        """
        depth = np.full((len(casters), *wanted.shape), np.inf, np.float32)
        for i, caster in enumerate(casters):
            pose = poses[np.array([i])]
            window = grid.window(caster.bounds_px(grid.camera, pose))
            if window is not None:
                rays = grid.rays[window]
                depth[i][window] = _cast(grid, caster, rays.reshape(-1, 3), pose).reshape(rays.shape[:2])
        return cls(grid, wanted, casters, depth, settings)

    def __post_init__(self) -> None:
        self.mask_pixels = self._counts(self.wanted)
        shown = _nearest(self.depth_m, np.arange(len(self.casters)))[1]
        self._pixels, self._right = self._counts(shown), self._counts(shown[shown == self.wanted])

    def look(self, i: int, poses: PoseBatch) -> TriedPoses | None:
        """What is seen of object i in several poses near its present one, which is the first; None where nothing is."""
        bounds = self.casters[i].bounds_px(self.grid.camera, poses)
        window = self.grid.window(bounds)
        if window is None:
            return None
        rest = self._without(i, window)
        here = self.depth_m[i][window]
        moved_px, moved_m, nearest_m = self._farthest_move(i, poses)
        alone = np.abs(rest.depth_m - np.where(np.isfinite(here), here, 0.0)) > self.settings.slanted * moved_m
        open_to_change = ~(alone & _erode(np.isfinite(here), moved_px)) & (rest.depth_m > nearest_m)
        depth = np.repeat(here[None], len(poses), axis=0)
        rays = self.grid.rays[window][open_to_change]
        depth[1:, open_to_change] = _cast(self.grid, self.casters[i], rays, poses[1:])
        seen = [self._with(i, rest, depth_of_pose) for depth_of_pose in depth]
        pixels, right = np.array([p for p, _ in seen]), np.array([r for _, r in seen])
        agreement = right / np.maximum(pixels + self.mask_pixels - right, 1)
        return TriedPoses(i, poses, rest, agreement, bounds)

    def replace(self, look: TriedPoses, chosen: int) -> None:
        """Let the object of a look be seen in one of its poses from now on."""
        i, window, rays = look.index, look.rest.window, self.grid.rays[look.rest.window]
        depth = _cast(self.grid, self.casters[i], rays.reshape(-1, 3), look.poses[np.array([chosen])])
        self.depth_m[i] = np.inf
        self.depth_m[i][window] = depth.reshape(rays.shape[:2])
        self._pixels, self._right = self._with(i, look.rest, self.depth_m[i][window])

    def _farthest_move(self, i: int, poses: PoseBatch) -> tuple[float, float, float]:
        """How far a corner of an object's box is from where it is in the first pose, and how near it can be.

        Returns:
            Pixels of the grid, infinitely many for what reaches behind the camera; metres; and the least depth.
        """
        corners = poses.apply(self.casters[i].corners)
        moved_m = float(np.linalg.norm(corners - corners[0], axis=2).max())
        nearest_m = float(self.grid.camera.to_camera(corners.reshape(-1, 3))[:, 2].min())
        if nearest_m <= 0.0:
            return np.inf, moved_m, nearest_m
        pixels = self.grid.camera.project(corners.reshape(-1, 3)).reshape(*corners.shape[:2], 2)
        moved_px = float(np.linalg.norm(pixels - pixels[0], axis=2).max())
        return moved_px / self.grid.step, moved_m, nearest_m

    def _counts(self, labels: Int[np.ndarray, "*s"]) -> Int[np.ndarray, " n"]:
        return np.bincount(labels[labels >= 0], minlength=len(self.casters))

    def _without(self, i: int, window: Window) -> Rest:
        """What is seen without object i, which is seen within the window only."""
        others = np.flatnonzero(np.arange(len(self.casters)) != i)
        here, wanted = self.depth_m[(slice(None), *window)], self.wanted[window]
        depth, behind = _nearest(here[others], others)
        shown = np.where(here[i] < depth, i, behind)
        pixels = self._pixels - self._counts(shown) + self._counts(behind)
        right = self._right - self._counts(shown[shown == wanted]) + self._counts(behind[behind == wanted])
        return Rest(window, depth, behind, pixels, right)

    def _with(
        self, i: int, rest: Rest, depth_m: Float32[np.ndarray, "h w"]
    ) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, " n"]]:
        """Pixels and right pixels of every object with object i at such depths in its window."""
        covered = depth_m < rest.depth_m
        lost, wanted = rest.index[covered], self.wanted[rest.window][covered]
        pixels, right = rest.pixels - self._counts(lost), rest.right - self._counts(lost[lost == wanted])
        pixels[i], right[i] = len(lost), np.count_nonzero(wanted == i)
        return pixels, right


def _cast(
    grid: PixelGrid, caster: ShapeCaster, rays: Float[np.ndarray, "r 3"], poses: PoseBatch
) -> Float32[np.ndarray, "p r"]:
    return caster.cast(grid.camera.position, rays, poses).depth_m.astype(np.float32)


def _erode(covered: Bool[np.ndarray, "h w"], margin: float) -> Bool[np.ndarray, "h w"]:
    """Pixels so far inside a mask that they remain in it when it moves by less than the margin."""
    reach = int(np.ceil(margin)) + 1 if np.isfinite(margin) else max(covered.shape)
    if 2 * reach >= min(covered.shape):
        return np.zeros_like(covered)
    kernel = np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)
    eroded = cv2.erode(covered.astype(np.uint8), kernel, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    return np.asarray(eroded, dtype=bool)


def _nearest(
    depth_m: Float32[np.ndarray, "m h w"], indices: Int[np.ndarray, " m"]
) -> tuple[Float32[np.ndarray, "h w"], Int[np.ndarray, "h w"]]:
    """Depth and index of the nearest object at every pixel: infinite and -1 where there is none."""
    if not len(depth_m):
        return np.full(depth_m.shape[1:], np.inf, np.float32), np.full(depth_m.shape[1:], -1)
    nearest = depth_m.min(axis=0)
    return nearest, np.where(np.isfinite(nearest), indices[depth_m.argmin(axis=0)], -1)
