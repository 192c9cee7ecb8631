"""Where the sun stands at a time of day, and how strong and of what colour its light and that of the sky are.

The day is an equinox at 45 degrees north: the sun rises at six in the east, stands half-way up in the south at noon and
sets at six in the west, so that it shines into windows on every side but the north.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

LATITUDE_RAD = np.radians(45.0)
OPTICAL_DEPTH = np.array([0.10, 0.18, 0.33])
"""Optical depth of the clear atmosphere straight up, for red, green and blue."""
NIGHT_SKY = np.array([0.035, 0.045, 0.075])
"""Light of the sky at night relative to noon: enough to find one's way."""
DAY_SKY = np.array([0.94, 0.97, 1.0])
TWILIGHT_RAD, FULL_DAY_RAD = np.radians(-8.0), np.radians(25.0)
"""Elevations of the sun between which the sky brightens."""


@dataclass(frozen=True, eq=False)
class Daylight:
    """Light from outside, linear; 1 is the sun outside the atmosphere and the sky at noon."""

    direction: Float[np.ndarray, "3"]
    """Unit vector toward the sun in the world."""
    sun: Float[np.ndarray, "3"]
    """Colour of the sun's direct light on what faces it; 0 while it is down."""
    sky: Float[np.ndarray, "3"]


def sun_direction(hour: float, north_rad: float) -> Float[np.ndarray, "3"]:
    """Unit vector toward the sun in the world; below the horizon at night.

    Args:
        hour: local solar time, 0 to 24.
        north_rad: direction of north, counter-clockwise from +X.
    """
    angle = (hour - 12.0) * np.pi / 12.0
    east, north = -np.sin(angle), -np.sin(LATITUDE_RAD) * np.cos(angle)
    up = np.cos(LATITUDE_RAD) * np.cos(angle)
    c, s = np.cos(north_rad), np.sin(north_rad)
    return np.array([north * c + east * s, north * s - east * c, up])


def daylight(hour: float, north_rad: float) -> Daylight:
    """The light from outside at a time of day; arguments as for `sun_direction`."""
    direction = sun_direction(hour, north_rad)
    elevation = float(np.arcsin(np.clip(direction[2], -1.0, 1.0)))
    risen = np.clip((elevation - TWILIGHT_RAD) / (FULL_DAY_RAD - TWILIGHT_RAD), 0.0, 1.0)
    level = risen * risen * (3.0 - 2.0 * risen)
    sky = NIGHT_SKY + level * (DAY_SKY - NIGHT_SKY)
    return Daylight(direction, _direct(elevation), sky)


def _direct(elevation_rad: float) -> Float[np.ndarray, "3"]:
    """What the atmosphere lets through (air mass of Kasten and Young, 1989); 0 below the horizon."""
    if elevation_rad <= 0.0:
        return np.zeros(3)
    degrees = np.degrees(elevation_rad)
    air_mass = 1.0 / (np.sin(elevation_rad) + 0.50572 * (degrees + 6.07995) ** -1.6364)
    return np.exp(-OPTICAL_DEPTH * air_mass)
