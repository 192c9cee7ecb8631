"""Edits of objects done exactly: places in metres, supports, walls and the room's outline, one side's length, copies,
exchanges, states, names.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.editing.aligning import align, distribute, widest_axis
from diorama_core.editing.homes import draw_room_of_home
from diorama_core.editing.placing import against_wall, seat
from diorama_core.editing.positioning import Positioner
from diorama_core.editing.relations import Relation
from diorama_core.editing.sunlight import set_light, switch_lamp
from diorama_core.editing.support_changes import why_not_on
from diorama_core.errors import EditRefused
from diorama_core.library.opening import can_open
from diorama_core.render.lamps import lamps_of
from diorama_core.scene import edits
from diorama_core.scene.room_edits import move_plane
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene, Support, yaw_rotation
from diorama_core.text.edit_places import free, relations_of, unmet_notes
from diorama_core.text.edit_plan import (
    Align,
    Copy,
    Done,
    DrawRoom,
    Exchange,
    Measure,
    MoveWall,
    Rename,
    SetPlace,
    SetState,
    SetSupport,
    names_of,
)


def place_at(positioner: Positioner, scene: Scene, edit: SetPlace) -> Done:
    """One object at a base point, heading and size; what stands on it goes along."""
    object_id = edit.objects[0]
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
    met = {b if a in moved_ids else a for a, b in positioner.collisions.pairs(after, moved_ids)} - set(moved_ids)
    notes = [f"{item.label} meets {names_of(after, sorted(met))}"] if met else []
    if not positioner.is_inside(after, object_id):
        notes.append(f"{item.label} is not wholly inside the room")
    x, y, z = after.object(object_id).pose.position - pose.R_world_object[:, 2] * size[2] / 2
    sentence = f"place {item.label} at ({x:.2f}, {y:.2f}, {z:.2f}) m, heading {np.degrees(pose.yaw_rad):.0f} degrees"
    return Done(after, (sentence,), (object_id,), tuple(notes))


def support(positioner: Positioner, scene: Scene, edit: SetSupport) -> Done:
    """Objects held up by something else, and moved onto it; or held by nothing where there is no parent."""
    ids, parent, against = edit.objects, edit.parent, edit.against
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
        after = seat(edits.attach(after, edge), positioner.library, object_id)
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


def outline(scene: Scene, edit: DrawRoom) -> Done:
    """The room over another outline."""
    after = draw_room_of_home(scene, np.array(edit.corners))
    return Done(after, (f"draw the room again with {len(edit.corners)} corners",))


_AXES = {"depth": 0, "width": 1, "height": 2}
FACTORS = (0.1, 10.0)
"""By so much a side may change at once."""
UPRIGHT = np.array([0.0, 0.0, 1.0])


def set_side(positioner: Positioner, scene: Scene, edit: Measure) -> Done:
    """One side of objects longer or shorter, on the same base; what stands on them rises and sinks with their tops."""
    after, notes, lines = scene, list[str](), list[str]()
    for object_id in edit.objects:
        item = after.object(object_id)
        axis, size = _AXES[edit.side], item.size_m.copy()
        now = float(size[axis])
        target = edit.to_m or now * edit.factor + edit.by_m
        if not FACTORS[0] <= target / now <= FACTORS[1]:
            raise EditRefused(f"{item.label} cannot be {target:.2f} m in {edit.side}; it is {now:.2f} m now")
        size[axis] = target
        edge = after.support_of(object_id)
        hangs = edge is not None and edge.relation == "mounted on"
        after = edits.resize(after, object_id, size)
        if hangs:  # it grows to all sides of where it hangs
            pose = replace(after.object(object_id).pose, position=item.pose.position)
            after = seat(edits.move(after, object_id, pose), positioner.library, object_id)
        else:
            for child in after.children_of(object_id):
                after = seat(after, positioner.library, child)
            after, note = free(positioner, after, object_id)
            notes += note
        lines.append(f"make {item.label} {target:.2f} m in {edit.side}")
    return Done(after, tuple(lines), tuple(edit.objects), tuple(notes))


def copy(positioner: Positioner, scene: Scene, edit: Copy) -> Done:
    """Copies of objects with all that was set of them, beside them where no place is said."""
    ids, count, relations = edit.objects, edit.count, relations_of(scene, edit.places)
    after, new, missed = scene, list[str](), list[str]()
    for object_id in ids:
        item = scene.object(object_id)
        for _ in range(count):
            new_id = edits.fresh_id(after, item.category)
            number = sum(o.category == item.category for o in after.objects) + 1
            label = f"{item.category} {number}"
            copy = replace(item, id=new_id, label=label, locked=False, hidden=False, mask_id=None, box_px=None)
            placing = relations or [Relation("beside", (object_id,))]
            spot = positioner.best(after, copy, placing, near=None if relations else item.pose.position)
            if spot is None and not relations:
                spot = positioner.best(after, copy, near=item.pose.position)
            if spot is None:
                raise EditRefused(f"there is no free place for another {item.category} {placing[0].words(scene)}")
            after = positioner.put(after, copy, spot)
            new.append(new_id)
            missed += unmet_notes(after, new_id, relations)
    where = "".join(f" {r.words(scene)}" for r in relations)
    often = f" {count} times" if count > 1 else ""
    return Done(after, (f"copy {names_of(scene, ids)}{often}{where}",), tuple(new), tuple(missed))


def exchange(positioner: Positioner, scene: Scene, edit: Exchange) -> Done:
    """Two objects each where the other one was, on the same base; each turns as the other one stood."""
    if len(edit.objects) < 2:
        raise EditRefused("two different objects can change places")
    first, second = (scene.object(i) for i in edit.objects)
    after = scene
    for item, other in ((first, second), (second, first)):
        low, high = (float(f(other.corners_world[:, 2])) for f in (np.min, np.max))
        position = other.pose.position.copy()
        hung = scene.support_of(other.id)
        if hung is None or hung.relation != "mounted on":
            position[2] = low + item.size_m[2] / 2
        elif any(p.id == hung.parent for p in scene.architecture.by_role("ceiling")):
            position[2] = high - item.size_m[2] / 2
        else:  # their backs are at the wall, whatever their depth
            position = position + other.pose.R_world_object[:, 0] * float(item.size_m[0] - other.size_m[0]) / 2
        after = edits.move(after, item.id, replace(other.pose, position=position, scale=item.pose.scale))
        if hung is not None and hung.parent != item.id:
            after = edits.attach(after, replace(hung, child=item.id))
    notes: list[str] = []
    for item in (first, second):
        edge = after.support_of(item.id)
        for wall in edge.adheres_to if edge is not None else ():
            after = against_wall(after, item.id, after.plane(wall))
        after, note = free(positioner, after, item.id)
        notes += note
    return Done(after, (f"exchange {first.label} and {second.label}",), tuple(edit.objects), tuple(notes))


def put_in_state(positioner: Positioner, scene: Scene, edit: SetState) -> Done:
    """Objects locked, hidden, open, or lit, or the contrary."""
    after, state = scene, edit.state
    for object_id in edit.objects:
        item = after.object(object_id)
        if state in ("locked", "unlocked"):
            after = edits.set_locked(after, object_id, state == "locked")
        elif state in ("hidden", "shown"):
            after = edits.set_hidden(after, object_id, state == "hidden")
        elif state in ("open", "closed"):
            if not can_open(positioner.library, item.shape_id):
                raise EditRefused(f"{item.label} has nothing that opens; other shapes of the library do")
            after = edits.set_open(after, object_id, 1.0 if state == "open" else 0.0)
        else:
            if item not in lamps_of(after):
                raise EditRefused(f"{item.label} is no lamp; only lamps are turned on and off")
            after = set_light(after, switch_lamp(after, object_id, on=state == "on"))
    verb = {"on": "turn on", "off": "turn off", "locked": "lock", "unlocked": "unlock", "hidden": "hide",
            "shown": "show", "open": "open", "closed": "close"}[state]  # fmt: skip
    return Done(after, (f"{verb} {names_of(scene, edit.objects)}",), tuple(edit.objects))


def rename(scene: Scene, edit: Rename) -> Done:
    """An object under another name."""
    object_id = edit.objects[0]
    line = f"call {scene.object(object_id).label} “{edit.to}”"
    return Done(edits.rename(scene, object_id, edit.to), (line,), (object_id,))


def line_up(positioner: Positioner, scene: Scene, edit: Align) -> Done:
    """Objects in one line, what hangs at one height; or with equal gaps along the way they are spread."""
    ids = edit.objects
    if len(ids) < 2:
        raise EditRefused(f"{names_of(scene, ids)} is alone; two objects or more are lined up")
    axis = widest_axis(scene, ids)
    if edit.how == "evenly":
        return Done(distribute(scene, ids, axis), (f"space {names_of(scene, ids)} evenly",), tuple(ids))
    hung = [i for i in ids if (s := scene.support_of(i)) is not None and s.relation == "mounted on"]
    if len(hung) == len(ids):
        level = float(np.median([scene.object(i).pose.position[2] for i in ids]))
        after = scene
        for object_id in ids:
            pose = scene.object(object_id).pose
            after = edits.move(after, object_id, pose.move((0.0, 0.0, level - float(pose.position[2]))))
        return Done(after, (f"hang {names_of(scene, ids)} at one height",), tuple(ids))
    across = np.cross(UPRIGHT, axis)
    after, notes = align(scene, ids, across, "middle"), list[str]()
    for object_id in ids:
        after, note = free(positioner, after, object_id)
        notes += note
    return Done(after, (f"line up {names_of(scene, ids)}",), tuple(ids), tuple(notes))
