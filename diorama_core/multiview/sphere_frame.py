"""Gravity and the room's axes from straight lines all around: a line of the room is a great circle on the sphere.

A segment with the normal n of its great circle may run in a direction v where n . v = 0. The vertical is the direction
near the picture's own that most segments may run in; the room's axes are the two level directions, a quarter turn
apart, that most of the others may run in. All three are then refined together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.geometry.segments import line_segments_px
from diorama_core.geometry.sphere import level_axes, perspective
from diorama_core.scene.types import Camera, Intrinsics, yaw_rotation


@dataclass(frozen=True)
class SphereFrameSettings:
    """Numbers by which straight lines are read from the sphere."""

    side_px: int = 640
    """Side of the views in which segments are looked for: a quarter turn each."""
    max_tilt_deg: float = 15.0
    """Cameras that stitch level the horizon; a tripod or a hand is off by less than this."""
    level_deg: float = 5.0
    level_weight: float = 0.03
    """Deviation of cameras from level, and what it counts beside all lines, as `LineCameraSettings.prior_weight`."""
    coarse_deg: float = 1.0
    sigma_deg: float = 1.0
    """Deviation of a segment's great circle from the direction in which it runs."""
    rounds: int = 8


SETTINGS = SphereFrameSettings()


@dataclass(frozen=True, eq=False)
class SphereLines:
    """Segments all around."""

    normals: Float[np.ndarray, "n 3"]
    """Normals of their great circles, unit, in the sphere's frame."""
    weights: Float[np.ndarray, "n"]
    """Their angular lengths."""


def sphere_lines(picture: UInt8[np.ndarray, "h w 3"]) -> SphereLines:
    """Straight segments of an equirectangular picture, from perspective views that overlap by half."""
    side, T = SETTINGS.side_px, np.eye(4)
    k = Intrinsics.from_fov(side, side, np.pi / 2)
    looks = [(turn * np.pi / 4, 0.0) for turn in range(8)] + [(0.0, np.pi / 2), (0.0, -np.pi / 2)]
    normals, weights = [np.zeros((0, 3))], [np.zeros(0)]
    for azimuth, elevation in looks:
        T[:3, :3] = level_axes(azimuth, elevation)
        ends = line_segments_px(perspective(picture, T[:3, :3], k)).reshape(-1, 2, 2)
        away = Camera(k, T).rays(ends)
        away /= np.linalg.norm(away, axis=-1, keepdims=True)
        across = np.cross(away[:, 0], away[:, 1])
        length = np.linalg.norm(across, axis=1)
        normals.append(across / np.maximum(length, 1e-9)[:, None])
        weights.append(np.arcsin(np.clip(length, 0.0, 1.0)))
    return SphereLines(np.concatenate(normals), np.concatenate(weights))


def room_axes(lines: SphereLines) -> Float[np.ndarray, "3 3"]:
    """The turn from the sphere's frame to +Z up with the room's axes along x and y, by the least turn about +Z.

    A picture without lines stays as it is.
    """
    if not len(lines.weights):
        return np.eye(3)
    R = _with_yaw(lines, _levelled(lines))
    sigma = np.sin(np.deg2rad(SETTINGS.sigma_deg))
    for _ in range(SETTINGS.rounds):
        # A small turn w moves an axis a by w x a: the sine n . a changes by w . (a x n).
        sines = lines.normals @ R.T
        axis = np.abs(sines).argmin(axis=1)
        off = np.take_along_axis(sines, axis[:, None], 1)[:, 0]
        slopes = np.cross(R[axis], lines.normals)
        w = lines.weights * np.exp(-0.5 * (off / sigma) ** 2)
        step = -np.linalg.solve((slopes * w[:, None]).T @ slopes + 1e-6 * np.eye(3), slopes.T @ (w * off))
        R = R @ rotation_from_vector(step).T
    return R


def _levelled(lines: SphereLines) -> Float[np.ndarray, "3 3"]:
    """The least turn that makes upright lines upright."""
    reach = np.deg2rad(np.arange(-SETTINGS.max_tilt_deg, SETTINGS.max_tilt_deg + 1e-6, SETTINGS.coarse_deg))
    tilts = np.stack(np.meshgrid(reach, reach), axis=-1).reshape(-1, 2)
    tilts = tilts[np.linalg.norm(tilts, axis=1) <= reach[-1]]
    ups = np.column_stack([np.sin(tilts), np.sqrt(1 - (np.sin(tilts) ** 2).sum(axis=1))])
    votes = np.exp(-0.5 * (ups @ lines.normals.T / np.sin(np.deg2rad(SETTINGS.coarse_deg))) ** 2) @ lines.weights
    votes -= (
        SETTINGS.level_weight * lines.weights.sum() * 0.5 * (np.rad2deg(tilts) ** 2).sum(axis=1) / SETTINGS.level_deg**2
    )
    up = ups[int(np.argmax(votes))]
    turn = np.cross(up, [0.0, 0.0, 1.0])
    return rotation_from_vector(turn * (np.arcsin(np.linalg.norm(turn)) / max(float(np.linalg.norm(turn)), 1e-12)))


def _with_yaw(lines: SphereLines, R: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    """The turn with the room's axes along x and y."""
    n = lines.normals @ R.T
    upright = np.hypot(n[:, 0], n[:, 1])
    angle = np.arctan2(n[:, 1], n[:, 0])  # a level line runs a quarter turn from its normal's: alike modulo that
    # Upright lines may run in no level direction, and lines at the horizon in all of them.
    w = lines.weights * upright * (np.abs(n[:, 2]) > np.sin(2 * np.deg2rad(SETTINGS.coarse_deg)))
    turns = np.deg2rad(np.arange(-45.0, 45.0, SETTINGS.coarse_deg / 2))
    off = np.angle(np.exp(4j * (angle[None] - turns[:, None]))) / 4
    sines = upright * np.sin(off)
    votes = np.exp(-0.5 * (sines / np.sin(np.deg2rad(SETTINGS.coarse_deg))) ** 2) @ w
    return yaw_rotation(-float(turns[int(np.argmax(votes))])) @ R
