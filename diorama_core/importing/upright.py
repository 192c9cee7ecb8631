"""Which way is up in points that do not say it: across levels, and things stand below."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

LEVEL_M = 0.02
"""Bin height of the histogram of heights."""
WALL_SHARE = 0.08
"""Share of the plan at its border, ignored because its points belong to walls."""
LEVEL_SHARE = 0.06
"""Share of the height at each end that counts as floor and as ceiling."""
UPSIDE_DOWN = 1.6
"""So many times more things above the middle than below it are a room on its head."""
MAX_ASKED = 200_000


def likely_up(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "3"]:
    """Unit vector against gravity, along an axis of the points.

    Levels (floor, ceiling, boards) are densest across it; furniture fills the lower half of a room more than the upper.
    """
    asked = points[:: max(1, -(-len(points) // MAX_ASKED))]
    axis = max((2, 1), key=lambda a: sharpness(asked[:, a], LEVEL_M))
    low, high = np.quantile(asked, [0.01, 0.99], axis=0)
    share = (asked - low) / np.maximum(high - low, 1e-9)
    plan = np.delete(share, axis, axis=1)
    inner = ((plan > WALL_SHARE) & (plan < 1 - WALL_SHARE)).all(axis=1)
    height = share[inner, axis]
    below = int(((height > LEVEL_SHARE) & (height < 0.5)).sum())
    above = int(((height > 0.5) & (height < 1 - LEVEL_SHARE)).sum())
    up = np.zeros(3)
    up[axis] = -1.0 if above > UPSIDE_DOWN * max(below, 1) else 1.0
    return up


def sharpness(values: Float[np.ndarray, "n"], step: float) -> float:
    """How much of all values lies in few bins."""
    low, high = np.quantile(values, [0.005, 0.995])
    counts, _ = np.histogram(values, np.arange(low - 0.1, high + 0.1 + step, step))
    return float((counts.astype(float) ** 2).sum()) / max(len(values), 1) ** 2
