"""Putting a wrong guess right: a shape turned, resized or renamed by a person."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import trimesh

from diorama_core.errors import InputError
from diorama_core.library import taxonomy
from diorama_core.library.ingest.given import Given, axis_name, axis_vector
from diorama_core.library.ingest.relief import relief, symmetry_fold
from diorama_core.library.ingest.repair import whole_of
from diorama_core.library.ingest.shaping import pack_shape
from diorama_core.library.ingest.sink import Ingested
from diorama_core.library.part_notes import transform
from diorama_core.library.record import Assumption, Guess, Shape, ShapeLibrary, usual_contact_faces


def correct(
    library: ShapeLibrary,
    shape_id: str,
    *,
    up: str = "+z",
    front: str | None = None,
    scale: float = 1.0,
    category: str | None = None,
    source_key: str = "",
) -> Ingested:
    """The shape as it should have been taken in; hand it to the library's `add` to replace the old one.

    Args:
        library: Where the shape is.
        shape_id: Which shape.
        up: Axis of the shape as it stands now that ought to point up (`+z` leaves it).
        front: Axis as it stands now that ought to be the front; by default the front stays, or what becomes of it.
        scale: Factor on its size (0.01 where metres were read and centimetres meant).
        category: What it is, in any words the taxonomy knows.
        source_key: Of the file it came from, so that adding the folder again leaves the correction alone.

    Raises:
        InputError: when the axes are not at right angles, the scale is not positive or the category is unknown.
        LibraryError: when the shape does not exist.
    """
    if not 1e-6 < scale < 1e6:
        raise InputError(f"scale {scale}: give a positive factor, such as 0.01")
    Given(up=up, front=front, category=category)
    R_to_from = _turn(up, front)
    shape = library.shape(shape_id)
    T = np.eye(4)
    T[:3, :3] = R_to_from * scale
    meshes = _turn_parts(library.parts(shape_id), T)
    whole = whole_of(meshes)
    name = shape.category if category is None else taxonomy.resolve(category).category.name
    record = replace(
        shape,
        category=name,
        symmetry=symmetry_fold(whole, relief(whole)),
        contact_faces=usual_contact_faces(taxonomy.category(name).mount),
        guess=_guess(shape, R_to_from, scale, name),
    )
    return pack_shape(record, meshes, None, source_key, ())


def _turn(up: str, front: str | None) -> np.ndarray:
    """Rotation whose rows are the new axes in the old frame."""
    z = axis_vector(up)
    if front is None:
        front = next(a for a in ("+x", "-z" if up == "+x" else "+z", "+y") if a[1] != up[1])
    x = axis_vector(front)
    if x @ z:
        raise InputError(f"up {up} and front {front} lie along one axis; they must be at right angles")
    return np.stack([x, np.cross(z, x), z])


def _turn_parts(parts: trimesh.Scene, T: np.ndarray) -> list[trimesh.Trimesh]:
    meshes = []
    for node in sorted(parts.graph.nodes_geometry):
        T_shape_part, name = parts.graph[node]
        mesh = transform(parts.geometry[name], T @ T_shape_part)
        mesh.metadata["name"] = str(name).partition(" ")[2]
        meshes.append(mesh)
    bounds = np.array([m.bounds for m in meshes])
    centre = (bounds[:, 0].min(axis=0) + bounds[:, 1].max(axis=0)) / 2
    T_centred = np.eye(4)
    T_centred[:3, 3] = -centre
    return [transform(mesh, T_centred) for mesh in meshes]


def _guess(shape: Shape, R_to_from: np.ndarray, scale: float, category: str) -> Guess | None:
    """What was guessed, as corrected; in terms of the file's axes."""
    if shape.guess is None:
        return None
    old = shape.guess
    x, z = axis_vector(old.front.value), axis_vector(old.up.value)
    R_file_to_new = R_to_from @ np.stack([x, np.cross(z, x), z])
    reason = "corrected by hand"
    return Guess(
        up=Assumption(axis_name(R_file_to_new[2]), 1.0, reason),
        front=Assumption(axis_name(R_file_to_new[0]), 1.0, reason),
        unit=Assumption(f"{float(old.unit.value) * scale:.6g}", 1.0, reason) if scale != 1.0 else old.unit,
        category=Assumption(category, 1.0, reason),
    )
