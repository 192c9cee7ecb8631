"""Models that stand turned in their files, as things cut out of scenes do: squared by their own faces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import trimesh
from jaxtyping import Float

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
