"""The measured points of one object (eroded mask, right depth layer, no strays); their settings."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float
from scipy import ndimage

from diorama_core.artefacts import DetectedObject


@dataclass(frozen=True)
class MeasuredSettings:
    """How objects are measured in the points of a depth map."""

    voxel_m: float = 0.04
    max_cells: int = 128
    """Points farther than this many cells from the first, along an axis, are lumped together."""
    layer_gap_m: float = 0.12
    """Steps in depth larger than this (plus 4 % of the depth) separate an object from what is behind or before it."""
    assumed_height_m: float = 1.4
    """Assumed camera height when no floor is visible."""
    guess_confidence: float = 0.2
    ring_px: float = 0.02
    """Width of the ring of background around a mask, as a share of the picture."""
    full_points: int = 1500
    """From this many points on, a cloud is as good as it gets."""
    on_floor_m: float = 0.15
    """A bottom lower than this rests on the floor: lower parts are often hidden."""
    gap_m: float = 0.1
    """Usual error of the height of an underside above what holds it."""
    nearer_m: float = 0.08
    """Something this much nearer below an object hides its end."""
    gap_nats: float = 4.0
    """What a gap of many such errors says against a supporter."""


SETTINGS = MeasuredSettings()


MIN_POINTS = 30


def erode_mask(mask: Bool[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """The eroded mask, without the rim where depth mixes with the background; unchanged when nothing would remain."""
    inner = cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=1).astype(bool)
    return inner if inner.sum() >= MIN_POINTS else mask


def object_points(
    detected: DetectedObject,
    points_world: Float[np.ndarray, "h w 3"],
    depth_m: Float[np.ndarray, "h w"],
    settings: MeasuredSettings = SETTINGS,
) -> Float[np.ndarray, "n 3"]:
    """World points of an object, at least `MIN_POINTS` or none at all.

    Args:
        detected: Its mask; a mask from a box alone may hold background.
        points_world: Of every pixel.
        depth_m: Of every pixel, 0 where missing.
    """
    rows, columns = np.nonzero(erode_mask(detected.mask) & (depth_m > 0))
    if len(rows) < MIN_POINTS:
        return np.zeros((0, 3))
    layer = main_layer(depth_m[rows, columns], _centrality(detected, rows, columns), settings)
    return largest_piece(points_world[rows[layer], columns[layer]], settings)


def _centrality(detected: DetectedObject, rows: np.ndarray, columns: np.ndarray) -> Float[np.ndarray, "n"]:
    """Weights that trust a mask's middle more than its border; even for a mask known to be right."""
    x1, y1, x2, y2 = detected.box
    across = np.abs((columns + 0.5 - 0.5 * (x1 + x2)) / max(x2 - x1, 1.0))
    down = np.abs((rows + 0.5 - 0.5 * (y1 + y2)) / max(y2 - y1, 1.0))
    return 1.0 - (1.0 - detected.mask_confidence) * np.clip(2.0 * np.maximum(across, down), 0.0, 1.0)


def main_layer(
    depth_m: Float[np.ndarray, "n"], weights: Float[np.ndarray, "n"], settings: MeasuredSettings = SETTINGS
) -> Bool[np.ndarray, "n"]:
    """The pixels of the heaviest layer of depth; layers are parted by gaps."""
    order = np.argsort(depth_m, kind="stable")
    ranked = depth_m[order]
    parts = np.concatenate([[0], np.cumsum(np.diff(ranked) > settings.layer_gap_m + 0.04 * ranked[:-1])])
    heaviest = np.bincount(parts, weights=weights[order]).argmax()
    keep = np.zeros(len(depth_m), dtype=bool)
    keep[order] = parts == heaviest
    return keep


def largest_piece(points: Float[np.ndarray, "n 3"], settings: MeasuredSettings = SETTINGS) -> Float[np.ndarray, "m 3"]:
    """Points of the connected pieces that hold at least a fifth of the largest one's; none when all are few."""
    if len(points) < MIN_POINTS:
        return np.zeros((0, 3))
    low = points.min(axis=0)
    cells = ((points - low) / settings.voxel_m).astype(int)
    cells = np.minimum(cells, settings.max_cells - 1)
    grid = np.zeros(cells.max(axis=0) + 1, dtype=bool)
    grid[tuple(cells.T)] = True
    joined = ndimage.binary_dilation(grid, np.ones((3, 3, 3), bool))
    labels = ndimage.label(joined)[0][tuple(cells.T)]
    sizes = np.bincount(labels)
    large = points[sizes[labels] >= 0.2 * sizes.max()]
    return large if len(large) >= MIN_POINTS else np.zeros((0, 3))
