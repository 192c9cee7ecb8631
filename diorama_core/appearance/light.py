"""The main light of a room, from how brightly surfaces of one material are lit that are turned differently.

Irradiance is modelled as `1 + b . n` relative to even light (the first two bands of spherical harmonics,
Ramamoorthi and Hanrahan 2001): the direction of b is where most light comes from.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares

from diorama_core.scene.types import RoomLight

USUAL = np.array([0.0, 0.0, 0.25])
"""Light in rooms comes more from above than from below."""
PRIOR_WEIGHT = 0.6
MAX_LENGTH = 0.85
ROBUST = 0.15
"""Differences of log luminance beyond about this are shadows and other materials."""
MIN_SAMPLES = 3
SHINING = 190
"""Brightest channel, of 255, from which on pixels of a lamp are its light."""


@dataclass(frozen=True, eq=False)
class Shade:
    """One material seen at several normals."""

    normals_world: Float[np.ndarray, "n 3"]
    luminance: Float[np.ndarray, "n"]
    """Linear, positive."""
    weight: Float[np.ndarray, "n"]


def estimated_light(shades: Sequence[Shade]) -> RoomLight:
    """The light that explains all materials' shades best; the usual one where they say nothing."""
    shades = [s for s in shades if len(s.luminance) >= 2]
    if sum(len(s.luminance) for s in shades) < MIN_SAMPLES:
        return RoomLight()

    def residuals(b: Float[np.ndarray, "3"]) -> Float[np.ndarray, "m"]:
        out = [PRIOR_WEIGHT * (b - USUAL)]
        for shade in shades:
            light = np.maximum(1.0 + shade.normals_world @ b, 1.0 - MAX_LENGTH)
            albedo = np.log(shade.luminance / light)
            off = albedo - np.average(albedo, weights=shade.weight)
            out.append(np.sqrt(shade.weight) * off / ROBUST)
        return np.concatenate(out)

    found = least_squares(residuals, USUAL, loss="soft_l1").x
    length = float(np.linalg.norm(found))
    x, y, z = (float(v) for v in found / max(length, 1e-9))
    return RoomLight((x, y, z), min(length, MAX_LENGTH)) if length > 1e-3 else RoomLight()
