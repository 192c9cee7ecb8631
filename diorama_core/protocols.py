"""One protocol per stage; each has one method and returns a frozen artefact of `diorama_core.artefacts`. Order::

    (Photo -> recognition -> detection, depth prediction ->)
    Inputs -> camera -> objects (-> naming) -> geometry (-> graph) -> architecture -> depth -> retrieval -> pose
    -> Scene -> layout (-> refinement)

With measured depth, camera and geometry read it; from a photo alone they reason from vanishing points, contact
with the floor and known sizes, and depth is rendered from what they found.

What holds for every method:

Frames and units are those of `diorama_core.scene.frames`: metres, radians, pixels of `Photo.rgb` (h rows, w columns),
world +Z up with the floor at z = 0, camera axes x right, y down, z forward, object frame +X front and +Z up. Arrays
that are given are read-only.

A stage carries its settings in its own frozen fields, because a result is cached under `repr(stage)` and the content
of its arguments: equal fields and arguments must give equal results.

`progress.report(fraction, message)` takes the stage's own share, 0 to 1, and raises `Cancelled` when the user asked to
stop; a stage lets that through. What the user can do something about is raised as another
`diorama_core.errors.DioramaError` of one line: what was wrong, where, what to do. Any other exception is shown as an
internal error.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, UInt8

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
    SeenKinds,
)
from diorama_core.progress import Progress
from diorama_core.scene.types import Intrinsics, Scene


@runtime_checkable
class RecognitionStage(Protocol):
    """Names the kinds of objects in a photo, for a detector that needs words."""

    def recognise(self, photo: Photo, progress: Progress) -> tuple[str, ...]:
        """Name the kinds of objects that the photo shows.

        Args:
            photo: upright, `rgb` of shape (h, w, 3), sRGB, eight bits.
            progress: reports and cancellation.

        Returns:
            Singular English nouns, each once, without the room's own parts (wall, floor, ceiling).

        Raises:
            UnavailableError: the model cannot be asked.
        """
        ...


@runtime_checkable
class DetectionStage(Protocol):
    """Proposes boxes where the user gave neither boxes nor masks."""

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        """Find the objects in the photo.

        Args:
            photo: upright, `rgb` of shape (h, w, 3).
            words: kinds to look for, from the recognition stage; empty where the stage is to use its own vocabulary.
            progress: reports and cancellation.

        Returns:
            One box per object, best first: x1, y1, x2, y2 in pixels of `photo.rgb`, clipped to it, with a category of
            `diorama_core.library.taxonomy` or "object", and a score of 0 to 1. Empty where nothing was found.

        Raises:
            UnavailableError: the network is missing or damaged.
        """
        ...


@runtime_checkable
class DepthPredictionStage(Protocol):
    """Predicts depth, normals and intrinsics from the photo where no depth was measured."""

    def predict(self, photo: Photo, intrinsics: Intrinsics | None, progress: Progress) -> DepthPrediction:
        """Predict the photo's geometry in the camera frame.

        Args:
            photo: upright, `rgb` of shape (h, w, 3).
            intrinsics: of `photo.rgb`, where the user gave them; None lets the network estimate them.
            progress: reports and cancellation.

        Returns:
            `depth_m` (h, w): metric z in camera, 0 where unknown; `normals_camera` (h, w, 3): unit, toward the camera,
            zero where unknown; `intrinsics`: those given, or the network's.

        Raises:
            UnavailableError: the network is missing or damaged.
        """
        ...


@runtime_checkable
class GraphStage(Protocol):
    """Decides what supports what; replaces the geometry stage's edges."""

    def relate(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> SceneGraph:
        """Infer the support graph.

        Args:
            inputs: what the user gave, with what networks added.
            objects: with masks of shape (h, w).
            geometry: camera, cuboids in the world, and the support edges that geometry suggests.
            progress: reports and cancellation.

        Returns:
            One edge per object that has a cuboid, without cycles. A parent is an object's id, "floor", "wall" or
            "ceiling". One score per edge, 0 to 1.

        Raises:
            UnavailableError: the model cannot be asked.
        """
        ...


@runtime_checkable
class CameraStage(Protocol):
    """Estimates intrinsics and orientation."""

    def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
        """Estimate the camera from the photo, and from depth where there is some.

        Args:
            inputs: photo, and whatever is known: `intrinsics` must be used as they are, `depth_m` (h, w) is z in
                camera in metres, 0 where missing.
            progress: reports and cancellation.

        Returns:
            At least one hypothesis, best first, each with intrinsics of `photo.rgb` and `R_world_camera` (3, 3): the
            rotation that takes camera axes to the world, whose x and y follow the room and whose +Y is the axis
            nearest to the viewing direction. `height_m` is the camera's height above the floor where depth measured
            it, else None.

        Raises:
            InputError: what the user gave does not suffice for this stage.
        """
        ...


@runtime_checkable
class ObjectStage(Protocol):
    """Segments every object that was given or detected."""

    def segment(self, inputs: Inputs, progress: Progress) -> tuple[DetectedObject, ...]:
        """Segment the objects.

        Args:
            inputs: photo, `boxes`, and `instances` (h, w) where the user gave masks: a pixel's id, 0 for background.
                Camera fields are None, so that a corrected camera does not segment again.
            progress: reports and cancellation.

        Returns:
            One object per given instance and per box without one: an `id` that is unique in the photo, a `mask_id`
            from 1, and a boolean `mask` (h, w) that is not empty.

        Raises:
            UnavailableError: the network is missing or damaged.
        """
        ...


@runtime_checkable
class NamingStage(Protocol):
    """Looks at every object and says which kinds it looks like, whatever it is called."""

    def name(self, photo: Photo, objects: tuple[DetectedObject, ...], progress: Progress) -> tuple[SeenKinds, ...]:
        """Compare every object's picture with the kinds of the taxonomy.

        Args:
            photo: upright, `rgb` of shape (h, w, 3).
            objects: with their boxes.
            progress: reports and cancellation.

        Returns:
            One for each object, in their order.

        Raises:
            UnavailableError: the network is missing or damaged.
        """
        ...


@runtime_checkable
class GeometryStage(Protocol):
    """Measures the metric camera, a cuboid per object, and support edges."""

    def measure(
        self, inputs: Inputs, camera: CameraEstimate, objects: tuple[DetectedObject, ...], progress: Progress
    ) -> ObjectGeometry:
        """Place camera and objects in the world.

        Args:
            inputs: what the user gave, with what networks added.
            camera: hypotheses, best first; the stage may choose another than the first.
            objects: with masks of shape (h, w).
            progress: reports and cancellation.

        Returns:
            `camera` with `T_world_camera` (4, 4), above the origin of the world; per object a cuboid
            (`R_world_object` (3, 3), `centre` (3,) and `size_m` (3,) in metres along the object's own axes) and one
            support edge whose parent is an object's id, "floor", "wall" or "ceiling". Objects that cannot be placed
            have no cuboid.

        Raises:
            InputError: what the user gave does not suffice for this stage.
        """
        ...


@runtime_checkable
class EmptyRoomFiller(Protocol):
    """Inpaints a region of a photo, as LaMa and MI-GAN do (PlainRecon's first step)."""

    def fill(self, rgb: UInt8[np.ndarray, "h w 3"], hole: Bool[np.ndarray, "h w"]) -> UInt8[np.ndarray, "h w 3"]:
        """The photo with the room's surfaces where `hole` is true, and unchanged elsewhere.

        Args:
            rgb: The photo, sRGB.
            hole: Pixels of what stands in the room, with their margin.

        Returns:
            A picture of the photo's size.

        Raises:
            UnavailableError: the network cannot run.
        """
        ...


@runtime_checkable
class ArchitectureStage(Protocol):
    """Reconstructs floor, walls and ceiling."""

    def reconstruct(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> ArchitectureEstimate:
        """Reconstruct the room and say which plane supports what.

        Args:
            inputs: what the user gave, with what networks added.
            objects: with masks of shape (h, w).
            geometry: camera and cuboids in the world, and support edges.
            progress: reports and cancellation.

        Returns:
            Planes with unique ids and roles, whose polygons (n, 3) lie in the world, counter-clockwise seen from
            inside the room; one of them is the floor. `supports` are the geometry's edges with "floor", "wall" and
            "ceiling" replaced by ids of planes. `openings` are ids of objects that are open doorways.

        Raises:
            InputError: what the user gave does not suffice for this stage.
        """
        ...


@runtime_checkable
class DepthStage(Protocol):
    """Gives depth and normals for every pixel."""

    def depth(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        architecture: ArchitectureEstimate,
        progress: Progress,
    ) -> DepthMap:
        """Complete the depth map.

        Args:
            inputs: `depth_m` (h, w), z in camera, where it was measured or predicted.
            objects: without openings; masks of shape (h, w).
            geometry: camera and cuboids in the world, mounted objects moved to their planes.
            architecture: the room's planes in the world.
            progress: reports and cancellation.

        Returns:
            `depth_m` (h, w): z in camera in metres; `normals_world` (h, w, 3): unit, toward the camera. Both zero where
            neither the room nor an object is.
        """
        ...


@runtime_checkable
class RetrievalStage(Protocol):
    """Retrieves shapes of the library."""

    def retrieve(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> tuple[RankedShapes, ...]:
        """Rank shapes for every object.

        Args:
            inputs: photo and what was given with it.
            objects: without openings; masks of shape (h, w).
            geometry: camera and cuboids in the world; `size_m` is what a shape should measure.
            progress: reports and cancellation.

        Returns:
            Per object that has a cuboid: (shape id, score) pairs, best first, of the library that the stage was
            constructed with; scores are comparable within one object. `note` tells the user what was taken for an
            unknown class.

        Raises:
            LibraryError: a shape cannot be read.
        """
        ...


@runtime_checkable
class PoseStage(Protocol):
    """Finds poses of nine degrees of freedom: rotation, position, and a scale per axis."""

    def pose(
        self,
        inputs: Inputs,
        objects: tuple[DetectedObject, ...],
        geometry: ObjectGeometry,
        depth: DepthMap,
        shapes: tuple[RankedShapes, ...],
        progress: Progress,
    ) -> tuple[PosedCandidates, ...]:
        """Pose the ranked shapes of every object.

        Args:
            inputs: photo and what was given with it.
            objects: without openings; masks of shape (h, w).
            geometry: camera and cuboids in the world.
            depth: z in camera and world normals of every pixel.
            shapes: ranked shapes, best first.
            progress: reports and cancellation.

        Returns:
            Per object its candidates, best first, with poses `p_world = R_world_object @ (scale * p_object) +
            position` in metres. An object without candidates is left out of the scene.

        Raises:
            LibraryError: a shape cannot be read.
        """
        ...


Preview = Callable[[Scene, Sequence[tuple[str, float]]], None]
"""Receives an intermediate scene and the current (cost name, value) pairs."""


@runtime_checkable
class LayoutStage(Protocol):
    """Makes poses respect support, contact and space."""

    def optimise(self, scene: Scene, progress: Progress, preview: Preview | None = None) -> tuple[Scene, LayoutReport]:
        """Optimise the layout.

        Args:
            scene: poses in the world; objects that are `locked` stay where they are.
            progress: reports and cancellation.
            preview: receives intermediate scenes; called on the thread that optimises.

        Returns:
            The scene with other poses, and a report: costs by name before and after, seconds, and reasons where
            something could not be achieved.

        Raises:
            Cancelled: on request; the scene that was given is unchanged.
            LibraryError: a shape cannot be read.
        """
        ...


@runtime_checkable
class RefinementStage(Protocol):
    """Fits a finished layout to the picture."""

    def refine(
        self,
        scene: Scene,
        report: LayoutReport,
        observed: Scene,
        objects: Sequence[DetectedObject],
        progress: Progress,
    ) -> tuple[Scene, LayoutReport]:
        """Change poses so that the objects, seen together, agree better with their masks.

        Args:
            scene: after the layout; objects that are `locked` stay where they are.
            report: of the layout.
            observed: the scene before the layout, with the same objects.
            objects: what was detected in the photo; the ids are those of the scene's objects.
            progress: reports and cancellation.

        Returns:
            The scene with other poses, and the report of its layout as it is then.

        Raises:
            Cancelled: on request; the scene that was given is unchanged.
            LibraryError: a shape cannot be read.
        """
        ...
