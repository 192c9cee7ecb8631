"""A scene from a file that Diorama wrote, as the file has it now, with its pictures, notes and photo.

Nodes that were moved, turned or scaled move their objects, deleted nodes delete them, copies become objects of their
own, and an object that was hung below another one stands on it. What was not touched is exactly as it was.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import EditRefused, InputError, SceneError
from diorama_core.importing.marked import MarkedFile, ObjectNode
from diorama_core.perception.inputs.photos.reading import read_photo
from diorama_core.perception.inputs.source import read_source
from diorama_core.scene import edits
from diorama_core.scene.schema import scene_from_json
from diorama_core.scene.support import ancestors
from diorama_core.scene.types import Architecture, Camera, Pose, Scene, SceneObject, Support

MAX_PHOTO_PX = 8192
"""Longest side of a photo; a larger one does not fit its camera any more."""
STILL_M = 2e-4
"""Corners that moved less than this did not move: programs keep single precision."""
SHEAR = 1e-3
"""Cosine between axes from which on a node counts as sheared, which objects cannot be."""


@dataclass(frozen=True, eq=False)
class Opened:
    """A scene from a file."""

    scene: Scene
    textures: Mapping[str, UInt8[np.ndarray, "h w 3"]] = field(default_factory=dict)
    """Pictures of planes and of objects' materials, by name."""
    changes: tuple[str, ...] = ()
    """What the file has otherwise than it was written, one line each."""
    provenance: Mapping[str, Any] = field(default_factory=dict)
    """Where the scene came from, as the file says."""
    photo: Photo | None = None
    """The photo, where the file holds it."""
    boxes: tuple[LabelledBox, ...] = ()
    """What is marked in the photo."""

    @property
    def inputs(self) -> Inputs | None:
        """What a later build starts from: the photo and the scene's own camera."""
        if self.photo is None:
            return None
        camera = self.scene.camera
        return Inputs(self.photo, self.boxes, intrinsics=None if camera is None else camera.intrinsics)


class Names:
    """Ids of new objects: a word and a number."""

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()

    def new(self, word: str) -> str:
        """An id that was not given before."""
        stem = re.sub(r"[^a-z0-9]+", "-", word.lower()).strip("-") or "object"
        self._counts[stem] += 1
        return f"{stem}-{self._counts[stem]}"


def open_marked(file: MarkedFile) -> Opened:
    """The scene that Diorama wrote, as the file has it now.

    Raises:
        InputError: when the scene document in the file is damaged or of a newer version.
    """
    scene, changes = _restore(file)
    shown = file.pictures
    planes = tuple(
        replace(p, texture=p.texture or f"plane-{p.id}") if p.id in shown else p for p in scene.architecture.planes
    )
    textures = {**file.material_pictures, **{str(p.texture): shown[p.id] for p in planes if p.id in shown}}
    scene = replace(scene, architecture=Architecture(planes))
    photo, remarks = _photo(file, scene)
    return Opened(scene, textures, (*changes, *remarks), file.provenance, photo)


def _restore(file: MarkedFile) -> tuple[Scene, tuple[str, ...]]:
    """The scene, and one line each for what was moved, deleted, copied or hung elsewhere in the file."""
    try:
        scene = scene_from_json(file.document)
    except SceneError as error:
        raise InputError(f"the scene inside the file cannot be read: {error}") from error
    original, changes = scene, []
    scene, ids, copies = _with_copies(scene, file.nodes)
    changes += copies
    for node, object_id in zip(file.nodes, ids, strict=True):
        if object_id is not None:
            scene, remarks = _move(scene, object_id, node)
            changes += remarks
    scene, remarks = _without_deleted(scene, file)
    changes += remarks
    for index, object_id in enumerate(ids):
        if object_id is not None:
            scene, remarks = _hang(scene, original, object_id, _carrier(file.nodes, ids, index))
            changes += remarks
    scene, remarks = _room_and_camera(scene, file)
    return scene, (*changes, *remarks)


def _photo(file: MarkedFile, scene: Scene) -> tuple[Photo | None, tuple[str, ...]]:
    """The photo that the file holds, and what to know where it cannot be used."""
    name = str(file.provenance.get("photo") or "photo.jpg")
    if file.photo is None:
        return None, (
            f"{name} is not in the file; export it again with its photo",
        ) if "photo" in file.provenance else ()
    try:
        photo = read_photo(read_source(file.photo, "photo", name), MAX_PHOTO_PX).photo
    except InputError as error:
        return None, (f"the photo in the file cannot be read: {error}",)
    camera = scene.camera
    if camera is not None and (camera.intrinsics.width, camera.intrinsics.height) != (photo.width, photo.height):
        return None, (f"{name} is not of the camera's size; it was left out",)
    return photo, ()


def pose_of(matrix: Float[np.ndarray, "4 4"]) -> tuple[Pose, bool]:
    """The nine-parameter pose nearest to a matrix, and whether shear or a mirror had to be given up.

    Raises:
        InputError: when the matrix flattens its object, or is not finite.
    """
    linear = np.asarray(matrix, dtype=np.float64)[:3, :3]
    with np.errstate(over="ignore", invalid="ignore"):
        scale = np.linalg.norm(linear, axis=0)  # overflows where the numbers themselves are finite
    if not (np.isfinite(matrix).all() and np.isfinite(scale).all()):
        raise InputError("a node is placed or scaled by numbers that are too large or none")
    if scale.min() < 1e-9:
        raise InputError("a node has no size along one axis; give it a scale other than zero")
    axes = linear / scale
    U, _, V = np.linalg.svd(axes)
    mirrored = np.linalg.det(axes) < 0
    R = U @ np.diag([1.0, 1.0, -1.0 if mirrored else 1.0]) @ V
    sheared = bool(np.abs(axes.T @ axes - np.eye(3)).max() > SHEAR)
    return Pose(R, np.asarray(matrix)[:3, 3], scale), bool(mirrored or sheared)


def _with_copies(scene: Scene, nodes: Sequence[ObjectNode]) -> tuple[Scene, list[str | None], list[str]]:
    """The scene with an object for every node, and each node's object id (None where its mark names nothing).

    Of nodes with one id, the one nearest to where the object was is the object, the others are copies of it.
    """
    nearest: dict[str, int] = {}
    for index, node in enumerate(nodes):
        if scene.has_object(node.id):
            known = nearest.setdefault(node.id, index)
            if _distance(scene, node) < _distance(scene, nodes[known]):
                nearest[node.id] = index
    ids: list[str | None] = []
    remarks: list[str] = []
    for index, node in enumerate(nodes):
        if not scene.has_object(node.id):
            ids.append(None)
        elif nearest[node.id] == index:
            ids.append(node.id)
        else:
            scene, copy_id = edits.duplicate(scene, node.id, offset_world=(0.0, 0.0, 0.0))
            remarks.append(f"{scene.object(node.id).label} ({node.id}) was copied: {copy_id}")
            ids.append(copy_id)
    return scene, ids, remarks


def _distance(scene: Scene, node: ObjectNode) -> float:
    return float(np.abs(node.M_world_shape - scene.object(node.id).pose.matrix).max())


def _move(scene: Scene, object_id: str, node: ObjectNode) -> tuple[Scene, list[str]]:
    item = scene.object(object_id)
    pose, forced = pose_of(node.M_world_shape)
    if np.abs(replace(item, pose=pose).corners_world - item.corners_world).max() < STILL_M:
        return scene, []
    remarks = [f"{item.label} ({object_id}) was moved"]
    if forced:
        remarks.append(f"{item.label} ({object_id}) is sheared or mirrored in the file: the nearest pose was taken")
    T_new_old = pose.T_world_object @ np.linalg.inv(item.pose.T_world_object)
    return _replace(scene, replace(_with_candidates_moved(item, T_new_old), pose=pose)), remarks


def _with_candidates_moved(item: SceneObject, T_new_old: Float[np.ndarray, "4 4"]) -> SceneObject:
    """Its alternatives follow it, so that a swap shows them where the object now is."""
    candidates = []
    for c in item.candidates:
        T = T_new_old @ c.pose.T_world_object
        U, _, V = np.linalg.svd(T[:3, :3])
        candidates.append(replace(c, pose=Pose(U @ V, T[:3, 3], c.pose.scale)))
    return replace(item, candidates=tuple(candidates))


def _without_deleted(scene: Scene, file: MarkedFile) -> tuple[Scene, list[str]]:
    """Objects that were written and have no node any more are deleted; hidden ones never had one."""
    present = {n.id for n in file.nodes}
    written = {o.id for o in scene.objects if not o.hidden} if file.written is None else file.written
    copies = {o.id for o in scene.objects} - {o.id for o in scene_from_json(file.document).objects}
    gone = [o for o in scene.objects if o.id in written and o.id not in present and o.id not in copies]
    for item in gone:
        scene = edits.set_locked(scene, item.id, False) if item.locked else scene
    scene = edits.remove(scene, [o.id for o in gone])
    return scene, [f"{o.label} ({o.id}) was deleted" for o in gone]


def _carrier(nodes: Sequence[ObjectNode], ids: Sequence[str | None], index: int) -> str | None:
    above = nodes[index].parent
    while above is not None:
        if ids[above] is not None:
            return ids[above]
        above = nodes[above].parent
    return None


def _hang(scene: Scene, original: Scene, object_id: str, carrier: str | None) -> tuple[Scene, list[str]]:
    """An object below another node than it was written below stands on that one's object."""
    if carrier is None or carrier in ancestors(scene, object_id):
        return scene, []
    item = scene.object(object_id)
    try:
        scene = edits.attach(scene, Support(object_id, carrier))
    except EditRefused as error:
        return scene, [f"{item.label} ({object_id}) keeps its supporter: {error}"]
    return scene, [f"{item.label} ({object_id}) now stands on {scene.object(carrier).label} ({carrier})"]


def _room_and_camera(scene: Scene, file: MarkedFile) -> tuple[Scene, list[str]]:
    remarks, planes = [], []
    for plane in scene.architecture.planes:
        T = file.planes.get(plane.id)
        moved = plane.polygon if T is None else plane.polygon @ T[:3, :3].T + T[:3, 3]
        if np.abs(moved - plane.polygon).max() >= STILL_M:
            remarks.append(f"the {plane.role} ({plane.id}) was moved")
            plane = replace(plane, polygon=moved)
        planes.append(plane)
    scene = replace(scene, architecture=Architecture(tuple(planes)))
    camera, T = scene.camera, file.T_world_camera
    if camera is not None and T is not None and np.abs(T - camera.T_world_camera).max() >= STILL_M:
        pose, _ = pose_of(T)
        scene = replace(scene, camera=Camera(camera.intrinsics, pose.T_world_object))
        remarks.append("the photo's camera was moved")
    return scene, remarks


def _replace(scene: Scene, item: SceneObject) -> Scene:
    return replace(scene, objects=tuple(item if o.id == item.id else o for o in scene.objects))
