"""ACDC's architecture (Dai et al. 2024) as planes as Diorama's supplement does to compare with it.

A plane by RANSAC for each segment of the floor and of walls, the smallest rectangle around what lies on it, walls
square to the floor. Nothing is joined and nothing reaches behind furniture. The publication's segments come from a
network that is asked for "floor" and "wall"; here they are the planar pieces of measured depth that no object hides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.architecture.plainrecon.bounds import upright
from diorama_core.architecture.plainrecon.stage import assumed_floor, floor_and_walls, plane_of
from diorama_core.architecture.supports import resolve_supports
from diorama_core.architecture.texture.colours import coloured, object_pixels
from diorama_core.architecture.walls.closed_room import GUESS_CONFIDENCE
from diorama_core.architecture.walls.surface import measured_surface
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod, RoomSource
from diorama_core.scene.types import Architecture

CONFIDENCE = 0.6


@dataclass(frozen=True)
class AcdcRoom:
    """A rectangle for each segment of floor and walls."""

    seed: int = 0

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Floor and walls; an assumed floor below the camera when none is found.

        Raises:
            ValueError: when the inputs hold no measured depth.
        """
        if inputs.depth_m is None:
            raise ValueError("ACDC's architecture needs measured depth; use PhotoRoom for a photo alone")
        progress.report(0.0, "Fitting a plane to every segment")
        hidden = object_pixels((inputs.photo.height, inputs.photo.width), objects)
        floor, walls = floor_and_walls(measured_surface(inputs.depth_m, geometry.camera, hidden), self.seed)
        base = assumed_floor(geometry.camera.position) if floor is None else floor
        planes = [plane_of("floor", base, GUESS_CONFIDENCE if floor is None else CONFIDENCE)]
        planes += [plane_of(f"wall_{k}", upright(w, base), CONFIDENCE) for k, w in enumerate(walls, 1)]
        architecture = Architecture(coloured(tuple(planes), inputs.photo.rgb, geometry.camera, objects))
        progress.report(1.0, "Floor and walls are fitted")
        return ArchitectureEstimate(
            architecture=architecture,
            supports=resolve_supports(geometry, architecture),
            confidence=float(np.mean([p.confidence for p in architecture.planes])),
            source=RoomSource(RoomMethod.ACDC, walls_found=len(walls), floor_found=floor is not None),
        )
