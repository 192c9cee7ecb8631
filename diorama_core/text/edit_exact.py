"""Edits that say exactly what is where: places in metres, supports, walls and the room's outline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diorama_core.editing.placing import seated
from diorama_core.editing.positioning import Positioner
from diorama_core.editing.sensible_support import why_not_on
from diorama_core.editing.wall_edits import draw_room
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.room_edits import move_plane
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene, Support, yaw_rotation
from diorama_core.text.edit_outcome import Done, names_of
from diorama_core.text.edit_plan import DrawRoom, MoveWall, SetPlace


def placed(positioner: Positioner, scene: Scene, object_id: str, edit: SetPlace) -> Done:
    """One object at a base point, heading and size; what stands on it goes along.

    Args:
        positioner: knows what meets what.
        scene: as it is.
        object_id: of the object.
        edit: what was asked for.
    """
    item, after = scene.object(object_id), scene
    if edit.size_m is not None:
        if min(edit.size_m) <= 0:
            raise EditRefused(f"{item.label} needs sizes above 0")
        after = edits.resize(after, object_id, np.array(edit.size_m))
    pose, size = after.object(object_id).pose, after.object(object_id).size_m
    if edit.heading_deg is not None:
        turn = float(np.radians(edit.heading_deg)) - pose.yaw_rad
        pose = replace(pose, R_world_object=yaw_rotation(turn) @ pose.R_world_object)
    if edit.base_m is not None:
        pose = replace(pose, position=np.array(edit.base_m) + pose.R_world_object[:, 2] * size[2] / 2)
    after = edits.move(after, object_id, pose)
    moved_ids = [object_id, *descendants(after, object_id)]
    met = {b if a in moved_ids else a for a, b in positioner.collisions.of(after, moved_ids)} - set(moved_ids)
    notes = [f"{item.label} meets {names_of(after, sorted(met))}"] if met else []
    if not positioner.inside(after, object_id):
        notes.append(f"{item.label} is not wholly inside the room")
    x, y, z = after.object(object_id).pose.position - pose.R_world_object[:, 2] * size[2] / 2
    sentence = f"place {item.label} at ({x:.2f}, {y:.2f}, {z:.2f}) m, heading {np.degrees(pose.yaw_rad):.0f} degrees"
    return Done(after, (sentence,), (object_id,), tuple(notes))


def supported(positioner: Positioner, scene: Scene, ids: Sequence[str], parent: str, against: str) -> Done:
    """Objects held up by something else, and moved onto it; or held by nothing where there is no parent.

    Args:
        positioner: knows the library.
        scene: as it is.
        ids: of the objects.
        parent: id of an object or plane; empty for nothing.
        against: id of a wall that they also stand against; empty for none.
    """
    for plane_or_object in filter(None, (parent, against)):
        if not (scene.has_object(plane_or_object) or scene.has_plane(plane_or_object)):
            raise EditRefused(f"there is no object, wall, floor or ceiling “{plane_or_object}” in this scene")
    after, names = scene, names_of(scene, ids)
    if not parent:
        for object_id in ids:
            after = edits.detach(after, object_id)
        return Done(after, (f"let nothing hold {names}",), tuple(ids))
    hangs = scene.has_plane(parent) and scene.plane(parent).role != "floor"
    for object_id in ids:
        why_not = why_not_on(scene, object_id, parent)
        if why_not:
            raise EditRefused(why_not)
        walls = (against,) if against and not hangs else ()
        edge = Support(object_id, parent, "mounted on" if hangs else "placed on", adheres_to=walls)
        after = seated(edits.attach(after, edge), positioner.library, object_id)
    name = scene.object(parent).label if scene.has_object(parent) else parent
    return Done(after, (f"{'hang' if hangs else 'put'} {names} on {name}",), tuple(ids))


def wall_moved(scene: Scene, edit: MoveWall) -> Done:
    """A plane of the room moved along its normal."""
    if not scene.has_plane(edit.plane):
        known = ", ".join(p.id for p in scene.architecture.planes)
        raise EditRefused(f"there is no wall, floor or ceiling “{edit.plane}” here; there are {known}")
    way = "out of" if edit.outward_m > 0 else "into"
    line = f"move {edit.plane} by {abs(edit.outward_m):g} m {way} the room"
    return Done(move_plane(scene, edit.plane, edit.outward_m), (line,))


def outlined(scene: Scene, edit: DrawRoom) -> Done:
    """The room over another outline."""
    return Done(draw_room(scene, np.array(edit.corners)), (f"draw the room again with {len(edit.corners)} corners",))
