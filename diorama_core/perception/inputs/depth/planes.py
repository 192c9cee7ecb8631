"""What the numbers of a depth map may be a function of, and how well they form planes under each reading of what they
are.

In the pixels of a perspective photo a plane's inverse depth is an affine function, whatever the focal length. So the
numbers themselves are piecewise affine where they are inverse depth or disparity (with any offset), their inverses are
where they are depth along the optical axis, the inverses of their squares where they are its square root, and the
inverses of their product with the rays' cosines where they are distances along the rays.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class DepthFunction:
    """Depth in some unit is a power of the numbers, the numbers and a constant, or their exponential."""

    power: float = 1.0
    offset: float = 0.0
    """Added to the numbers first."""
    rate: float | None = None
    """Depth is `exp(rate * number)`; None where it is a power."""

    def inverse_depth(self, numbers: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
        """Reciprocal of positive numbers; affine in the picture on planes."""
        if self.rate is not None:
            return np.asarray(np.exp(-self.rate * numbers))
        return np.asarray((numbers + self.offset) ** -self.power)

    def numbers(self, inverse: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
        """The numbers of inverse depth; infinite where no number stands for it."""
        positive = np.where(inverse > 0, inverse, 1.0)
        if self.rate is not None:
            numbers = -np.log(positive) / self.rate
        else:
            numbers = positive ** (-1.0 / self.power) - self.offset
        return np.where(inverse > 0, numbers, np.inf)

    def scale(self, factor: float) -> DepthFunction:
        """The function of numbers that are so many times as large."""
        rate = None if self.rate is None else self.rate / factor
        return DepthFunction(self.power, self.offset * factor, rate)


DEPTH, ROOT, INVERSE = DepthFunction(), DepthFunction(power=2.0), DepthFunction(power=-1.0)
"""Depth itself, its square root, and its inverse."""


MAX_PLANES = 5
"""Floor, ceiling and three walls are all that one photo of a room shows."""
TRIALS = 220
MAX_POINTS = 2400
TOLERANCES = (0.002, 0.005, 0.012, 0.03)
"""Shares of the numbers' spread within which a number lies on a plane: of exact renderings up to noisy sensors."""
MIN_NEW_SHARE = 0.01
"""Smallest share of the points that a further plane explains."""
_SEED = 7
_ALL = slice(None)
_NEIGHBOURS = 2
"""Pixels around a sampled one whose median it is: a sensor's noise must not hide which reading makes planes."""
_REACH = 0.35
"""Share of the picture's width within which the three points of a trial lie: of one surface, mostly."""


@dataclass(frozen=True, eq=False)
class SampledDepth:
    """Some of a map's measured numbers."""

    x: Float[np.ndarray, "n"]
    """Across, from the middle, in shares of the longer side."""
    y: Float[np.ndarray, "n"]
    """Down, likewise."""
    values: Float[np.ndarray, "n"]
    """As they are stored, positive."""

    @property
    def spread(self) -> float:
        """The range of most values."""
        low, high = np.percentile(self.values, [5, 95])
        return max(float(high - low), 1e-9 * float(abs(high)) + 1e-12)

    def subsample(self, count: int) -> SampledDepth:
        """About so many of them, evenly."""
        step = max(1, len(self.values) // count)
        return SampledDepth(self.x[::step], self.y[::step], self.values[::step])


@dataclass(frozen=True, eq=False)
class PlaneFit:
    """Planes found in a map under one reading."""

    explained: float
    """Share of the points on planes, the mean over the tolerances."""
    planes: Float[np.ndarray, "k 3"]
    """Coefficients of x, y and 1 of the affine functions, largest plane first."""
    shares: Float[np.ndarray, "k"]
    """Share of the points on each plane."""


def sample_depth(values: Float[np.ndarray, "h w"]) -> SampledDepth:
    """Evenly spread positive numbers of a map, each the median of its neighbourhood."""
    height, width = values.shape
    valid = values > 0
    step = max(1, int(np.sqrt(valid.sum() / MAX_POINTS)))
    rows, columns = np.nonzero(valid[step // 2 :: step, step // 2 :: step])
    rows, columns = rows * step + step // 2, columns * step + step // 2
    side = max(height, width)
    x, y = (columns + 0.5 - width / 2) / side, (rows + 0.5 - height / 2) / side
    around = np.arange(-_NEIGHBOURS, _NEIGHBOURS + 1)
    near = (
        np.clip(rows[:, None, None] + around[:, None], 0, height - 1),
        np.clip(columns[:, None, None] + around, 0, width - 1),
    )
    known = np.where(valid[near], values[near].astype(np.float64), np.nan)
    return SampledDepth(x, y, np.nanmedian(known.reshape(len(rows), -1), axis=1))


def planes_of(sample: SampledDepth, function: DepthFunction = DEPTH, trials: int = TRIALS) -> PlaneFit:
    """The planes of a map, one after another, each the best of so many random ones through three points."""
    random = np.random.default_rng(_SEED)
    basis = np.stack([sample.x, sample.y, np.ones_like(sample.x)], axis=1)
    numbers = _Numbers(basis, sample.values, sample.spread, function)
    left = np.ones(len(basis), bool)
    fits, shares, explained = [], [], np.zeros(len(TOLERANCES))
    for _ in range(MAX_PLANES):
        if left.sum() < max(30, MIN_NEW_SHARE * len(left)):
            break
        best = _best_plane(numbers, left, trials, random)
        if best is None:
            break
        plane, off = best
        hits = np.array([(off[left] < t).sum() for t in TOLERANCES]) / len(left)
        if hits.mean() < MIN_NEW_SHARE:
            break
        explained += hits
        fits.append(plane)
        shares.append(float((off[left] < TOLERANCES[-1]).sum() / len(left)))
        left &= off >= TOLERANCES[-1]
    planes = np.array(fits).reshape(-1, 3)
    return PlaneFit(float(explained.mean()), planes, np.array(shares))


@dataclass(frozen=True, eq=False)
class _Numbers:
    """What planes are fitted to."""

    basis: Float[np.ndarray, "n 3"]
    values: Float[np.ndarray, "n"]
    spread: float
    function: DepthFunction

    @property
    def affine(self) -> Float[np.ndarray, "n"]:
        """What is affine on planes."""
        return self.function.inverse_depth(self.values)

    def off(self, planes: Float[np.ndarray, "*k 3"], some: np.ndarray | slice = _ALL) -> Float[np.ndarray, "*k m"]:
        """Residuals of some numbers under planes, in shares of the spread: of all readings in the numbers' own unit."""
        numbers = self.function.numbers(planes @ self.basis[some].T)
        return np.abs(numbers - self.values[some]) / self.spread


def _best_plane(
    numbers: _Numbers, left: np.ndarray, trials: int, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray] | None:
    """The affine function that most of the remaining points lie on, refined, and everybody's distance from it."""
    index, basis, affine = np.flatnonzero(left), numbers.basis, numbers.affine
    first = random.choice(index, trials)
    triples = np.stack([first, *_nearby_points(basis, index, first, random)], axis=1)
    system = basis[triples]
    good = np.abs(np.linalg.det(system)) > 1e-5
    if not good.any():
        return None
    planes = np.linalg.solve(system[good], affine[triples[good]][..., None])[..., 0]
    off = numbers.off(planes, index[:: max(1, len(index) // (2 * trials))])
    plane = planes[int(np.argmax(sum(np.count_nonzero(off < t, axis=1) for t in TOLERANCES)))]
    for tolerance in (TOLERANCES[-1], TOLERANCES[-2], TOLERANCES[-2]):
        near = left & (numbers.off(plane) < tolerance)
        if near.sum() < 12:
            break
        plane = np.linalg.lstsq(basis[near], affine[near], rcond=None)[0]
    return plane, numbers.off(plane)


def _nearby_points(
    basis: np.ndarray, index: np.ndarray, first: np.ndarray, random: np.random.Generator
) -> list[np.ndarray]:
    """Two further points for each first one, of several tries those that are nearest in the picture but not beside."""
    tries = random.choice(index, (2, 6, len(first)))
    distance = np.linalg.norm(basis[tries, :2] - basis[first, :2], axis=-1)
    distance = np.where(distance > _REACH, distance + 1.0, -distance)
    chosen = np.argmin(distance, axis=1)
    return [tries[k, chosen[k], np.arange(len(first))] for k in range(2)]
