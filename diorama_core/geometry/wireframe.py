"""Edges of boxes and planes as a camera sees them."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.projection import NEAR_M, edges_of_cuboid
from diorama_core.scene.types import Camera, Plane


def box_edges(corners_world: Float[np.ndarray, "8 3"]) -> Float[np.ndarray, "12 2 3"]:
    """Both ends of a box's edges, of corners in the order of `box_corners`."""
    return corners_world[edges_of_cuboid()]


def plane_edges(plane: Plane) -> Float[np.ndarray, "n 2 3"]:
    """Both ends of the edges of a plane's polygon."""
    return np.stack([plane.polygon, np.roll(plane.polygon, -1, axis=0)], axis=1)


def seen_segments(camera: Camera, edges_world: Iterable[Float[np.ndarray, "_ 2 3"]]) -> Float[np.ndarray, "k 2 2"]:
    """Segments in pixels, cut where they come too near the camera; those all behind it are left out."""
    ends = np.concatenate([np.empty((0, 2, 3)), *edges_world])
    depth = camera.to_camera(ends)[..., 2]
    kept = depth.max(axis=1) > NEAR_M
    ends, depth = ends[kept], depth[kept]
    rows, behind = np.arange(len(ends)), depth.argmin(axis=1)
    low, high = depth[rows, behind], depth[rows, 1 - behind]
    share = np.where(low < NEAR_M, (NEAR_M - low) / np.maximum(high - low, 1e-9), 0.0)
    ends[rows, behind] += share[:, None] * (ends[rows, 1 - behind] - ends[rows, behind])
    return camera.project(ends)
