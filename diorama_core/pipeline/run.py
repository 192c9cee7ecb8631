"""The one place where stages are constructed and run in order: Inputs -> Scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import UInt8

from diorama_core.architecture.from_depth.stage import PlanarRoom
from diorama_core.architecture.mounting import snap_mounted_objects
from diorama_core.architecture.passages import without_openings
from diorama_core.architecture.single_view.stage import PhotoRoom
from diorama_core.architecture.texture.empty_room import EmptyRoomFiller
from diorama_core.architecture.texture.plane_textures import plane_textures
from diorama_core.artefacts import (
    ArchitectureEstimate,
    CameraEstimate,
    DepthMap,
    DetectedObject,
    Inputs,
    LayoutReport,
    ObjectGeometry,
    SceneGraph,
)
from diorama_core.layout.recipes import recipe as layout_recipe
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.camera.estimate import EmbeddedCamera
from diorama_core.perception.camera.given_attitude import with_given_attitude
from diorama_core.perception.depth import MeasuredDepth, RenderedDepth
from diorama_core.perception.foundation.depth_prediction import with_network_wording
from diorama_core.perception.graph.geometric import GeometricGraph
from diorama_core.perception.masks import EmbeddedMasks
from diorama_core.perception.measured import MeasuredGeometry
from diorama_core.perception.metrology import SingleViewMetrology
from diorama_core.pipeline.assemble import assemble
from diorama_core.pipeline.colours import photo_colours, shared_by_sets
from diorama_core.pipeline.network_inputs import with_graph, with_network_inputs
from diorama_core.pipeline.runner import Runner, StageRun
from diorama_core.pose import RenderAndCompare
from diorama_core.progress import Progress
from diorama_core.protocols import (
    ArchitectureStage,
    CameraStage,
    DepthPredictionStage,
    DepthStage,
    DetectionStage,
    GeometryStage,
    GraphStage,
    LayoutStage,
    ObjectStage,
    PoseStage,
    Preview,
    RecognitionStage,
    RetrievalStage,
)
from diorama_core.retrieval import HierarchicalRetrieval
from diorama_core.scene.edits import set_metrics
from diorama_core.scene.room_edits import floor_height, rescale_to_length
from diorama_core.scene.types import Scene

DEFAULT_RECIPE = "feasible"


@dataclass(frozen=True)
class Stages:
    """The implementations that one run uses."""

    camera: CameraStage
    objects: ObjectStage
    geometry: GeometryStage
    architecture: ArchitectureStage
    depth: DepthStage
    retrieval: RetrievalStage
    pose: PoseStage
    layout: LayoutStage
    recognition: RecognitionStage | None = None
    """Names kinds of things to look for; optional, as are the next three."""
    detection: DetectionStage | None = None
    """Finds boxes where the user gave none."""
    depth_prediction: DepthPredictionStage | None = None
    """Reads depth from the photo where the user measured none."""
    graph: GraphStage | None = None
    """Decides what holds up what; without it the geometry stage does."""
    filler: EmptyRoomFiller | None = None
    """Paints furniture out of the photo for the planes' pictures; without it each plane is continued by itself."""


@dataclass(frozen=True)
class Built:
    """A scene and everything it was derived from."""

    scene: Scene
    camera: CameraEstimate
    objects: tuple[DetectedObject, ...]
    geometry: ObjectGeometry
    architecture: ArchitectureEstimate
    depth: DepthMap
    observed: Scene
    """The scene before the layout optimiser."""
    layout: LayoutReport | None
    """None when there was nothing to arrange."""
    textures: Mapping[str, UInt8[np.ndarray, "h w 3"]]
    """The planes' pictures by name."""
    inputs: Inputs
    """What the user gave, with the boxes and the depth that networks added."""
    runs: tuple[StageRun, ...]
    """Which stage used what, and how long it took."""
    notes: tuple[str, ...] = ()
    """What the user should know, in plain words."""


def embedded_stages(inputs: Inputs, library: ShapeLibrary, *, recipe: str = DEFAULT_RECIPE) -> Stages:
    """The stages that need no download, chosen by what the user gave: measured depth or a photo alone."""
    measured = inputs.depth_m is not None
    return Stages(
        camera=with_given_attitude(EmbeddedCamera(), inputs.camera_attitude),
        objects=EmbeddedMasks(),
        geometry=MeasuredGeometry() if measured else SingleViewMetrology(),
        architecture=PlanarRoom() if measured else PhotoRoom(),
        depth=MeasuredDepth() if measured else RenderedDepth(),
        retrieval=HierarchicalRetrieval(library),
        pose=RenderAndCompare(library),
        layout=layout_recipe(recipe, library, depth_measured=measured),
        graph=GeometricGraph() if measured else None,
    )


def build_scene(
    inputs: Inputs,
    library: ShapeLibrary,
    *,
    stages: Stages | None = None,
    cache: Path | None = None,
    progress: Progress | None = None,
    preview: Preview | None = None,
) -> Built:
    """Run every stage.

    Args:
        inputs: what the user gave.
        library: where shapes come from.
        stages: implementations; the embedded ones by default.
        cache: folder for stage results; an interrupted run resumes from it.
        progress: reports and cancellation.
        preview: receives the layout optimiser's intermediate scenes.

    Raises:
        Cancelled: on request; finished stages stay in the cache.
        DioramaError: with the reason, when a stage cannot do its work.
    """
    s = stages or embedded_stages(inputs, library)
    progress = progress or Progress()
    runner = Runner(cache)

    inputs = with_network_inputs(inputs, s, runner, progress.part(0.0, 0.05))
    camera = runner.run("camera", s.camera, s.camera.estimate, (inputs,), progress.part(0.05, 0.1))
    # Outlines do not depend on the camera: correcting its field of view must not look for them again.
    seen = inputs.of_any_camera
    objects = runner.run("objects", s.objects, s.objects.segment, (seen,), progress.part(0.1, 0.25))
    geometry = runner.run(
        "geometry", s.geometry, s.geometry.measure, (inputs, camera, objects), progress.part(0.25, 0.38)
    )
    graph = None
    if s.graph is not None:
        found = (inputs, objects, geometry)
        graph = runner.run("graph", s.graph, s.graph.relate, found, progress.part(0.38, 0.4))
        geometry = with_graph(geometry, graph)
    room = runner.run(
        "architecture", s.architecture, s.architecture.reconstruct, (inputs, objects, geometry), progress.part(0.4, 0.5)
    )
    pointed_at = objects
    objects, geometry = without_openings(objects, snap_mounted_objects(geometry, room), room)
    depth = runner.run("depth", s.depth, s.depth.depth, (inputs, objects, geometry, room), progress.part(0.5, 0.55))
    shapes = runner.run(
        "retrieval", s.retrieval, s.retrieval.retrieve, (inputs, objects, geometry), progress.part(0.55, 0.65)
    )
    posed = runner.run(
        "pose", s.pose, s.pose.pose, (inputs, objects, geometry, depth, shapes), progress.part(0.65, 0.85)
    )
    textures = plane_textures(inputs, pointed_at, geometry.camera, room.architecture, s.filler)
    shape_of = {p.object_id: p.candidates[0].shape_id for p in posed if p.candidates}
    colours = shared_by_sets(photo_colours(inputs.photo.rgb, objects), objects, shape_of)
    observed = _textured(assemble(objects, geometry, room, posed, library, colours), textures)

    scene, report = observed, None
    if observed.objects:
        step = progress.part(0.85, 1.0)
        step.report(0.0, "layout…")
        scene, report = s.layout.optimise(observed, step, preview)
        runner.runs.append(StageRun("layout", repr(s.layout), report.seconds, cached=False))
        scene = set_metrics(scene, report.after)
    scene = _as_high(scene, inputs.camera_height_m)
    progress.report(1.0, "done")
    network = inputs.depth_source == "network"
    return Built(
        scene=scene,
        camera=camera,
        objects=objects,
        geometry=geometry,
        architecture=room,
        depth=depth,
        observed=observed,
        layout=report,
        textures=textures,
        inputs=inputs,
        runs=tuple(runner.runs),
        notes=_notes(network, camera, geometry, room, graph, tuple(r.note for r in shapes), report),
    )


def _as_high(scene: Scene, camera_height_m: float | None) -> Scene:
    """The scene in the scale that a person gave."""
    if camera_height_m is None or scene.camera is None:
        return scene
    return rescale_to_length(scene, float(scene.camera.position[2]) - floor_height(scene), camera_height_m)


def _textured(scene: Scene, textures: Mapping[str, object]) -> Scene:
    planes = tuple(replace(p, texture=p.id) if p.id in textures else p for p in scene.architecture.planes)
    return replace(scene, architecture=replace(scene.architecture, planes=planes))


def _notes(
    network: bool,
    camera: CameraEstimate,
    geometry: ObjectGeometry,
    room: ArchitectureEstimate,
    graph: SceneGraph | None,
    retrieval: tuple[str, ...],
    report: LayoutReport | None,
) -> tuple[str, ...]:
    sources: tuple[str, ...] = (f"camera: {camera.source}", f"objects: {geometry.source}", f"room: {room.source}")
    if network:
        sources = tuple(with_network_wording(s) for s in sources)
    if graph is not None:
        sources = (*sources, f"what stands on what: {graph.source}")
    return (*sources, *(n for n in retrieval if n), *(report.reasons if report else ()))
