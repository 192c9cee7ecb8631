"""Frame, unit and the way up of a scene in a format that promises little, and of points."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.importing.point_cloud import likely_unit
from diorama_core.library.ingest.given import AXES, axis_vector
from diorama_core.library.ingest.models import RawModel

LOWER = 0.85
"""Largest ratio of extents at which the shorter axis is vertical although the format's habit says otherwise."""


def frame_of_scene(raw: RawModel, unit_m: float | None = None) -> tuple[Float[np.ndarray, "4 4"], tuple[str, ...]]:
    """The frame and unit of a room's scene to the world (+Z up, metres), and notes about what had to be guessed.

    Without `unit_m` it is what the format says or the size makes likely.
    """
    promised = max(AXES, key=lambda axis: raw.convention.up.get(axis, 0.0))
    extents = np.asarray(raw.scene.extents, float)
    others = [a for a in ("+y", "+z") if a != promised and raw.convention.up.get(a, 0.0) > 0.05]
    up = next((a for a in others if _extent(extents, a) < LOWER * _extent(extents, promised)), promised)
    corners = np.asarray(raw.scene.to_geometry().vertices, np.float64)
    sure = {u: p for u, p in raw.convention.unit.items() if p > 0.75} if unit_m is None else {unit_m: 1.0}
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


LEVEL_M = 0.02
"""Bin height of the histogram of heights."""
WALL_SHARE = 0.08
"""Share of the plan at its border, ignored because its points belong to walls."""
LEVEL_SHARE = 0.06
"""Share of the height at each end that counts as floor and as ceiling."""
UPSIDE_DOWN = 1.6
"""So many times more things above the middle than below it are a room on its head."""
MAX_ASKED = 200_000


def likely_up(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "3"]:
    """Unit vector against gravity, along an axis of the points.

    Levels (floor, ceiling, boards) are densest across it; furniture fills the lower half of a room more than the upper.
    """
    asked = points[:: max(1, -(-len(points) // MAX_ASKED))]
    axis = max((2, 1), key=lambda a: sharpness(asked[:, a], LEVEL_M))
    low, high = np.quantile(asked, [0.01, 0.99], axis=0)
    share = (asked - low) / np.maximum(high - low, 1e-9)
    plan = np.delete(share, axis, axis=1)
    inner = ((plan > WALL_SHARE) & (plan < 1 - WALL_SHARE)).all(axis=1)
    height = share[inner, axis]
    below = int(((height > LEVEL_SHARE) & (height < 0.5)).sum())
    above = int(((height > 0.5) & (height < 1 - LEVEL_SHARE)).sum())
    up = np.zeros(3)
    up[axis] = -1.0 if above > UPSIDE_DOWN * max(below, 1) else 1.0
    return up


def sharpness(values: Float[np.ndarray, "n"], step: float) -> float:
    """How much of all values lies in few bins."""
    low, high = np.quantile(values, [0.005, 0.995])
    counts, _ = np.histogram(values, np.arange(low - 0.1, high + 0.1 + step, step))
    return float((counts.astype(float) ** 2).sum()) / max(len(values), 1) ** 2
