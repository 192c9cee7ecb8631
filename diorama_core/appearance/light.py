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

USUAL = np.array([0.0, 0.0, 0.3])
"""Light in rooms comes more from above than from below."""
SHINING = 190
"""Brightest channel, of 255, from which on pixels of a lamp are its light."""


@dataclass(frozen=True)
class EstimatedLightSettings:
    """How the room's main light is found."""

    level_sigma: float = 0.25
    upright_sigma: float = 0.1
    """How far it differs from that along the floor, where rooms differ most, and upward: shadows below things, which
    look like light from below, are no evidence."""
    from_window: float = 0.35
    """How much of it comes from the side of a window that is seen."""
    of_walls: float = 4.0
    """What walls say beside one material of an object, as a factor of deviations: they are large, flat and even."""
    max_length: float = 0.85
    robust: float = 0.25
    """Differences of log luminance beyond about this are shadows and other materials."""
    min_samples: int = 3


SETTINGS = EstimatedLightSettings()


@dataclass(frozen=True, eq=False)
class Shade:
    """One material seen at several normals."""

    normals_world: Float[np.ndarray, "n 3"]
    luminance: Float[np.ndarray, "n"]
    """Linear, positive."""
    weight: Float[np.ndarray, "n"]


def estimate_light(
    shades: Sequence[Shade], walls: Shade | None = None, to_window: Float[np.ndarray, "3"] | None = None
) -> RoomLight:
    """The light that explains all materials' shades best; the usual one where nothing is known."""
    observations = [(s, 1.0) for s in shades if len(s.luminance) >= 2] + (
        [] if walls is None else [(walls, SETTINGS.of_walls)]
    )
    usual = USUAL if to_window is None else USUAL + SETTINGS.from_window * np.array([*to_window[:2], 0.0])
    if sum(len(s.luminance) for s, _ in observations) < SETTINGS.min_samples and walls is None and to_window is None:
        return RoomLight()

    def residuals(b: Float[np.ndarray, "3"]) -> Float[np.ndarray, "m"]:
        out = [(b - usual) / (SETTINGS.level_sigma, SETTINGS.level_sigma, SETTINGS.upright_sigma)]
        for shade, factor in observations:
            light = np.maximum(1.0 + shade.normals_world @ b, 1.0 - SETTINGS.max_length)
            albedo = np.log(shade.luminance / light)
            off = albedo - np.average(albedo, weights=shade.weight)
            out.append(factor * np.sqrt(shade.weight) * off / SETTINGS.robust)
        return np.concatenate(out)

    solution = least_squares(residuals, usual, loss="soft_l1").x
    length = float(np.linalg.norm(solution))
    x, y, z = (float(v) for v in solution / max(length, 1e-9))
    return RoomLight((x, y, z), min(length, SETTINGS.max_length)) if length > 1e-3 else RoomLight()
