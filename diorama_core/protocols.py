"""One protocol per stage; each has one method and returns a frozen artefact.

```
(Photo -> recognition -> detection, sight ->)
Inputs -> camera -> objects -> object geometry (-> graph) -> architecture -> depth
       -> retrieval -> pose -> Scene -> layout
```

With measured depth, camera and geometry read it; from a photo alone they reason from vanishing points, contact
with the floor and known sizes, and depth is rendered from what they found. A stage carries its settings in its own
frozen fields: `repr(stage)` is part of the cache key.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from diorama_core.artefacts import (
    ArchitectureEstimate,
    CameraEstimate,
    DepthMap,
    DepthPrediction,
    DetectedObject,
    Inputs,
    LabelledBox,
    LayoutReport,
    ObjectGeometry,
    Photo,
    PosedCandidates,
    RankedShapes,
    SceneGraph,
)
from diorama_core.progress import Progress
from diorama_core.scene.types import Intrinsics, Scene


class RecognitionStage(Protocol):
    """What kinds of things are in a photo: words to look for."""

    def recognise(self, photo: Photo, progress: Progress) -> tuple[str, ...]: ...


class DetectionStage(Protocol):
    """Boxes of the things in a photo; `words` are kinds to look for, none where a stage brings its own."""

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]: ...


class DepthPredictionStage(Protocol):
    """Depth, normals and intrinsics that a network reads from a photo."""

    def predict(self, photo: Photo, intrinsics: Intrinsics | None, progress: Progress) -> DepthPrediction: ...


class GraphStage(Protocol):
    """What holds up what, given where things are."""

    def relate(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> SceneGraph: ...


class CameraStage(Protocol):
    """Intrinsics and gravity."""

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate: ...


class ObjectStage(Protocol):
    """A mask for everything that was pointed at or detected."""

    def segment(self, inputs: Inputs, progress: Progress) -> tuple[DetectedObject, ...]: ...


class GeometryStage(Protocol):
    """Metric camera, object cuboids and support edges."""

    def measure(
        self, inputs: Inputs, camera: CameraEstimate, objects: tuple[DetectedObject, ...], progress: Progress
    ) -> ObjectGeometry: ...


class ArchitectureStage(Protocol):
    """Floor, walls, ceiling; resolves "floor" and "wall" supports to planes."""

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate: ...


class DepthStage(Protocol):
    """Depth and normals of every pixel."""

    def depth(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        architecture: ArchitectureEstimate,
        progress: Progress,
    ) -> DepthMap: ...


class RetrievalStage(Protocol):
    """Ranked shapes for every object."""

    def retrieve(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> tuple[RankedShapes, ...]: ...


class PoseStage(Protocol):
    """Nine-degree-of-freedom poses for every object's ranked shapes."""

    def pose(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]: ...


Preview = Callable[[Scene, Sequence[tuple[str, float]]], None]
"""Receives an intermediate scene and the current (cost name, value) pairs."""


class LayoutStage(Protocol):
    """Poses that respect support, contact and space. Streams intermediate scenes to `preview`."""

    def optimise(
        self, scene: Scene, progress: Progress, preview: Preview | None = None
    ) -> tuple[Scene, LayoutReport]: ...
