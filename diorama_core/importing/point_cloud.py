"""Measured points in metres, the pictures that were taken with them, and frame, unit and the way up of a scene.

Where a file does not say its unit, rooms do: they are about as high and as large everywhere.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial import cKDTree

from diorama_core.library.ingest.given import AXES, axis_vector
from diorama_core.library.ingest.models import RawModel
from diorama_core.scene.types import Camera

MAX_POINTS = 4_000_000
"""More are thinned out evenly."""
MIN_POINTS = 2000
ASKED = 2000
"""Points by which the usual distance to the next one is told."""
ALONE, FEW = 12.0, 2
"""So many usual distances around a point with no more than a few others, it floats alone."""
MAX_ALONE, NOTED_ALONE = 0.1, 0.002
"""Shares of the points: more are a thin scan, fewer are not worth a note."""
MESH_POINTS_M2 = 1500.0
"""Points that stand for a square metre of a mesh."""
GUESSED = "lengths were taken for"
"""How a note on a guessed unit begins."""
HEIGHT_M, HEIGHT_LOG_SIGMA = 2.6, 0.3
WIDTH_M, WIDTH_LOG_SIGMA = 4.5, 0.8
"""Size of a room: its height, and the square root of its floor's area."""
BINS = 150
"""Number of bins of the histogram that tells levels from other axes."""
Up = Float[np.ndarray, "3"]


@dataclass(frozen=True, eq=False)
class ScanPhoto:
    """A picture that was taken with the depth beside it."""

    picture: Path
    depth: Path
    """Depth picture of any size, `unit_m` a step."""
    camera: Camera
    """In the world of the points; its intrinsics are the picture's."""
    unit_m: float = 0.001

    def move(self, T_to_from: Float[np.ndarray, "4 4"]) -> ScanPhoto:
        """A copy of the photo in another frame: `p_to = T_to_from @ p_from`, rigid."""
        return replace(self, camera=Camera(self.camera.intrinsics, T_to_from @ self.camera.T_world_camera))


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Points of surfaces, in metres."""

    points: Float[np.ndarray, "n 3"]
    up: Up | None
    """Direction against gravity, where the format says it."""
    notes: tuple[str, ...] = ()
    photos: tuple[ScanPhoto, ...] = ()
    unit_m: float = 1.0
    """Metres that one unit of the file was taken for."""

    def to_unit(self, unit_m: float) -> PointCloud:
        """The cloud of a file whose unit is known to be another."""
        factor = unit_m / self.unit_m
        notes = tuple(note for note in self.notes if not note.startswith(GUESSED))
        photos = tuple(_scale(photo, factor) for photo in self.photos)
        return replace(self, points=self.points * factor, notes=notes, photos=photos, unit_m=unit_m)


def _scale(photo: ScanPhoto, factor: float) -> ScanPhoto:
    T = photo.camera.T_world_camera.copy()
    T[:3, 3] *= factor
    return replace(photo, camera=Camera(photo.camera.intrinsics, T), unit_m=photo.unit_m * factor)


def to_metres(cloud: PointCloud) -> PointCloud:
    """The cloud of a format that does not say its unit, without points that float alone."""
    finite = cloud.points[np.isfinite(cloud.points).all(axis=1)]
    if not len(finite):
        return cloud
    together, notes = without_floaters(finite)
    unit = likely_unit(together, cloud.up)
    notes = (*cloud.notes, *notes, *unit_note(unit))
    return replace(cloud, points=together * unit.metres, notes=notes, unit_m=unit.metres)


def without_floaters(points: Float[np.ndarray, "n 3"]) -> tuple[Float[np.ndarray, "m 3"], tuple[str, ...]]:
    """Finite points without those that float alone: reflections, dust, and what networks dream up; and the note.

    Args:
        points: finite, in any unit.
    """
    some = points[:: max(1, len(points) // ASKED)]
    nearest = cKDTree(points).query(some, k=[2])[0] if len(points) > 1 else np.zeros(1)
    cell = ALONE * float(np.median(nearest))
    if not cell > 0 or float(np.ptp(points, axis=0).max()) / cell > 1e6:
        return points, ()
    cells, which, counts = np.unique(
        np.floor((points - points.min(axis=0)) / cell).astype(np.int64), axis=0, return_inverse=True, return_counts=True
    )
    crowded = cKDTree(cells[counts > FEW]) if (counts > FEW).any() else None
    if crowded is None:
        return points, ()
    sparse = np.flatnonzero(counts <= FEW)
    # Beside a crowded cell are the edges of surfaces.
    apart = crowded.query(cells[sparse], distance_upper_bound=1.8)[0] > 1.8
    alone = np.isin(which.ravel(), sparse[apart])
    share = float(alone.mean())
    if not 0 < share < MAX_ALONE:
        return points, ()
    note = f"{int(alone.sum())} points that float alone were left out"
    return points[~alone], (note,) if share > NOTED_ALONE else ()


def unit_note(unit: Unit) -> tuple[str, ...]:
    """A line where lengths were not taken for metres."""
    if unit.metres == 1.0:
        return ()
    return (f"{GUESSED} {unit.name}: only so the points are about as large as a room",)


def points_of_mesh(loaded: object) -> Float[np.ndarray, "n 3"]:
    """Vertices of a point cloud; of a mesh, points spread evenly over its faces."""
    if isinstance(loaded, trimesh.Scene):
        loaded = loaded.to_geometry()
    if isinstance(loaded, trimesh.Trimesh) and len(loaded.faces):
        count = int(np.clip(loaded.area * MESH_POINTS_M2, MIN_POINTS, MAX_POINTS))
        return np.asarray(trimesh.sample.sample_surface(loaded, count, seed=20)[0], np.float64)
    return np.asarray(getattr(loaded, "vertices", np.zeros((0, 3))), np.float64).reshape(-1, 3)


@dataclass(frozen=True)
class Unit:
    """A unit of length."""

    name: str
    metres: float
    share: float
    """Prior probability among the clouds that do not state their unit."""


UNITS = (
    Unit("metres", 1.0, 0.9),
    Unit("centimetres", 0.01, 0.03),
    Unit("millimetres", 0.001, 0.04),
    Unit("feet", 0.3048, 0.02),
    Unit("inches", 0.0254, 0.01),
)


def likely_unit(points: Float[np.ndarray, "n 3"], up: Float[np.ndarray, "3"] | None) -> Unit:
    """The unit in which the points are most likely a room; `up` is against gravity, along an axis.

    Args:
        points: in that unit.
        up: against gravity, along an axis; None where it is not known.
    """
    low, high = np.quantile(points, [0.005, 0.995], axis=0)
    extent = np.maximum(high - low, 1e-9)
    if up is not None:
        axis = int(np.argmax(np.abs(up)))
    else:
        axis = max((2, 1), key=lambda a: _level_share(points[:, a], float(low[a]), float(high[a])))
    width = float(np.sqrt(np.prod(np.delete(extent, axis))))
    return max(UNITS, key=lambda unit: _log_likelihood(unit, float(extent[axis]), width))


def _log_likelihood(unit: Unit, height: float, width: float) -> float:
    off = np.log(unit.metres * height / HEIGHT_M) / HEIGHT_LOG_SIGMA
    across = np.log(unit.metres * width / WIDTH_M) / WIDTH_LOG_SIGMA
    return float(np.log(unit.share) - (off**2 + across**2) / 2)


def _level_share(values: Float[np.ndarray, "n"], low: float, high: float) -> float:
    """How much of all values lies in few bins."""
    if high <= low:
        return 1.0
    counts, _ = np.histogram(values, BINS, (low, high))
    return float(((counts / max(counts.sum(), 1)) ** 2).sum())


LOWER = 0.85
"""Largest ratio of extents at which the shorter axis is vertical although the format's habit says otherwise."""


def frame_of_scene(raw: RawModel, unit_m: float | None = None) -> tuple[Float[np.ndarray, "4 4"], tuple[str, ...]]:
    """The frame and unit of a room's scene to the world (+Z up, metres), and notes about what had to be guessed.

    Without `unit_m` it is what the format says or the size makes likely.

    Args:
        raw: A scene of a room, not a single model.
        unit_m: Metres in one unit of the file; None takes what the format says or the size makes likely.
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
