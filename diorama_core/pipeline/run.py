"""From the user's inputs to a scene: the whole plan evaluated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import UInt8

from diorama_core.artefacts import (
    ArchitectureEstimate,
    CameraEstimate,
    DepthMap,
    DetectedObject,
    Inputs,
    LayoutReport,
    ObjectGeometry,
    Reason,
    SceneGraph,
)
from diorama_core.library.record import ShapeLibrary
from diorama_core.perception.illuminant import Illuminant
from diorama_core.pipeline.beside import prepare_processes
from diorama_core.pipeline.findings import camera_sentence, geometry_sentence, graph_sentence, room_sentence
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.runner import Runner, StageRun
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.pipeline.steps import Artefacts
from diorama_core.progress import SILENT, Progress
from diorama_core.protocols import Preview
from diorama_core.scene.types import Scene


@dataclass(frozen=True)
class Built:
    """A scene and everything it was derived from."""

    scene: Scene
    camera: CameraEstimate
    objects: tuple[DetectedObject, ...]
    geometry: ObjectGeometry
    graph: SceneGraph | None
    """What holds up what; None where no graph stage ran."""
    architecture: ArchitectureEstimate
    depth: DepthMap
    observed: Scene
    """The scene before the layout optimiser."""
    layout: LayoutReport | None
    """None when the scene has no objects."""
    textures: Mapping[str, UInt8[np.ndarray, "_ _ 3"]]
    """The pictures of planes and of objects' materials, by name."""
    illuminant: Illuminant
    """The photo's light, of which colours and pictures of the scene are free."""
    inputs: Inputs
    """What the user gave, with the boxes and the depth that networks added."""
    runs: tuple[StageRun, ...]
    """Which stage used what, and how long it took."""
    notes: tuple[str, ...] = ()
    """What the user should know, in plain words."""
    stages: Stages | None = None
    """The implementations that ran."""
    reasons: tuple[Reason, ...] = ()
    """Why each object is where it is and what it is, by object."""


def build_scene(
    inputs: Inputs,
    library: ShapeLibrary,
    *,
    stages: Stages | None = None,
    cache: Path | None = None,
    progress: Progress = SILENT,
    preview: Preview | None = None,
    plane_pictures: bool = True,
) -> Built:
    """Run every stage.

    Args:
        inputs: what the user gave.
        library: where shapes come from.
        stages: implementations; the embedded ones by default.
        cache: folder for stage results; an interrupted run resumes from it.
        progress: reports and cancellation.
        preview: receives the layout optimiser's intermediate scenes.
        plane_pictures: whether floor, walls and ceiling get pictures.

    Raises:
        Cancelled: on request; finished stages stay in the cache.
        DioramaError: with the reason, when a stage cannot do its work.
    """
    prepare_processes()
    stages = stages or embedded_stages(inputs, library)
    runner = Runner(cache)
    given: Artefacts = {"given": inputs, "library": library, "preview": preview}
    if not plane_pictures:
        given = {**given, "plane_pictures": {}}
    artefacts = evaluate(stages, given, ("scene", "textures", "dressed_observed", "reasons"), runner, progress)
    progress.report(1.0, "done")
    return Built(
        scene=artefacts["scene"],
        camera=artefacts["camera"],
        objects=artefacts["furniture_objects"],
        geometry=artefacts["geometry"],
        graph=artefacts["graph"],
        architecture=artefacts["white_room"],
        depth=artefacts["depth"],
        observed=artefacts["dressed_observed"],
        layout=artefacts["refined"].report,
        textures=artefacts["textures"],
        illuminant=artefacts["illuminant"],
        inputs=artefacts["inputs"],
        runs=tuple(runner.runs),
        stages=stages,
        notes=(*_notes(artefacts), *runner.lost),
        reasons=artefacts["reasons"],
    )


def _notes(artefacts: Artefacts) -> tuple[str, ...]:
    """Where the scene's parts come from, what was changed and what could not be achieved, in plain words."""
    depth, graph = artefacts["inputs"].depth_source, artefacts["graph"]
    report: LayoutReport | None = artefacts["refined"].report
    sources = [
        f"camera: {camera_sentence(artefacts['camera'], depth)}",
        f"objects: {geometry_sentence(artefacts['geometry'], depth)}",
        f"room: {room_sentence(artefacts['architecture'], depth)}",
    ]
    if graph is not None:
        sources.append(f"what stands on what: {graph_sentence(graph)}")
    notes = (*(s.note for s in artefacts["shapes"] if s.note), *artefacts["corrected"].notes)
    return (*sources, *notes, *(report.reasons if report else ()))
