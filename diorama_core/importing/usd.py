"""Diorama's marks in USD and USDZ files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from diorama_core.importing.gltf import CAMERA_AXES
from diorama_core.importing.marked import MarkedFile, ObjectNode, as_bytes, as_ids, as_mapping
from diorama_core.library.ingest.usd_stage import matrix_of, open_stage, usd_errors, world_of


def read_marked_usd(path: Path) -> MarkedFile | None:
    """What Diorama wrote into a file; None when the file is not from it.

    Raises:
        InputError: when the file cannot be read.
        UnavailableError: when usd-core is missing.
    """
    stage = open_stage(path)
    with usd_errors(path):
        return _mark(stage)


def _mark(stage: Any) -> MarkedFile | None:
    from pxr import Usd, UsdGeom

    root = next((p for p in stage.Traverse() if p.HasAttribute("diorama:scene")), None)
    if root is None:
        return None
    to_world, places = world_of(stage), UsdGeom.XformCache()
    prims = [p for p in Usd.PrimRange(root) if p != root]
    nodes: list[ObjectNode] = []
    numbers: dict[Any, int] = {}
    planes: dict[str, Float[np.ndarray, "4 4"]] = {}
    T_world_camera = None
    for prim in prims:
        M = to_world @ matrix_of(places.GetLocalToWorldTransform(prim))
        entry, plane = as_mapping(_note(prim, "entry")), as_mapping(_note(prim, "plane"))
        if entry is not None and "id" in entry:
            numbers[prim.GetPath()] = len(nodes)
            scaled = M @ np.diag([*_scale(prim, entry), 1.0])
            name = prim.GetDisplayName() or prim.GetName()
            nodes.append(ObjectNode(str(entry["id"]), name, scaled, entry, _parent_number(prim, numbers)))
        elif plane is not None and "id" in plane:
            planes[str(plane["id"])] = M
        elif T_world_camera is None and prim.IsA(UsdGeom.Camera):
            T_world_camera = M @ CAMERA_AXES
    return MarkedFile(
        document=str(_note(root, "scene")),
        nodes=tuple(nodes),
        written=as_ids(_note(root, "objects")),
        planes=planes,
        T_world_camera=T_world_camera,
        provenance=as_mapping(_note(root, "provenance")) or {},
        photo=as_bytes(_note(root, "photo")),
    )


def _note(prim: Any, name: str) -> object:
    return prim.GetAttribute(f"diorama:{name}").Get() if prim.HasAttribute(f"diorama:{name}") else None


def _scale(prim: Any, entry: Any) -> Float[np.ndarray, "3"]:
    """The scale of the geometry below an object's prim, which the prim itself does not have."""
    from pxr import UsdGeom

    shape = next((c for c in prim.GetChildren() if c.GetName().startswith("Shape")), None)  # Blender appends numbers
    if shape is not None and shape.IsA(UsdGeom.Xformable):
        local = matrix_of(UsdGeom.Xformable(shape).GetLocalTransformation())
        return np.linalg.norm(local[:3, :3], axis=0)
    return np.array(entry.get("scale", [1.0, 1.0, 1.0]), dtype=np.float64)


def _parent_number(prim: Any, numbers: dict[Any, int]) -> int | None:
    above = prim.GetPath().GetParentPath().GetAncestorsRange()
    return next((numbers[path] for path in above if path in numbers), None)
