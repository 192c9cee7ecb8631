"""Walls as plans see them: a line on the floor with a thickness behind it, a height, and doors and windows along it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import manifold3d
import numpy as np
from jaxtyping import Float

from diorama_core.geometry.openings import DOOR, HOME, OPENING_CATEGORIES, walls_cut_by
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.scene.types import Plane, Scene, SceneObject


@dataclass(frozen=True)
class Opening:
    """A rectangle along a wall."""

    id: str
    from_m: float
    """Distance of its left edge from the wall's start, seen from inside the room."""
    to_m: float
    bottom_m: float
    """World height of its lower edge."""
    top_m: float
    is_door: bool
    """Whether one walks through it."""
    object_id: str | None = None
    """The door or window that fills it; None for a bare opening, and in the face behind a door's."""


@dataclass(frozen=True, eq=False)
class DrawnWall:
    """One wall's face on the floor, from left to right seen from inside the room."""

    plane: Plane
    start: Float[np.ndarray, "2"]
    end: Float[np.ndarray, "2"]
    bottom_m: float
    top_m: float
    openings: tuple[Opening, ...] = ()

    @property
    def id(self) -> str:
        """The plane's."""
        return self.plane.id

    @property
    def length_m(self) -> float:
        """Length of the face."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def direction(self) -> Float[np.ndarray, "2"]:
        """Unit direction from start to end."""
        return (self.end - self.start) / max(self.length_m, 1e-9)

    @property
    def outward(self) -> Float[np.ndarray, "2"]:
        """Unit direction out of the room."""
        return np.array([-self.direction[1], self.direction[0]])

    def point_at(self, distance_m: float, behind_m: float = 0.0) -> Float[np.ndarray, "2"]:
        """A point so far along the wall and so far behind its face."""
        return self.start + distance_m * self.direction + behind_m * self.outward


def wall_lines(planes: Iterable[Plane], items: Sequence[SceneObject], scene: Scene) -> tuple[DrawnWall, ...]:
    """The walls among some planes with their openings.

    Args:
        planes: Walls and others.
        items: Objects; doors and windows among them become openings of the wall they hang on or stand in.
        scene: Says what hangs on what.
    """
    walls = [bare_wall(p) for p in planes if p.role == "wall"]
    fills = [o for o in items if o.category in OPENING_CATEGORIES]
    cut = walls_cut_by(fills, [w.plane for w in walls], scene)

    def open_wall(wall: DrawnWall) -> DrawnWall:
        hung = [_fill(wall, o) for o in fills if cut[o.id] and cut[o.id][0] is wall.plane]
        behind = [_fill(wall, o, is_behind=True) for o in fills if any(w is wall.plane for w in cut[o.id][1:])]
        # Where each room has a door of its own in the wall, both stay.
        return _with_openings(wall, [*hung, *(b for b in behind if not any(_meet(b, h) for h in hung))])

    return tuple(open_wall(w) for w in walls)


def bare_wall(plane: Plane) -> DrawnWall:
    """A wall without its openings."""
    origin, axes, extents = plane_rectangle(plane)
    start = origin[:2]
    heights = plane.polygon[:, 2]
    return DrawnWall(plane, start, start + axes[:2, 0] * extents[0], float(heights.min()), float(heights.max()))


def _with_openings(wall: DrawnWall, filled: Sequence[Opening]) -> DrawnWall:
    bare = [o for o in _gaps(wall) if not any(_meet(o, f) for f in filled)]
    ordered = tuple(sorted((*filled, *bare), key=lambda o: o.from_m))
    return DrawnWall(wall.plane, wall.start, wall.end, wall.bottom_m, wall.top_m, ordered)


def _fill(wall: DrawnWall, item: SceneObject, *, is_behind: bool = False) -> Opening:
    """The opening of a door or window, which fills it in the face that it hangs on."""
    corners = item.corners_world
    along = np.clip((corners[:, :2] - wall.start) @ wall.direction, 0, wall.length_m)
    low, high = np.clip(corners[:, 2], wall.bottom_m, wall.top_m)[[corners[:, 2].argmin(), corners[:, 2].argmax()]]
    ends = float(along.min()), float(along.max())
    name, fill = (f"opening-{item.id}-behind", None) if is_behind else (f"opening-{item.id}", item.id)
    return Opening(name, *ends, float(low), float(high), item.category == DOOR, fill)


def _gaps(wall: DrawnWall) -> list[Opening]:
    """Rectangles that the wall's polygon leaves out, other than at its ends and its top."""
    length, height = wall.length_m, wall.top_m - wall.bottom_m
    corners = wall.plane.polygon
    flat = np.stack([(corners[:, :2] - wall.start) @ wall.direction, corners[:, 2] - wall.bottom_m], axis=1)
    whole = manifold3d.CrossSection([[[0, 0], [length, 0], [length, height], [0, height]]])
    rest = whole - manifold3d.CrossSection([flat], manifold3d.FillRule.NonZero)
    gaps = []
    for number, piece in enumerate(rest.decompose()):
        left, low, right, high = piece.bounds()
        inside = left > 1e-3 and right < length - 1e-3 and high < height - 1e-3
        if inside and right - left >= HOME.min_opening_m and high - low >= HOME.min_opening_m:
            low, high = low + wall.bottom_m, high + wall.bottom_m
            is_door = low < wall.bottom_m + 0.05
            gaps.append(Opening(f"opening-{wall.plane.id}-{number + 1}", left, right, low, high, is_door))
    return gaps


def _meet(a: Opening, b: Opening) -> bool:
    return a.from_m < b.to_m and b.from_m < a.to_m and a.bottom_m < b.top_m and b.bottom_m < a.top_m
