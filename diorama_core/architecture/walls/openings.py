"""Doorways and windows of measured walls: where a wall is seen through, in rectangles.

A wall with openings stays one polygon: a doorway is a notch in its foot, a window is reached by a cut from the foot.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float

from diorama_core.architecture.walls.settings import WallSettings
from diorama_core.architecture.walls.surface import MeasuredSurface
from diorama_core.architecture.walls.wall_candidates import WallCandidate, crossings, tolerance_m
from diorama_core.architecture.walls.wall_sequence import WallPiece


@dataclass(frozen=True)
class WallOpening:
    """A rectangle of a wall: metres along its foot from its left end, and heights."""

    left: float
    right: float
    bottom: float
    top: float

    @property
    def is_doorway(self) -> bool:
        """Whether it reaches the floor."""
        return self.bottom == 0.0


def find_openings(
    surface: MeasuredSurface, piece: WallPiece, top_m: float, settings: WallSettings
) -> tuple[WallOpening, ...]:
    """Rectangles of a wall through which farther objects are measured, from left to right.

    Args:
        surface: The measured points.
        piece: The wall; one that was only assumed has no openings.
        top_m: Its height.
    """
    if piece.candidate is None or piece.length_m < 3 * settings.min_side_m:
        return ()
    passed, stopped = _rays(surface, piece, piece.candidate, top_m, settings)
    share = passed / np.maximum(passed + stopped, 1e-9)
    through = ((share > settings.seen_through) & (passed >= 2)).astype(np.uint8)
    through = cv2.morphologyEx(through, cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    through = cv2.morphologyEx(through, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    count, _, stats, _ = cv2.connectedComponentsWithStats(through, connectivity=4)
    openings = [_opening(stats[i], piece, top_m, settings) for i in range(1, count)]
    return tuple(sorted((o for o in openings if o is not None), key=lambda o: o.left))


def is_shut(
    surface: MeasuredSurface, piece: WallPiece, opening: WallOpening, top_m: float, settings: WallSettings
) -> bool:
    """Whether more of what is measured within a rectangle lies on the wall than behind it.

    Args:
        surface: measured points in the world.
        piece: the wall.
        opening: the rectangle on it, in metres along and above the wall's foot.
        top_m: height to which the room was measured.
        settings: the cell size and tolerances of walls.
    """
    if piece.candidate is None:
        return False
    passed, stopped = _rays(surface, piece, piece.candidate, top_m, settings)
    rows = slice(int(opening.bottom / settings.cell_m), int(opening.top / settings.cell_m) + 1)
    columns = slice(int(opening.left / settings.cell_m), int(opening.right / settings.cell_m) + 1)
    return bool(stopped[rows, columns].sum() > passed[rows, columns].sum())


def counts(openings: tuple[tuple[WallOpening, ...], ...]) -> tuple[int, int]:
    """How many doorways and how many windows the walls have."""
    doorways = sum(o.is_doorway for wall in openings for o in wall)
    return doorways, sum(len(wall) for wall in openings) - doorways


def _rays(
    surface: MeasuredSurface, piece: WallPiece, wall: WallCandidate, top_m: float, settings: WallSettings
) -> tuple[Float[np.ndarray, "v u"], Float[np.ndarray, "v u"]]:
    """How many rays pass and how many stop in each cell of the wall, row 0 at the floor."""
    along = (piece.end - piece.start) / piece.length_m
    crossing, share = crossings(surface, wall.normal, wall.offset)
    u, v = (crossing[:, :2] - piece.start) @ along, crossing[:, 2]
    depth_behind = wall.offset - surface.points[:, :2] @ wall.normal
    inside = (share > 0) & (u > 0) & (u < piece.length_m) & (v > 0) & (v < top_m)
    beyond = inside & (depth_behind > settings.beyond_m + 2.0 * tolerance_m(surface.depth_m))
    on = inside & (np.abs(depth_behind) < tolerance_m(surface.depth_m))
    shape = (int(np.ceil(top_m / settings.cell_m)), int(np.ceil(piece.length_m / settings.cell_m)))

    def count_per_cell(chosen: Bool[np.ndarray, "n"]) -> Float[np.ndarray, "v u"]:
        index = (v[chosen] / settings.cell_m).astype(int) * shape[1] + (u[chosen] / settings.cell_m).astype(int)
        return np.bincount(index, minlength=shape[0] * shape[1]).reshape(shape).astype(np.float64)

    return count_per_cell(beyond), count_per_cell(on)


def _opening(stats: np.ndarray, piece: WallPiece, top_m: float, settings: WallSettings) -> WallOpening | None:
    """The rectangle of a component, if it can be a doorway or a window."""
    column, row, width, height, cells = (int(v) for v in stats[:5])
    left, right = column * settings.cell_m, (column + width) * settings.cell_m
    bottom, top = row * settings.cell_m, (row + height) * settings.cell_m
    large = (
        min(width, height) * settings.cell_m >= settings.min_side_m
        and cells * settings.cell_m**2 >= settings.min_area_m2
    )
    framed = left > settings.frame_m and right < piece.length_m - settings.frame_m and top < top_m - settings.frame_m
    if not (large and framed and cells >= settings.min_fill * width * height):
        return None
    return WallOpening(left, right, 0.0 if bottom < settings.sill_m else bottom, top)


def with_openings(polygon: Float[np.ndarray, "n 3"], openings: tuple[WallOpening, ...]) -> Float[np.ndarray, "m 3"]:
    """A wall's polygon, whose first edge is its foot from left to right, with openings cut out of it.

    Args:
        polygon: Corners, counter-clockwise seen from inside the room.
        openings: From left to right, not overlapping.
    """
    start, end = polygon[:2]
    along = (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
    up = np.array([0.0, 0.0, 1.0])
    cut: list[np.ndarray] = []
    reached = 0.0
    for o in openings:
        if o.left <= reached:
            continue
        corners = [(o.left, 0.0)] * (not o.is_doorway)
        corners += [(o.left, o.bottom), (o.left, o.top), (o.right, o.top), (o.right, o.bottom)]
        corners += [(o.left, o.bottom), (o.left, 0.0)] * (not o.is_doorway)
        cut += [start + u * along + v * up for u, v in corners]
        reached = o.right
    return np.array([start, *cut, *polygon[1:]])
