"""What the buttons, hotkeys and panels do to the open room, each as one undo step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_app.room import Room
from diorama_core.errors import EditRefused
from diorama_core.library.record import Shape
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Candidate, Pose, Scene, SceneObject, Support, yaw_rotation

NUDGE_MERGE = "fields"


def undo(room: Room) -> None:
    """Take back the last change."""
    room.document.undo()
    room.changed()


def redo(room: Room) -> None:
    """Do again what was undone."""
    room.document.redo()
    room.changed()


def delete_selected(room: Room) -> None:
    """Delete what is selected; what stood on it is handed to the next supporter."""
    room.need_selected()
    chosen = room.document.selection
    names = room.scene.object(chosen[0]).label if len(chosen) == 1 else f"{len(chosen)} objects"
    room.edit(f"delete {names}", lambda scene: edits.remove(scene, chosen), selection=())


def duplicate_selected(room: Room) -> None:
    """Copy the selected objects beside themselves and select the copies."""
    room.need_selected()
    scene, copies = room.scene, []
    for object_id in room.document.selection:
        size = scene.object(object_id).size_m
        offset = scene.object(object_id).pose.R_world_object @ np.array([0.0, size[1] + 0.08, 0.0])
        scene, copy = edits.duplicate(scene, object_id, offset_world=(offset[0], offset[1], 0.0))
        copies.append(copy)
    label = room.scene.object(room.document.selection[0]).label
    room.commit(f"duplicate {label}", scene, selection=copies)


def set_locked(room: Room, object_id: str, locked: bool) -> None:
    """Lock or unlock an object."""
    label = room.scene.object(object_id).label
    room.edit(f"{'lock' if locked else 'unlock'} {label}", lambda s: edits.set_locked(s, object_id, locked))


def set_hidden(room: Room, object_id: str, hidden: bool) -> None:
    """Hide or show an object."""
    label = room.scene.object(object_id).label
    room.edit(f"{'hide' if hidden else 'show'} {label}", lambda s: edits.set_hidden(s, object_id, hidden))


def set_base_position(room: Room, object_id: str, base: Float[np.ndarray, "3"]) -> None:
    """Put the middle of an object's underside at a place in the world."""
    item = room.scene.object(object_id)
    offset = np.asarray(base, dtype=np.float64) - base_position(item)
    if np.abs(offset).max() < 5e-5:
        return
    pose = item.pose.moved(offset)
    room.edit(f"move {item.label}", lambda s: edits.move(s, object_id, pose), merge_key=f"{NUDGE_MERGE} {object_id} at")


def set_yaw(room: Room, object_id: str, yaw_deg: float) -> None:
    """Turn an object about world up until its front has this heading."""
    item = room.scene.object(object_id)
    turn = np.radians(yaw_deg) - item.pose.yaw_rad
    if abs(np.arctan2(np.sin(turn), np.cos(turn))) < 1e-5:
        return
    pose = replace(item.pose, R_world_object=yaw_rotation(float(turn)) @ item.pose.R_world_object)
    room.edit(
        f"turn {item.label}", lambda s: edits.move(s, object_id, pose), merge_key=f"{NUDGE_MERGE} {object_id} yaw"
    )


def set_size(room: Room, object_id: str, size_m: Float[np.ndarray, "3"]) -> None:
    """Give an object these extents along its own axes, standing where it stands."""
    item = room.scene.object(object_id)
    size = np.asarray(size_m, dtype=np.float64)
    if np.abs(size - item.size_m).max() < 5e-5:
        return
    if (size <= 0).any():
        room.refresh()
        raise EditRefused(f"{item.label} must be larger than nothing; give sizes above 0")
    rise = item.pose.R_world_object[:, 2] * (size[2] - item.size_m[2]) / 2
    pose = Pose(item.pose.R_world_object, item.pose.position + rise, size / np.asarray(item.shape_size_m))

    def resize(scene: Scene) -> Scene:
        # What stands on it rises with the new top: a rigid move alone carries it only half of the way.
        lift = pose.position - item.pose.position
        moved = edits.move(scene, object_id, pose)
        return edits.place(moved, {i: moved.object(i).pose.moved(lift) for i in descendants(scene, object_id)})

    room.edit(f"resize {item.label}", resize, merge_key=f"{NUDGE_MERGE} {object_id} size")


def base_position(item: SceneObject) -> Float[np.ndarray, "3"]:
    """Middle of an object's underside in the world."""
    return item.pose.position - item.pose.R_world_object[:, 2] * item.size_m[2] / 2


def rename(room: Room, object_id: str, label: str) -> None:
    """Call an object something else."""
    if label.strip() and label != room.scene.object(object_id).label:
        room.edit(f"rename to {label.strip()[:40]}", lambda s: edits.rename(s, object_id, label))


def swap_candidate(room: Room, object_id: str, index: int) -> None:
    """Take one of an object's ranked alternatives, where it stands."""
    item = room.scene.object(object_id)
    if not 0 <= index < len(item.candidates):
        raise EditRefused("that alternative is gone; choose another")
    _swap(room, item, item.candidates[index])


def swap_shape(room: Room, object_id: str, shape_id: str) -> None:
    """Take any shape of the library, at its own size, where the object stands."""
    item = room.scene.object(object_id)
    shape = room.library.shape(shape_id)
    _swap(room, item, Candidate(shape.id, shape.size_m, 0.0, replace(item.pose, scale=np.ones(3))))


def _swap(room: Room, item: SceneObject, candidate: Candidate) -> None:
    if candidate.shape_id == item.shape_id:
        return

    def take(scene: Scene) -> Scene:
        # What was clicked is what comes: in the colours of its picture, not in those of what it replaces.
        return edits.recolour(edits.swap(scene, item.id, candidate, keep_pose=True), item.id, None)

    room.edit(f"swap {item.label}", take)


def insert_shape(room: Room, shape_id: str, looked_at: Float[np.ndarray, "3"] | None) -> None:
    """Put a shape of the library on the selected object, or else on the floor where the person looks."""
    shape = room.library.shape(shape_id)
    scene, parent = room.scene, room.document.selected
    if parent is not None and room.library.shape(parent.shape_id).surfaces:
        base = parent.pose.position + parent.pose.R_world_object[:, 2] * parent.size_m[2] / 2
        edge_parent: str | None = parent.id
        yaw = parent.pose.yaw_rad
    else:
        floor = scene.architecture.floor
        height = 0.0 if floor is None else float(floor.offset / max(floor.normal[2], 1e-6))
        x, y = _free_spot(scene, shape, looked_at)
        base, edge_parent, yaw = np.array([x, y, height]), None if floor is None else floor.id, _facing(scene, x, y)
    new_id = edits.fresh_id(scene, shape.category)
    position = base + np.array([0.0, 0.0, shape.size_m[2] / 2])
    item = SceneObject(new_id, shape.category, shape.category, shape.id, shape.size_m, Pose.upright(position, yaw))
    edge = None if edge_parent is None else Support(new_id, edge_parent)
    room.edit(f"insert {shape.category}", lambda s: edits.insert(s, item, edge), selection=(new_id,))


def _free_spot(scene: Scene, shape: Shape, looked_at: Float[np.ndarray, "3"] | None) -> tuple[float, float]:
    """The place on the floor nearest to where the person looks that no other footprint covers."""
    floor = scene.architecture.floor
    middle = np.zeros(2) if floor is None else floor.centre[:2]
    wanted = middle if looked_at is None else np.asarray(looked_at[:2], dtype=np.float64)
    if floor is not None:
        low, high = floor.polygon[:, :2].min(axis=0) + 0.3, floor.polygon[:, :2].max(axis=0) - 0.3
        wanted = np.where(low < high, np.clip(wanted, low, high), middle)
    radius = max(shape.size_m[:2]) / 2
    taken = [(o.pose.position[:2], float(max(o.size_m[:2])) / 2) for o in scene.objects if o.category != "rug"]
    for reach in np.arange(0.0, 3.0, 0.25):
        for angle in np.arange(0.0, 2 * np.pi, np.pi / 6):
            spot = wanted + reach * np.array([np.cos(angle), np.sin(angle)])
            if all(np.linalg.norm(spot - place) > radius + other for place, other in taken):
                return float(spot[0]), float(spot[1])
    return float(wanted[0]), float(wanted[1])


def _facing(scene: Scene, x: float, y: float) -> float:
    """A heading toward the photo's camera, in quarter turns."""
    if scene.camera is None:
        return -np.pi / 2
    toward = scene.camera.position[:2] - (x, y)
    return float(np.round(np.arctan2(toward[1], toward[0]) / (np.pi / 2)) * np.pi / 2)


def attach(room: Room, object_id: str, parent_id: str) -> None:
    """Say that an object stands on another, or on (or against) a plane."""
    scene = room.scene
    wall = scene.has_plane(parent_id) and scene.plane(parent_id).role != "floor"
    edge = Support(object_id, parent_id, "mounted on" if wall else "placed on")
    label = scene.object(object_id).label
    room.edit(f"support of {label}", lambda s: edits.attach(s, edge))


def detach(room: Room, object_id: str) -> None:
    """Say that nothing holds an object up."""
    label = room.scene.object(object_id).label
    room.edit(f"support of {label}", lambda s: edits.detach(s, object_id))
