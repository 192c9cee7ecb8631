"""The vector product without `numpy.cross`'s overhead, for inner loops on small arrays."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def cross(a: Float[np.ndarray, "*n 3"], b: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    """a x b over the last axis, broadcasting."""
    x0, x1, x2 = a[..., 0], a[..., 1], a[..., 2]
    y0, y1, y2 = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([x1 * y2 - x2 * y1, x2 * y0 - x0 * y2, x0 * y1 - x1 * y0], axis=-1)
