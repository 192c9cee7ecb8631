"""What is known already, as the stages that would otherwise find it: by other photos of the room, or by the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.architecture.supports import resolve_supports
from diorama_core.artefacts import (
    ArchitectureEstimate,
    CameraEstimate,
    CameraHypothesis,
    Cuboid,
    DetectedObject,
    Inputs,
    LayoutReport,
    ObjectGeometry,
)
from diorama_core.perception.metrology.box_observations import gather
from diorama_core.perception.metrology.placement import place_all
from diorama_core.perception.metrology.problem import View
from diorama_core.perception.metrology.stage import supports_of
from diorama_core.progress import Progress
from diorama_core.protocols import Preview
from diorama_core.provenance import CameraSource, RoomMethod, RoomSource, ScaleSource
from diorama_core.scene.types import Architecture, Camera, Scene


def exact_camera_estimate(camera: Camera) -> CameraEstimate:
    """A camera that is known, as the stage that finds it would say it."""
    reading = CameraHypothesis(camera.intrinsics, camera.T_world_camera[:3, :3], 1.0)
    return CameraEstimate((reading,), 1.0, CameraSource.exact(), height_m=float(camera.position[2]))


@dataclass(frozen=True, eq=False)
class GivenCamera:
    """A camera that is known."""

    camera: Camera

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        """The camera."""
        return exact_camera_estimate(self.camera)


@dataclass(frozen=True, eq=False)
class GivenObjects:
    """Objects that were outlined already."""

    objects: tuple[DetectedObject, ...]

    def segment(self, inputs: Inputs, progress: Progress) -> tuple[DetectedObject, ...]:
        """The objects."""
        return self.objects


@dataclass(frozen=True, eq=False)
class GivenCuboids:
    """The cuboids of all photos, with the supports that the photo itself suggests."""

    camera: Camera
    cuboids: tuple[Cuboid, ...]

    def measure(
        self, inputs: Inputs, camera: CameraEstimate, objects: tuple[DetectedObject, ...], progress: Progress
    ) -> ObjectGeometry:
        """The cuboids, and what holds them up as far as the photo tells.

        Args:
            inputs, camera, objects, progress: as documented in `protocols.GeometryStage`.
        """
        observations = gather(objects, inputs.photo.width, inputs.photo.height)
        view = View(self.camera.intrinsics, self.camera.T_world_camera[:3, :3])
        supports = supports_of(place_all(observations, view, float(self.camera.position[2])), objects)
        return ObjectGeometry(self.camera, self.cuboids, supports, ScaleSource.GIVEN, 1.0)


@dataclass(frozen=True, eq=False)
class GivenRoom:
    """A room that several views told, as the stage that finds it."""

    architecture: Architecture
    openings: tuple[str, ...] = ()
    """Objects of the photo that are open doorways."""

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """The room, with what the photo's objects stand on and hang from.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.ArchitectureStage`.
        """
        walls = self.architecture.by_role("wall")
        seen = sum(w.is_seen for w in walls)
        source = RoomSource(RoomMethod.SEVERAL_VIEWS, walls_found=seen, walls_assumed=len(walls) - seen)
        sure = float(np.mean([w.confidence for w in walls])) if walls else 0.0
        supports = resolve_supports(geometry, self.architecture)
        return ArchitectureEstimate(self.architecture, supports, sure, source, self.openings)


@dataclass(frozen=True)
class AsObserved:
    """No layout: the scene as the photo shows it."""

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        """The scene as it is."""
        return scene, LayoutReport("none", {}, {}, 0.0)
