"""The room as furniture meets it: the floor's outline, walls as lines on the floor, corners, floor to be left free."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from diorama_core.editing.footprints import Quad, footprints
from diorama_core.geometry.openings import DOOR
from diorama_core.library.taxonomy import category
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Plane, Scene, SceneObject
from diorama_core.scene.values import ArrayValue


@dataclass(frozen=True, eq=False)
class WallLine(ArrayValue):
    """One wall from its left to its right end, as seen from inside the room; metres."""

    id: str
    start: Float[np.ndarray, "2"]
    end: Float[np.ndarray, "2"]

    @property
    def length_m(self) -> float:
        """From end to end."""
        return float(np.linalg.norm(self.end - self.start))

    @property
    def direction(self) -> Float[np.ndarray, "2"]:
        """Unit, from left to right."""
        return (self.end - self.start) / self.length_m

    @property
    def inward(self) -> Float[np.ndarray, "2"]:
        """Unit, into the room."""
        return np.array([self.direction[1], -self.direction[0]])

    @property
    def yaw_rad(self) -> float:
        """Heading of what stands with its back to it."""
        return float(np.arctan2(self.inward[1], self.inward[0]))

    def point(self, t_m: float, off_m: float = 0.0) -> Float[np.ndarray, "2"]:
        """The place `t_m` from the left end and `off_m` into the room."""
        return self.start + self.direction * t_m + self.inward * off_m

    def t_of(self, xy: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n"]:
        """How far along the wall points are."""
        return np.asarray((np.asarray(xy) - self.start) @ self.direction)

    def off_of(self, xy: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n"]:
        """How far before the wall points are."""
        return np.asarray((np.asarray(xy) - self.start) @ self.inward)


AROUND_OBJECTS_M = 1.0
"""Where there is no floor, the room reaches this far beyond its objects."""
UPRIGHT = 0.3
"""A wall's normal rises by less."""
JOINED_M = 0.15
"""Ends of two stretches of wall nearer than this meet in a corner."""
SWING_M = 0.9
"""Floor that a door needs on either side."""


@dataclass(frozen=True, eq=False)
class WallRun(WallLine):
    """One wall of a scene, with the heights it reaches from and to."""

    low_m: float
    high_m: float


@dataclass(frozen=True, eq=False)
class RoomFrame:
    """Floor, walls and corners of a scene."""

    outline: Float[np.ndarray, "k 2"]
    """Outline of the floor, counter-clockwise."""
    floor_m: float
    floor_id: str | None
    walls: tuple[WallRun, ...]
    ceiling: Plane | None

    @classmethod
    def of(cls, scene: Scene) -> RoomFrame:
        """The frame of a scene's architecture; around its objects where it has none."""
        floor = scene.architecture.floor
        if floor is not None:
            outline = floor.polygon[:, :2]
        else:
            corners = [o.corners_world[:, :2] for o in scene.objects] or [np.zeros((1, 2))]
            points = np.concatenate(corners)
            low, high = points.min(axis=0) - AROUND_OBJECTS_M, points.max(axis=0) + AROUND_OBJECTS_M
            outline = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
        walls = tuple(w for p in scene.architecture.by_role("wall") if (w := _run(p)) is not None)
        ceiling = next(iter(scene.architecture.by_role("ceiling")), None)
        return cls(outline, floor_height(scene), None if floor is None else floor.id, walls, ceiling)

    @cached_property
    def corners(self) -> tuple[Float[np.ndarray, "2"], ...]:
        """Where two walls meet inward."""
        corners = []
        for a in self.walls:
            for b in self.walls:
                turn = a.direction[0] * b.direction[1] - a.direction[1] * b.direction[0]
                if np.linalg.norm(a.end - b.start) < JOINED_M and turn < -0.5:
                    corners.append(0.5 * (a.end + b.start))
        return tuple(corners)

    @property
    def middle(self) -> Float[np.ndarray, "2"]:
        """The middle of the floor's bounding box."""
        return 0.5 * (self.outline.min(axis=0) + self.outline.max(axis=0))

    @property
    def axis_rad(self) -> float:
        """Heading of the longest edge of the floor: furniture stands along it."""
        edges = np.roll(self.outline, -1, axis=0) - self.outline
        longest = edges[int(np.linalg.norm(edges, axis=1).argmax())]
        return float(np.arctan2(longest[1], longest[0]))

    def wall(self, wall_id: str) -> WallRun | None:
        """The stretch of a wall by its plane's id."""
        return next((w for w in self.walls if w.id == wall_id), None)


def _run(plane: Plane) -> WallRun | None:
    n = plane.normal
    if abs(float(n[2])) > UPRIGHT:
        return None
    inward = n[:2] / np.linalg.norm(n[:2])
    along = np.array([-inward[1], inward[0]])
    t = plane.polygon[:, :2] @ along
    foot = (plane.polygon[:, :2] @ inward).mean()
    if float(np.ptp(t)) < 0.05:
        return None
    low, high = float(plane.polygon[:, 2].min()), float(plane.polygon[:, 2].max())
    return WallRun(plane.id, along * t.min() + inward * foot, along * t.max() + inward * foot, low, high)


def front_floor(item: SceneObject) -> Quad | None:
    """The floor that people need before an object; None where they need none."""
    depth = category(item.category).floor_before_m or 0.0
    if depth <= 0.0:
        return None
    return _floor_ahead(item, (item.size_m[0] + depth) / 2, depth - 0.02, 0.8 * item.size_m[1])


def door_floors(objects: Iterable[SceneObject]) -> list[Quad]:
    """The floor before every door."""
    return [_floor_ahead(o, SWING_M / 2, SWING_M, o.size_m[1]) for o in objects if o.category == DOOR]


def _floor_ahead(item: SceneObject, middle_m: float, depth_m: float, width_m: float) -> Quad:
    """A rectangle of floor whose middle is so far ahead of an object's."""
    yaw = item.pose.yaw_rad
    ahead = np.array([np.cos(yaw), np.sin(yaw)]) * middle_m
    return footprints(np.array([depth_m, width_m]), (item.pose.position[:2] + ahead)[None], np.array([yaw]))[0]
