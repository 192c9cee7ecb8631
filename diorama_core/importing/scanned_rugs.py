"""Rugs in the points of a scan: places where the floor is a little higher, level, and rectangular.

A rug is thinner than what `measured_cloud` leaves to the floor. It is seen where a scan is finer than the rug is thick;
furniture on it hides a part, so that its rectangle need not be full, but no bare floor may be inside.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float
from scipy import ndimage

MAX_DEVIATION = 1.4826
"""Standard deviations in a median absolute deviation of normal noise."""


@dataclass(frozen=True)
class RugSettings:
    """Finds the rug in points whose floor is at 0."""

    min_height_m: float = 0.007
    sigmas: float = 4.0
    """Multiple of the floor's noise that a rug is higher."""
    unlevel: float = 0.3
    """Deviation of a rug's heights, as a share of its height: a floor that bends rises little by little."""
    max_height_m: float = 0.06
    standing_m: float = 0.3
    """What has points between the height of a rug and this one stands there, and hides the rug."""
    cell_m: float = 0.1
    reach: int = 2
    """Cells by which pieces of one rug grow before they meet: what stands on it hides so much."""
    min_side_m: float = 0.5
    min_points: int = 40
    max_floor: float = 0.08
    """Share of floor among the low points inside its rectangle."""


SETTINGS = RugSettings()


def scanned_rugs(points: Float[np.ndarray, "n 3"]) -> list[Float[np.ndarray, "_ 3"]]:
    """Points of each rug, the largest first.

    Args:
        points: of the room, away from walls; the floor at 0, +Z up.
    """
    low = _free(points)
    below = low[low[:, 2] <= 0, 2]
    if len(below) < SETTINGS.min_points:
        return []
    noise_m = MAX_DEVIATION * float(np.median(-below))  # half of the floor's noise is below it
    raised = low[:, 2] > max(SETTINGS.min_height_m, SETTINGS.sigmas * noise_m)
    rugs = [p for p in _pieces(low, raised) if _is_rug(p, low[~raised], noise_m)]
    return sorted(rugs, key=len, reverse=True)


def _free(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "m 3"]:
    """Points at the floor where nothing stands."""
    points = points[points[:, 2] < SETTINGS.standing_m]
    if not len(points):
        return points
    cells = np.floor((points[:, :2] - points[:, :2].min(axis=0)) / SETTINGS.cell_m).astype(int)
    grid = np.zeros(cells.max(axis=0) + 1, bool)
    low = points[:, 2] < SETTINGS.max_height_m
    grid[tuple(cells[~low].T)] = True
    return points[low & ~grid[tuple(cells.T)]]


def _pieces(low: Float[np.ndarray, "n 3"], raised: Bool[np.ndarray, " n"]) -> Iterator[Float[np.ndarray, "_ 3"]]:
    """Raised points in groups that are apart from each other."""
    cells = np.floor((low[:, :2] - low[:, :2].min(axis=0)) / SETTINGS.cell_m).astype(int)
    grid = np.zeros(cells.max(axis=0) + 1, bool)
    grid[tuple(cells[raised].T)] = True
    grown = ndimage.binary_dilation(grid, np.ones((3, 3), bool), iterations=SETTINGS.reach)
    labels, count = ndimage.label(grown)
    which = np.where(raised, labels[tuple(cells.T)], 0)
    for number in range(count):
        piece = low[which == number + 1]
        level = float(np.median(piece[:, 2]))
        yield piece[np.abs(piece[:, 2] - level) < level / 2]  # without what stands on it


def _is_rug(piece: Float[np.ndarray, "n 3"], floor: Float[np.ndarray, "m 3"], noise_m: float) -> bool:
    if len(piece) < SETTINGS.min_points:
        return False
    height = float(np.median(piece[:, 2]))
    rectangle = cv2.minAreaRect(piece[:, :2].astype(np.float32))
    if min(rectangle[1]) < SETTINGS.min_side_m or piece[:, 2].std() > max(SETTINGS.unlevel * height, 1.5 * noise_m):
        return False
    corners = cv2.boxPoints(rectangle)
    near = floor[((floor[:, :2] > corners.min(axis=0)) & (floor[:, :2] < corners.max(axis=0))).all(axis=1), :2]
    inside = sum(cv2.pointPolygonTest(corners, (float(x), float(y)), False) > 0 for x, y in near)
    return inside <= SETTINGS.max_floor * (inside + len(piece))
