"""Doors, drawers and lids that stand open: shapes whose moving parts are moved along their joints."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from diorama_core.io.cache import LruCache
from diorama_core.library.furniture.articulation import Articulation, articulation, joint_of
from diorama_core.library.furniture.joints import Joint
from diorama_core.library.furniture.solids import Solid
from diorama_core.library.part_notes import notes_of, transform
from diorama_core.library.record import BUILT_IN, ShapeLibrary, record_of
from diorama_core.library.slots import transform_of
from diorama_core.library.stretch import EVEN, Scale

STEPS = 20
"""Shapes are made for so many degrees of openness: each is meshes of its own."""


def articulation_of(library: ShapeLibrary, shape_id: str) -> Articulation | None:
    """The moving parts of a shape, built in or with notes of its author (`part_notes`); None where it has none.

    Raises:
        LibraryError: when the shape is unknown, or its notes are damaged.
    """
    record = record_of(library, shape_id)
    if record.source == BUILT_IN:
        return articulation(shape_id)
    return _NOTED.get((record.content_hash, shape_id), lambda: _joints(library.parts(shape_id)))


_NOTED: LruCache[tuple[str, str], Articulation | None] = LruCache(256)
_OPENED: LruCache[tuple[str, str, int, Scale], trimesh.Scene] = LruCache(64)


def _joints(parts: trimesh.Scene) -> Articulation | None:
    if all((notes := notes_of(mesh)) is None or notes.joint is None for mesh in parts.geometry.values()):
        return None
    meshes = {str(name): transform(mesh, transform_of(parts, name)) for name, mesh in parts.geometry.items()}
    moved_by = {name: None if (notes := notes_of(mesh)) is None else notes.joint for name, mesh in meshes.items()}
    joints = list(dict.fromkeys(joint for joint in moved_by.values() if joint is not None))
    scene, solids = trimesh.Scene(), list[tuple[int | None, Solid]]()
    for name, mesh in meshes.items():
        joint = moved_by[name]
        number = None if joint is None else joints.index(joint)
        label = f"{'fixed' if number is None else number}/{len(solids):02d} {name}"
        scene.add_geometry(mesh, node_name=label, geom_name=label)
        uv = np.zeros((len(mesh.vertices), 2))
        solids.append((number, Solid(mesh.vertices, mesh.faces, mesh.vertex_normals, uv)))
    return Articulation(_number(joints), scene, tuple(solids))


def _number(joints: list[Joint]) -> tuple[Joint, ...]:
    """Joints whose names are unique: "door 1", "door 2"."""
    counts, met, out = Counter(joint.name for joint in joints), Counter[str](), []
    for joint in joints:
        met[joint.name] += 1
        out.append(joint if counts[joint.name] == 1 else replace(joint, name=f"{joint.name} {met[joint.name]}"))
    return tuple(out)


def can_open(library: ShapeLibrary, shape_id: str) -> bool:
    """Whether a shape has doors, drawers or lids."""
    pieces = articulation_of(library, shape_id)
    return pieces is not None and any(j.kind != "swivel" for j in pieces.joints)


def open_parts(library: ShapeLibrary, shape_id: str, open_share: float, scale: Scale = EVEN) -> trimesh.Scene:
    """The parts of a shape as it stands open; the library's own where nothing of it opens.

    Args:
        library: where it is.
        shape_id: which shape.
        open_share: 0 closed to 1 as far as it goes.
        scale: by which it will be scaled, relative to an even scale: what turns keeps its form.

    Raises:
        LibraryError: when the shape is unknown.
    """
    step = round(open_share * STEPS)
    pieces = articulation_of(library, shape_id) if step else None
    if pieces is None or all(joint.kind == "swivel" for joint in pieces.joints):
        return library.parts(shape_id)
    key = (record_of(library, shape_id).content_hash, shape_id, step, scale)
    return _OPENED.get(key, lambda: _open(pieces, step, scale))


class OpenedShapes:
    """Lets an open shape be read like the parts of a library's shape."""

    def __init__(self, library: ShapeLibrary, open_share: float, scale: Scale = EVEN) -> None:
        """Arguments as for `open_parts`."""
        self._library, self._open_share, self._scale = library, open_share, scale

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials, in the canonical frame. Shared: do not change it."""
        return open_parts(self._library, shape_id, self._open_share, self._scale)


def _open(pieces: Articulation, step: int, scale: Scale) -> trimesh.Scene:
    scene = trimesh.Scene()
    for name, mesh in pieces.scene.geometry.items():
        number = joint_of(str(name))
        shown = mesh.copy()
        if number is not None:
            shown.vertices = _move(np.asarray(mesh.vertices), pieces.joints[number], step / STEPS, np.array(scale))
        scene.add_geometry(shown, node_name=str(name), geom_name=str(name))
    return scene


def travel_at(joint: Joint, open_share: float) -> float:
    """How far along its joint a part stands, radians or metres, when its shape is open by a share; 0 for swivels."""
    if joint.kind == "swivel":
        return 0.0
    return joint.lower + round(open_share * STEPS) / STEPS * (joint.upper - joint.lower)


def _move(
    vertices: Float[np.ndarray, "n 3"], joint: Joint, share: float, scale: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "n 3"]:
    """Vertices moved a share of the way along a joint, rigidly in the scaled shape."""
    travel = travel_at(joint, share)
    axis, origin = np.asarray(joint.axis), np.asarray(joint.origin)
    if joint.kind == "slide":
        return vertices + travel * axis
    if joint.kind == "swivel":
        return vertices
    scaled_axis = axis * scale
    R = Rotation.from_rotvec(travel * scaled_axis / np.linalg.norm(scaled_axis)).as_matrix()
    return (((vertices - origin) * scale) @ R.T) / scale + origin
