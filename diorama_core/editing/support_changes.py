"""Changes of what holds objects up: what stood on a deleted object comes down, what fell is held by what it lies on,
and one object carries another only where that is sensible.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from diorama_core.editing.footprints import footprint_of
from diorama_core.editing.placing import seat
from diorama_core.editing.positioning import Positioner
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.geometry.rooms import rooms_of_objects
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene, SceneObject, Support


def without_objects(scene: Scene, library: ShapeLibrary, object_ids: Iterable[str]) -> tuple[Scene, tuple[str, ...]]:
    """The scene without objects, and the ids of what stood on them: lowered, beside what is in the way there.

    Args:
        scene: where.
        library: where shapes come from.
        object_ids: what goes.

    Raises:
        EditRefused: one of them is locked.
    """
    gone = set(object_ids)
    after = edits.remove(scene, gone)
    loads = tuple(s.child for s in scene.supports if s.parent in gone and s.child not in gone)
    positioner = Positioner(library)
    for load in loads:
        after = seat(after, library, load)
        removed = (load, *after.children_of(load))
        spot = positioner.nearby(after, load) if positioner.collisions.pairs(after, removed) else None
        after = after if spot is None else edits.move(after, load, spot.pose)
    return after, loads


MOVED_M, TOUCH_M = 0.01, 0.05
"""What moved by less is held as before; so near to a top something lies on it."""


def reattach(start: Scene, final: Scene) -> Scene:
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


def attach_to_room_floor(scene: Scene, object_id: str) -> Scene:
    """Attach an object that stands on a floor of a home to the floor of the room where it is now."""
    edge, floors = scene.support_of(object_id), {r.id: r.floor for r in scene.rooms}
    if edge is None or edge.parent not in floors.values():
        return scene
    item = scene.object(object_id)
    room = rooms_of_objects(replace(scene, objects=(item,), supports=())).get(object_id)
    return (
        scene if room is None or floors[room] == edge.parent else edits.attach(scene, Support(object_id, floors[room]))
    )


def _lies_on(item: SceneObject, other: SceneObject) -> bool:
    middle = is_in_polygon(item.pose.position[None, :2], footprint_of(other))[0]
    return bool(middle) and abs(float(item.corners_world[:, 2].min()) - _top(other)) < TOUCH_M


def _top(item: SceneObject) -> float:
    return float(item.corners_world[:, 2].max())


MAX_FOOTPRINT_RATIO = 2.5
"""A child may stick out: a table lamp's shade over its table, a board over a trestle."""
MAX_VOLUME_RATIO = 6.0
"""Volumes of boxes stand for weights."""
THIN_M = 0.06
"""What is so flat weighs little: rugs, boards, cloths."""


def why_not_on(scene: Scene, child_id: str, parent_id: str) -> str:
    """Why an object should not stand on another one, in a sentence; empty where it may. Planes carry everything."""
    if not (scene.has_object(child_id) and scene.has_object(parent_id)):
        return ""
    child, parent = scene.object(child_id), scene.object(parent_id)
    if _footprint_m2(child) > MAX_FOOTPRINT_RATIO * _footprint_m2(parent):
        return f"{child.label} is much larger than {parent.label}"
    flat = float(np.min(child.size_m)) < THIN_M
    if not flat and float(np.prod(child.size_m)) > MAX_VOLUME_RATIO * float(np.prod(parent.size_m)):
        return f"{child.label} is much too heavy for {parent.label}"
    return ""


def _footprint_m2(item: SceneObject) -> float:
    corners = item.corners_world[:, :2]
    return float(np.prod(np.ptp(corners, axis=0)))
