"""Light that comes straight from the sun or from a lamp, with the shadows that it casts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Float32

from diorama_core.geometry.ray_scene import RayScene
from diorama_core.geometry.vectors import dot, unit

Vectors = Float32[np.ndarray, "n 3"]
SUN_BLUR = 0.012
"""Radius of the sun over its distance; about twice the real one, as haze makes it."""
LIFT_M = 2e-3
"""Shadow rays begin so far above what they belong to."""
NEAREST_M = 0.08
"""Nearer to a lamp it gets no brighter: its glowing part is as large."""


@runtime_checkable
class DirectLight(Protocol):
    """A source of light that reaches a place or is held off."""

    def falling(self, points: Vectors, normals: Vectors, sample: Float32[np.ndarray, "n 2"]) -> Vectors:
        """Irradiance of places.

        Args:
            points: world, metres.
            normals: unit, toward the light's side.
            sample: 0 to 1, chooses the point of the source.
        """
        ...


@dataclass(frozen=True, eq=False)
class SunLight:
    """Parallel light."""

    direction: Float[np.ndarray, "3"]
    """Unit vector toward the sun."""
    irradiance: Float[np.ndarray, "3"]
    """Irradiance of what faces it."""
    blockers: RayScene
    """Everything that holds it off, walls and ceiling with their openings too."""

    def falling(self, points: Vectors, normals: Vectors, sample: Float32[np.ndarray, "n 2"]) -> Vectors:
        """Irradiance of places; see `DirectLight`.

        Args:
            points: world, metres.
            normals: unit, toward the light's side.
            sample: 0 to 1, chooses the point of the source.
        """
        across = unit(np.cross(self.direction, [0.3, 0.5, 0.81]))
        disc = SUN_BLUR * (2 * sample - 1) @ np.stack([across, np.cross(self.direction, across)]).astype(np.float32)
        toward = (self.direction.astype(np.float32) + disc).astype(np.float32)
        strength = np.maximum(dot(normals, toward), 0)
        strength = _visible_strength(strength, points + np.float32(LIFT_M) * normals, toward, self.blockers, np.inf)
        return strength[:, None] * self.irradiance.astype(np.float32)


@dataclass(frozen=True, eq=False)
class LampLight:
    """Light to all sides from a small ball."""

    position: Float[np.ndarray, "3"]
    intensity: Float[np.ndarray, "3"]
    """Irradiance of what faces it one metre away."""
    radius_m: float
    blockers: RayScene
    """Everything that holds it off, but for the lamp itself: its shade lets light through."""

    def falling(self, points: Vectors, normals: Vectors, sample: Float32[np.ndarray, "n 2"]) -> Vectors:
        """Irradiance of places; see `DirectLight`.

        Args:
            points: world, metres.
            normals: unit, toward the light's side.
            sample: 0 to 1, chooses the point of the source.
        """
        up, around = 2 * sample[:, :1] - 1, 2 * np.pi * sample[:, 1:]
        level = np.sqrt(1 - up * up)
        ball = np.concatenate([level * np.cos(around), level * np.sin(around), up], axis=1)
        origins = points + np.float32(LIFT_M) * normals
        ray = (self.position + self.radius_m * ball - origins).astype(np.float32)
        squared = dot(ray, ray)
        distance = np.sqrt(squared)
        strength = np.maximum(dot(normals, ray), 0) / distance / np.maximum(squared, np.float32(NEAREST_M**2))
        strength = _visible_strength(strength, origins, ray, self.blockers, 1.0)
        return (strength[:, None] * self.intensity).astype(np.float32)


def _visible_strength(
    strength: Float32[np.ndarray, "n"], origins: Vectors, toward: Vectors, blockers: RayScene, far: float
) -> Float32[np.ndarray, "n"]:
    """Strength of light, 0 where something stands between a place and the light, up to `far` times the ray."""
    lit = np.flatnonzero(strength > 0)
    rays = np.concatenate([origins, toward], axis=1).take(lit, axis=0).astype(np.float32)
    light = strength.copy()
    light[lit[blockers.is_occluded(rays, far=far)]] = 0
    return light
