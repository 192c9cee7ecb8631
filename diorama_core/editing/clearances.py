"""How far an object is from walls and neighbours, moved to another distance, and kept clear of walls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.editing.room_frame import UPRIGHT
from diorama_core.errors import EditRefused
from diorama_core.geometry.casting import cast_plane
from diorama_core.geometry.planes import is_in_plane_polygon
from diorama_core.scene import edits
from diorama_core.scene.support import ancestors, descendants
from diorama_core.scene.types import Plane, Pose, Scene, SceneObject

Side = Literal["front", "back", "left", "right"]
SIDES: dict[Side, tuple[int, float]] = {"front": (0, 1.0), "back": (0, -1.0), "left": (1, 1.0), "right": (1, -1.0)}
"""The object's own axis and its sign."""
ACROSS = np.linspace(-0.48, 0.48, 9)
"""Where a side is measured from, as shares of its width."""
MIN_OVERLAP_M = 0.03
"""Objects that share less height than this pass over one another: rugs, what hangs above."""
MAX_M = 15.0
OPPOSITE = 0.7
"""Planes face one another where the cosine between them is below minus this."""


@dataclass(frozen=True, eq=False)
class Clearance:
    """The free length on one side."""

    side: Side
    distance_m: float
    """Negative where the object reaches into what is there."""
    start: Float[np.ndarray, "3"]
    """On the object's side, in the world."""
    end: Float[np.ndarray, "3"]
    other: str
    """Id of the plane or object that ends it."""


@dataclass(frozen=True, eq=False)
class _Boxes:
    """Other objects, for all four sides."""

    ids: tuple[str, ...]
    R: Float[np.ndarray, "b 3 3"]
    centre: Float[np.ndarray, "b 3"]
    half: Float[np.ndarray, "b 3"]

    @classmethod
    def of(cls, items: Sequence[SceneObject]) -> _Boxes:
        """The boxes of objects."""
        poses = [o.pose for o in items]
        R = np.array([p.R_world_object for p in poses]).reshape(-1, 3, 3)
        centre, size = np.array([p.position for p in poses]), np.array([o.size_m for o in items])
        return cls(tuple(o.id for o in items), R, centre.reshape(-1, 3), size.reshape(-1, 3) / 2)

    def heights_shared_with(self, item: SceneObject) -> tuple[Float[np.ndarray, "b"], Float[np.ndarray, "b"]]:
        """Lower and upper end of the heights that each shares with an object."""
        rise = (np.abs(self.R[:, 2]) * self.half).sum(axis=1)
        low, high = _heights(item.corners_world)
        return np.maximum(self.centre[:, 2] - rise, low), np.minimum(self.centre[:, 2] + rise, high)


_Wall = tuple[Plane, float]
"""With the middle of the heights that it shares with the object."""


def clearances(scene: Scene, object_id: str) -> tuple[Clearance, ...]:
    """What is nearest on each side of an object, level; sides with nothing within reach are left out.

    What it stands on, what stands on it and hidden objects are no neighbours.
    """
    item = scene.object(object_id)
    family = {object_id, *descendants(scene, object_id), *ancestors(scene, object_id)}
    others = _Boxes.of([o for o in scene.objects if o.id not in family and not o.hidden])
    ends = _heights(item.corners_world)
    spans = [(w, *_heights(w.polygon)) for w in scene.architecture.by_role("wall")]
    walls = [
        (w, (max(low, ends[0]) + min(high, ends[1])) / 2) for w, low, high in spans if low < ends[1] and ends[0] < high
    ]
    nearest = (_nearest(item, side, walls, others) for side in SIDES)
    return tuple(c for c in nearest if c is not None)


def set_clearance(scene: Scene, object_id: str, side: Side, distance_m: float) -> Scene:
    """The object moved along one of its axes until that side is free by a length; what is on it goes along.

    Args:
        scene: as it is.
        object_id: of the object.
        side: of the object.
        distance_m: that is free beside it.

    Raises:
        EditRefused: there is nothing on that side, or the length is none.
    """
    if not (np.isfinite(distance_m) and 0.0 <= distance_m <= MAX_M):
        raise EditRefused(f"a distance of {distance_m:g} m cannot be set; give 0 to {MAX_M:g} m")
    now = next((c for c in clearances(scene, object_id) if c.side == side), None)
    if now is None:
        raise EditRefused(f"there is nothing to the {side} to keep a distance from")
    item = scene.object(object_id)
    shift = (now.distance_m - distance_m) * _outward(item, side)
    return edits.move(scene, object_id, item.pose.move(shift))


def _outward(item: SceneObject, side: Side) -> Float[np.ndarray, "3"]:
    """Level direction out of one side."""
    axis, sign = SIDES[side]
    direction = item.pose.R_world_object[:, axis] * sign * (1.0, 1.0, 0.0)
    return np.asarray(direction / max(float(np.linalg.norm(direction)), 1e-9))


def _nearest(item: SceneObject, side: Side, walls: Sequence[_Wall], others: _Boxes) -> Clearance | None:
    axis, _ = SIDES[side]
    out = _outward(item, side)
    along = np.array([-out[1], out[0], 0.0])
    half, width = float(item.size_m[axis]) / 2, float(item.size_m[1 - axis])
    starts = item.pose.position + ACROSS[:, None] * width * along  # rays from the middle notice what is reached into
    low, high = others.heights_shared_with(item)
    nearest = _Reached.of(_to_boxes(starts, out, others, (low + high) / 2, high - low > MIN_OVERLAP_M))
    other, height = "", 0.0
    if np.isfinite(nearest.cost):
        other, height = others.ids[nearest.which], float(low[nearest.which] + high[nearest.which]) / 2
    for wall, level, before in _planes_before(starts, out, walls):
        if before.min() >= nearest.cost:
            break  # and so are the others
        hit = is_in_plane_polygon(level + before[:, None] * out, wall)
        reached = _Reached.of(np.where(hit, before, np.inf)[None])
        if reached.cost < nearest.cost:
            nearest, other, height = reached, wall.id, float(level[0, 2])
    distance = nearest.distance - half
    if not np.isfinite(distance) or distance > MAX_M:
        return None
    face = np.array([*(starts[nearest.ray] + half * out)[:2], height])
    return Clearance(side, distance, face, face + distance * out, other)


@dataclass(frozen=True, eq=False)
class _Reached:
    """The nearest of what rays reach."""

    cost: float
    """The distance; of those that are as near along the whole side that from its middle is the least."""
    distance: float
    which: int
    ray: int

    @classmethod
    def of(cls, distances: Float[np.ndarray, "b n"]) -> _Reached:
        """The nearest; infinitely far where nothing is reached."""
        if not len(distances):
            return cls(np.inf, np.inf, 0, 0)
        costs = distances + 1e-6 * np.abs(ACROSS)
        which, ray = (int(k) for k in np.unravel_index(int(np.argmin(costs)), costs.shape))
        return cls(float(costs[which, ray]), float(distances[which, ray]), which, ray)


def _heights(points: Float[np.ndarray, "_ 3"]) -> tuple[float, float]:
    return float(points[:, 2].min()), float(points[:, 2].max())


def _planes_before(
    starts: Float[np.ndarray, "n 3"], out: Float[np.ndarray, "3"], walls: Sequence[_Wall]
) -> list[tuple[Plane, Float[np.ndarray, "n 3"], Float[np.ndarray, "n"]]]:
    """Walls that face the rays, the nearest first: with the rays' starts at the wall's height, and how far its plane is
    from each."""
    before = []
    for wall, height in walls:
        slope = float(wall.normal @ out)
        if slope < 0:
            level = np.column_stack([starts[:, :2], np.full(len(starts), height)])
            t = (wall.offset - level @ wall.normal) / slope
            before.append((wall, level, np.where(t > 0, t, MAX_M + 1.0)))
    return sorted(before, key=lambda one: float(one[2].min()))


def _to_boxes(
    starts: Float[np.ndarray, "n 3"],
    out: Float[np.ndarray, "3"],
    others: _Boxes,
    heights: Float[np.ndarray, "b"],
    asked: Bool[np.ndarray, "b"],
) -> Float[np.ndarray, "b n"]:
    """How far boxes are from every start (slab method), each at a height of its own; infinitely where not asked."""
    origins = np.repeat(starts[None], len(heights), axis=0)
    origins[..., 2] = heights[:, None]
    half = others.half[:, None]
    local = np.einsum("bji,bnj->bni", others.R, origins - others.centre[:, None])
    direction = np.einsum("bji,j->bi", others.R, out)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (-half - local) / direction, (half - local) / direction
    parallel = np.abs(direction) < 1e-12
    within = np.abs(local) <= half
    enter = np.where(parallel, np.where(within, -np.inf, np.inf), np.minimum(a, b)).max(axis=-1)
    leave = np.where(parallel, np.where(within, np.inf, -np.inf), np.maximum(a, b)).min(axis=-1)
    met = asked[:, None] & (enter <= leave) & (leave > 0)
    return np.asarray(np.where(met, np.maximum(enter, 0.0), np.inf))


def room_before(scene: Scene, plane_id: str) -> Clearance | None:
    """The free length from the middle of a plane straight across the room; None where nothing is met."""
    plane = scene.plane(plane_id)
    others = [p for p in scene.architecture.planes if float(p.normal @ plane.normal) < -OPPOSITE]
    middle = 0.5 * (plane.polygon.min(axis=0) + plane.polygon.max(axis=0))
    reached = [(float(cast_plane(middle, plane.normal[None], p, 1e-3)[0]), p.id) for p in others]
    distance, other = min(reached, default=(np.inf, ""))
    if not np.isfinite(distance):
        return None
    return Clearance("front", distance, middle, middle + distance * plane.normal, other)


def clear_of_walls(scene: Scene, item: SceneObject) -> Pose:
    """The pose of an object, pushed into the room where it would reach through a wall that its middle is before.

    A page does the same with the ghost of what is being placed (`static/ghost.js`).
    """
    pose = item.pose
    half = item.size_m / 2
    for wall in scene.architecture.by_role("wall"):
        if abs(float(wall.normal[2])) > UPRIGHT:
            continue
        reach = float(np.abs(wall.normal @ pose.R_world_object) @ half)
        gap = float(pose.position @ wall.normal) - wall.offset
        heights = wall.polygon[:, 2]
        foot = pose.position - gap * wall.normal
        foot[2] = np.clip(foot[2], float(heights.min()) + UPRIGHT, float(heights.max()) - UPRIGHT)
        if -reach < gap < reach and is_in_plane_polygon(foot[None], wall)[0]:
            pose = pose.move((reach - gap) * wall.normal)
    return pose
