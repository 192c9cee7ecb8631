"""What a place for an object costs: wishes, and habits: backs to walls, doors and fronts free."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.editing.collisions import WALKED_ON_M
from diorama_core.editing.footprints import Quads, footprint_of, footprints, lie_within, overlapping, put_at, to_outline
from diorama_core.editing.habits import MID_WALL, OFTEN_AT_WALLS, belongs_before, stands
from diorama_core.editing.placement_candidates import Candidates
from diorama_core.editing.relations import NO_FRONT, Relation, Stances, is_long, relation_cost
from diorama_core.editing.room_frame import RoomFrame, door_floors, front_floor
from diorama_core.library.taxonomy import broad, category, having
from diorama_core.scene.types import Pose, Scene, SceneObject

USUAL_WEIGHT = 0.6
SEATS_APART_M = 0.62
"""Seats around one table are at least so far apart, where there is room."""
OTHER_SIDE_COST = 0.15
"""Half of what it costs to sit in the same direction from a table's middle as another."""
LARGE_M2, ASKEW_COST = 0.9, 0.8
"""Furniture of at least this floor area; what it costs at 45 degrees to the walls."""
DOUBLE_BED_M, BEDSIDE_M = 1.2, 0.55
"""Wider beds are entered from both sides."""


def placement_costs(
    scene: Scene,
    item: SceneObject,
    candidates: Candidates,
    relations: Sequence[Relation],
    usual: Sequence[Relation],
    others: Mapping[str, Sequence[Relation]],
    frame: RoomFrame,
    near: Float[np.ndarray, "3"] | None,
) -> Float[np.ndarray, "n"]:
    """What an object costs at every candidate; see `Positioner.best` for the arguments.

    Args:
        scene: as it is.
        item: the object.
        candidates: stances.
        relations: what was asked for it.
        usual: what is usual for its kind.
        others: relations of the objects that stand, by id.
        frame: the room's axes and outline.
        near: where it was said to be; None for anywhere.
    """
    stances = candidates.stances
    cost = candidates.extra.copy()
    known = {o.id: o for o in scene.objects}
    for relation in relations:
        cost += 2.0 * relation_cost(relation, stances, item.category, known, frame)
    for relation in usual:
        cost += USUAL_WEIGHT * relation_cost(relation, stances, item.category, known, frame)
    for relation in (*relations, *usual):
        cost += _sibling_cost(item, relation, stances, known)
    cost += _reverse_costs(item, candidates, known, others, frame)
    if near is not None:
        cost += 0.15 * np.linalg.norm(stances.places - np.asarray(near)[:2], axis=1)
    if category(item.category).mount in ("wall", "ceiling") or any(r.kind == "on" for r in relations):
        return cost
    if candidates.supports and candidates.supports[0] is not None and scene.has_object(candidates.supports[0].parent):
        host = scene.object(candidates.supports[0].parent)
        if host.category not in having("rug"):
            return cost
    return cost + _habits(scene, item, stances, (*relations, *usual), frame)


def _reverse_costs(
    item: SceneObject,
    candidates: Candidates,
    known: Mapping[str, SceneObject],
    others: Mapping[str, Sequence[Relation]],
    frame: RoomFrame,
) -> Float[np.ndarray, "n"]:
    """What the wishes of other objects that name this one cost at the most promising stances."""
    stances = candidates.stances
    cost = np.zeros(len(stances.places))
    wishes = [
        (known[i], r) for i, rs in others.items() if i in known and i != item.id for r in rs if item.id in r.targets
    ]
    if not wishes:
        return cost
    for k in np.flatnonzero(candidates.usable):
        here = replace(item, pose=candidates.pose(item, int(k)))
        for other, relation in wishes:
            cost[k] += 2.0 * float(
                relation_cost(relation, Stances.of(other), other.category, {**known, item.id: here}, frame)[0]
            )
    return cost


def _habits(
    scene: Scene, item: SceneObject, stances: Stances, relations: Sequence[Relation], frame: RoomFrame
) -> Float[np.ndarray, "n"]:
    """Backs to walls, ways to doors, and floor before what is opened or sat on."""
    quads, kind = stances.quads, broad(item.category)
    cost = np.zeros(len(quads))
    if item.category in having("rug"):
        return cost + 0.05 * np.linalg.norm(stances.places - frame.middle, axis=1)
    cost += _obstruction_cost(scene, item, quads, relations) + _askew(item, stances, frame)
    free = any(r.kind in ("in middle", "around", "facing", "between", "opposite") for r in relations)
    walled = item.category in OFTEN_AT_WALLS and not (free and kind == "desk")
    wall_cost = relation_cost(Relation("against wall"), stances, item.category, {}, frame) if frame.walls else 0.0
    if walled:
        cost += 0.9 * np.minimum(wall_cost, 2.0)
        if item.category in MID_WALL:
            cost += 0.5 * _off_middle(stances, frame)
    elif item.category in having("in_corner"):
        cost += 0.25 * np.minimum(to_outline(stances.places, frame.outline), 2.0)
    elif item.category in having("mid_room"):
        cost += 0.25 * np.linalg.norm(stances.places - frame.middle, axis=1) * (kind == "table")
        cost += 0.8 * np.maximum(
            0.9 - to_outline(stances.places, frame.outline) + 0.3 * float(item.size_m[:2].max()), 0.0
        )
    elif item.category in having("seat") and not relations:
        inward = frame.middle - stances.places
        away = np.arctan2(inward[:, 1], inward[:, 0])
        cost += 0.3 * np.abs(np.arctan2(np.sin(stances.yaws_rad - away), np.cos(stances.yaws_rad - away)))
        cost += 0.15 * np.minimum(to_outline(stances.places, frame.outline), 2.0)
    tables = {t for r in relations if r.kind == "around" for t in r.targets}
    for other in scene.objects if tables else ():
        if broad(other.category) == kind:
            apart = np.linalg.norm(stances.places - other.pose.position[:2], axis=1)
            cost += 1.5 * np.maximum(SEATS_APART_M - apart, 0.0)
    if kind == "bed" and float(item.size_m[1]) > DOUBLE_BED_M:
        roomy = item.size_m + np.array([0.0, 2 * BEDSIDE_M, 0.0])
        sides = Stances(roomy, stances.places, stances.yaws_rad).quads
        cost += 0.6 * ~lie_within(sides, frame.outline)
        for quad in door_floors(scene.objects):
            cost += 0.6 * overlapping(sides, quad)
    return cost + _own_front(scene, item, stances, relations, frame)


def _askew(item: SceneObject, stances: Stances, frame: RoomFrame) -> Float[np.ndarray, "n"]:
    """Large furniture stands square to a wall, also where it faces something a little aside."""
    if not frame.walls or float(np.prod(item.size_m[:2])) < LARGE_M2:
        return np.zeros(len(stances.places))
    turned = [np.abs(np.sin(2.0 * (stances.yaws_rad - wall.yaw_rad))) for wall in frame.walls]
    return ASKEW_COST * np.min(turned, axis=0)


def _obstruction_cost(
    scene: Scene, item: SceneObject, quads: Quads, relations: Sequence[Relation]
) -> Float[np.ndarray, "n"]:
    """Cost of floor before doors, windows and furniture."""
    cost = np.zeros(len(quads))
    for quad in door_floors(scene.objects):
        cost += 4.0 * overlapping(quads, quad)
    for other in scene.objects:
        floor = front_floor(other)
        if floor is not None and not belongs_before(item, other, relations):
            cost += 1.2 * overlapping(quads, floor)
        if other.category == "window" and item.size_m[2] > float(other.corners_world[:, 2].min()) + 0.05:
            wide = footprints(
                np.array([0.5, other.size_m[1]]), other.pose.position[None, :2], np.array([other.pose.yaw_rad])
            )
            cost += 0.8 * overlapping(quads, wide[0])
    return cost


def _own_front(
    scene: Scene, item: SceneObject, stances: Stances, relations: Sequence[Relation], frame: RoomFrame
) -> Float[np.ndarray, "n"]:
    """Floor that the object itself needs before it."""
    sample = front_floor(replace(item, pose=Pose.upright(np.zeros(3), 0.0, item.pose.scale)))
    if sample is None:
        return np.zeros(len(stances.places))
    fronts = put_at(sample, stances.places, stances.yaws_rad)
    cost = 1.2 * ~np.array(lie_within(fronts, frame.outline))
    for other in scene.objects:
        if other.size_m[2] < WALKED_ON_M or belongs_before(other, item, relations) or not stands(scene, other):
            continue
        cost = cost + 1.0 * overlapping(fronts, footprint_of(other))
    return cost


def _sibling_cost(
    item: SceneObject, relation: Relation, stances: Stances, known: Mapping[str, SceneObject]
) -> Float[np.ndarray, "n"]:
    """Cost beside others of a kind: one stands on each side of what they are beside or around; opposite something they
    stand in a row."""
    cost = np.zeros(len(stances.places))
    target = known.get(relation.targets[0]) if relation.targets else None
    if target is None or relation.kind not in ("beside", "opposite", "in front of", "around"):
        return cost
    R = target.pose.R_world_object[:2, :2]
    local = (stances.places - target.pose.position[:2]) @ R
    for other in known.values():
        if other.category != item.category or other.id in (item.id, target.id):
            continue
        theirs = (other.pose.position[:2] - target.pose.position[:2]) @ R
        if relation.kind == "beside" and float(np.abs(theirs).max()) < float(target.size_m[:2].max()) / 2 + 1.0:
            cost += 0.5 * (np.sign(local[:, 1]) == np.sign(theirs[1]))
            if item.category not in NO_FRONT:
                cost += 0.25 * (1.0 - np.cos(stances.yaws_rad - other.pose.yaw_rad))
        elif relation.kind == "around":
            lengths = np.maximum(np.linalg.norm(local, axis=1) * float(np.linalg.norm(theirs)), 1e-6)
            short = int(target.size_m[1] < target.size_m[0])  # seats are opposite one another across a long table
            facing = (
                np.sign(local[:, short]) * np.sign(theirs[short])
                if is_long(target.size_m)
                else local @ theirs / lengths
            )
            cost += OTHER_SIDE_COST * (1.0 + facing)
        elif relation.kind != "beside":
            cost += 0.6 * np.minimum(np.abs(local[:, 0] - theirs[0]), 2.0)
    return cost


def _off_middle(stances: Stances, frame: RoomFrame) -> Float[np.ndarray, "n"]:
    """How far along its wall from the middle an object is, 0 to 0.5."""
    best = np.full(len(stances.places), 9.0)
    share = np.full(len(stances.places), 0.5)
    for wall in frame.walls:
        off = np.abs(wall.off_of(stances.places)) + 3.0 * np.abs(np.sin((stances.yaws_rad - wall.yaw_rad) / 2))
        here = off < best
        share = np.where(here, np.abs(wall.t_of(stances.places) / wall.length_m - 0.5), share)
        best = np.minimum(best, off)
    return np.minimum(share, 0.5)
