"""Levels: a thing that carries others has a surface where these lie, however well another outline would fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Cuboid
from diorama_core.library.record import Shape
from diorama_core.pose.settings import SETTINGS, PoseEvidenceSettings
from diorama_core.scene.types import Pose


def level_cost(
    shape: Shape, pose: Pose, carried: Sequence[Cuboid], settings: PoseEvidenceSettings = SETTINGS.evidence
) -> float:
    """What speaks against a shape, by the heights at which the things that it carries lie; half squared sigmas.

    Args:
        shape: with its support surfaces; where none is known, nothing speaks against it.
        pose: upright, in the world.
        carried: what lies on it, measured without knowing the shape.
    """
    if not carried or not shape.surfaces:
        return 0.0
    levels = pose.position[2] + pose.scale[2] * np.array([s.height_m for s in shape.surfaces])
    bases: Float[np.ndarray, "n"] = np.array([c.centre[2] - c.size_m[2] / 2 for c in carried])
    sigma = np.hypot(settings.level_sigma_m, settings.level_share_sigma * pose.scale[2] * shape.size_m[2])
    off = np.abs(bases[:, None] - levels).min(axis=1) / sigma
    return float(np.minimum(0.5 * off**2, settings.max_level_cost).mean())
