"""Render and compare, after Stekovic et al. 2020: planes are proposed, and a set of polygons is searched that fills the
picture and agrees best with depth and segments.

The publication's planar segments and classes come from networks; here they are the planar pieces of measured depth
that no object hides, found as PlainRecon finds them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import MultiPolygon, Polygon

from diorama_core.architecture.plainrecon.bounds import counter_clockwise
from diorama_core.architecture.rac.proposals import Proposals, proposals
from diorama_core.architecture.rac.refinement import refine_layout
from diorama_core.architecture.rac.search import RoomLayout, best_layout
from diorama_core.architecture.supports import resolve_supports
from diorama_core.architecture.texture.colours import colour_planes, object_pixels
from diorama_core.architecture.walls.surface import measure_surface
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.errors import InputError
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod, RoomSource
from diorama_core.scene.types import Architecture, Camera, Plane

CONFIDENCE = 0.6
MIN_REGION_PX = 40.0


@dataclass(frozen=True)
class RenderAndCompareRoom:
    """Planes from depth; a discrete search for the polygons that explain the picture."""

    seed: int = 0
    refine: bool = True
    """Whether walls may end at walls that nothing shows, as the publication's later step lets them."""

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Floor, walls and ceiling as far as the picture shows them.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.ArchitectureStage`.

        Raises:
            ValueError: when the inputs hold no measured depth.
            InputError: when no set of polygons fills the picture, or none of them is a floor.
        """
        if inputs.depth_m is None:
            raise ValueError("render and compare needs measured depth; use PhotoRoom for a photo alone")
        progress.report(0.0, "Proposing planes")
        camera = geometry.camera
        hidden = object_pixels((inputs.photo.height, inputs.photo.width), objects)
        surface = measure_surface(inputs.depth_m, camera, hidden)
        proposed = proposals(surface, self.seed)
        progress.report(0.3, "Comparing rendered layouts with the picture")
        layout = best_layout(surface, proposed, camera)
        if layout is None:
            raise InputError("render and compare found no layout that fills the picture; use --room closed")
        if self.refine:
            progress.report(0.6, "Ending walls where the picture looks past them")
            layout = refine_layout(layout, surface, proposed, camera)
        planes = polygons(layout, proposed, camera)
        if not any(p.role == "floor" for p in planes):
            raise InputError("render and compare found no floor in the picture; use --room closed")
        architecture = Architecture(colour_planes(planes, inputs.photo.rgb, camera, objects))
        progress.report(1.0, "The layout is found")
        walls = len(architecture.by_role("wall"))
        return ArchitectureEstimate(
            architecture=architecture,
            supports=resolve_supports(geometry, architecture),
            confidence=CONFIDENCE,
            source=RoomSource(RoomMethod.RENDER_AND_COMPARE, walls_found=walls, floor_found=True),
        )


def polygons(layout: RoomLayout, proposals: Proposals, camera: Camera) -> tuple[Plane, ...]:
    """The cells of every plane as one polygon in space; of pieces that do not touch, the largest."""
    planes: list[Plane] = []
    cells = layout.cells
    for p in range(len(cells.inverse)):
        lines = [
            Polygon(c.corners).buffer(0.01, join_style="mitre")
            for c, k in zip(cells.cells, layout.chosen, strict=True)
            if k == p
        ]
        if not lines:
            continue
        union = shapely.unary_union(lines)
        region = max(union.geoms, key=lambda g: g.area) if isinstance(union, MultiPolygon) else union
        if region.area < MIN_REGION_PX:
            continue
        outline = np.array(shapely.simplify(region, 0.05).exterior.coords)[:-1]
        role = proposals.role(p)
        number = sum(q.role == role for q in planes)
        if role != "wall" and number:
            continue
        name = f"wall_{number + 1}" if role == "wall" else role
        corners = camera.rays(outline) / cells.inverse_at(p, outline)[:, None] + camera.position
        polygon = counter_clockwise(corners, proposals.normals[p])
        planes.append(Plane(name, role, polygon, confidence=CONFIDENCE))
    return tuple(sorted(planes, key=lambda plane: ("floor", "wall", "ceiling").index(plane.role)))
