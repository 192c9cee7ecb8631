"""How far an object is from walls and neighbours, moved to another distance, and kept clear of walls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

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
class _Neighbour:
    """Another object, and the heights of its corners, which all four sides ask for."""

    item: SceneObject
    heights: Float[np.ndarray, "8"]


def clearances(scene: Scene, object_id: str) -> tuple[Clearance, ...]:
    """What is nearest on each side of an object, level; sides with nothing within reach are left out.

    What it stands on, what stands on it and hidden objects are no neighbours.
    """
    item = scene.object(object_id)
    family = {object_id, *descendants(scene, object_id), *ancestors(scene, object_id)}
    others = [_Neighbour(o, o.corners_world[:, 2]) for o in scene.objects if o.id not in family and not o.hidden]
    walls = scene.architecture.by_role("wall")
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


def _nearest(item: SceneObject, side: Side, walls: tuple[Plane, ...], others: list[_Neighbour]) -> Clearance | None:
    axis, _ = SIDES[side]
    out = _outward(item, side)
    along = np.array([-out[1], out[0], 0.0])
    half, width = float(item.size_m[axis]) / 2, float(item.size_m[1 - axis])
    starts = item.pose.position + ACROSS[:, None] * width * along  # rays from the middle notice what is reached into
    low, high = (float(e) for e in (item.corners_world[:, 2].min(), item.corners_world[:, 2].max()))
    facing = [w for w in walls if float(w.normal @ out) < 0]
    spans = [_overlap(low, high, w.polygon[:, 2]) for w in facing] + [_overlap(low, high, o.heights) for o in others]
    reached = [_to_wall(starts, out, w, span) for w, span in zip(facing, spans, strict=False)]
    reached += _to_boxes(starts, out, [o.item for o in others], spans[len(facing) :])
    if not reached:
        return None
    shared = np.array([span[1] - span[0] for span in spans])
    least = np.array([0.0] * len(facing) + [MIN_OVERLAP_M] * len(others))
    reach = np.where((shared > least)[:, None], np.array(reached), np.inf) - half
    # As near along the whole side: from its middle.
    nearest = reach + 1e-6 * np.abs(ACROSS)
    which, ray = (int(k) for k in np.unravel_index(int(np.argmin(nearest)), nearest.shape))
    distance = float(reach[which, ray])
    if not np.isfinite(distance) or distance > MAX_M:
        return None
    height = float(np.mean(spans[which]))
    face = np.array([*(starts[ray] + half * out)[:2], height])
    name = facing[which].id if which < len(facing) else others[which - len(facing)].item.id
    return Clearance(side, distance, face, face + distance * out, name)


def _overlap(low: float, high: float, heights: Float[np.ndarray, "_"]) -> tuple[float, float]:
    """The heights that two things share."""
    return max(low, float(heights.min())), min(high, float(heights.max()))


def _to_wall(
    starts: Float[np.ndarray, "n 3"], out: Float[np.ndarray, "3"], wall: Plane, span: tuple[float, float]
) -> Float[np.ndarray, "n"]:
    """How far a wall is from every start, at the middle of the heights that it shares with the object."""
    level = np.column_stack([starts[:, :2], np.full(len(starts), np.mean(span))])
    t = (wall.offset - level @ wall.normal) / float(out @ wall.normal)
    hit = is_in_plane_polygon(level + t[:, None] * out, wall) & (t > 0)
    return np.asarray(np.where(hit, t, np.inf))


def _to_boxes(
    starts: Float[np.ndarray, "n 3"],
    out: Float[np.ndarray, "3"],
    others: list[SceneObject],
    spans: list[tuple[float, float]],
) -> list[Float[np.ndarray, "n"]]:
    """How far the boxes of objects are from every start (slab method), at the middle of the heights they share."""
    if not others:
        return []
    R = np.stack([o.pose.R_world_object for o in others])
    centre = np.stack([o.pose.position for o in others])
    half = np.stack([o.size_m for o in others])[:, None] / 2
    origins = np.repeat(starts[None], len(others), axis=0)
    origins[..., 2] = np.mean(spans, axis=1)[:, None]
    local = np.einsum("bji,bnj->bni", R, origins - centre[:, None])
    direction = np.einsum("bji,j->bi", R, out)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (-half - local) / direction, (half - local) / direction
    parallel = np.abs(direction) < 1e-12
    within = np.abs(local) <= half
    enter = np.where(parallel, np.where(within, -np.inf, np.inf), np.minimum(a, b)).max(axis=-1)
    leave = np.where(parallel, np.where(within, np.inf, -np.inf), np.maximum(a, b)).min(axis=-1)
    return list(np.where((enter <= leave) & (leave > 0), np.maximum(enter, 0.0), np.inf))


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


UPRIGHT = 0.3
"""A wall's normal rises by less."""


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
