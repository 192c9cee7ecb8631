"""Measured points in metres, and the pictures that were taken with them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.importing.cloud_units import Unit, likely_unit
from diorama_core.scene.types import Camera

MAX_POINTS = 4_000_000
"""More are thinned out evenly."""
MIN_POINTS = 2000
MESH_POINTS_M2 = 1500.0
"""Points that stand for a square metre of a mesh."""
Up = Float[np.ndarray, "3"]


@dataclass(frozen=True, eq=False)
class ScanPhoto:
    """A picture that was taken with the depth beside it."""

    picture: Path
    depth: Path
    """Of any size, `unit_m` a step."""
    camera: Camera
    """In the world of the points; its intrinsics are the picture's."""
    unit_m: float = 0.001

    def moved(self, T_to_from: Float[np.ndarray, "4 4"]) -> ScanPhoto:
        """The same photo in another frame: `p_to = T_to_from @ p_from`, rigid."""
        return replace(self, camera=Camera(self.camera.intrinsics, T_to_from @ self.camera.T_world_camera))


@dataclass(frozen=True, eq=False)
class PointCloud:
    """Points of surfaces, in metres."""

    points: Float[np.ndarray, "n 3"]
    up: Up | None
    """Direction against gravity, where the format says it."""
    notes: tuple[str, ...] = ()
    photos: tuple[ScanPhoto, ...] = ()


def in_metres(cloud: PointCloud) -> PointCloud:
    """The cloud of a format that does not say its unit."""
    finite = cloud.points[np.isfinite(cloud.points).all(axis=1)]
    if not len(finite):
        return cloud
    unit = likely_unit(finite, cloud.up)
    return replace(cloud, points=cloud.points * unit.metres, notes=(*cloud.notes, *unit_note(unit)))


def unit_note(unit: Unit) -> tuple[str, ...]:
    """A line where lengths were not taken for metres."""
    if unit.metres == 1.0:
        return ()
    return (f"lengths were taken for {unit.name}: only so the points are about as large as a room",)


def points_of_mesh(loaded: object) -> Float[np.ndarray, "n 3"]:
    """Vertices of a point cloud; of a mesh, points spread evenly over its faces."""
    if isinstance(loaded, trimesh.Scene):
        loaded = loaded.to_geometry()
    if isinstance(loaded, trimesh.Trimesh) and len(loaded.faces):
        count = int(np.clip(loaded.area * MESH_POINTS_M2, MIN_POINTS, MAX_POINTS))
        return np.asarray(trimesh.sample.sample_surface(loaded, count, seed=20)[0], np.float64)
    return np.asarray(getattr(loaded, "vertices", np.zeros((0, 3))), np.float64).reshape(-1, 3)
