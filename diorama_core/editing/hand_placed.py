"""What a person placed, turned or sized, which automatic steps leave as it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.scene.support import ancestors
from diorama_core.scene.types import Plane, Scene, SceneObject, Support

RIDES_M = 1e-6
"""An object whose place on its supporter changes by no more was carried along, not placed."""
AWAY_M = 0.05
"""An object whose gap to a wall grew by more than this no longer stands against it."""


def mark_by_hand(before: Scene, after: Scene) -> Scene:
    """A scene as a person left it: what the edit itself placed, turned or sized is noted as such.

    What only rides on its supporter is not. Objects that were taken away from a wall no longer stand against it, unless
    the edit itself said against which walls they stand.

    Args:
        before: the scene before the edit.
        after: the scene after it.
    """
    placed = {o.id for o in after.objects if before.has_object(o.id) and _is_placed(before, after, o.id)}
    if not placed:
        return after
    objects = tuple(replace(o, by_hand=True) if o.id in placed else o for o in after.objects)
    supports = tuple(_off_walls(before, after, s) if s.child in placed else s for s in after.supports)
    return replace(after, objects=objects, supports=supports)


def ids_to_keep(scene: Scene) -> frozenset[str]:
    """Ids of objects that no automatic step moves: what people placed, and what carries it."""
    placed = [o.id for o in scene.objects if o.by_hand]
    carrying = {i for object_id in placed for i in ancestors(scene, object_id) if scene.has_object(i)}
    return frozenset(placed) | carrying


def _is_placed(before: Scene, after: Scene, object_id: str) -> bool:
    old, new = before.object(object_id), after.object(object_id)
    if old.pose == new.pose:
        return False
    if np.abs(new.size_m - old.size_m).max() > RIDES_M and old.shape_id == new.shape_id:
        return True
    edge = after.support_of(object_id)
    if edge is None or edge != before.support_of(object_id) or not before.has_object(edge.parent):
        return True
    local = [np.linalg.inv(s.object(edge.parent).pose.T_world_object) @ s.object(object_id).pose.T_world_object
             for s in (before, after)]  # fmt: skip
    rise = (after.object(edge.parent).size_m[2] - before.object(edge.parent).size_m[2]) / 2
    local[0][2, 3] += rise  # the top on which it stands has risen
    return bool(np.abs(local[1] - local[0]).max() > RIDES_M)


def _off_walls(before: Scene, after: Scene, edge: Support) -> Support:
    if edge != before.support_of(edge.child):
        return edge
    item, old = after.object(edge.child), before.object(edge.child)
    left = tuple(w for w in edge.adheres_to if _gap_m(item, after.plane(w)) > _gap_m(old, before.plane(w)) + AWAY_M)
    return replace(edge, adheres_to=tuple(w for w in edge.adheres_to if w not in left))


def _gap_m(item: SceneObject, wall: Plane) -> float:
    return max(float((item.corners_world @ wall.normal).min()) - wall.offset, 0.0)
