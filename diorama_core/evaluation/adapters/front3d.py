"""3D-FRONT houses with 3D-FUTURE furniture: one room of a house as a `Scene` with its architecture.

A house is one JSON file: `furniture` (uid, jid, bbox, category), `mesh` (walls, floors, ceilings with xyz and faces)
and `scene.room[*].children` (ref, pos, rot xyzw, scale). Worlds have +Y up; sizes are metres.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull

from diorama_core.errors import InputError
from diorama_core.evaluation.adapters.files import R_ZUP_YUP, read_json
from diorama_core.geometry.rotations import rotation_from_quaternion
from diorama_core.library.taxonomy import resolve
from diorama_core.scene.types import Architecture, Plane, PlaneRole, Pose, Scene, SceneObject, Support

ROLES: dict[str, PlaneRole] = {
    "Floor": "floor", "WallInner": "wall", "Ceiling": "ceiling", "CustomizedCeiling": "ceiling",
}  # fmt: skip
_R_FRONT_OBJECT = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
"""Our object axes (front, left, up) as 3D-FUTURE's (x right of the viewer, +Y up, +Z front)."""


def rooms_of(path: Path) -> tuple[str, ...]:
    """Names of the rooms of a house."""
    return tuple(str(r["instanceid"]) for r in read_json(path)["scene"]["room"])


def read_front3d(path: Path, room: str) -> Scene:
    """One room; furniture stands on its floor. Shape ids are 3D-FUTURE's `jid`."""
    house = read_json(path)
    record = next((r for r in house["scene"]["room"] if r["instanceid"] == room), None)
    if record is None:
        raise InputError(f"{path}: there is no room '{room}'; it has {', '.join(rooms_of(path))}")
    furniture = {f["uid"]: f for f in house["furniture"] if f.get("valid", True) and f.get("size") is not None}
    meshes = {m["uid"]: m for m in house["mesh"]}
    objects: list[SceneObject] = []
    planes: list[Plane] = []
    for child in record["children"]:
        if child["ref"] in furniture:
            objects.append(_object(child, furniture[child["ref"]], len(objects)))
        elif child["ref"] in meshes:
            planes += _plane(meshes[child["ref"]], len(planes))
    architecture = Architecture(tuple(planes))
    floor = architecture.floor
    edges = () if floor is None else tuple(Support(o.id, floor.id) for o in objects)
    return Scene(architecture=architecture, objects=tuple(objects), supports=edges)


def _object(child: dict[str, Any], record: dict[str, Any], index: int) -> SceneObject:
    label = str(record.get("category") or record.get("title") or "object").split("/")[-1].strip()
    x, y, z, w = child["rot"]
    R = R_ZUP_YUP @ rotation_from_quaternion(np.array([w, x, y, z])) @ _R_FRONT_OBJECT
    width, height, depth = (float(v) for v in record["size"])
    scale_x, scale_y, scale_z = (float(v) for v in child["scale"])
    foot = R_ZUP_YUP @ np.array(child["pos"], dtype=np.float64)
    category = resolve(label).category.name
    return SceneObject(
        id=f"object_{index}",
        label=label,
        category=category,
        shape_id=str(record["jid"]),
        shape_size_m=(depth, width, height),
        # positions are of the middle of the foot
        pose=Pose(R, foot + np.array([0.0, 0.0, height * scale_y / 2]), np.array([scale_z, scale_x, scale_y])),
    )


def _plane(record: dict[str, Any], index: int) -> list[Plane]:
    """The outline of one flat mesh of the room; none for what is no floor, wall or ceiling."""
    role = ROLES.get(str(record["type"]))
    points = np.array(record["xyz"], dtype=np.float64).reshape(-1, 3) @ R_ZUP_YUP.T
    if role is None or len(points) < 3:
        return []
    normal = np.array(record["normal"], dtype=np.float64).reshape(-1, 3)[0] @ R_ZUP_YUP.T
    centre = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - centre)
    flat = (points - centre) @ axes[:2].T
    if np.linalg.matrix_rank(flat, tol=1e-6) < 2:
        return []
    outline = centre + flat[ConvexHull(flat).vertices] @ axes[:2]
    plane = Plane(f"{role}_{index}", role, outline)
    return [plane if plane.normal @ normal > 0 else Plane(plane.id, role, outline[::-1])]
