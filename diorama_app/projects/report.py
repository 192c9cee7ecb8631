"""What the build commands write and print about a room that they built."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import Any

from diorama_core.api import Reconstruction
from diorama_core.artefacts import LayoutReport
from diorama_core.errors import ProjectError
from diorama_core.io.atomic import write_document
from diorama_core.io.text import number_of
from diorama_core.perception.foundation.proposals import JoinedDetection, OwnDetection, count_left_out
from diorama_core.pipeline.arrangements import arrangement, arrangement_count
from diorama_core.pipeline.findings import camera_sentence
from diorama_core.pipeline.plan import evaluate
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.steps import LaidOut
from diorama_core.progress import Progress
from diorama_core.scene import edits
from diorama_core.scene.schema import scene_from_json, scene_to_json


def write_arrangements(room: Reconstruction, count: int, progress: Progress) -> tuple[str, ...]:
    """Write `count` scenes, or as many as differ and have room for everything, of a room built in a project:
    `scene.json` and `arrangements/scene_2.json`...; returns their paths in the project."""
    from diorama_core.retrieval.appearance_similarity import EmbeddedSimilarity

    assert room.project is not None
    assert room.built is not None
    assert room.stages is not None
    observed = room.built.observed
    similarity, names = EmbeddedSimilarity(room.library), ["scene.json"]

    def alike(a: str, b: str) -> float:
        return similarity.form_agreement(room.library.shape(a), room.library.shape(b))

    different = arrangement_count(observed, alike) if count > 1 else 1
    for rank in range(1, different):
        if len(names) >= count:
            break
        other, whole = arrangement(observed, rank, alike), replace(progress, start=0.0, end=1.0)
        known = {"observed": other, "furniture_objects": room.built.objects}
        arranged: LaidOut = evaluate(room.stages, known, ("refined",), Runner(), whole)["refined"]
        if arranged.report is None or _overlaps(arranged.report) > _overlaps(room.layout):
            continue  # these shapes have no room beside one another here; the next may
        name = f"arrangements/scene_{len(names) + 1}.json"
        text = scene_to_json(edits.set_metrics(arranged.scene, arranged.report.after))
        write_document(room.project.folder / name, text.encode(), scene_from_json, ProjectError)
        names.append(name)
    return tuple(names)


def _overlaps(report: LayoutReport | None) -> float:
    return 0.0 if report is None else report.after.get("overlapping_pairs", 0.0)


def build_report(room: Reconstruction, scenes: tuple[str, ...]) -> dict[str, Any]:
    """What `diorama build --json` prints about a room built in a project."""
    assert room.project is not None
    scene, built = room.scene, room.built
    planes = scene.architecture.planes
    walls = len(scene.architecture.by_role("wall"))
    seconds = 0.0 if built is None else sum(run.seconds for run in built.runs)
    took = "" if built is None else f", {seconds:.1f} s"
    detection = None if room.stages is None else room.stages.detection
    unsure = {}
    if built is not None and isinstance(detection, OwnDetection | JoinedDetection):
        unsure = {"left_out": count_left_out(detection, built.inputs.photo)}
    camera = None
    if built is not None:
        sentence = camera_sentence(built.camera, built.inputs.depth_source)
        camera = {"confidence": built.camera.confidence, "source": sentence}
    return {
        "project": str(room.project.folder),
        "scenes": list(scenes),
        "summary": f"{number_of(len(scene.objects))}, {number_of(walls, 'wall')}{took}",
        "objects": [
            {
                "id": o.id,
                "label": o.label,
                "category": o.category,
                "shape": o.shape_id,
                "size_m": [round(float(v), 4) for v in o.size_m],
                "confidence": round(o.confidence, 3),
                "belief": None if o.belief is None else asdict(o.belief),
            }
            for o in scene.objects
        ],
        "planes": [{"id": p.id, "role": p.role} for p in planes],
        "camera": camera,
        "stages": [
            {"stage": r.stage, "seconds": round(r.seconds, 3), "cached": r.cached}
            for r in (() if built is None else built.runs)
        ],
        "notes": list(room.warnings if built is None else built.notes),
        **unsure,
        "metrics": dict(scene.metrics),
    }
