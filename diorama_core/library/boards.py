"""Shapes whose boards are at other heights, known by their ids, and piecewise linear maps of an axis.

`bookshelf-oak-four+boards-96-310-540-790` is the shape `bookshelf-oak-four` with its places, from the lowest one up, at
these thousandths of its height. The bounding box stays, boards keep their thickness, and what lies between them is
stretched. Nothing has to be stored: libraries derive such a shape from the one it is named after.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.errors import LibraryError
from diorama_core.library.furniture.measures import MARK as MADE_MARK
from diorama_core.library.record import Shape, SupportSurface
from diorama_core.library.slots import placed_vertices, transform_of


@dataclass(frozen=True, eq=False)
class AxisMap:
    """A piecewise linear map of one axis onto itself; both ends stay."""

    knots: Float[np.ndarray, "k"]
    values: Float[np.ndarray, "k"]

    def __call__(self, x: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
        """Where coordinates go."""
        return np.interp(x, self.knots, self.values)

    def slope(self, x: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
        """How much lengths grow there."""
        k = np.clip(np.searchsorted(self.knots, x, side="right") - 1, 0, len(self.knots) - 2)
        return np.asarray(np.diff(self.values)[k] / np.maximum(np.diff(self.knots)[k], 1e-12))


_MARK = "+boards-"
_THOUSAND = 1000
ONE_LEVEL_M = 0.01
"""Surfaces whose heights differ by less are one level."""
BOARD_SHARE = 0.015
"""Thickness of a board, of the shape's height: what is so far below a level goes with it."""
MIN_SLOPE, MAX_SLOPE = 0.3, 3.0
"""What lies between two boards becomes at most so much lower or higher."""


def base_id(shape_id: str) -> str:
    """The listed shape that an id is derived from, made to measure or not; the id itself where it is not derived."""
    return shape_id.split(_MARK)[0].split(MADE_MARK)[0]


def without_boards(shape_id: str) -> str:
    """The shape whose boards an id says are elsewhere, which may be made to measure; the id itself otherwise."""
    return shape_id.split(_MARK)[0]


def levels_m(shape: Shape) -> tuple[float, ...]:
    """Heights of a shape's places in its own frame, from the lowest one up."""
    found: list[float] = []
    for height in sorted(s.height_m for s in shape.surfaces):
        if not found or height - found[-1] > ONE_LEVEL_M:
            found.append(height)
    return tuple(found)


def with_boards(shape: Shape, heights_m: Float[np.ndarray, " k"]) -> str | None:
    """The id of a shape with its places elsewhere; None where that would squeeze or stretch it too much.

    Args:
        shape: with its support surfaces.
        heights_m: of its levels (`levels_m`) in its own frame, from the lowest one up.
    """
    bottom, height = -shape.size_m[2] / 2, shape.size_m[2]
    shares = [round(_THOUSAND * (z - bottom) / height) for z in heights_m]
    wanted = f"{shape.id}{_MARK}{'-'.join(map(str, shares))}"
    return wanted if shape.id == without_boards(shape.id) and _map(shape, shares) is not None else None


@dataclass(frozen=True)
class Boards:
    """A shape's boards at other heights."""

    id: str
    heights: AxisMap

    @classmethod
    def of(cls, shape_id: str, base: Shape) -> Boards:
        """What a derived id says.

        Raises:
            LibraryError: when it is not one that `with_boards` gives.
        """
        words = shape_id.split(_MARK)[1].split("-")
        if not all(w.isdecimal() and len(w) <= 4 for w in words):
            raise LibraryError(f"'{shape_id}' does not say where the boards of '{base.id}' are")
        heights = _map(base, [int(w) for w in words])
        if heights is None:
            raise LibraryError(f"the boards of '{base.id}' cannot be where '{shape_id}' puts them")
        return cls(shape_id, heights)

    def record(self, base: Shape) -> Shape:
        """The record, with the support surfaces of the base where they are now."""
        key = hashlib.sha256(f"{base.content_hash} {self.id}".encode()).hexdigest()[:24]
        surfaces = tuple(self._moved(s) for s in base.surfaces)
        return replace(base, id=self.id, surfaces=surfaces, content_hash=key)

    def mesh(self, base: trimesh.Trimesh) -> trimesh.Trimesh:
        """Geometry only."""
        return trimesh.Trimesh(self._vertices(np.asarray(base.vertices)), base.faces, process=False)

    def parts(self, base: trimesh.Scene) -> trimesh.Scene:
        """Geometry with materials."""
        scene = base.copy()
        for name, mesh in base.geometry.items():
            if not isinstance(mesh, trimesh.Trimesh):
                continue
            placed = placed_vertices(base, str(name))
            back = np.linalg.inv(transform_of(base, str(name)))
            normals = np.asarray(mesh.vertex_normals).copy()
            normals[:, 2] /= self.heights.slope(placed[:, 2])
            scene.geometry[name] = trimesh.Trimesh(
                trimesh.transform_points(self._vertices(placed), back),
                mesh.faces,
                vertex_normals=normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12),
                visual=mesh.visual,
                metadata=mesh.metadata,
                process=False,
            )
        return scene

    def _vertices(self, vertices: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
        return np.column_stack([vertices[:, :2], self.heights(vertices[:, 2])])

    def _moved(self, surface: SupportSurface) -> SupportSurface:
        level = surface.height_m
        now = float(self.heights(np.array([level]))[0])
        ceiling = float(self.heights(np.array([level + surface.clearance_m]))[0])
        clearance = surface.clearance_m if np.isinf(surface.clearance_m) else ceiling - now
        return replace(surface, polygon=surface.polygon + np.array([0.0, 0.0, now - level]), clearance_m=clearance)


def _map(base: Shape, shares: Sequence[int]) -> AxisMap | None:
    """Takes the base's levels to these thousandths of its height; None where it would squeeze or stretch too much."""
    levels, height = levels_m(base), base.size_m[2]
    bottom = -height / 2
    if len(levels) != len(shares) or not levels:
        return None
    board = BOARD_SHARE * height
    knots, values = [bottom], [bottom]
    for level, share in zip(levels, shares, strict=True):
        target = bottom + height * share / _THOUSAND
        ends = abs(level - bottom) < board or abs(level + bottom) < board
        if ends and abs(target - level) > height / _THOUSAND:
            return None
        if ends:
            continue
        knots += [level - board, level]
        values += [target - board, target]
    knots, values = [*knots, -bottom], [*values, -bottom]
    lengths = np.diff(knots)
    if (lengths <= 0).any():
        return None
    slopes = np.diff(values) / lengths
    fits = bool((slopes > MIN_SLOPE).all() and (slopes < MAX_SLOPE).all())
    return AxisMap(np.array(knots), np.array(values)) if fits else None
