"""Rotations as matrices, quaternions and rotation vectors (`scipy.spatial.transform`, array to array), and a camera's
pitch and roll relative to the floor.

scipy is loaded when it is first needed: the editor's port opens without it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


def quaternion_wxyz(R: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "4"]:
    """Unit quaternion (w, x, y, z), w >= 0, of a rotation matrix."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(R).as_quat(canonical=True, scalar_first=True)


def rotation_from_quaternion(wxyz: Float[np.ndarray, "4"]) -> Float[np.ndarray, "3 3"]:
    """Rotation matrix of a quaternion (w, x, y, z), normalised first."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(wxyz, scalar_first=True).as_matrix()


def rotation_from_vector(vectors: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3 3"]:
    """Rotation matrices of rotation vectors: axis times angle, radians."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_rotvec(vectors).as_matrix()


def rotation_vector(R: Float[np.ndarray, "*n 3 3"]) -> Float[np.ndarray, "*n 3"]:
    """Rotation vectors (axis times angle, at most pi) of rotation matrices."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(R).as_rotvec()


def yaw_rotations(yaws_rad: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n 3 3"]:
    """Rotations about world up."""
    R = np.zeros((len(yaws_rad), 3, 3))
    R[:, 0, 0] = R[:, 1, 1] = np.cos(yaws_rad)
    R[:, 1, 0] = np.sin(yaws_rad)
    R[:, 0, 1], R[:, 2, 2] = -R[:, 1, 0], 1.0
    return R


UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class CameraAttitude:
    """Attitude of a camera relative to the floor."""

    pitch_rad: float
    """Downward, of the viewing direction."""
    roll_rad: float
    """Clockwise about the viewing direction, as the photographer sees it."""

    @classmethod
    def of(cls, R_world_camera: Float[np.ndarray, "3 3"]) -> CameraAttitude:
        """Attitude of this camera."""
        right, forward = R_world_camera[:, 0], R_world_camera[:, 2]
        level, below = _level_axes(forward)
        return cls(float(-np.arcsin(np.clip(forward[2], -1, 1))), float(np.arctan2(right @ below, right @ level)))

    def rotation(self, heading: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
        """R_world_camera of a camera with this attitude that looks along `heading`, whose height is not used."""
        flat = np.asarray(heading) * (1.0, 1.0, 0.0)
        flat = flat / np.linalg.norm(flat)
        forward = np.cos(self.pitch_rad) * flat - np.sin(self.pitch_rad) * UP
        level, below = _level_axes(forward)
        c, s = np.cos(self.roll_rad), np.sin(self.roll_rad)
        return np.column_stack([c * level + s * below, c * below - s * level, forward])


def _level_axes(forward: Float[np.ndarray, "3"]) -> tuple[np.ndarray, np.ndarray]:
    """Right and down of a camera that looks along `forward` and is not rolled."""
    level = np.cross(forward, UP)
    level = level / np.linalg.norm(level)
    return level, np.cross(forward, level)
