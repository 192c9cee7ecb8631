"""PlainRecon as published (Diorama, section 3.1 and supplement): the baseline beside `from_depth.PlanarRoom`.

It reads the measured depth of what no object hides; the publication reads a network's depth of an inpainted picture.
As published it gives floor and walls only: what faces down is left out.

ACDC's architecture (Dai et al. 2024), as planes as Diorama's supplement does to compare with it, has the same pieces:
its publication's come from a network that is asked for "floor" and "wall". Each is bounded by the smallest rectangle,
walls square to the floor. Nothing is joined and nothing reaches behind furniture.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.architecture.plainrecon.bounds import PlaneSheet, counter_clockwise, fit_sheet, join_walls, upright
from diorama_core.architecture.plainrecon.clusters import MIN_POINTS, planar_clusters
from diorama_core.architecture.supports import resolve_supports
from diorama_core.architecture.texture.colours import colour_planes, object_pixels
from diorama_core.architecture.walls.closed_room import GUESS_CONFIDENCE
from diorama_core.architecture.walls.surface import MeasuredSurface, measure_surface
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod, RoomSource
from diorama_core.scene.types import Architecture, Plane

UP_COSINE = 0.7
"""A cluster whose mean normal is at least so much upward may be the floor; so much downward, it is a ceiling."""
CONFIDENCE = 0.6
ASSUMED_FLOOR_M = 3.0


@dataclass(frozen=True)
class PlainRecon:
    """Voxels, outliers, K-means on normals, growth, DBSCAN; RANSAC planes, smallest rectangles, joined corners."""

    seed: int = 0
    method: RoomMethod = RoomMethod.PLAINRECON
    """With `RoomMethod.ACDC` walls are not joined."""

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Floor and walls; an assumed floor below the camera when none is found.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.ArchitectureStage`.

        Raises:
            ValueError: when the inputs hold no measured depth.
        """
        if inputs.depth_m is None:
            raise ValueError(f"the room of {self.method.value} needs measured depth; use PhotoRoom for a photo alone")
        progress.report(0.0, "Clustering the measured points by their normals")
        hidden = object_pixels((inputs.photo.height, inputs.photo.width), objects)
        floor, pieces = floor_and_walls(measure_surface(inputs.depth_m, geometry.camera, hidden), self.seed)
        progress.report(0.7, "Bounding the planes")
        base = default_floor(geometry.camera.position) if floor is None else floor
        walls = [upright(piece, base) for piece in pieces]
        walls = walls if self.method is RoomMethod.ACDC else join_walls(base, walls)
        planes = [plane_of("floor", base, GUESS_CONFIDENCE if floor is None else CONFIDENCE)]
        planes += [plane_of(f"wall_{k}", w, CONFIDENCE) for k, w in enumerate(walls, 1)]
        architecture = Architecture(colour_planes(tuple(planes), inputs.photo.rgb, geometry.camera, objects))
        progress.report(1.0, "Floor and walls are bounded")
        return ArchitectureEstimate(
            architecture=architecture,
            supports=resolve_supports(geometry, architecture),
            confidence=float(np.mean([p.confidence for p in architecture.planes])),
            source=RoomSource(self.method, walls_found=len(walls), floor_found=floor is not None),
        )


def floor_and_walls(surface: MeasuredSurface, seed: int = 0) -> tuple[PlaneSheet | None, list[PlaneSheet]]:
    """A rectangle around every planar piece that stands, and around the largest one that is level and looks up."""
    free = ~surface.is_object & (surface.normals != 0).any(axis=1)
    points, normals = surface.points[free], surface.normals[free]
    labels = planar_clusters(points, normals, seed)
    sizes = np.bincount(labels[labels >= 0], minlength=1)
    facing = [float(normals[labels == k][:, 2].mean()) if sizes[k] else 0.0 for k in range(len(sizes))]
    level = [k for k in range(len(sizes)) if facing[k] > UP_COSINE]
    standing = [k for k in range(len(sizes)) if abs(facing[k]) <= UP_COSINE and sizes[k] >= MIN_POINTS]

    def sheet(k: int) -> PlaneSheet:
        return fit_sheet(points[labels == k], surface.camera_position)

    floor = sheet(max(level, key=lambda k: int(sizes[k]))) if level else None
    return floor, [sheet(k) for k in standing]


def default_floor(eye: Float[np.ndarray, "3"]) -> PlaneSheet:
    """A square of floor at height 0 around the camera."""
    reach = ASSUMED_FLOOR_M * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    corners = np.concatenate([eye[:2] + reach, np.zeros((4, 1))], axis=1)
    return PlaneSheet(np.array([0.0, 0.0, 1.0]), 0.0, corners)


def plane_of(name: str, sheet: PlaneSheet, confidence: float) -> Plane:
    """The sheet as a plane of the room, a wall unless it is called "floor".

    Corners counter-clockwise seen from inside; a wall starts at its lower left.
    """
    corners = counter_clockwise(sheet.corners, sheet.normal)
    if name != "floor":
        # Lower left seen from inside: lowest together with least along.
        along = np.cross([0.0, 0.0, 1.0], sheet.normal)
        corners = np.roll(corners, -int((corners @ along + corners[:, 2]).argmin()), axis=0)
    return Plane(name, "floor" if name == "floor" else "wall", corners, confidence=confidence)
