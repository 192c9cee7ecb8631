"""Rotations as matrices, quaternions and rotation vectors: one face of `scipy.spatial.transform`, array to array."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation


def quaternion_wxyz(R: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "4"]:
    """Unit quaternion (w, x, y, z), w >= 0, of a rotation matrix."""
    return Rotation.from_matrix(R).as_quat(canonical=True, scalar_first=True)


def rotation_from_quaternion(wxyz: Float[np.ndarray, "4"]) -> Float[np.ndarray, "3 3"]:
    """Rotation matrix of a quaternion (w, x, y, z), normalised first."""
    return Rotation.from_quat(wxyz, scalar_first=True).as_matrix()


def rotation_from_vector(vectors: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3 3"]:
    """Rotation matrices of rotation vectors: axis times angle, radians."""
    return Rotation.from_rotvec(vectors).as_matrix()


def rotation_vector(R: Float[np.ndarray, "*n 3 3"]) -> Float[np.ndarray, "*n 3"]:
    """Rotation vectors (axis times angle, at most pi) of rotation matrices."""
    return Rotation.from_matrix(R).as_rotvec()


def yaw_rotations(yaws_rad: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n 3 3"]:
    """Rotations about world up."""
    R = np.zeros((len(yaws_rad), 3, 3))
    R[:, 0, 0] = R[:, 1, 1] = np.cos(yaws_rad)
    R[:, 1, 0] = np.sin(yaws_rad)
    R[:, 0, 1], R[:, 2, 2] = -R[:, 1, 0], 1.0
    return R
