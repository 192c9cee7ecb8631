"""Rotations of a camera over the floor: by pitch, roll and heading, and in the world's convention.

Pitch is positive when the camera looks down, roll when it leans clockwise as seen from behind.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def up_in_camera(
    pitch_rad: Float[np.ndarray, "*n"] | float, roll_rad: Float[np.ndarray, "*n"] | float
) -> Float[np.ndarray, "*n 3"]:
    """World up as a unit vector in the camera frame."""
    pitch, roll = np.broadcast_arrays(np.asarray(pitch_rad, float), np.asarray(roll_rad, float))
    return np.stack([-np.cos(pitch) * np.sin(roll), -np.cos(pitch) * np.cos(roll), -np.sin(pitch)], axis=-1)


def pitch_and_roll(up_camera: Float[np.ndarray, "*n 3"]) -> tuple[Float[np.ndarray, "*n"], Float[np.ndarray, "*n"]]:
    """Inverse of `up_in_camera`, radians."""
    up = np.asarray(up_camera, dtype=np.float64)
    pitch, roll = np.arcsin(np.clip(-up[..., 2], -1, 1)), np.arctan2(-up[..., 0], -up[..., 1])
    return np.asarray(pitch), np.asarray(roll)


def world_frame(
    up_camera: Float[np.ndarray, "3"], horizontal_camera: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "3 3"]:
    """`R_world_camera` of a gravity and any one of the room's horizontal directions, both in the camera frame.

    World +Z is up; +Y is the one of the room's four horizontal directions that is nearest to the viewing direction; +X
    lies to its right. `horizontal_camera` need not be exactly perpendicular to gravity.
    """
    up = up_camera / np.linalg.norm(up_camera)
    along = horizontal_camera - (horizontal_camera @ up) * up
    if np.linalg.norm(along) < 1e-6:
        along = facing_direction(up)
    along = along / np.linalg.norm(along)
    across = np.cross(up, along)
    choices = np.stack([along, across, -along, -across])
    forward = choices[int(np.argmax(np.round(choices[:, 2], 9)))]
    return np.stack([np.cross(forward, up), forward, up])


def facing_direction(up_camera: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """The horizontal direction that the camera faces, or the picture's up when it looks straight down."""
    for axis in (np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0, 0.0])):
        along = axis - (axis @ up_camera) * up_camera
        if np.linalg.norm(along) > 1e-3:
            break
    return along / np.linalg.norm(along)


def frame_difference_rad(a: Float[np.ndarray, "*n 3 3"], b: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "*n"]:
    """Angle of the smallest turn that makes room frames agree with one, quarter turns of the room left free."""
    (x, y, z), zero = b, np.zeros(3)
    straight = (a * np.stack([x, y, zero])).sum(axis=(-2, -1))
    turned = (a * np.stack([-y, x, zero])).sum(axis=(-2, -1))
    trace = np.maximum(np.abs(straight), np.abs(turned)) + a[..., 2, :] @ z
    return np.asarray(np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0)))
