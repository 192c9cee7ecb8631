"""Turns about up that leave a shape looking the same."""

from __future__ import annotations

import numpy as np
import trimesh

from diorama_core.library.ingest.relief import Relief, relief, turned
from diorama_core.library.record import SymmetryFold

_SAME = 0.035
"""Mean difference of two reliefs below which they are one shape seen twice."""
_QUARTER = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])


def symmetry_fold(mesh: trimesh.Trimesh, pictures: Relief) -> SymmetryFold:
    """The fold of a mesh in its canonical frame, from its relief; 36 means round."""
    if _differ(pictures, turned(pictures, _QUARTER @ _QUARTER)):
        return 1
    x, y, _ = mesh.extents
    if abs(x - y) > 0.03 * max(x, y) or _differ(pictures, turned(pictures, _QUARTER)):
        return 2
    return 4 if _differ(pictures, _turned_by(mesh, 30.0)) or _differ(pictures, _turned_by(mesh, 45.0)) else 36


def _turned_by(mesh: trimesh.Trimesh, angle_deg: float) -> Relief:
    R = trimesh.transformations.rotation_matrix(np.radians(angle_deg), (0, 0, 1))[:3, :3]
    return relief(trimesh.Trimesh(np.asarray(mesh.vertices) @ R.T, mesh.faces, process=False))


def _differ(a: Relief, b: Relief) -> bool:
    return bool(np.abs(a - b).mean() > _SAME)
