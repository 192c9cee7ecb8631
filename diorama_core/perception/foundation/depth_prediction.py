"""Depth from a network, and the stages that go on from it as they would from measured depth."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from diorama_core.artefacts import (
    ArchitectureEstimate,
    CameraEstimate,
    DepthMap,
    DepthPrediction,
    DetectedObject,
    Inputs,
    ObjectGeometry,
    Photo,
)
from diorama_core.models.seen_depth import GeometryNetwork
from diorama_core.perception.camera.estimate import EmbeddedCamera
from diorama_core.perception.depth import fill_depth, render_geometry
from diorama_core.progress import Progress
from diorama_core.provenance import DepthSource, FocalSource
from diorama_core.scene.types import Intrinsics


@dataclass(frozen=True)
class NetworkDepthPrediction:
    """Reads a photo's depth with MoGe-2 or Metric3D v2."""

    network: GeometryNetwork

    def predict(self, photo: Photo, intrinsics: Intrinsics | None, progress: Progress) -> DepthPrediction:
        """Depth, normals and intrinsics; given intrinsics are not replaced.

        Args:
            photo, intrinsics, progress: as documented in `protocols.DepthPredictionStage`.
        """
        progress.report(0.0, "Reading depth from the photo")
        seen = self.network.predict(photo.rgb, intrinsics)
        return DepthPrediction(seen.depth_m, seen.normals_camera, seen.intrinsics)


def with_depth(inputs: Inputs, seen: DepthPrediction) -> Inputs:
    """The inputs with the predicted depth as measured depth, marked with its source."""
    return replace(
        inputs,
        depth_m=seen.depth_m,
        normals_camera=seen.normals_camera,
        intrinsics=inputs.intrinsics or seen.intrinsics,
        depth_source=DepthSource.NETWORK,
    )


@dataclass(frozen=True)
class NetworkCamera:
    """Gravity and height from a network's depth, read as measured depth is."""

    reader: EmbeddedCamera = field(default_factory=EmbeddedCamera)

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        """The readings of one photo, best first."""
        estimate = self.reader.estimate(inputs, progress)
        if estimate.source.focal is not FocalSource.GIVEN:
            return estimate
        return replace(estimate, source=replace(estimate.source, focal=FocalSource.NETWORK))


@dataclass(frozen=True)
class NetworkDepth:
    """The network's map; what it left open is rendered from the room and the cuboids."""

    def depth(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        architecture: ArchitectureEstimate,
        progress: Progress,
    ) -> DepthMap:
        """Depth and normals of every pixel.

        Args:
            inputs, objects, geometry, architecture, progress: as documented in `protocols.DepthStage`.

        Raises:
            ValueError: when the inputs hold no depth.
        """
        if inputs.depth_m is None or inputs.normals_camera is None:
            raise ValueError("NetworkDepth needs depth and normals from a network; use RenderedDepth without them")
        progress.report(0.0, "Filling holes of the depth")
        rendered = render_geometry(geometry, objects, architecture.architecture)
        return fill_depth(inputs.depth_m, inputs.normals_camera, geometry.camera, rendered, DepthSource.NETWORK)
