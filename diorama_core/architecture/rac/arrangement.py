"""The picture cut into convex cells by the lines at which planes meet.

A plane's inverse depth is linear in the pixel: `a @ (x, y, 1)`. Two planes meet where theirs are equal, and a plane
is in front of the camera where its own is positive, so all cuts are straight lines through the whole picture.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.geometry.planes import clip_polygon, signed_area
from diorama_core.geometry.vectors import unique_rows
from diorama_core.scene.types import Camera

MIN_AREA_PX = 0.5
"""Smaller pieces are rounding, not cells."""
MIN_INVERSE_M = 0.02
"""A plane that is seen at more than 50 m is not in front of the camera."""


@dataclass(frozen=True, eq=False)
class Cell:
    """A convex piece of the picture that no line crosses."""

    corners: Float[np.ndarray, "k 2"]
    """Pixels."""
    sides: tuple[bool, ...]
    """For every line, on which side of it the cell lies."""


@dataclass(frozen=True, eq=False)
class PlaneLine:
    """A cut through the picture."""

    form: Float[np.ndarray, "3"]
    """`form @ (x, y, 1)` is positive on one side of it."""
    ending: frozenset[int]
    """Planes that may end here: the two that meet, none at a plane's horizon, one before what hides its end."""


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Cells and lines of a set of planes."""

    inverse: Float[np.ndarray, "p 3"]
    """Per plane `a`: inverse depth 1/m at pixel (x, y) is `a @ (x, y, 1)`."""
    lines: tuple[PlaneLine, ...]
    cells: tuple[Cell, ...]

    def inverse_at(self, plane: int, pixels: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n"]:
        """Inverse depth of a plane, 1/m; not positive where it is behind the camera."""
        a = self.inverse[plane]
        return np.asarray(pixels @ a[:2] + a[2])

    def neighbours(self) -> tuple[tuple[int, int, int], ...]:
        """(cell, cell, line) for cells that touch along a line."""
        known = {cell.sides: k for k, cell in enumerate(self.cells)}
        neighbours = []
        for k, cell in enumerate(self.cells):
            for line in range(len(self.lines)):
                if cell.sides[line]:
                    other = (*cell.sides[:line], False, *cell.sides[line + 1 :])
                    if other in known:
                        neighbours.append((k, known[other], line))
        return tuple(neighbours)

    def holds(self, pixels: Float[np.ndarray, "n 2"]) -> Int[np.ndarray, "n"]:
        """The cell of every pixel; -1 for one in a piece too small to be a cell."""
        forms = np.array([line.form for line in self.lines]).reshape(-1, 3)
        signs: Bool[np.ndarray, "n l"] = pixels @ forms[:, :2].T + forms[:, 2] > 0
        known = {cell.sides: k for k, cell in enumerate(self.cells)}
        first, kind = unique_rows(signs)
        return np.array([known.get(tuple(signs[k].tolist()), -1) for k in first], dtype=int)[kind]


def inverse_depths(
    normals: Float[np.ndarray, "p 3"], offsets: Float[np.ndarray, "p"], camera: Camera
) -> Float[np.ndarray, "p 3"]:
    """Per plane `n . x = offset` in the world, its inverse depth as a linear form of the pixel."""
    R, k = camera.T_world_camera[:3, :3], camera.intrinsics
    away = offsets - normals @ camera.position
    local = (normals @ R) / np.where(np.abs(away) < 1e-9, 1e-9, away)[:, None]
    x, y = local[:, 0] / k.fx, local[:, 1] / k.fy
    return np.stack([x, y, local[:, 2] - x * k.cx - y * k.cy], axis=1)


def plane_lines(inverse: Float[np.ndarray, "p 3"]) -> tuple[PlaneLine, ...]:
    """Where every two planes meet, and where each leaves the view (its horizon)."""
    count = len(inverse)
    meetings = [PlaneLine(inverse[i] - inverse[j], frozenset((i, j))) for i, j in combinations(range(count), 2)]
    return (*meetings, *(PlaneLine(inverse[k] - [0, 0, MIN_INVERSE_M], frozenset()) for k in range(count)))


def arrangement(
    inverse: Float[np.ndarray, "p 3"], size_px: tuple[int, int], hidden_ends: Sequence[PlaneLine] = ()
) -> Arrangement:
    """The picture of this size (width, height) cut by all lines of the planes that cross it, and by hidden ends."""
    width, height = size_px
    frame = np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])
    sides = [(line, frame @ line.form[:2] + line.form[2]) for line in (*plane_lines(inverse), *hidden_ends)]
    lines = tuple(line for line, side in sides if side.min() < 0 < side.max())
    pieces: list[tuple[np.ndarray, tuple[bool, ...]]] = [(frame, ())]
    for line in lines:
        cut: list[tuple[np.ndarray, tuple[bool, ...]]] = []
        for corners, within in pieces:
            for positive in (True, False):
                form = line.form if positive else -line.form
                part = clip_polygon(corners, form[:2], -float(form[2]))
                if abs(signed_area(part)) > MIN_AREA_PX:
                    cut.append((part, (*within, positive)))
        pieces = cut
    return Arrangement(inverse, lines, tuple(Cell(corners, within) for corners, within in pieces))
