"""Telling circles from other convex outlines."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

_CIRCLE = 0.975
"""Isoperimetric quotient (4 pi area / perimeter squared) above which a convex outline is a circle: of a square .79."""
_AS_WIDE_AS_DEEP = 1.03
"""Ratio of the sides of a box around what may still be a circle."""
_MIN_POINTS = 8


def is_circle(points_xy: Float[np.ndarray, "n 2"]) -> bool:
    """Whether the convex outline of points of a plane is about a circle, not an ellipse."""
    if len(points_xy) < _MIN_POINTS:
        return False
    extent = np.ptp(points_xy, axis=0)
    if extent.min() <= 0.0 or extent.max() > _AS_WIDE_AS_DEEP * extent.min():
        return False
    try:
        hull = ConvexHull(points_xy)
    except QhullError:
        return False
    area, perimeter = hull.volume, hull.area  # of plane hulls
    return bool(4.0 * np.pi * area > _CIRCLE * perimeter**2)
