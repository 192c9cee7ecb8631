"""Frames of models: what formats promise, what Diorama's files carry, and turned models squared."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import Rotation

MARK = "diorama"


@dataclass(frozen=True, eq=False)
class OwnFrame:
    """Where an exported object's own axes are in its file, and what it is."""

    R_file_object: Float[np.ndarray, "3 3"]
    """Columns are its front, left and up in the file's frame."""
    category: str


def own_frame(document: Mapping[str, Any]) -> OwnFrame | None:
    """The frame of the one object in a file of Diorama; None where there is none, or more than one."""
    nodes = document.get("nodes", [])
    entries = [(k, entry) for k, node in enumerate(nodes) if (entry := _entry(node)) is not None]
    if len(entries) != 1:
        return None
    index, entry = entries[0]
    parents = {int(child): k for k, node in enumerate(nodes) for child in node.get("children", [])}
    R, seen = np.eye(3), set[int]()
    at: int | None = index
    while at is not None and at not in seen:
        seen.add(at)
        R = _rotation(nodes[at]) @ R
        at = parents.get(at)
    return OwnFrame(R, str(entry["category"]))


def _entry(node: Mapping[str, Any]) -> Mapping[str, Any] | None:
    extras = node.get("extras")
    entry = extras.get(MARK) if isinstance(extras, Mapping) else None
    if isinstance(entry, str):
        try:
            entry = json.loads(entry)
        except ValueError:
            return None
    return entry if isinstance(entry, Mapping) and "id" in entry and "category" in entry else None


def _rotation(node: Mapping[str, Any]) -> Float[np.ndarray, "3 3"]:
    if "matrix" in node:
        linear = np.array(node["matrix"], dtype=float).reshape(4, 4).T[:3, :3]
        U, _, V = np.linalg.svd(linear)
        return np.asarray(U @ V)
    return np.asarray(Rotation.from_quat(node.get("rotation", [0.0, 0.0, 0.0, 1.0])).as_matrix())


MIN_TURN_RAD = float(np.radians(1.5))
MIN_AGREEMENT = 0.6
"""Agreement of the upright faces' directions modulo a quarter turn; round and rough shapes have less."""
MIN_SHRINK = 0.97
"""The box around a squared model is smaller than this share of the one before."""
UPRIGHT_COS = 0.25
"""Faces whose normal leans more against the axis say nothing about the turn."""


def squaring_turn(mesh: trimesh.Trimesh, axes: Sequence[int] = (0, 1, 2)) -> tuple[Float[np.ndarray, "3 3"], float]:
    """The rotation that squares a model about one of its axes, and its angle; identity and 0 where it is square.

    Args:
        mesh: in the file's frame.
        axes: of the file that may be up.
    """
    best = (MIN_SHRINK, np.eye(3), 0.0)
    for axis in axes:
        angle = _angle(mesh, axis)
        if abs(angle) < MIN_TURN_RAD:
            continue
        R = trimesh.transformations.rotation_matrix(-angle, np.eye(3)[axis])[:3, :3]
        across = [k for k in range(3) if k != axis]
        before = float(np.prod(np.ptp(mesh.vertices[:, across], axis=0)))
        after = float(np.prod(np.ptp((mesh.vertices @ R.T)[:, across], axis=0)))
        if after < best[0] * before:
            best = (after / before, R, angle)
    return best[1], best[2]


def _angle(mesh: trimesh.Trimesh, axis: int) -> float:
    """By how much the upright faces are turned about an axis, modulo a quarter; 0 where they do not agree."""
    normals = mesh.face_normals
    upright = np.abs(normals[:, axis]) < UPRIGHT_COS
    areas = mesh.area_faces[upright]
    if not areas.sum() > 0:
        return 0.0
    a, b = normals[upright][:, (axis + 1) % 3], normals[upright][:, (axis + 2) % 3]
    mean = (areas * np.exp(4j * np.arctan2(b, a))).sum() / areas.sum()
    return float(np.angle(mean)) / 4.0 if abs(mean) > MIN_AGREEMENT else 0.0


@dataclass(frozen=True)
class Convention:
    """Probabilities of axes, and of metres in a unit."""

    name: str
    up: Mapping[str, float]
    front: Mapping[str, float] = field(default_factory=dict)
    unit: Mapping[float, float] = field(default_factory=dict)
    promises: bool = False
    """Whether the specification says metres and +Y up, so that nothing else is ever guessed while it can be true."""
    kept: bool = False
    """Whether other files of the folder keep the promise, so that this one does."""


GLTF = Convention("glTF", {"+y": 0.99}, {"+z": 0.7}, {1.0: 0.85, 0.01: 0.04, 0.001: 0.03}, promises=True)
"""The specification: +Y up, +Z front, metres. Fronts are mostly kept."""
OBJ = Convention("OBJ", {"+y": 0.65, "+z": 0.3}, {}, {1.0: 0.4, 0.01: 0.3, 0.001: 0.15, 0.0254: 0.1})
PLY = Convention("PLY", {"+z": 0.5, "+y": 0.4}, {}, {1.0: 0.6, 0.001: 0.2, 0.01: 0.1})
STL = Convention("STL", {"+z": 0.75, "+y": 0.2}, {}, {0.001: 0.7, 1.0: 0.15, 0.01: 0.05, 0.0254: 0.08})
THREE_DS = Convention("3DS", {"+z": 0.85, "+y": 0.1}, {"-y": 0.6}, {1.0: 0.3, 0.01: 0.25, 0.0254: 0.25, 0.001: 0.15})
UNKNOWN = Convention("no", {}, {}, {1.0: 0.4, 0.01: 0.2, 0.001: 0.2, 0.0254: 0.1})
"""Nothing is promised; for tests of what geometry alone tells."""
