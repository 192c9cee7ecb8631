"""Where objects touch what holds them up: the points of a shape near its contact face.

A round table stands within a floor that the corners of its box overhang; a lamp stands on its base, not on its shade.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.convex import ConvexPart
from diorama_core.geometry.vectors import unique_rows
from diorama_core.scene.types import box_corners

CONTACT_SHARE = 0.03
"""What is within this share of a shape's depth from its contact face touches what holds it up."""


def footing_of(parts: Sequence[ConvexPart], contact: Float[np.ndarray, "3"]) -> Float[np.ndarray, "k 3"]:
    """Points of convex parts (object frame) near the face with outward normal `contact`, flattened onto its plane."""
    points = np.concatenate([part.vertices for part in parts])
    along = points @ contact
    near = along >= along.max() - CONTACT_SHARE * np.ptp(along)
    return _distinct(points[near] * (1.0 - np.abs(contact)))


def box_footing(size_m: Float[np.ndarray, "3"], contact: Float[np.ndarray, "3"]) -> Float[np.ndarray, "k 3"]:
    """The corners of a box's contact face, flattened onto its plane."""
    return _distinct(box_corners(size_m) * (1.0 - np.abs(contact)))


def _distinct(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "k 3"]:
    return points[unique_rows(points)[0]]


def reach_of(
    footing: Float[np.ndarray, "k 3"],
    R: Float[np.ndarray, "3 3"],
    scale: Float[np.ndarray, "3"],
    outward: Float[np.ndarray, "s 3"],
) -> Float[np.ndarray, " s"]:
    """How far a footing reaches from the centre of the contact face along each outward direction (world), metres.

    Args:
        footing: points at scale 1, object frame.
        R: rotation of the object.
        scale: along its axes.
        outward: unit directions, world.
    """
    return (outward @ (R @ (footing * scale).T)).max(axis=1)
