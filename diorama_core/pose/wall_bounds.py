"""Walls that were measured around an object: a pose may not reach through them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.arrangement.facing.evidence import WallSamples
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.pose.depth_fit import SeenPoints
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings


@dataclass(frozen=True, eq=False)
class WallBounds:
    """Points of the walls that an object is in front of."""

    walls: WallSamples
    settings: PoseEvidenceSettings = SETTINGS.evidence

    @classmethod
    def of(
        cls, walls: WallSamples, points: SeenPoints, settings: PoseEvidenceSettings = SETTINGS.evidence
    ) -> WallBounds:
        """The walls near an object that none of its measured points is behind.

        Args:
            walls: upright surfaces that belong to no object.
            points: of the object.
        """
        xy = points.points_world[:, :2]
        middle, reach = xy.mean(axis=0), np.ptp(xy, axis=0).max() + 2.0
        near = np.flatnonzero(np.linalg.norm(walls.points_xy - middle, axis=1) < reach)
        near = near[:: max(1, -(-len(near) // settings.max_samples))]
        at, normals = walls.points_xy[near], walls.normals_xy[near]
        behind = (normals @ xy.T) - (normals * at).sum(axis=1, keepdims=True) < -settings.wall_sigma_m
        bounding = behind.mean(axis=1) < settings.seen_behind_share
        return cls(WallSamples(at[bounding], normals[bounding]), settings)

    def through_m(self, poses: PoseBatch, shape_size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, " p"]:
        """How deep the lower corners of poses' boxes reach through the walls; 0 where they reach through none."""
        at, normals = self.walls.points_xy, self.walls.normals_xy
        if len(at) == 0:
            return np.zeros(len(poses))
        half = 0.5 * poses.scale * shape_size_m
        signs = np.array([[1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, -1.0]])
        corners = poses.position[:, None] + np.einsum("pij,pkj->pki", poses.R, half[:, None] * signs)
        offset = corners[..., None, :2] - at
        depth = -(offset * normals).sum(axis=-1)
        beside = np.abs(offset[..., 0] * normals[:, 1] - offset[..., 1] * normals[:, 0])
        met = (beside < self.settings.beside_m) & (depth > 0.0)
        return np.where(met, depth, 0.0).max(axis=(1, 2))

    def log_likelihood(self, poses: PoseBatch, shape_size_m: Float[np.ndarray, "3"]) -> Float[np.ndarray, " p"]:
        """What the walls say of poses: the layout will bring them into the room, away from where they were seen."""
        return (
            -0.5
            * np.minimum(
                self.through_m(poses, shape_size_m) / self.settings.wall_sigma_m, self.settings.max_wall_sigmas
            )
            ** 2
        )


NO_BOUNDS = WallBounds(WallSamples(np.zeros((0, 2)), np.zeros((0, 2))))
