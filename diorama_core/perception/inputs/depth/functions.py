"""What the numbers of a depth map may be a function of: how they and inverse depth become one another."""

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

    def of_larger(self, factor: float) -> DepthFunction:
        """The function of numbers that are so many times as large."""
        rate = None if self.rate is None else self.rate / factor
        return DepthFunction(self.power, self.offset * factor, rate)


DEPTH, ROOT, INVERSE = DepthFunction(), DepthFunction(power=2.0), DepthFunction(power=-1.0)
"""Depth itself, its square root, and its inverse."""
