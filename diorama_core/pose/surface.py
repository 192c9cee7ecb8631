"""Measured depth at the resolution at which rendered shapes are compared with it, and how noisy it is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Float32, Int

from diorama_core.artefacts import DepthMap
from diorama_core.geometry.observed import Observed
from diorama_core.geometry.silhouette import ShapeHits
from diorama_core.geometry.window import Window
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings
from diorama_core.provenance import DepthSource


def noise_of(depth: DepthMap, settings: PoseEvidenceSettings = SETTINGS.evidence) -> float:
    """The standard deviation of single pixels as a share of their depth; 0 where depth was rendered.

    Second differences along the rows vanish on planes (of inverse depth); their median is deaf to edges.
    """
    if depth.source is DepthSource.RENDERED:
        return 0.0
    step = max(1, depth.depth_m.shape[0] * depth.depth_m.shape[1] // settings.noise_samples)
    rows = depth.depth_m[::step].astype(np.float64)
    good = np.isfinite(rows) & (rows > 0)
    inverse = np.where(good, 1.0 / np.where(good, rows, 1.0), 0.0)
    known = good[:, :-2] & good[:, 1:-1] & good[:, 2:]
    bend = (inverse[:, :-2] - 2 * inverse[:, 1:-1] + inverse[:, 2:]) / np.maximum(inverse[:, 1:-1], 1e-9)
    return float(1.4826 * np.median(np.abs(bend[known])) / np.sqrt(6)) if known.any() else 0.0


@dataclass(frozen=True, eq=False)
class ObjectSurface:
    """Measured depth and normals in the cells of an object's window."""

    depth_m: Float[np.ndarray, "n"]
    """Depth of the object where its mask is, of whatever else is seen elsewhere; 1 where nothing was measured."""
    normals_world: Float[np.ndarray, "n 3"]
    weight: Float[np.ndarray, "n"]
    """0 where nothing was measured or the cell is not the object's."""
    known: Bool[np.ndarray, "n"]
    """Whether depth was measured in the cell, of the object or of anything else."""
    tolerance_m: Float[np.ndarray, "n"]
    """Expected deviation of depth."""
    spread_m: Float[np.ndarray, "n"]
    """Standard deviation of the noise in it alone."""
    normals_share: float = SETTINGS.evidence.normals_share
    """How much normals say beside depth."""
    settings: PoseEvidenceSettings = SETTINGS.evidence

    def agreement(self, hits: ShapeHits) -> Float[np.ndarray, "p"]:
        """0 to 1: nearness of depth and of normals over the object's measured cells."""
        is_informative, weight = self._valid_cells, self.weight[self._valid_cells]
        depth, covered = hits.depth_m[:, is_informative], hits.is_hit[:, is_informative]
        off = (np.where(covered, depth, 0.0) - self.depth_m[is_informative]) / self.tolerance_m[is_informative]
        score = np.where(covered, np.exp(-(off**2)), 0.0)
        if self.normals_share >= self.settings.min_normals_share:
            aligned = hits.select_rays(is_informative).normals_along(self.normals_world[is_informative])
            score = (1 - self.normals_share) * score + self.normals_share * np.clip(aligned, 0.0, 1.0)
        return (score @ weight) / max(float(weight.sum()), 1e-9)

    @cached_property
    def _valid_cells(self) -> Int[np.ndarray, " k"]:
        """The object's measured cells: only they are compared."""
        return np.flatnonzero(self.weight > 0)

    def hides(self, hits: ShapeHits) -> Bool[np.ndarray, "p n"]:
        """Where something was measured in front of the shape, so that the cell is no observation of it."""
        return self.known & (self.weight == 0) & hits.is_hit & (hits.depth_m > self.depth_m + 2 * self.tolerance_m)


def measure_surface(
    depth: DepthMap,
    seen: Observed,
    mask: Bool[np.ndarray, "h w"],
    noise: float,
    settings: PoseEvidenceSettings = SETTINGS.evidence,
) -> ObjectSurface | None:
    """Depth and normals in an object's window; None where depth was only rendered from what is already known.

    Args:
        depth: of the photo.
        seen: the object's window.
        mask: the object's visible pixels.
        noise: from `noise_of`.
    """
    if depth.source is DepthSource.RENDERED:
        return None
    metres = seen.window.sample(depth.depth_m).astype(np.float64)
    spread = np.full(len(metres), noise)
    if noise > settings.calm:
        metres, spread = _means(depth.depth_m, seen.window, mask, seen.covered, metres, noise)
    normals = np.nan_to_num(seen.window.sample(depth.normals_world).astype(np.float64))
    known = np.isfinite(metres) & (metres > 0)
    weight = seen.covered * seen.weight * known
    if weight.sum() < settings.min_surface_cells:
        return None
    metres = np.where(known, metres, 1.0)
    spread_m = np.where(known, spread, 0.0) * metres
    tolerance = 0.02 + 0.01 * metres + 1.5 * spread_m
    share = settings.normals_share / (1.0 + (noise / settings.normals_noise) ** 2)
    return ObjectSurface(metres, normals, weight, known, tolerance, spread_m, share, settings)


def _means(
    depth_m: Float32[np.ndarray, "h w"],
    window: Window,
    mask: Bool[np.ndarray, "h w"],
    covered: Float[np.ndarray, "n"],
    single_m: Float[np.ndarray, "n"],
    noise: float,
) -> tuple[Float[np.ndarray, "n"], Float[np.ndarray, "n"]]:
    """Means of the object's pixels in the cells of its mask and of the others elsewhere, and their expected spread."""
    height, width = mask.shape
    x1, y1, x2, y2 = window.bounds_px
    top, bottom = int(np.clip(np.floor(y1), 0, height)), int(np.clip(np.ceil(y2), 0, height))
    left, right = int(np.clip(np.floor(x1), 0, width)), int(np.clip(np.ceil(x2), 0, width))
    row = np.floor((np.arange(top, bottom) + 0.5 - y1) / (y2 - y1) * window.cells).astype(int)
    column = np.floor((np.arange(left, right) + 0.5 - x1) / (x2 - x1) * window.cells).astype(int)
    row, column = np.clip(row, 0, window.cells - 1), np.clip(column, 0, window.cells - 1)
    cell = row[:, None] * window.cells + column
    metres = depth_m[top:bottom, left:right].astype(np.float64)
    of_object = covered > 0
    good = np.isfinite(metres) & (metres > 0) & (mask[top:bottom, left:right] == of_object[cell])
    count = np.bincount(cell[good], minlength=len(single_m))
    total = np.bincount(cell[good], metres[good], minlength=len(single_m))
    mean = np.where(count > 0, total / np.maximum(count, 1), single_m)
    return mean, noise / np.sqrt(np.maximum(count, 1))
