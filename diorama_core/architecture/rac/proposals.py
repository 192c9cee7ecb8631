"""Planes that the picture shows: planar pieces of measured depth that no object hides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from diorama_core.architecture.plainrecon.clusters import planar_clusters
from diorama_core.architecture.walls.surface import MeasuredSurface
from diorama_core.geometry.planes import ransac_plane
from diorama_core.scene.types import PlaneRole

MAX_PLANES = 7
UP_COSINE = 0.7
PLANE_M = 0.05
SAME_COSINE, SAME_M = float(np.cos(np.deg2rad(10.0))), 0.15
"""Pieces as parallel and as near as this are of one plane, parted by furniture."""


@dataclass(frozen=True, eq=False)
class Proposals:
    """Planes that the picture shows."""

    normals: Float[np.ndarray, "p 3"]
    """Unit, world, toward the camera."""
    offsets: Float[np.ndarray, "p"]
    segment: Int[np.ndarray, "n"]
    """The plane of each measured point; -1 for objects and crumbs."""

    def role(self, plane: int) -> PlaneRole:
        """What a plane is by the upward part of its normal."""
        upward = float(self.normals[plane, 2])
        if upward > UP_COSINE:
            return "floor"
        return "ceiling" if upward < -UP_COSINE else "wall"


def proposals(surface: MeasuredSurface, seed: int = 0) -> Proposals:
    """Planar pieces of what no object hides; pieces of one plane are one, the largest planes are kept."""
    free = ~surface.is_object & (surface.normals != 0).any(axis=1)
    labels = np.full(len(free), -1)
    labels[free] = planar_clusters(surface.points[free], surface.normals[free], seed)
    normals: list[np.ndarray] = []
    offsets: list[float] = []
    segment = np.full(len(free), -1)
    sizes = np.bincount(labels[labels >= 0]) if (labels >= 0).any() else np.zeros(0, int)
    for k in np.argsort(-sizes, kind="stable"):
        member = labels == k
        if sizes[k] < 3:
            continue
        normal, offset, _ = ransac_plane(surface.points[member], PLANE_M)
        if float(normal @ surface.camera_position) < offset:
            normal, offset = -normal, -offset
        same = [
            p
            for p in range(len(normals))
            if normals[p] @ normal > SAME_COSINE
            and np.median(np.abs(surface.points[member] @ normals[p] - offsets[p])) < SAME_M
        ]
        if same:
            segment[member] = same[0]
        elif len(normals) < MAX_PLANES:
            segment[member] = len(normals)
            normals.append(normal)
            offsets.append(float(offset))
    return Proposals(np.array(normals).reshape(-1, 3), np.array(offsets), segment)
