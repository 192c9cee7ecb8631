"""Shapes with a left and a right: a desk with drawers at one side, a corner sofa."""

from __future__ import annotations

import numpy as np
import trimesh

from diorama_core.library.catalogue import base_id
from diorama_core.library.furniture.measures import mirror_image
from diorama_core.library.record import BUILT_IN, ShapeLibrary, record_of

MIN_UNEVEN = 0.1
"""From which on a shape is uneven enough to be told from its mirror image."""


def unevenness(mesh: trimesh.Trimesh) -> float:
    """How far a shape's left and right differ, 0 to 1: the largest moment of its surface that changes sign with y."""
    points, areas = mesh.triangles_center - mesh.bounds.mean(axis=0), mesh.area_faces
    x, y, z = (points / np.maximum(0.5 * np.ptp(mesh.bounds, axis=0), 1e-9)).T
    moments = np.stack([y, y * z, y * x, y**3]) @ areas / max(float(areas.sum()), 1e-12)
    return float(np.abs(moments).max())


def other_hand(library: ShapeLibrary, shape_id: str) -> str | None:
    """The shape with left and right changed; None where it has none, or is no built-in design."""
    if record_of(library, base_id(shape_id)).source != BUILT_IN or unevenness(library.mesh(shape_id)) < MIN_UNEVEN:
        return None
    return mirror_image(shape_id)
