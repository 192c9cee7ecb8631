"""Render and compare, after Stekovic et al. 2020: planes are proposed, and a set of polygons is searched that fills the
picture and agrees best with depth and segments.

The publication's planar segments and classes come from networks; here they are the planar pieces of measured depth
that no object hides, found as PlainRecon finds them. Costs are the publication's two: a layout's depth should be that
which is measured where the room is seen and nowhere in front of the objects, and its segments should be those of the
picture. What is left out is the later refinement by planes that nothing shows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float, Int
from shapely.geometry import MultiPolygon, Polygon

from diorama_core.architecture.plainrecon.clusters import planar_clusters
from diorama_core.architecture.rac.arrangement import Arrangement, arrangement, inverse_depths
from diorama_core.architecture.rac.search import borders_of, labelled
from diorama_core.architecture.supports import resolve_supports
from diorama_core.architecture.texture.colours import coloured, object_pixels
from diorama_core.architecture.walls.surface import MeasuredSurface, measured_surface
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.errors import InputError
from diorama_core.geometry.planes import ransac_plane
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod, RoomSource
from diorama_core.scene.types import Architecture, Camera, Plane, PlaneRole

MAX_PLANES = 7
UP_COSINE = 0.7
PLANE_M = 0.05
SAME_COSINE, SAME_M = float(np.cos(np.deg2rad(10.0))), 0.15
"""Pieces as parallel and as near as this are of one plane, parted by furniture."""
FULL_DISAGREEMENT = 0.2
"""Relative difference of depth that counts in full."""
SEGMENT_WEIGHT = 0.5
"""Of a pixel in another plane's segment, beside one with the wrong depth."""
CONFIDENCE = 0.6
MIN_REGION_PX = 40.0


@dataclass(frozen=True, eq=False)
class Proposals:
    """Planes that the picture shows."""

    normals: Float[np.ndarray, "p 3"]
    """Unit, world, toward the camera."""
    offsets: Float[np.ndarray, "p"]
    segment: Int[np.ndarray, "n"]
    """The plane of each measured point; -1 for objects and crumbs."""


@dataclass(frozen=True)
class RenderAndCompareRoom:
    """Planes from depth; a discrete search for the polygons that explain the picture."""

    seed: int = 0

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Floor, walls and ceiling as far as the picture shows them.

        Raises:
            ValueError: when the inputs hold no measured depth.
            InputError: when no set of polygons fills the picture, or none of them is a floor.
        """
        if inputs.depth_m is None:
            raise ValueError("render and compare needs measured depth; use PhotoRoom for a photo alone")
        progress.report(0.0, "Proposing planes")
        camera = geometry.camera
        hidden = object_pixels((inputs.photo.height, inputs.photo.width), objects)
        surface = measured_surface(inputs.depth_m, camera, hidden)
        found = proposals(surface, self.seed)
        progress.report(0.3, "Comparing rendered layouts with the picture")
        cells = arrangement(
            inverse_depths(found.normals, found.offsets, camera), (camera.intrinsics.width, camera.intrinsics.height)
        )
        chosen = labelled(cell_costs(cells, surface, found, camera), borders_of(cells))
        if chosen is None:
            raise InputError("render and compare found no layout that fills the picture; use --room closed")
        planes = polygons(cells, chosen, found, camera)
        if not any(p.role == "floor" for p in planes):
            raise InputError("render and compare found no floor in the picture; use --room closed")
        architecture = Architecture(coloured(planes, inputs.photo.rgb, camera, objects))
        progress.report(1.0, "The layout is found")
        walls = len(architecture.by_role("wall"))
        return ArchitectureEstimate(
            architecture=architecture,
            supports=resolve_supports(geometry, architecture),
            confidence=CONFIDENCE,
            source=RoomSource(RoomMethod.RENDER_AND_COMPARE, walls_found=walls, floor_found=True),
        )


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


def cell_costs(
    cells: Arrangement, surface: MeasuredSurface, found: Proposals, camera: Camera
) -> Float[np.ndarray, "c p"]:
    """Disagreement of each plane in each cell, in shares of the picture; infinite behind the camera."""
    pixels = camera.project(surface.points)
    cell = cells.holds(pixels)
    measured = 1.0 / np.maximum(surface.depth_m, 1e-6)
    costs = np.zeros((len(cells.cells), len(cells.inverse)))
    for p in range(len(cells.inverse)):
        q = cells.inverse_at(p, pixels)
        off = (q - measured) / measured
        # What hides the layout bounds it from one side only.
        wrong = np.where(surface.is_object, np.maximum(off, 0.0), np.abs(off))
        each = np.minimum(wrong / FULL_DISAGREEMENT, 1.0)
        each = each + SEGMENT_WEIGHT * ((found.segment >= 0) & (found.segment != p))
        inside = cell >= 0
        costs[:, p] = np.bincount(cell[inside], each[inside], minlength=len(cells.cells))
        behind = [float(cells.inverse_at(p, c.corners.mean(axis=0, keepdims=True))[0]) <= 0.0 for c in cells.cells]
        costs[np.array(behind, dtype=bool), p] = np.inf
    return costs / max(len(pixels), 1)


def polygons(cells: Arrangement, chosen: tuple[int, ...], found: Proposals, camera: Camera) -> tuple[Plane, ...]:
    """The cells of every plane as one polygon in space; of pieces that do not touch, the largest."""
    planes: list[Plane] = []
    for p in range(len(cells.inverse)):
        own = [
            Polygon(c.corners).buffer(0.01, join_style="mitre")
            for c, k in zip(cells.cells, chosen, strict=True)
            if k == p
        ]
        if not own:
            continue
        union = shapely.unary_union(own)
        region = max(union.geoms, key=lambda g: g.area) if isinstance(union, MultiPolygon) else union
        if region.area < MIN_REGION_PX:
            continue
        outline = np.array(shapely.simplify(region, 0.05).exterior.coords)[:-1]
        role = _role(float(found.normals[p, 2]))
        number = sum(q.role == role for q in planes)
        if role != "wall" and number:
            continue
        name = f"wall_{number + 1}" if role == "wall" else role
        corners = _in_space(outline, cells.inverse_at(p, outline), camera)
        planes.append(Plane(name, role, _inward(corners, found.normals[p]), confidence=CONFIDENCE))
    return tuple(sorted(planes, key=lambda plane: ("floor", "wall", "ceiling").index(plane.role)))


def _role(upward: float) -> PlaneRole:
    """What a plane is by the upward part of its normal."""
    if upward > UP_COSINE:
        return "floor"
    return "ceiling" if upward < -UP_COSINE else "wall"


def _in_space(
    pixels: Float[np.ndarray, "n 2"], inverse: Float[np.ndarray, "n"], camera: Camera
) -> Float[np.ndarray, "n 3"]:
    k = camera.intrinsics
    rays = np.stack([(pixels[:, 0] - k.cx) / k.fx, (pixels[:, 1] - k.cy) / k.fy, np.ones(len(pixels))], axis=1)
    return (rays / inverse[:, None]) @ camera.T_world_camera[:3, :3].T + camera.position


def _inward(corners: Float[np.ndarray, "n 3"], normal: Float[np.ndarray, "3"]) -> Float[np.ndarray, "n 3"]:
    area = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    return corners if area @ normal > 0 else corners[::-1]
