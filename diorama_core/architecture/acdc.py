"""ACDC's architecture (Dai et al. 2024) as planes as Diorama's supplement does to compare with it.

A plane by RANSAC for each segment of the floor and of walls, the smallest rectangle around what lies on it, walls
square to the floor. Nothing is joined and nothing reaches behind furniture. The publication's segments come from a
network that is asked for "floor" and "wall"; here they are the planar pieces of measured depth that no object hides.
"""

from __future__ import annotations

from dataclasses import dataclass

from diorama_core.architecture.plainrecon.bounds import PlaneSheet, upright
from diorama_core.architecture.plainrecon.stage import room_of_pieces
from diorama_core.artefacts import ArchitectureEstimate, DetectedObject, Inputs, ObjectGeometry
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod


@dataclass(frozen=True)
class AcdcRoom:
    """A rectangle for each segment of floor and walls."""

    seed: int = 0

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Floor and walls; an assumed floor below the camera when none is found.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.ArchitectureStage`.

        Raises:
            ValueError: when the inputs hold no measured depth.
        """
        return room_of_pieces(
            inputs, objects, geometry, progress, seed=self.seed, method=RoomMethod.ACDC, bound=_upright_on
        )


def _upright_on(floor: PlaneSheet, walls: list[PlaneSheet]) -> list[PlaneSheet]:
    return [upright(wall, floor) for wall in walls]
