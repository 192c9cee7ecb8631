"""The vector product without `numpy.cross`'s overhead, for inner loops on small arrays."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def cross(a: Float[np.ndarray, "*#n 3"], b: Float[np.ndarray, "*#n 3"]) -> Float[np.ndarray, "*_ 3"]:
    """a x b over the last axis, broadcasting."""
    if a.ndim == 1 and b.ndim == 1:
        p0, p1, p2 = a.tolist()
        q0, q1, q2 = b.tolist()
        return np.array([p1 * q2 - p2 * q1, p2 * q0 - p0 * q2, p0 * q1 - p1 * q0])
    x0, x1, x2 = a[..., 0], a[..., 1], a[..., 2]
    y0, y1, y2 = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([x1 * y2 - x2 * y1, x2 * y0 - x0 * y2, x0 * y1 - x1 * y0], axis=-1)
