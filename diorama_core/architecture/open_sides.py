"""Sides of a floor at which no wall stands: where the picture ended, and not the room.

Something that reaches beyond such a side shows that the room goes on there, along all of it: the side moves outward,
and the walls that end at it go on to it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.scene.types import Architecture, Plane, Scene

MIN_SIDE_M = 1.0
"""Shorter sides are details of an outline."""
ENDS_M = 0.05
"""A wall stands at a side, or ends at it, within this."""
_PARALLEL = 0.98


@dataclass(frozen=True, eq=False)
class _Side:
    """One side of an outline."""

    start: Float[np.ndarray, "2"]
    along: Float[np.ndarray, "2"]
    """Unit direction, the floor on its left."""
    length_m: float

    @property
    def outward(self) -> Float[np.ndarray, "2"]:
        """Unit normal away from the floor."""
        return np.array([self.along[1], -self.along[0]])

    def beyond_m(self, points: Float[np.ndarray, "k 2"]) -> float:
        """How far a footprint beside the side reaches beyond it, 0 where it does not."""
        places = (points - self.start) @ self.along
        if places.max() <= 0.0 or places.min() >= self.length_m:
            return 0.0
        return max(float(((points - self.start) @ self.outward).max()), 0.0)

    def is_along(self, wall: Plane) -> bool:
        """Whether a wall stands at it."""
        line = wall.polygon[:, :2] - self.start
        places = line @ self.along
        overlap = min(places.max(), self.length_m) - max(places.min(), 0.0)
        return bool(np.abs(line @ self.outward).max() < ENDS_M and overlap > ENDS_M)


def with_open_sides_moved(scene: Scene, footprints: Sequence[Float[np.ndarray, "_ 2"]]) -> Scene:
    """The scene with the floor's open sides as far out as what stands there reaches, and walls that go on to them.

    Args:
        scene: With a floor, counter-clockwise in plan.
        footprints: In plan, of what stands not only on the floor so far.
    """
    floor = scene.architecture.floor
    if floor is None or not footprints:
        return scene
    outline = floor.polygon[:, :2]
    walls = scene.architecture.by_role("wall")
    sides = _sides(outline)
    count = len(sides)
    reach = np.array(
        [
            _reach_m(side, walls, footprints) if _square(sides[k - 1], side, sides[(k + 1) % count]) else 0.0
            for k, side in enumerate(sides)
        ]
    )
    if not reach.any():
        return scene
    moved = outline.copy()
    for k, side in enumerate(sides):
        moved[[k, (k + 1) % count]] += reach[k] * side.outward
    floor_z = float(floor.centre[2])
    wide = replace(floor, polygon=np.column_stack([moved, np.full(len(moved), floor_z)]))
    planes = [_going_on(p, sides, reach, walls) if p.role == "wall" else p for p in scene.architecture.planes]
    planes = [wide if p.id == floor.id else p for p in planes]
    return replace(scene, architecture=Architecture(tuple(planes)))


def _sides(outline: Float[np.ndarray, "k 2"]) -> list[_Side]:
    ends = np.roll(outline, -1, axis=0)
    lengths = np.maximum(np.linalg.norm(ends - outline, axis=1), 1e-9)
    return [
        _Side(a, (b - a) / length, float(length)) for a, b, length in zip(outline, ends, lengths.tolist(), strict=True)
    ]


def _reach_m(side: _Side, walls: Sequence[Plane], footprints: Sequence[Float[np.ndarray, "_ 2"]]) -> float:
    """How far a side is to move: not at all where a wall stands at it."""
    if side.length_m < MIN_SIDE_M or any(side.is_along(wall) for wall in walls):
        return 0.0
    return max(side.beyond_m(points) for points in footprints)


def _square(before: _Side, side: _Side, after: _Side) -> bool:
    """Whether a side moves outward without pulling its neighbours askew: they go straight away from it, inward."""
    return bool(before.along @ side.outward > _PARALLEL and after.along @ side.outward < -_PARALLEL)


def _going_on(wall: Plane, sides: Sequence[_Side], reach_m: Float[np.ndarray, "s"], walls: Sequence[Plane]) -> Plane:
    """A wall that ended at a side which moved, up to where that is now."""
    polygon = wall.polygon.copy()
    for side, reached in zip(sides, reach_m.tolist(), strict=True):
        level = np.cross([0.0, 0.0, 1.0], wall.normal)
        away = float(level[:2] @ side.outward)
        if reached == 0.0 or abs(away) < _PARALLEL:
            continue
        height = (wall.polygon[:, :2] - side.start) @ side.outward
        places = (wall.polygon[:, :2] - side.start) @ side.along
        at_end = (np.abs(height) < ENDS_M) & (np.minimum(np.abs(places), np.abs(places - side.length_m)) < ENDS_M)
        if at_end.any() and not meets_a_wall(wall, wall.polygon[at_end], walls, ENDS_M):
            polygon[at_end] += reached / away * level
    return wall if np.array_equal(polygon, wall.polygon) else replace(wall, polygon=polygon)


def meets_a_wall(wall: Plane, corners: Float[np.ndarray, "k 3"], walls: Sequence[Plane], within_m: float) -> bool:
    """Whether all of some corners of a wall are at corners of another one."""
    return any(
        bool((np.linalg.norm(other.polygon[:, None] - corners[None], axis=2).min(axis=0) < within_m).all())
        for other in walls
        if other.id != wall.id
    )
