"""What buttons, hotkeys and fields do to objects of the open room, each as one undo step."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial, reduce

import numpy as np
from jaxtyping import Float

from diorama_app.session.client import Client
from diorama_app.strings import _, plural
from diorama_core.editing.clearances import SIDES, set_clearance
from diorama_core.editing.support_changes import attach_to_room_floor
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Finish, MaterialSource, Scene, SceneObject, Support, yaw_rotation

NUDGE_MERGE = "fields"
BESIDE_M = 0.08


def names_of(scene: Scene, ids: Iterable[str]) -> str:
    """Label of one or several objects: the name of one, or the number of several."""
    chosen = tuple(ids)
    return (
        scene.object(chosen[0]).label[:40]
        if len(chosen) == 1
        else plural("{count} object", "{count} objects", len(chosen))
    )


def delete_selected(client: Client) -> None:
    """Delete the selection; what stood on it comes down, and is offered to go as well."""
    from diorama_core.editing.support_changes import without_objects

    session, chosen = client.session, client.need_selection()
    names = names_of(session.scene, chosen)
    loads = without_objects(session.scene, session.library, chosen)[1]
    step = _("delete {names}").format(names=names)
    session.edit(step, lambda scene: without_objects(scene, session.library, chosen)[0], by=client, selection=())
    if loads:
        on_it = names_of(session.scene, loads)
        label = _("Delete it too") if len(loads) == 1 else _("Delete them too")
        said = _("Deleted {names}; lowered what stood on top: {loads}").format(names=names, loads=on_it)
        client.offer(said, label, partial(_delete_loads, client, loads))


def _delete_loads(client: Client, loads: tuple[str, ...]) -> None:
    scene = client.session.scene
    gone = tuple(i for load in loads if scene.has_object(load) for i in (load, *descendants(scene, load)))
    if gone:
        label = _("delete {names}").format(names=names_of(scene, loads))
        client.session.edit(label, lambda s: edits.remove(s, gone), by=client, selection=())


def duplicate_selected(client: Client) -> None:
    """Duplicate the selected objects next to themselves and select the copies."""
    scene, copies = client.session.scene, []
    chosen = client.need_selection()
    for object_id in chosen:
        size = scene.object(object_id).size_m
        offset = scene.object(object_id).pose.R_world_object @ np.array([0.0, size[1] + BESIDE_M, 0.0])
        scene, copy = edits.duplicate(scene, object_id, offset_world=(offset[0], offset[1], 0.0))
        copies.append(copy)
    label = _("duplicate {names}").format(names=names_of(client.session.scene, chosen))
    client.session.commit(label, scene, by=client, selection=copies)


def set_locked(client: Client, ids: Iterable[str], locked: bool) -> None:
    """Lock or unlock objects."""
    _each(
        client, _("lock {names}") if locked else _("unlock {names}"), ids, lambda s, i: edits.set_locked(s, i, locked)
    )


def set_hidden(client: Client, ids: Iterable[str], hidden: bool) -> None:
    """Hide or show objects."""
    _each(client, _("hide {names}") if hidden else _("show {names}"), ids, lambda s, i: edits.set_hidden(s, i, hidden))


def show_all(client: Client) -> None:
    """Show everything that is hidden."""
    hidden = tuple(o.id for o in client.session.scene.objects if o.hidden)
    if not hidden:
        raise EditRefused("nothing is hidden")
    set_hidden(client, hidden, False)


def set_colour(client: Client, ids: Iterable[str], colour: tuple[float, float, float] | None) -> None:
    """Paint objects; None restores the shape's own colours."""
    chosen = tuple(ids)
    label = _("paint {names}") if colour is not None else _("reset the colour of {names}")
    merge_key = f"{NUDGE_MERGE} colour {' '.join(chosen)}"
    _each(client, label, chosen, lambda s, i: edits.recolour(s, i, colour), merge_key)


def set_finish(client: Client, ids: Iterable[str], finish: Finish | None) -> None:
    """Set the finish of objects; None restores the shape's own."""
    label = _("{finish} finish for {names}") if finish is not None else _("reset the finish of {names}")
    label = label.replace("{finish}", _(finish or ""))
    _each(client, label, ids, lambda s, i: edits.refinish(s, i, finish))


def set_open(client: Client, object_id: str, open_share: float) -> None:
    """Open the doors, drawers and lids of an object; quick changes are one step."""
    item = client.session.scene.object(object_id)
    session = client.session
    label = _("close {label}") if open_share == 0.0 else _("open {label} by {percent} %")
    label = label.format(label=item.label, percent=round(100 * open_share))
    session.edit(label, lambda s: edits.set_open(s, object_id, open_share), by=client, merge_key=f"open {object_id}")


def set_material_source(client: Client, ids: Iterable[str], source: MaterialSource) -> None:
    """Show the materials that the photo gave objects, or those of their shapes."""
    chosen = tuple(i for i in ids if client.session.scene.object(i).photo_materials)
    names = names_of(client.session.scene, chosen or tuple(ids))
    if not chosen:
        said = _("the photo shows no material of {names}; build it from the photo first").format(names=names)
        raise EditRefused(said)
    label = (
        _("materials of {names} from the photo") if source == "photo" else _("materials of {names} from the library")
    )
    _each(client, label, chosen, lambda s, i: edits.set_material_source(s, i, source))


def rename(client: Client, object_id: str, label: str) -> None:
    """Rename an object."""
    if label.strip() and label != client.session.scene.object(object_id).label:
        client.session.edit(
            _("rename to {label}").format(label=label.strip()[:40]),
            lambda s: edits.rename(s, object_id, label),
            by=client,
            merge_key=f"{NUDGE_MERGE} {object_id} name",
        )


def set_base_position(client: Client, object_id: str, base: Float[np.ndarray, 3]) -> None:
    """Move the centre of an object's base to a point in the world."""
    item = client.session.scene.object(object_id)
    offset = np.asarray(base, dtype=np.float64) - base_position(item)
    if np.abs(offset).max() < 5e-4:
        return
    client.session.edit(
        _("move {label}").format(label=item.label),
        lambda s: attach_to_room_floor(edits.move(s, item.id, item.pose.move(offset)), item.id),
        by=client,
        merge_key=f"{NUDGE_MERGE} {item.id} at",
        by_hand=True,
    )


def set_yaw(client: Client, object_id: str, yaw_deg: float) -> None:
    """Rotate an object about world up to the given heading."""
    item = client.session.scene.object(object_id)
    turn = np.radians(yaw_deg) - item.pose.yaw_rad
    if abs(np.arctan2(np.sin(turn), np.cos(turn))) < 1e-4:
        return
    _turn(client, (object_id,), float(turn))


def turn_selected(client: Client, by_deg: float) -> None:
    """Rotate every selected object about its own vertical axis, as one undo step."""
    _turn(client, client.need_selection(), float(np.radians(by_deg)))


def _turn(client: Client, ids: tuple[str, ...], turn_rad: float) -> None:
    def turn(scene: Scene, object_id: str) -> Scene:
        pose = scene.object(object_id).pose
        return edits.move(scene, object_id, replace(pose, R_world_object=yaw_rotation(turn_rad) @ pose.R_world_object))

    _each(client, _("turn {names}"), ids, turn, f"{NUDGE_MERGE} {' '.join(ids)} yaw", by_hand=True)


def set_size(client: Client, object_id: str, size_m: Float[np.ndarray, 3]) -> None:
    """Resize an object to these extents along its own axes, with its base fixed."""
    session, item = client.session, client.session.scene.object(object_id)
    size = np.asarray(size_m, dtype=np.float64)
    if np.abs(size - item.size_m).max() < 5e-4:
        return
    if (size <= 0).any():
        client.refresh()
        raise EditRefused(_("{label} needs a size above 0").format(label=item.label))
    session.edit(
        _("resize {label}").format(label=item.label),
        lambda s: edits.resize(s, object_id, size),
        by=client,
        merge_key=f"{NUDGE_MERGE} {object_id} size",
        by_hand=True,
    )


def base_position(item: SceneObject) -> Float[np.ndarray, 3]:
    """Middle of an object's underside in the world."""
    return item.pose.position - item.pose.R_world_object[:, 2] * item.size_m[2] / 2


def attach(client: Client, object_id: str, parent_id: str, *, anyway: bool = False) -> None:
    """Support an object by another object or by a plane, and move it there.

    What is too large or too heavy for its supporter is refused with the reason, and offered `anyway`.

    Args:
        client: the browser that asked.
        object_id: of the object.
        parent_id: of the object or plane.
        anyway: whether size and weight do not matter.
    """
    from diorama_core.editing.placing import seat
    from diorama_core.editing.support_changes import why_not_on

    session = client.session
    scene = session.scene
    if not scene.has_object(object_id):
        raise EditRefused("that object no longer exists")
    in_a_circle = parent_id in descendants(scene, object_id)  # refused below, with a better reason
    why_not = "" if anyway or in_a_circle else why_not_on(scene, object_id, parent_id)
    if why_not:
        client.offer(
            f"{_(why_not)[:1].upper()}{_(why_not)[1:]}",
            _("Put it there anyway"),
            partial(attach, client, object_id, parent_id, anyway=True),
        )
        return
    wall = scene.has_plane(parent_id) and scene.plane(parent_id).role != "floor"
    support = scene.support_of(object_id)
    edge = Support(
        object_id,
        parent_id,
        "mounted on" if wall else "placed on",
        adheres_to=support.adheres_to if support is not None and not wall else (),
    )
    label = scene.object(object_id).label
    step = _("put {label} onto {supporter}").format(label=label, supporter=supporter_name(scene, parent_id))
    session.edit(
        step,
        lambda s: seat(edits.attach(s, edge), session.library, object_id),
        by=client,
        by_hand=True,
    )


def detach(client: Client, object_id: str) -> None:
    """Remove the support of an object."""
    label = client.session.scene.object(object_id).label
    client.session.edit(_("detach {label}").format(label=label), lambda s: edits.detach(s, object_id), by=client)


def set_relation(client: Client, object_id: str, mounted: bool) -> None:
    """Set whether an object is placed on its supporter or mounted on it."""
    edge = client.session.scene.support_of(object_id)
    if edge is None:
        raise EditRefused("it has no support; choose one first")
    changed = replace(edge, relation="mounted on" if mounted else "placed on", child_face=None, parent_surface=None)
    label = client.session.scene.object(object_id).label
    client.session.edit(
        _("change the support of {label}").format(label=label), lambda s: edits.attach(s, changed), by=client
    )


def set_adherence(client: Client, object_id: str, wall_id: str | None) -> None:
    """Set the wall an object also stands against (none: no wall), and move it there."""
    from diorama_core.editing.placing import against_wall

    scene = client.session.scene
    edge = scene.support_of(object_id)
    if edge is None:
        raise EditRefused("it has no support; choose one first")
    changed = replace(edge, adheres_to=() if wall_id is None else (wall_id,))
    label = scene.object(object_id).label

    def apply(s: Scene) -> Scene:
        attached = edits.attach(s, changed)
        return attached if wall_id is None else against_wall(attached, object_id, attached.plane(wall_id))

    said = _("move {label} against the wall") if wall_id else _("take {label} off the wall")
    client.session.edit(said.format(label=label), apply, by=client, by_hand=True)


def set_distance(client: Client, object_id: str, side: str, distance_m: float) -> None:
    """Move an object along one of its axes until that side is so far from the nearest wall or neighbour.

    Args:
        client: the browser that asked.
        object_id: of the object.
        side: which side of the object.
        distance_m: from that side to what is nearest.
    """
    item = client.session.scene.object(object_id)
    known = next((s for s in SIDES if s == side), None)
    if known is None:
        raise EditRefused("a distance is to the front, back, left or right")
    client.session.edit(
        _("move {label}").format(label=item.label),
        lambda s: set_clearance(s, object_id, known, distance_m),
        by=client,
        by_hand=True,
    )


def supporter_name(scene: Scene, any_id: str) -> str:
    """Display name of a supporter."""
    if scene.has_object(any_id):
        return scene.object(any_id).label
    plane = scene.plane(any_id)
    number = scene.architecture.number_of(plane)
    return _(plane.role) if number is None else f"{_(plane.role)} {number}"


def _each(
    client: Client,
    label: str,
    ids: Iterable[str],
    change: Callable[[Scene, str], Scene],
    merge_key: str | None = None,
    *,
    by_hand: bool = False,
) -> None:
    """Change objects one after another, as one undo step; the label names them."""
    chosen = tuple(ids)
    label = label.format(names=names_of(client.session.scene, chosen))
    client.session.edit(label, lambda s: reduce(change, chosen, s), by=client, merge_key=merge_key, by_hand=by_hand)
