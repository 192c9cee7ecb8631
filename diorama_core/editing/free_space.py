"""Which things still find a place in a room: on its free floor, or on one of its walls."""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
from jaxtyping import Bool, Float

from diorama_core.editing.room_frame import RoomFrame
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.library.record import Shape
from diorama_core.library.taxonomy import resolve
from diorama_core.scene.types import Scene, yaw_rotation

CELL_M = 0.05
MAX_CELLS = 800
"""Cells of either side of the floor's grid; larger rooms have coarser cells."""
FLAT_M = 0.05
"""What is lower may be stood on: rugs."""


@dataclass(frozen=True, eq=False)
class FreeSpace:
    """What is free of a scene, measured once for many questions."""

    free: Bool[np.ndarray, "h w"] | None
    """Cells of the floor, along the room's longest edge; None in a room without a floor."""
    cell_m: float
    height_m: float
    """Below the ceiling; infinite without one."""
    walls_m: tuple[tuple[float, float], ...]
    """Length and height of every wall."""
    T_world_grid: Float[np.ndarray, "2 3"] = field(default_factory=lambda: np.eye(2, 3))
    """From metres along the grid's columns and rows to x and y in the world."""

    @property
    def free_m2(self) -> float:
        """Area of the free floor."""
        return 0.0 if self.free is None else float(self.free.sum()) * self.cell_m**2

    def spots(self, width_m: float, depth_m: float, most: int = 5) -> tuple[tuple[float, float], ...]:
        """Middles, in the world, of free rectangles of the floor so wide and so deep, or turned; none overlap.

        Args:
            width_m: along one side of the room.
            depth_m: along the other.
            most: how many are given.
        """
        spots: list[tuple[float, float]] = []
        apart_m = max(width_m, depth_m)
        for across_m, down_m in dict.fromkeys(((width_m, depth_m), (depth_m, width_m))):
            fits = self._free_rectangles(across_m, down_m)
            if fits is None:
                continue
            rows, columns = np.nonzero(fits)
            for x, y in zip(columns * self.cell_m + across_m / 2, rows * self.cell_m + down_m / 2, strict=True):
                if len(spots) < most and all(max(abs(x - a), abs(y - b)) >= apart_m for a, b in spots):
                    spots.append((float(x), float(y)))
        return tuple((float(x), float(y)) for x, y in (self.T_world_grid @ (*middle, 1.0) for middle in spots))

    def has_place_for(self, shape: Shape) -> bool:
        """Whether a shape finds a place as it is, in one of four headings; what lies on furniture always does."""
        depth, width, height = shape.size_m
        mount = resolve(shape.category).category.mount
        if height > self.height_m:
            return False
        if mount == "wall":
            return not self.walls_m or any(width <= w and height <= h for w, h in self.walls_m)
        if mount != "floor" or self.free is None:
            return True
        return self._fits(depth, width) or self._fits(width, depth)

    def _fits(self, across_m: float, down_m: float) -> bool:
        """Whether a rectangle of free cells is as large."""
        fits = self._free_rectangles(across_m, down_m)
        return fits is not None and bool(fits.any())

    def _free_rectangles(self, across_m: float, down_m: float) -> Bool[np.ndarray, "_ _"] | None:
        """By their first cell, which rectangles of so many metres are free; None where the floor is smaller."""
        if self.free is None:
            return None
        columns, rows = (max(1, int(np.ceil(e / self.cell_m - 1e-6))) for e in (across_m, down_m))
        if columns > self.free.shape[1] or rows > self.free.shape[0]:
            return None
        total = cv2.integral(self.free.astype(np.uint8))
        inside = total[rows:, columns:] - total[:-rows, columns:] - total[rows:, :-columns] + total[:-rows, :-columns]
        return np.asarray(inside >= rows * columns)


def free_space(scene: Scene) -> FreeSpace:
    """Measure the free floor between visible objects that stand on it or reach down to it, and the walls."""
    walls = tuple(
        (float(np.linalg.norm(np.ptp(w.polygon[:, :2], axis=0))), float(np.ptp(w.polygon[:, 2])))
        for w in scene.architecture.by_role("wall")
    )
    floor = scene.architecture.floor
    if floor is None:
        return FreeSpace(None, CELL_M, np.inf, walls)
    level = float(floor.polygon[:, 2].mean())
    ceilings = [float(p.polygon[:, 2].max()) for p in scene.architecture.by_role("ceiling")]
    outline = floor.polygon[:, :2]
    turn = yaw_rotation(RoomFrame.of(scene).axis_rad)[:2, :2]
    flat = outline @ turn
    origin, extent = flat.min(axis=0), np.ptp(flat, axis=0)
    cell = max(CELL_M, float(extent.max()) / MAX_CELLS)
    width, height = (max(1, int(e / cell + 1e-6)) for e in extent)
    free = _fill((flat - origin) / cell, height, width)
    for item in scene.objects:
        corners = item.corners_world
        low, high = float(corners[:, 2].min()) - level, float(corners[:, 2].max()) - level
        if item.hidden or high < FLAT_M or low > FLAT_M:
            continue
        free &= ~_fill((cv2.convexHull(corners[:, :2].astype(np.float32))[:, 0] @ turn - origin) / cell, height, width)
    T_world_grid = np.column_stack([turn, turn @ origin])
    return FreeSpace(free, cell, max(ceilings) - level if ceilings else np.inf, walls, T_world_grid)


def _fill(corners: Float[np.ndarray, "n 2"], height: int, width: int) -> Bool[np.ndarray, "{height} {width}"]:
    """Cells whose middles are in a polygon, given in cells."""
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    return is_in_polygon(np.stack([x, y], axis=-1), np.asarray(corners, dtype=np.float64))
