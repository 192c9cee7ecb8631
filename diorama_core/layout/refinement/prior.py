"""How far another pose of an object is from what was observed of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.layout.settings import REFINEMENT, RefinementSettings
from diorama_core.scene.types import Pose


@dataclass(frozen=True)
class Precision:
    """Standard deviations of what was observed of an object."""

    distance_m: float
    """Deviation of its distance from the camera, in metres."""
    distance_share: float
    """Deviation of the distance as a share of it."""
    size_share: float
    """Deviation of each of its extents, as a share."""
    sizes_follow: bool
    """Whether sizes follow distances, because a photo alone gave both."""


MEASURED = Precision(distance_m=0.01, distance_share=0.0, size_share=0.03, sizes_follow=False)
"""With measured depth."""
REASONED = Precision(distance_m=0.0, distance_share=0.033, size_share=0.05, sizes_follow=True)
"""From a photo alone."""


@dataclass(frozen=True, eq=False)
class PosePrior:
    """One observed pose."""

    eye: Float[np.ndarray, "3"]
    """The camera's position."""
    observed: Pose
    precision: Precision
    settings: RefinementSettings = REFINEMENT

    def was_pushed_away(self, position: Float[np.ndarray, "3"]) -> bool:
        """Whether a position is farther from a measured one than is usual."""
        usual = self.settings.linear_sigmas * self.precision.distance_m
        return usual > 0.0 and float(np.linalg.norm(position - self.observed.position)) > usual

    def cost(self, poses: PoseBatch) -> Float[np.ndarray, " p"]:
        """Cost of other poses, in shares of the agreement of one mask."""
        distance = float(np.linalg.norm(self.observed.position - self.eye))
        nearer = np.log(np.linalg.norm(poses.position - self.eye, axis=1) / distance)
        grown = np.log(poses.scale / self.observed.scale)
        if self.precision.sizes_follow:
            grown = grown - nearer[:, None]
        cosine = (np.einsum("pij,ij->p", poses.R, self.observed.R_world_object) - 1.0) / 2.0
        sigma = float(np.hypot(self.precision.distance_m / distance, self.precision.distance_share))
        turned = np.arccos(np.clip(cosine, -1.0, 1.0)) / self.settings.turn_sigma_rad
        deviations = np.column_stack([nearer / sigma, turned, grown / self.precision.size_share])
        squares = np.minimum(deviations**2, self.settings.max_sigmas**2)
        away, linear = np.abs(deviations[:, 0]), self.settings.linear_sigmas
        distant = np.where(away <= linear, away**2, linear * (2.0 * away - linear))
        return self.settings.sigma * (distant + squares[:, 1] + squares[:, 2:].mean(axis=1))
