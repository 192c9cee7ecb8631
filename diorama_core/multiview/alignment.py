"""From the world of given poses to the room: gravity, the room's axes, metres, and the floor.

Structure from motion leaves all of them open, ARKit only the axes and the floor. Photo by photo the camera stage reads
gravity and axes, and single-view metrology the distances of objects; all photos together vote.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import CameraEstimate
from diorama_core.library.taxonomy import broad
from diorama_core.multiview.settings import SETTINGS
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.floor import scan_heights
from diorama_core.perception.metrology.placement import place_all
from diorama_core.perception.metrology.problem import View
from diorama_core.scene.types import Camera, rigid, yaw_rotation


@dataclass(frozen=True, eq=False)
class RoomAlignment:
    """`p_room = scale * R @ p_poses + t`."""

    R: Float[np.ndarray, "3 3"]
    scale: float
    t: Float[np.ndarray, "3"]

    def camera(self, camera: Camera) -> Camera:
        """A camera of the poses' world in the room."""
        t = self.scale * self.R @ camera.position + self.t
        return Camera(camera.intrinsics, rigid(self.R @ camera.T_world_camera[:3, :3], t))


@dataclass(frozen=True, eq=False)
class PhotoReading:
    """One photo: its camera in the poses' world, what the camera stage reads, and its boxes."""

    camera: Camera
    estimate: CameraEstimate
    observations: BoxObservations


def align(
    readings: Sequence[PhotoReading], *, metric: bool = False, up: Float[np.ndarray, "3"] | None = None
) -> RoomAlignment:
    """The room's frame for a set of photos.

    Args:
        readings: at least one.
        metric: whether the poses are in metres.
        up: direction against gravity in the poses' world, where it is known.
    """
    R = _estimate_room_rotation(readings, up)
    cameras = [RoomAlignment(R, 1.0, np.zeros(3)).camera(r.camera) for r in readings]
    alone = [_alone(r, camera) for r, camera in zip(readings, cameras, strict=True)]
    pairs = [] if metric else [(i, j) for i in range(len(readings)) for j in range(i)]
    votes: list[tuple[float, float]] = []
    for i, j in pairs:
        votes += _votes(cameras[i], cameras[j], readings[i], readings[j], alone[i][1], alone[j][1])
    scale = _peak(votes) if votes else 1.0
    heights = [h - scale * float(c.position[2]) for (h, _), c in zip(alone, cameras, strict=True)]
    return RoomAlignment(R, scale, np.array([0.0, 0.0, float(np.median(heights))]))


def _estimate_room_rotation(
    readings: Sequence[PhotoReading], up: Float[np.ndarray, "3"] | None
) -> Float[np.ndarray, "3 3"]:
    """The turn to +Z up with the room's axes along x and y."""
    turns = [r.camera.T_world_camera[:3, :3] @ r.estimate.best.R_world_camera.T for r in readings]
    weights = np.array([max(r.estimate.confidence * r.estimate.best.score, 1e-3) for r in readings])
    if up is None:
        up = _robust_direction(np.array([T[:, 2] for T in turns]), weights)
    up = up / np.linalg.norm(up)
    side = np.cross(up, [1.0, 0.0, 0.0] if abs(up[0]) < 0.9 else [0.0, 1.0, 0.0])
    side /= np.linalg.norm(side)
    level = np.stack([side, np.cross(up, side), up])
    axes = [level @ T[:, 0] for T in turns]
    angles = 4.0 * np.array([np.arctan2(a[1], a[0]) for a in axes])  # axes are alike every quarter turn
    directions = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))])
    mean = _robust_direction(directions, weights)
    return yaw_rotation(-float(np.arctan2(mean[1], mean[0])) / 4.0) @ level


def _robust_direction(directions: Float[np.ndarray, "n 3"], weights: Float[np.ndarray, "n"]) -> Float[np.ndarray, "3"]:
    """The weighted mean, then again with less weight for those far from it."""
    mean = weights @ directions
    for _ in range(10):
        mean = mean / max(float(np.linalg.norm(mean)), 1e-9)
        off = np.arccos(np.clip(directions @ mean, -1.0, 1.0))
        mean = (weights / np.maximum(off, 0.02)) @ directions
    return mean / max(float(np.linalg.norm(mean)), 1e-9)


def _alone(reading: PhotoReading, camera: Camera) -> tuple[float, Float[np.ndarray, "n"]]:
    """The camera's height by the objects of its photo alone, and their distances."""
    forward = camera.T_world_camera[:3, 2]
    quarter = round(float(np.arctan2(forward[1], forward[0]) / (np.pi / 2)))
    view = View(camera.intrinsics, np.rint(yaw_rotation(np.pi / 2 * (1 - quarter))) @ camera.T_world_camera[:3, :3])
    height = scan_heights(reading.observations, view).height_m
    placed = place_all(reading.observations, view, height)
    eye = np.array([0.0, 0.0, height])
    return height, np.array([float(np.linalg.norm(p.cuboid.centre[0] - eye)) for p in placed])


def _votes(
    a: Camera,
    b: Camera,
    reading_a: PhotoReading,
    reading_b: PhotoReading,
    distances_a: Float[np.ndarray, "n"],
    distances_b: Float[np.ndarray, "m"],
) -> list[tuple[float, float]]:
    """(logarithm of metres a unit, weight) of pairs of boxes of a kind whose rays meet."""
    rays_a, rays_b = _rays(a, reading_a.observations), _rays(b, reading_b.observations)
    votes, base = [], b.position - a.position
    for i, kind_a in enumerate(reading_a.observations.categories):
        for j, kind_b in enumerate(reading_b.observations.categories):
            cosine = float(rays_a[i] @ rays_b[j])
            if broad(kind_a.name) != broad(kind_b.name) or abs(cosine) > np.cos(SETTINGS.min_parallax_rad):
                continue
            along = np.linalg.solve([[1.0, -cosine], [cosine, -1.0]], [base @ rays_a[i], base @ rays_b[j]])
            if min(along) <= 0:
                continue
            apart = a.position + along[0] * rays_a[i] - b.position - along[1] * rays_b[j]
            miss = float(np.linalg.norm(apart)) / float(np.mean(along))
            if miss < SETTINGS.miss:
                both = (np.log(distances_a[i] / along[0]), np.log(distances_b[j] / along[1]))
                agree = float(np.exp(-0.5 * ((both[0] - both[1]) / 0.3) ** 2))
                votes.append((float(np.mean(both)), agree))
    return votes


def _rays(camera: Camera, observations: BoxObservations) -> Float[np.ndarray, "n 3"]:
    boxes = observations.box_px
    rays = camera.rays((boxes[:, :2] + boxes[:, 2:]) / 2)
    return rays / np.linalg.norm(rays, axis=1, keepdims=True)


def _peak(votes: Sequence[tuple[float, float]]) -> float:
    """Where the votes are densest."""
    at, weight = np.array(votes).T
    density = [float(weight @ np.exp(-0.5 * ((at - x) / SETTINGS.vote_log_sigma) ** 2)) for x in at]
    best = at[int(np.argmax(density))]
    near = weight * np.exp(-0.5 * ((at - best) / SETTINGS.vote_log_sigma) ** 2)
    return float(np.exp(near @ at / near.sum()))
