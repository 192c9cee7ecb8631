"""The frame of a single object that Diorama exported, which its glTF file carries: it comes back as it was."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
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
    found = extras.get(MARK) if isinstance(extras, Mapping) else None
    if isinstance(found, str):
        try:
            found = json.loads(found)
        except ValueError:
            return None
    return found if isinstance(found, Mapping) and "id" in found and "category" in found else None


def _rotation(node: Mapping[str, Any]) -> Float[np.ndarray, "3 3"]:
    if "matrix" in node:
        linear = np.array(node["matrix"], dtype=float).reshape(4, 4).T[:3, :3]
        U, _, V = np.linalg.svd(linear)
        return np.asarray(U @ V)
    return np.asarray(Rotation.from_quat(node.get("rotation", [0.0, 0.0, 0.0, 1.0])).as_matrix())
