"""Turned vessels with an inside: what vases, cups, jars and pots have in common."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.solids import Profile, Solid, lathe


def hollow(
    profile: Profile, radius: float, height: float, wall: float, bottom: float = 0.012, segments: int = 36
) -> Solid:
    """A turned vessel with an inside, from an outer profile in fractions."""
    outside = [(a * radius, b * height) for a, b in profile]
    inside = [(max(r - wall, 0.004), max(z, bottom)) for r, z in reversed(outside) if z > bottom]
    floor = max(float(np.interp(bottom, [z for _, z in outside], [r for r, _ in outside])) - wall, 0.004)
    return lathe(
        [*outside, *inside, (floor, bottom + wall), (floor * 0.8, bottom), (0.004, bottom)], segments, np.deg2rad(55)
    )
