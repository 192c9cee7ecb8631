"""What the numbers of a depth map may be a function of: how they and inverse depth become one another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class DepthFunction:
    """Depth in some unit is a power of the numbers, or their exponential."""

    power: float = 1.0
    rate: float | None = None
    """Depth is `exp(rate * number)`; None where it is a power."""

    def inverse_depth(self, numbers: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
        """Of positive numbers; affine in the picture on planes."""
        return np.asarray(numbers**-self.power if self.rate is None else np.exp(-self.rate * numbers))

    def numbers(self, inverse: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
        """The numbers of inverse depth; infinite where no number stands for it."""
        positive = np.where(inverse > 0, inverse, 1.0)
        found = positive ** (-1.0 / self.power) if self.rate is None else -np.log(positive) / self.rate
        return np.where(inverse > 0, found, np.inf)

    def of_larger(self, factor: float) -> DepthFunction:
        """The function of numbers that are so many times as large."""
        return self if self.rate is None else DepthFunction(rate=self.rate / factor)


DEPTH, ROOT, INVERSE = DepthFunction(), DepthFunction(2.0), DepthFunction(-1.0)
"""Depth itself, its square root, and its inverse."""
