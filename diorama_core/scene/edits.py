"""Pure functions Scene -> Scene. Every change a person or the optimiser makes goes through one of these.

Each returns a new scene or raises `EditRefused` with the reason; the given scene is never changed. Moving an
object carries along everything it holds up.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.errors import EditRefused
from diorama_core.scene.room_edits import (
    ceiling_height,
    edge_length_m,
    floor_height,
    move_plane,
    rescale,
    rescale_by_edge,
    rescale_to_length,
    set_ceiling_height,
)
from diorama_core.scene.support import check_edge, descendants
from diorama_core.scene.types import (
    Candidate,
    Finish,
    HomeRoom,
    MaterialSource,
    Plane,
    Pose,
    Scene,
    SceneObject,
    Support,
)
from diorama_core.scene.values import Vector3

__all__ = [
    "attach", "ceiling_height", "detach", "duplicate", "edge_length_m", "floor_height", "fresh_id", "insert", "move",
    "move_plane", "place", "recolour", "refinish", "remove", "rename", "rescale", "rescale_by_edge",
    "rescale_to_length", "resize", "set_ceiling_height", "set_hidden", "set_locked", "set_material_source",
    "set_metrics", "set_open", "set_planes", "set_room", "swap",
]  # fmt: skip

SMALLEST_SIZE_M = 1e-3
LARGEST_SIZE_M = 50.0


def move(scene: Scene, object_id: str, pose: Pose) -> Scene:
    """Give an object a new pose; what it holds up follows rigidly (scale of followers is untouched)."""
    item = _editable(scene, object_id)
    _check_size(item, pose)
    T_new_old = pose.T_world_object @ np.linalg.inv(item.pose.T_world_object)
    followers = set(descendants(scene, object_id))
    poses = {o.id: _carry(o.pose, T_new_old) for o in scene.objects if o.id in followers} | {object_id: pose}
    return _map_objects(scene, lambda o: replace(o, pose=poses[o.id]) if o.id in poses else o)


def place(scene: Scene, poses: Mapping[str, Pose]) -> Scene:
    """Set several poses at once, each exactly as given (no following): what an optimiser commits."""
    for object_id, pose in poses.items():
        _check_size(_existing(scene, object_id), pose)
    return _map_objects(scene, lambda o: replace(o, pose=poses[o.id]) if o.id in poses else o)


def resize(scene: Scene, object_id: str, size_m: Float[np.ndarray, "3"]) -> Scene:
    """The scene with an object of this size on the same base; what stands on it keeps standing on its new top."""
    item = _editable(scene, object_id)
    rise = item.pose.R_world_object[:, 2] * (size_m[2] - item.size_m[2]) / 2
    pose = Pose(item.pose.R_world_object, item.pose.position + rise, size_m / np.asarray(item.shape_size_m))
    # What stands on it rises with the new top: a rigid move alone carries it only half of the way.
    moved = move(scene, object_id, pose)
    return place(moved, {i: moved.object(i).pose.move(rise) for i in descendants(scene, object_id)})


def swap(scene: Scene, object_id: str, candidate: Candidate, *, keep_pose: bool = False) -> Scene:
    """Replace an object's shape by one of its alternatives.

    With `keep_pose` the new shape takes the old one's base point, heading and observed height; without, the
    candidate's own initial pose is used. What stands on the object rises or sinks with its new top.

    Args:
        scene: as it is.
        object_id: of the object.
        candidate: the other shape, with its size and pose.
        keep_pose: whether base, heading and height stay.
    """
    item = _editable(scene, object_id)
    pose = _seat(item, candidate) if keep_pose else candidate.pose
    swapped = replace(item, shape_id=candidate.shape_id, shape_size_m=candidate.shape_size_m, pose=pose)
    _check_size(swapped, pose)
    rise = _top(swapped) - _top(item)
    followers = set(descendants(scene, object_id)) if abs(rise) > 1e-12 else set()
    changed = _map_objects(scene, lambda o: swapped if o.id == object_id else o)
    changed = replace(
        changed,
        supports=tuple(replace(s, parent_surface=None) if s.parent == object_id else s for s in changed.supports),
    )
    lift = np.array([0.0, 0.0, rise])
    return _map_objects(changed, lambda o: replace(o, pose=o.pose.move(lift)) if o.id in followers else o)


def insert(scene: Scene, item: SceneObject, support: Support | None = None) -> Scene:
    """Add an object, and the edge that holds it up when given."""
    if scene.has_object(item.id) or scene.has_plane(item.id):
        raise EditRefused(f"the id {item.id!r} is taken; choose another")
    _check_size(item, item.pose)
    grown = replace(scene, objects=(*scene.objects, item))
    return attach(grown, support) if support is not None else grown


def remove(scene: Scene, object_ids: Iterable[str]) -> Scene:
    """Delete objects; what they held up is handed to the nearest supporter that remains, or is left loose."""
    gone = set(object_ids)
    for object_id in gone:
        _editable(scene, object_id)
    supports: list[Support] = []
    for edge in scene.supports:
        if edge.child in gone:
            continue
        parent: str | None = edge.parent
        while parent in gone:
            above = scene.support_of(parent)
            parent = above.parent if above is not None else None
        if parent == edge.parent:
            supports.append(edge)
        elif parent is not None:
            supports.append(replace(edge, parent=parent, relation="placed on", parent_surface=None, child_face=None))
    return replace(scene, objects=tuple(o for o in scene.objects if o.id not in gone), supports=tuple(supports))


def duplicate(scene: Scene, object_id: str, *, offset_world: Vector3 = (0.3, 0.3, 0.0)) -> tuple[Scene, str]:
    """Copy one object beside itself, on the same supporter. Returns the scene and the copy's id."""
    item = _existing(scene, object_id)
    copy_id = fresh_id(scene, item.category)
    copy = replace(
        item, id=copy_id, pose=item.pose.move(offset_world), locked=False, hidden=False, mask_id=None, box_px=None
    )
    edge = scene.support_of(object_id)
    return insert(scene, copy, replace(edge, child=copy_id) if edge is not None else None), copy_id


def attach(scene: Scene, edge: Support) -> Scene:
    """Make an edge the child's only support; refused when it would make a cycle."""
    check_edge(scene, edge)
    return replace(scene, supports=(*(s for s in scene.supports if s.child != edge.child), edge))


def detach(scene: Scene, object_id: str) -> Scene:
    """Remove the edge that holds an object up."""
    _existing(scene, object_id)
    return replace(scene, supports=tuple(s for s in scene.supports if s.child != object_id))


def set_locked(scene: Scene, object_id: str, locked: bool) -> Scene:
    """Lock (the optimiser and edits leave it alone) or unlock an object."""
    return _with(scene, object_id, locked=locked)


def set_hidden(scene: Scene, object_id: str, hidden: bool) -> Scene:
    """Hide or show an object."""
    return _with(scene, object_id, hidden=hidden)


def rename(scene: Scene, object_id: str, label: str) -> Scene:
    """Change what people call an object."""
    text = " ".join(label.split())
    if not text:
        raise EditRefused("a name cannot be empty; type at least one character")
    return _with(scene, object_id, label=text[:200])


def recolour(scene: Scene, object_id: str, colour: tuple[float, float, float] | None) -> Scene:
    """Override the material's colour (sRGB 0 to 1), or give back the shape's own with None.

    An object whose surfaces show the photo's materials shows the library's from then on, in that colour; pictures and
    the like, which only cover a face, stay.
    """
    item = _editable(scene, object_id)
    clipped = None if colour is None else tuple(float(np.clip(c, 0.0, 1.0)) for c in colour)
    tiled = any(m.layout == "tiled" for m in item.photo_materials)
    source: MaterialSource = "library" if tiled and colour is not None else item.material_source
    return _with(scene, object_id, colour=clipped, material_source=source)


def set_material_source(scene: Scene, object_id: str, source: MaterialSource) -> Scene:
    """Show the materials that the photo gave an object, or those of its shape."""
    item = _editable(scene, object_id)
    if source == "photo" and not item.photo_materials:
        raise EditRefused(f"the photo shows no material of {item.label}; build it from the photo first")
    return _with(scene, object_id, material_source=source)


def set_open(scene: Scene, object_id: str, open_share: float) -> Scene:
    """Open the doors, drawers and lids of an object: 0 closed to 1 as far as they go."""
    _editable(scene, object_id)
    if not 0.0 <= open_share <= 1.0:
        raise EditRefused(f"something stands open by 0 to 100 %, not by {100 * open_share:g} %")
    return _with(scene, object_id, open_share=float(open_share))


def refinish(scene: Scene, object_id: str, finish: Finish | None) -> Scene:
    """Override how the main material throws light back, or give back the shape's own with None."""
    _editable(scene, object_id)
    return _with(scene, object_id, finish=finish)


def set_metrics(scene: Scene, metrics: Mapping[str, float]) -> Scene:
    """Attach the optimiser's report."""
    return replace(scene, metrics=tuple((k, float(v)) for k, v in metrics.items()))


def set_planes(scene: Scene, planes: Iterable[Plane]) -> Scene:
    """Replace the room's planes; support edges to planes that are gone are dropped."""
    changed = replace(scene, architecture=replace(scene.architecture, planes=tuple(planes)))
    supports = tuple(
        replace(s, adheres_to=tuple(w for w in s.adheres_to if changed.has_plane(w)))
        for s in scene.supports
        if changed.has_object(s.parent) or changed.has_plane(s.parent)
    )
    return replace(changed, supports=supports)


def set_room(scene: Scene, room_id: str, *, name: str | None = None, storey: int | None = None) -> Scene:
    """Rename a room of a home, or say on which storey it is.

    Args:
        scene: As it is.
        room_id: Of the room.
        name: What it is called from then on; None keeps its name.
        storey: Counted from the lowest; None keeps it.

    Raises:
        EditRefused: there is no such room, or the name is empty.
    """
    if all(r.id != room_id for r in scene.rooms):
        raise EditRefused(f"there is no room {room_id!r}; it may have been deleted")
    text = None if name is None else " ".join(name.split())[:200]
    if text == "":
        raise EditRefused("a name cannot be empty; type at least one character")

    def change(room: HomeRoom) -> HomeRoom:
        return replace(room, name=text or room.name, storey=room.storey if storey is None else storey)

    return replace(scene, rooms=tuple(change(r) if r.id == room_id else r for r in scene.rooms))


def fresh_id(scene: Scene, category: str) -> str:
    """An id not yet used in the scene: the category, simplified, and a number."""
    stem = re.sub(r"[^a-z0-9]+", "_", category.lower()).strip("_") or "object"
    taken = {o.id for o in scene.objects} | {p.id for p in scene.architecture.planes} | {r.id for r in scene.rooms}
    return next(name for n in range(1, len(taken) + 2) if (name := f"{stem}_{n}") not in taken)


def _existing(scene: Scene, object_id: str) -> SceneObject:
    if not scene.has_object(object_id):
        raise EditRefused(f"there is no object {object_id!r}; it may have been deleted")
    return scene.object(object_id)


def _editable(scene: Scene, object_id: str) -> SceneObject:
    item = _existing(scene, object_id)
    if item.locked:
        raise EditRefused(f"{item.label} is locked; unlock it first")
    return item


def _check_size(item: SceneObject, pose: Pose) -> None:
    size = np.asarray(item.shape_size_m) * pose.scale
    if (size < SMALLEST_SIZE_M).any() or (size > LARGEST_SIZE_M).any():
        raise EditRefused(
            f"{item.label} would measure {' x '.join(f'{s:.4g}' for s in size)} m; keep every side between "
            f"{SMALLEST_SIZE_M} and {LARGEST_SIZE_M:g} m"
        )


def _map_objects(scene: Scene, change: Callable[[SceneObject], SceneObject]) -> Scene:
    return replace(scene, objects=tuple(change(o) for o in scene.objects))


def _with(scene: Scene, object_id: str, **changes: Any) -> Scene:
    _existing(scene, object_id)
    return _map_objects(scene, lambda o: replace(o, **changes) if o.id == object_id else o)


def _carry(pose: Pose, T_new_old: Float[np.ndarray, "4 4"]) -> Pose:
    T = T_new_old @ pose.T_world_object
    u, _, vt = np.linalg.svd(T[:3, :3])
    return Pose(u @ vt, T[:3, 3], pose.scale)


def _top(item: SceneObject) -> float:
    return float(item.corners_world[:, 2].max())


def _seat(item: SceneObject, candidate: Candidate) -> Pose:
    """The candidate at the item's heading and base, in the candidate's own fitted size."""
    up = item.pose.R_world_object[:, 2]
    old_half, new_half = item.size_m[2] / 2, candidate.shape_size_m[2] * candidate.pose.scale[2] / 2
    position = item.pose.position + up * (new_half - old_half)
    return Pose(item.pose.R_world_object, position, candidate.pose.scale)
