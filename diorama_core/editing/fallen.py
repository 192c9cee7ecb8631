"""What holds objects up after they fell or were pushed off what held them."""

from __future__ import annotations

import numpy as np

from diorama_core.editing.footprints import footprint_of
from diorama_core.geometry.planes import in_polygon
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene, SceneObject, Support

MOVED_M, TOUCH_M = 0.01, 0.05
"""What moved by less is held as before; so near to a top something lies on it."""


def held_again(start: Scene, final: Scene) -> Scene:
    """A scene in which what fell off its supporter is held by what it lies on now: another object, or else the floor.

    Args:
        start: before anything moved.
        final: with the same objects elsewhere.
    """
    floor = final.architecture.floor
    for item in final.objects:
        edge = final.support_of(item.id)
        moved = float(np.linalg.norm(item.pose.position - start.object(item.id).pose.position))
        if edge is None or edge.relation == "mounted on" or moved < MOVED_M or not final.has_object(edge.parent):
            continue
        if _lies_on(item, final.object(edge.parent)):
            continue
        loads = descendants(final, item.id)
        below = [o for o in final.objects if o.id != item.id and o.id not in loads and _lies_on(item, o)]
        parent = max(below, key=lambda o: _top(o)).id if below else None if floor is None else floor.id
        final = edits.detach(final, item.id) if parent is None else edits.attach(final, Support(item.id, parent))
    return final


def _lies_on(item: SceneObject, other: SceneObject) -> bool:
    middle = in_polygon(item.pose.position[None, :2], footprint_of(other))[0]
    return bool(middle) and abs(float(item.corners_world[:, 2].min()) - _top(other)) < TOUCH_M


def _top(item: SceneObject) -> float:
    return float(item.corners_world[:, 2].max())
