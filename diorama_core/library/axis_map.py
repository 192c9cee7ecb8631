"""A piecewise linear map of one axis onto itself: how shapes stretch and boards move."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class AxisMap:
    """A piecewise linear map of one axis onto itself; both ends stay."""

    knots: Float[np.ndarray, "k"]
    values: Float[np.ndarray, "k"]

    def __call__(self, x: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
        """Where coordinates go."""
        return np.interp(x, self.knots, self.values)

    def slope(self, x: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
        """How much lengths grow there."""
        k = np.clip(np.searchsorted(self.knots, x, side="right") - 1, 0, len(self.knots) - 2)
        return np.asarray(np.diff(self.values)[k] / np.maximum(np.diff(self.knots)[k], 1e-12))
