"""How far a mean over rooms can be trusted: bootstrap intervals.

Whole rooms are drawn, since the objects of one room share its camera and its scale.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

import numpy as np

Group = TypeVar("Group")

COVERAGE = 0.9
"""Share of the resampled means that lie within an interval."""
DRAWS = 2000
GROUP_DRAWS = 500
"""Fewer, since a statistic of whole groups is computed anew for every sample."""
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


def statistic_interval(
    groups: Sequence[Group],
    statistic: Callable[[Sequence[Group]], float | None],
    coverage: float = COVERAGE,
    draws: int = GROUP_DRAWS,
) -> Interval | None:
    """The percentile interval of any statistic of groups of objects; None with fewer than two groups. Deterministic.

    Args:
        groups: Drawn whole, such as photos with their objects.
        statistic: Of the groups drawn; draws for which it is None are left out.
        coverage: Share of the resampled statistics within the interval.
        draws: How many samples are drawn.
    """
    values = [statistic([groups[k] for k in drawn]) for drawn in _drawn(len(groups), draws)]
    return _percentiles(values, coverage)


def paired_interval(
    before: Sequence[Group],
    after: Sequence[Group],
    statistic: Callable[[Sequence[Group]], float | None],
    coverage: float = COVERAGE,
    draws: int = GROUP_DRAWS,
) -> Interval | None:
    """The percentile interval of what a statistic changes by, the same groups drawn before and after.

    Args:
        before: Groups of objects, such as photos.
        after: The same groups in the same order.
        statistic: Of the groups drawn; draws for which either is None are left out.
        coverage: Share of the resampled changes within the interval.
        draws: How many samples are drawn.
    """
    values = []
    for drawn in _drawn(len(before), draws):
        old, new = statistic([before[k] for k in drawn]), statistic([after[k] for k in drawn])
        values.append(None if old is None or new is None else new - old)
    return _percentiles(values, coverage)


def _drawn(count: int, draws: int) -> Iterator[list[int]]:
    rng = np.random.default_rng(0)
    return (rng.integers(count, size=count).tolist() for _ in range(draws if count > 1 else 0))


def _percentiles(values: Sequence[float | None], coverage: float) -> Interval | None:
    known = [v for v in values if v is not None]
    if not known:
        return None
    low, high = np.quantile(known, [(1 - coverage) / 2, (1 + coverage) / 2])
    return float(low), float(high)
