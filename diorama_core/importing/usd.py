"""Diorama's marks in a USD or USDZ file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.errors import InputError, UnavailableError
from diorama_core.importing.gltf import CAMERA_AXES, Z_UP
from diorama_core.importing.marked import MarkedFile, ObjectNode, as_bytes, as_ids, as_mapping

MARK = "diorama"


def opened_stage(path: Path) -> Any:
    """A USD stage.

    Raises:
        UnavailableError: when usd-core is missing.
        InputError: when the file is no USD.
    """
    try:
        from pxr import Tf, Usd
    except ImportError as error:
        raise UnavailableError("reading USD needs an optional library: pip install 'diorama[usd]'") from error
    try:
        return Usd.Stage.Open(str(path))
    except Tf.ErrorException as error:
        # Of "Error in '...' at line ... : 'Failed to open layer @/path/room.usdz@'" people need the last words only.
        reason = str(error).strip().splitlines()[-1].rpartition(" : ")[2].replace(f"@{path}@", "").strip(" '")
        raise InputError(f"{path.name} cannot be read as USD ({reason}); export it again") from error


def read_marked_usd(path: Path) -> MarkedFile | None:
    """What Diorama wrote into a file; None when the file is not from it.

    Raises:
        InputError: when the file cannot be read.
        UnavailableError: when usd-core is missing.
    """
    from pxr import Usd, UsdGeom

    stage = opened_stage(path)
    root = stage.GetDefaultPrim()
    mark = root.GetCustomDataByKey(MARK) if root else None
    if not isinstance(mark, str):
        return None
    to_world, places = world_of(stage), UsdGeom.XformCache()
    prims = [p for p in Usd.PrimRange(root) if p != root]
    nodes: list[ObjectNode] = []
    numbers: dict[Any, int] = {}
    planes: dict[str, Float[np.ndarray, "4 4"]] = {}
    T_world_camera = None
    for prim in prims:
        M = to_world @ matrix_of(places.GetLocalToWorldTransform(prim))
        entry = as_mapping(prim.GetCustomDataByKey(MARK))
        plane = as_mapping(prim.GetCustomDataByKey("diorama_plane"))
        if entry is not None and "id" in entry:
            numbers[prim.GetPath()] = len(nodes)
            scaled = M @ np.diag([*_scale(prim, entry), 1.0])
            name = prim.GetDisplayName() or prim.GetName()
            nodes.append(ObjectNode(str(entry["id"]), name, scaled, entry, _above(prim, numbers)))
        elif plane is not None and "id" in plane:
            planes[str(plane["id"])] = M
        elif T_world_camera is None and prim.IsA(UsdGeom.Camera):
            T_world_camera = M @ CAMERA_AXES
    return MarkedFile(
        document=mark,
        nodes=tuple(nodes),
        written=as_ids(root.GetCustomDataByKey("diorama_objects")),
        planes=planes,
        T_world_camera=T_world_camera,
        provenance=as_mapping(root.GetCustomDataByKey("provenance")) or {},
        photo=as_bytes(root.GetCustomDataByKey("diorama_photo")),
    )


def world_of(stage: Any) -> Float[np.ndarray, "4 4"]:
    """The stage's frame and unit to the world: +Z up, metres."""
    from pxr import UsdGeom

    metres = float(UsdGeom.GetStageMetersPerUnit(stage))
    turn = Z_UP if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y else np.eye(4)
    return turn @ np.diag([metres, metres, metres, 1.0])


def matrix_of(matrix: Any) -> Float[np.ndarray, "4 4"]:
    """A USD matrix (rows are axes) as one that multiplies columns."""
    return np.array(matrix, dtype=np.float64).reshape(4, 4).T


def _scale(prim: Any, entry: Any) -> Float[np.ndarray, "3"]:
    """The scale of the geometry below an object's prim, which the prim itself does not have."""
    from pxr import UsdGeom

    shape = prim.GetChild("Shape")
    if shape and shape.IsA(UsdGeom.Xformable):
        local = matrix_of(UsdGeom.Xformable(shape).GetLocalTransformation())
        return np.linalg.norm(local[:3, :3], axis=0)
    return np.array(entry.get("scale", [1.0, 1.0, 1.0]), dtype=np.float64)


def _above(prim: Any, numbers: dict[Any, int]) -> int | None:
    path = prim.GetPath().GetParentPath()
    while not path.isEmpty:
        if path in numbers:
            return numbers[path]
        path = path.GetParentPath()
    return None
