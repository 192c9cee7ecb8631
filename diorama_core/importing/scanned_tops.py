"""Furniture apart from what lies on it, in the points of a scan.

A board is a level that much of a thing's outline fills and above which little is. What is above it lies on it, unless
it reaches from one side to the other, as backs of chairs and heads of beds do.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float
from scipy import ndimage

CELL_M = 0.05
MIN_BOARD = 0.6
"""Share of the outline that a board fills."""
MAX_ABOVE = 0.45
"""Share of the outline that may be filled at any height above it."""
MIN_HEIGHT_M = 0.25
"""Height of a board above the object's foot; lower ones are rugs, plinths and pedals."""
MIN_ABOVE_M = 0.08
REACHES_ALONG, REACHES_ACROSS = 0.78, 0.9
"""Shares of the longer side, and of the shorter one unless about square, at which a part belongs to the object."""
SQUARE = 0.75


def apart_from_tops(points: Float[np.ndarray, "n 3"]) -> list[Float[np.ndarray, "_ 3"]]:
    """The points of a thing, and those of each thing that lies on it; all of them together where nothing does.

    Args:
        points: +Z up, along the room's axes.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    cells = np.floor((points - low) / CELL_M).astype(int)
    counts = cells.max(axis=0) + 1
    grid = np.zeros(counts, bool)
    grid[tuple(cells.T)] = True
    board = _board(grid)
    if board is None or (high[2] - low[2]) - (board + 1) * CELL_M < MIN_ABOVE_M:
        return [points]
    above = grid.copy()
    above[:, :, : board + 2] = False
    labels, count = ndimage.label(above, np.ones((3, 3, 3)))
    if not count or any(_reaches(labels == k + 1) for k in range(count)):
        return [points]
    which = labels[tuple(cells.T)]
    return [points[which == 0], *(points[which == k + 1] for k in range(count))]


def _board(grid: Bool[np.ndarray, "x y z"]) -> int | None:
    """The highest level that fills much of the outline, all levels above it filling little."""
    area = grid.any(axis=2).sum()
    # A board may lie on the border of two levels, and its edge hides what is right below.
    level = np.array([grid[:, :, k : k + 2].any(axis=2).sum() for k in range(grid.shape[2])]) / max(area, 1)
    boards = np.flatnonzero(level >= MIN_BOARD)
    if not len(boards) or boards[-1] * CELL_M < MIN_HEIGHT_M:
        return None
    board = int(boards[-1])
    return board if (level[board + 3 :] <= MAX_ABOVE).all() else None


def _reaches(part: Bool[np.ndarray, "x y z"]) -> bool:
    """Whether a part goes from one side of the thing nearly to the other."""
    sides = part.shape[:2]
    for axes, side in zip(((1, 2), (0, 2)), sides, strict=True):
        share = (np.ptp(np.flatnonzero(part.any(axis=axes))) + 1) / side
        if share >= (REACHES_ALONG if side >= SQUARE * max(sides) else REACHES_ACROSS):
            return True
    return False
