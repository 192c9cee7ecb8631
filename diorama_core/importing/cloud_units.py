"""In which unit a point cloud is that does not say it: rooms are about as high and as large everywhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

HEIGHT_M, HEIGHT_LOG_SIGMA = 2.6, 0.3
WIDTH_M, WIDTH_LOG_SIGMA = 4.5, 0.8
"""Size of a room: its height, and the square root of its floor's area."""
BINS = 150
"""Number of bins of the histogram that tells levels from other axes."""


@dataclass(frozen=True)
class Unit:
    """A unit of length."""

    name: str
    metres: float
    share: float
    """Prior probability among the clouds that do not state their unit."""


UNITS = (
    Unit("metres", 1.0, 0.9),
    Unit("centimetres", 0.01, 0.03),
    Unit("millimetres", 0.001, 0.04),
    Unit("feet", 0.3048, 0.02),
    Unit("inches", 0.0254, 0.01),
)


def likely_unit(points: Float[np.ndarray, "n 3"], up: Float[np.ndarray, "3"] | None) -> Unit:
    """The unit in which the points are most likely a room.

    Args:
        points: in that unit.
        up: against gravity, along an axis; None where it is not known.
    """
    low, high = np.quantile(points, [0.005, 0.995], axis=0)
    extent = np.maximum(high - low, 1e-9)
    if up is not None:
        axis = int(np.argmax(np.abs(up)))
    else:
        axis = max((2, 1), key=lambda a: _level_share(points[:, a], float(low[a]), float(high[a])))
    width = float(np.sqrt(np.prod(np.delete(extent, axis))))
    return max(UNITS, key=lambda unit: _log_likelihood(unit, float(extent[axis]), width))


def _log_likelihood(unit: Unit, height: float, width: float) -> float:
    off = np.log(unit.metres * height / HEIGHT_M) / HEIGHT_LOG_SIGMA
    across = np.log(unit.metres * width / WIDTH_M) / WIDTH_LOG_SIGMA
    return float(np.log(unit.share) - (off**2 + across**2) / 2)


def _level_share(values: Float[np.ndarray, "n"], low: float, high: float) -> float:
    """How much of all values lies in few bins."""
    if high <= low:
        return 1.0
    counts, _ = np.histogram(values, BINS, (low, high))
    return float(((counts / max(counts.sum(), 1)) ** 2).sum())
