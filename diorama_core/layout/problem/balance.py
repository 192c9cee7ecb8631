"""Where objects balance: one whose centre of mass is above its support stands, although its foot reaches beyond."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from diorama_core.geometry.packed_parts import Parts
from diorama_core.io.cache import LruCache

HELD = 0.5
"""Share of the way from where an object balances to the edge of its foot that must be held up."""

_CENTRES: LruCache[str, Float[np.ndarray, "3"]] = LruCache(4096)


def bearing_of(
    footing: Float[np.ndarray, "k 3"], contact: Float[np.ndarray, "3"], balance: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "k 3"]:
    """The points of a footing's plane that must be held up, for the object to stand safely.

    Args:
        footing: points that touch the supporter, flattened onto the contact face (object frame).
        contact: outward normal of that face.
        balance: the object's centre of mass.
    """
    above = balance * (1.0 - np.abs(contact))
    return above + HELD * (footing - above)


def centre_of_mass(key: str, parts: Parts) -> Float[np.ndarray, "3"]:
    """Of bodies of one density, in their frame at scale 1.

    Args:
        key: names the shape by its content; empty where it has no name.
        parts: its convex bodies.
    """
    return _CENTRES.get(key, lambda: _centre_of_mass(parts)) if key else _centre_of_mass(parts)


def _centre_of_mass(parts: Parts) -> Float[np.ndarray, "3"]:
    found = [_volume_and_centre(part.vertices) for part in parts]
    volumes, centres = np.array([volume for volume, _ in found]), np.array([centre for _, centre in found])
    return np.asarray(volumes @ centres / volumes.sum()) if volumes.sum() > 0.0 else centres.mean(axis=0)


def _volume_and_centre(points: Float[np.ndarray, "n 3"]) -> tuple[float, Float[np.ndarray, "3"]]:
    """Of a convex hull: the sum over pyramids from its middle to its faces."""
    middle = points.mean(axis=0)
    try:
        corners = points[ConvexHull(points).simplices] - middle
    except (QhullError, ValueError):
        return 0.0, middle
    volumes = np.abs(np.linalg.det(corners)) / 6.0
    return float(volumes.sum()), middle + volumes @ corners.sum(axis=1) / (4.0 * max(float(volumes.sum()), 1e-15))
