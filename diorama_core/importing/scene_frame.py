"""Frame and unit of a scene in a format that promises little: rooms are lower than they are wide, and about as high."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.importing.cloud_units import likely_unit
from diorama_core.library.ingest.given import AXES, axis_vector
from diorama_core.library.ingest.models import RawModel

LOWER = 0.85
"""Largest ratio of extents at which the shorter axis is vertical although the format's habit says otherwise."""


def frame_of_scene(raw: RawModel) -> tuple[Float[np.ndarray, "4 4"], tuple[str, ...]]:
    """The file's frame and unit to the world (+Z up, metres), and notes about what had to be guessed.

    Args:
        raw: A scene of a room, not a single model.
    """
    promised = max(AXES, key=lambda axis: raw.convention.up.get(axis, 0.0))
    extents = np.asarray(raw.scene.extents, float)
    others = [a for a in ("+y", "+z") if a != promised and raw.convention.up.get(a, 0.0) > 0.05]
    up = next((a for a in others if _extent(extents, a) < LOWER * _extent(extents, promised)), promised)
    corners = np.asarray(raw.scene.to_geometry().vertices, np.float64)
    sure = {u: p for u, p in raw.convention.unit.items() if p > 0.75}
    unit = likely_unit(corners, axis_vector(up).astype(float))
    metres = next(iter(sure)) if sure else unit.metres
    z = axis_vector(up).astype(float)
    x = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.5 else np.array([0.0, 1.0, 0.0])
    T = np.eye(4)
    T[:3, :3] = np.stack([x, np.cross(z, x), z]) * metres
    notes = [] if up == promised else [f"its up was taken for {up}: so the room is lower than it is wide"]
    notes += [f"lengths were taken for {unit.name}"] if not sure and metres != 1.0 else []
    return T, tuple(notes)


def _extent(extents: Float[np.ndarray, "3"], axis: str) -> float:
    return float(extents["xyz".index(axis[1])])
