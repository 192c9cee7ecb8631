"""How far a mean over rooms can be trusted: bootstrap intervals.

Whole rooms are drawn, since the objects of one room share its camera and its scale.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

COVERAGE = 0.9
"""Share of the resampled means that lie within an interval."""
DRAWS = 2000
Interval = tuple[float, float]


def bootstrap_interval(
    values: Sequence[float | None], weights: Sequence[float] | None = None, coverage: float = COVERAGE
) -> Interval | None:
    """The percentile interval of a weighted mean over rooms; None with fewer than two values. Deterministic.

    Args:
        values: One per room; None where a room has no value, and such rooms are left out.
        weights: What each room counts, such as its objects; equal by default.
        coverage: Share of the resampled means within the interval.
    """
    known = [k for k, v in enumerate(values) if v is not None and np.isfinite(v)]
    if len(known) < 2:
        return None
    x = np.array([values[k] for k in known], dtype=float)
    w = np.ones(len(known)) if weights is None else np.array([weights[k] for k in known], dtype=float)
    if w.sum() <= 0:
        return None
    drawn = np.random.default_rng(0).integers(len(x), size=(DRAWS, len(x)))
    total = w[drawn].sum(axis=1)
    means = (w * x)[drawn].sum(axis=1)[total > 0] / total[total > 0]
    low, high = np.quantile(means, [(1 - coverage) / 2, (1 + coverage) / 2])
    return float(low), float(high)
