"""The empty room: its outline seen from above, its walls, and the planes they make.

Room frame: origin in the middle of the outline's bounding box on the floor, +Z up, x and y along the room's axes.
An attic's ceiling slopes down to a low wall on one side.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import manifold3d
import numpy as np
from jaxtyping import Float

from diorama_core.editing.room_frame import WallLine
from diorama_core.geometry.planes import signed_area
from diorama_core.scene.types import Architecture, Plane
from diorama_core.scene.values import ArrayValue

Outline = Literal["box", "L-shape", "slanted wall", "attic"]


@dataclass(frozen=True, eq=False)
class Slope(ArrayValue):
    """A sloping part of a rectangular room's ceiling."""

    wall: int
    """Number of the low wall that it comes down to."""
    low_m: float
    """That wall's height."""
    run_m: float
    """How far from the low wall, measured on the floor, the ceiling is level."""


@dataclass(frozen=True, eq=False)
class RoomPlan(ArrayValue):
    """Outline and height of a room."""

    outline: Float[np.ndarray, "n 2"]
    """Corners, counter-clockwise seen from above."""
    height_m: float
    slope: Slope | None = None

    @cached_property
    def walls(self) -> tuple[WallLine, ...]:
        """One wall per edge of the outline: `wall_0` from corner 1 to corner 0 and so on."""
        count = len(self.outline)
        return tuple(WallLine(f"wall_{k}", self.outline[(k + 1) % count], self.outline[k]) for k in range(count))

    @cached_property
    def _section(self) -> manifold3d.CrossSection:
        return manifold3d.CrossSection([self.outline])

    @property
    def middle(self) -> Float[np.ndarray, "2"]:
        """The place below the middle of the level ceiling's bounding box."""
        level = self._ceilings()[0]
        return np.asarray(0.5 * (level.min(axis=0) + level.max(axis=0)))

    def wall(self, wall_id: str) -> WallLine:
        """The wall with this id."""
        return self.walls[int(wall_id.removeprefix("wall_"))]

    @property
    def area_m2(self) -> float:
        """Area of the floor."""
        return float(self._section.area())

    def contains(self, quad: Float[np.ndarray, "4 2"], slack_m2: float = 1e-5) -> bool:
        """Whether a counter-clockwise footprint lies inside the outline."""
        return float((manifold3d.CrossSection([quad]) - self._section).area()) <= slack_m2

    def roof_m(self, xy: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n"]:
        """Height of the ceiling above places on the floor."""
        level = np.full(np.shape(xy)[:-1], self.height_m)
        if self.slope is None:
            return level
        low = self.walls[self.slope.wall]
        off = (xy - low.start) @ low.inward
        rise = (self.height_m - self.slope.low_m) / self.slope.run_m
        return np.minimum(level, self.slope.low_m + rise * off)

    def fits_under_roof(self, corners_m: Float[np.ndarray, "n 3"], gap_m: float = 0.02) -> bool:
        """True if a convex body with these corners leaves a gap below the ceiling."""
        return bool((corners_m[:, 2] <= self.roof_m(corners_m[:, :2]) - gap_m).all())

    def architecture(self, textures: tuple[str | None, str | None, str | None] = (None, None, None)) -> Architecture:
        """Floor, walls and ceiling; `textures` name the finishes of floor, walls and ceiling."""
        planes = [Plane("floor", "floor", _lift(self.outline, 0.0), texture=textures[0])]
        for wall in self.walls:
            top = self._top_of(wall)
            corners = np.concatenate([_lift(np.stack([wall.start, wall.end]), 0.0), _lift(top, self.roof_m(top))])
            planes.append(Plane(wall.id, "wall", corners, texture=textures[1]))
        planes += [
            Plane("ceiling" if k == 0 else "sloping_ceiling", "ceiling", _lift(part, self.roof_m(part))[::-1],
                  texture=textures[2])
            for k, part in enumerate(self._ceilings())
        ]  # fmt: skip
        return Architecture(tuple(planes))

    def _top_of(self, wall: WallLine) -> Float[np.ndarray, "n 2"]:
        """Places on the floor below the upper corners of a wall, from its right to its left end."""
        ends = np.stack([wall.end, wall.start])
        if self.slope is None:
            return ends
        low = self.walls[self.slope.wall]
        offs = (ends - low.start) @ low.inward
        if not offs.min() < self.slope.run_m < offs.max():
            return ends
        t = (self.slope.run_m - offs[0]) / (offs[1] - offs[0])
        return np.stack([ends[0], ends[0] + t * (ends[1] - ends[0]), ends[1]])

    def _ceilings(self) -> tuple[Float[np.ndarray, "_ 2"], ...]:
        """Places on the floor below the corners of the level and the sloping part, counter-clockwise from above."""
        if self.slope is None:
            return (self.outline,)
        low = self.walls[self.slope.wall]
        count, k = len(self.outline), self.slope.wall
        a, b = self.outline[k], self.outline[(k + 1) % count]
        far_b, far_a = self.outline[(k + 2) % count], self.outline[(k + 3) % count]
        ridge_a, ridge_b = a + self.slope.run_m * low.inward, b + self.slope.run_m * low.inward
        return np.stack([ridge_a, ridge_b, far_b, far_a]), np.stack([a, b, ridge_b, ridge_a])


def _lift(xy: Float[np.ndarray, "n 2"], height_m: float | Float[np.ndarray, "n"]) -> Float[np.ndarray, "n 3"]:
    return np.column_stack([xy, np.broadcast_to(height_m, len(xy))])


def room_plan(
    rng: np.random.Generator, width_m: tuple[float, float], depth_m: tuple[float, float], outline: Outline = "box"
) -> RoomPlan:
    """A room of random size.

    Args:
        rng: The source of chance.
        width_m: Least and greatest extent along x.
        depth_m: Least and greatest extent along y.
        outline: "box"; "L-shape" (one corner taken out); "slanted wall" (one corner cut off at an angle); "attic" (a
            rectangle whose ceiling slopes down to one of its long walls).
    """
    w, d = rng.uniform(*width_m), rng.uniform(*depth_m)
    x, y = w / 2, d / 2
    rectangle = [[-x, -y], [x, -y], [x, y], [-x, y]]
    if outline == "attic":
        long_side = int(d > w) + 2 * int(rng.integers(2))
        slope = Slope(long_side, float(rng.uniform(0.9, 1.4)), float(rng.uniform(0.35, 0.5) * min(w, d)))
        return RoomPlan(np.array(rectangle), float(rng.uniform(2.45, 2.85)), slope)
    corners = {
        "box": rectangle,
        "L-shape": _without_corner(x, y, rng.uniform(0.3, 0.42) * w, rng.uniform(0.3, 0.42) * d),
        "slanted wall": _cut_corner(x, y, rng.uniform(0.25, 0.4) * w, rng.uniform(0.25, 0.4) * d),
    }[outline]
    points = np.array(corners)
    if outline != "box":
        turned = points * np.where(rng.random(2) < 0.5, -1.0, 1.0)
        points = turned if signed_area(turned) > 0 else turned[::-1]
    return RoomPlan(points, float(rng.uniform(2.45, 2.85)))


def _without_corner(x: float, y: float, a: float, b: float) -> list[list[float]]:
    return [[-x, -y], [x, -y], [x, y - b], [x - a, y - b], [x - a, y], [-x, y]]


def _cut_corner(x: float, y: float, a: float, b: float) -> list[list[float]]:
    return [[-x, -y], [x, -y], [x, y - b], [x - a, y], [-x, y]]


def footprint(size_m: Float[np.ndarray, "3"], xy: Float[np.ndarray, "2"], yaw_rad: float) -> Float[np.ndarray, "4 2"]:
    """Corners of a turned rectangle, counter-clockwise seen from above."""
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    local = 0.5 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * np.asarray(size_m)[:2]
    return local @ np.array([[c, s], [-s, c]]) + xy


def quads_overlap(a: Float[np.ndarray, "4 2"], b: Float[np.ndarray, "4 2"], slack_m: float = 1e-4) -> bool:
    """Whether two convex outlines share more than `slack_m` in every direction (separating axes)."""
    for quad in (a, b):
        edges = np.roll(quad, -1, axis=0) - quad
        axes = np.stack([edges[:, 1], -edges[:, 0]], axis=1)
        axes /= np.maximum(np.linalg.norm(axes, axis=1, keepdims=True), 1e-12)
        pa, pb = a @ axes.T, b @ axes.T
        if ((pa.max(axis=0) <= pb.min(axis=0) + slack_m) | (pb.max(axis=0) <= pa.min(axis=0) + slack_m)).any():
            return False
    return True
