"""Doors, windows and passages in scanned walls: where a wall's plane has no points though nothing stands before it, and
where something as high as a door is set into the wall or stands out of it.

Glass and open doors reflect nothing at the wall, so that an opening is a hole that wall surrounds. A shut door is a
rectangle at another depth than the wall that reaches the floor; a picture does not reach it. A shut window whose glass
reflects looks like a picture, and is not found.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8
from scipy import ndimage

from diorama_core.geometry.planes import signed_area
from diorama_core.importing.measured_types import MeasuredOpening, MeasuredWall, OpeningKind

CELL_M, MAX_CELL_M = 0.05, 0.12
"""Cell side of the grid on a wall, and its largest value where points are sparse."""
POINTS_A_CELL = 4.0
"""Fewer on average, and cells would be empty by chance."""
ON_WALL_M = 0.09
"""Points so near to the wall's plane are its own, or of a leaf or a frame in it."""
BEFORE_M = 0.8
"""What stands nearer before a wall may hide it."""
RELIEF_M = 0.012
"""A surface so far off the wall's is not the wall's."""
MIN_SIDE_M, MIN_FILL = 0.35, 0.75
"""Shortest side of an opening, and the share of its rectangle that it fills at least."""
MIN_RIM = 0.7
"""Share of the cells right around an opening that are wall or frame."""
SILL_M = 0.15
"""What comes down lower reaches the floor."""
DOOR_WIDTH_M, DOOR_HEIGHT_M = (0.55, 2.0), (1.75, 2.5)
FRAME_M = 0.15
"""So wide may a frame be that stands out around an opening."""
BARS_M = 0.12
"""Bars in a window are narrower."""
SQUARE_CELLS = 3
SQUARE = np.ones((SQUARE_CELLS, SQUARE_CELLS), np.uint8)


@dataclass(frozen=True, eq=False)
class _Grid:
    """A wall seen from inside the room: rows upward from the floor, columns from its first corner to its second."""

    cell_m: float
    points: Bool[np.ndarray, "h w"]
    """Whether a cell has points of the wall's plane."""
    relief_m: Float[np.ndarray, "h w"]
    """How far those points stand out into the room."""
    hidden: Bool[np.ndarray, "h w"]
    """Whether something stands before a cell."""


@dataclass(frozen=True)
class _Rectangle:
    """Cells of a grid: the first column and row, and the first that are no longer in it."""

    left: int
    low: int
    right: int
    high: int


def find_openings(
    points: Float[np.ndarray, "n 3"], walls: Sequence[MeasuredWall], floor_outline: Float[np.ndarray, "k 2"]
) -> tuple[MeasuredOpening, ...]:
    """Openings of a room's upright walls, by the points of a scan whose floor is at 0."""
    area = signed_area(floor_outline)
    return tuple(chain.from_iterable(_wall_openings(points, wall, np.sign(area)) for wall in walls))


def _wall_openings(points: Float[np.ndarray, "n 3"], wall: MeasuredWall, turn: float) -> list[MeasuredOpening]:
    start, end = wall.polygon[0], wall.polygon[1]
    length, height = float(np.linalg.norm(end - start)), float(wall.polygon[:, 2].max())
    if length < MIN_SIDE_M:
        return []
    along = (end - start) / length
    inward = turn * np.array([-along[1], along[0], 0.0])
    local = (points - start) @ np.stack([along, [0.0, 0.0, 1.0], inward], axis=1)
    grid = _grid(local, length, height)
    if grid is None:
        return []
    rectangles: list[_Rectangle] = []
    for rectangle in (*_doors(grid), *_holes(grid)):
        rectangles += [] if any(_overlap(rectangle, other) for other in rectangles) else [rectangle]
    return [_opening(r, grid, start, along, wall.id) for r in rectangles]


def _grid(local: Float[np.ndarray, "n 3"], length_m: float, height_m: float) -> _Grid | None:
    """The wall's cells; None where it was hardly scanned. Points have columns along, up, and into the room."""
    inside = (local[:, 0] > 0) & (local[:, 0] < length_m) & (local[:, 1] > 0) & (local[:, 1] < height_m)
    on_wall = local[inside & (np.abs(local[:, 2]) < ON_WALL_M)]
    if not len(on_wall):
        return None
    cell = max(CELL_M, float(np.sqrt(POINTS_A_CELL * length_m * height_m / len(on_wall))))
    if cell > MAX_CELL_M:
        return None
    shape = (max(1, round(height_m / cell)), max(1, round(length_m / cell)))

    def tally(chosen: Float[np.ndarray, "k 3"], weights: Float[np.ndarray, "k"]) -> Float[np.ndarray, "h w"]:
        rows = np.minimum((chosen[:, 1] / cell).astype(int), shape[0] - 1)
        columns = np.minimum((chosen[:, 0] / cell).astype(int), shape[1] - 1)
        return np.bincount(rows * shape[1] + columns, weights, shape[0] * shape[1]).astype(np.float64).reshape(shape)

    count = tally(on_wall, np.ones(len(on_wall)))
    relief = tally(on_wall, on_wall[:, 2]) / np.maximum(count, 1.0)
    # Not the floor, the ceiling and the walls beside it, which are before every wall.
    amid = ((local[:, :2] > ON_WALL_M) & (local[:, :2] < np.array([length_m, height_m]) - ON_WALL_M)).all(axis=1)
    before = local[amid & (local[:, 2] >= ON_WALL_M) & (local[:, 2] < BEFORE_M)]
    hidden = cv2.dilate((tally(before, np.ones(len(before))) > 0).astype(np.uint8), SQUARE) > 0
    return _Grid(cell, count > 0, cv2.medianBlur(relief.astype(np.float32), 3).astype(np.float64), hidden)


def _holes(grid: _Grid) -> list[_Rectangle]:
    """Rectangles without points that the wall surrounds."""
    empty = (~grid.points & ~grid.hidden).astype(np.uint8)
    bars = 2 * round(BARS_M / grid.cell_m / 2) + 1
    joined = cv2.morphologyEx(empty, cv2.MORPH_CLOSE, np.ones((bars, bars), np.uint8))
    joined = cv2.morphologyEx(joined, cv2.MORPH_OPEN, SQUARE)
    found = _rectangles(joined, grid)
    return [_with_frame(r, grid) for r in found if _rim(r, grid) >= MIN_RIM and not _is_low(r, grid)]


def _doors(grid: _Grid) -> list[_Rectangle]:
    """Leaves as high as doors, down to the floor, that stand out of the wall or are set into it."""
    doors = []
    for side in (1.0, -1.0):
        leaf = grid.points & ~grid.hidden & (side * grid.relief_m > RELIEF_M)
        off = cv2.morphologyEx(leaf.astype(np.uint8), cv2.MORPH_CLOSE, SQUARE)
        off = ndimage.binary_fill_holes(off).astype(np.uint8)  # panes of a glazed door
        off = cv2.morphologyEx(off, cv2.MORPH_OPEN, SQUARE)
        doors += [r for r in _rectangles(off, grid) if _is_door(r, grid)]
    return doors


def _rectangles(cells: UInt8[np.ndarray, "h w"], grid: _Grid) -> list[_Rectangle]:
    """Connected cells that fill the rectangle around them, the largest first."""
    count, _, stats, _ = cv2.connectedComponentsWithStats(cells, connectivity=4)
    least = MIN_SIDE_M / grid.cell_m
    rectangles = []
    for left, low, width, height, area in sorted((tuple(s) for s in stats[1:count]), key=lambda s: (-s[4], s[:4])):
        if min(width, height) >= least and area >= MIN_FILL * width * height:
            rectangles.append(_Rectangle(int(left), int(low), int(left + width), int(low + height)))
    return rectangles


def _is_door(r: _Rectangle, grid: _Grid) -> bool:
    width, height = (r.right - r.left) * grid.cell_m, r.high * grid.cell_m
    fits = DOOR_WIDTH_M[0] <= width <= DOOR_WIDTH_M[1] and DOOR_HEIGHT_M[0] <= height <= DOOR_HEIGHT_M[1]
    return fits and r.low * grid.cell_m <= SILL_M


def _is_low(r: _Rectangle, grid: _Grid) -> bool:
    """Whether nobody could walk through what reaches the floor: it was not scanned, or is a niche."""
    return r.low * grid.cell_m <= SILL_M and r.high * grid.cell_m < DOOR_HEIGHT_M[0]


def _rim(r: _Rectangle, grid: _Grid) -> float:
    """Share of the cells beside and above a rectangle, and below it unless it reaches the floor, that have points."""
    height, width = grid.points.shape
    beside = [grid.points[r.low : r.high, c] for c in (r.left - 2, r.right + 1) if 0 <= c < width]
    level = [r.high + 1] if r.low * grid.cell_m <= SILL_M else [r.high + 1, r.low - 2]
    above = [grid.points[row, r.left : r.right] for row in level if 0 <= row < height]
    if len(beside) < 2 or len(above) < len(level):
        return 0.0  # where the wall ends is no opening of it
    return min(float(side.mean()) for side in (*beside, *above))


def _with_frame(r: _Rectangle, grid: _Grid) -> _Rectangle:
    """The rectangle with the frame around it that stands out of the wall."""
    off = grid.points & (np.abs(grid.relief_m) > RELIEF_M)
    steps = round(FRAME_M / grid.cell_m)
    left, low, right, high = r.left, r.low, r.right, r.high
    for _ in range(steps):
        left -= int(left > 0 and off[low:high, left - 1].mean() > 0.5)
        right += int(right < off.shape[1] and off[low:high, min(right, off.shape[1] - 1)].mean() > 0.5)
        low -= int(low > 0 and off[low - 1, left:right].mean() > 0.5)
        high += int(high < off.shape[0] and off[min(high, off.shape[0] - 1), left:right].mean() > 0.5)
    return _Rectangle(left, low, right, high)


def _opening(
    r: _Rectangle, grid: _Grid, start: Float[np.ndarray, "3"], along: Float[np.ndarray, "3"], wall: str
) -> MeasuredOpening:
    low = 0.0 if r.low * grid.cell_m <= SILL_M else r.low * grid.cell_m
    high, left, right = (v * grid.cell_m for v in (r.high, r.left, r.right))
    centre = start + along * (left + right) / 2
    centre = np.array([centre[0], centre[1], (low + high) / 2])
    is_door = low == 0.0 and _is_door(r, grid)
    kind: OpeningKind = "door" if is_door else "opening" if low == 0.0 else "window"
    return MeasuredOpening(kind, centre, right - left, high - low, wall)


def _overlap(a: _Rectangle, b: _Rectangle) -> bool:
    return a.left < b.right and b.left < a.right and a.low < b.high and b.low < a.high
