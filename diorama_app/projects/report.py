"""What the build command and the editor share around the pipeline."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from diorama_core.artefacts import LayoutReport
from diorama_core.errors import ProjectError
from diorama_core.io.atomic import write_atomically
from diorama_core.library.record import ShapeLibrary
from diorama_core.pipeline.arrangements import arrangement, arrangement_count
from diorama_core.progress import Progress
from diorama_core.project.storage import Project
from diorama_core.protocols import LayoutStage
from diorama_core.scene import edits
from diorama_core.scene.schema import scene_to_json

if TYPE_CHECKING:
    from diorama_core.pipeline.run import Built  # the whole pipeline; opening a project does without it


def library_named(name: str) -> ShapeLibrary:
    """The shape library of that name, or several joined by `+`; raises `LibraryError` when there is none."""
    from diorama_core.library.store import open_library

    return open_library(name)


def library_of(project: Project) -> ShapeLibrary:
    """The library that a project was built with; the built-in one where nothing is noted."""
    return library_named(str(project.info().get("library", "built-in")))


def write_arrangements(
    project: Project, built: Built, library: ShapeLibrary, layout: LayoutStage, count: int, progress: Progress
) -> tuple[str, ...]:
    """Write `count` scenes, or as many as differ and have room for everything: `scene.json` and
    `arrangements/scene_2.json`...; returns their paths in the project."""
    from diorama_core.retrieval.appearance_similarity import EmbeddedSimilarity

    similarity, names = EmbeddedSimilarity(library), ["scene.json"]

    def alike(a: str, b: str) -> float:
        return similarity.form_agreement(library.shape(a), library.shape(b))

    different = arrangement_count(built.observed, alike) if count > 1 else 1
    for rank in range(1, different):
        if len(names) >= count:
            break
        observed = arrangement(built.observed, rank, alike)
        arranged, report = layout.optimise(observed, replace(progress, start=0.0, span=1.0))
        if _overlaps(report) > _overlaps(built.layout):
            continue  # these shapes have no room beside one another here; the next may
        name = f"arrangements/scene_{len(names) + 1}.json"
        text = scene_to_json(edits.set_metrics(arranged, report.after))
        write_atomically(project.folder / name, text.encode(), error=ProjectError)
        names.append(name)
    return tuple(names)


def _overlaps(report: LayoutReport | None) -> float:
    return 0.0 if report is None else report.after.get("overlapping_pairs", 0.0)


def build_report(project: Project, built: Built, scenes: tuple[str, ...]) -> dict[str, Any]:
    """What `diorama build --json` prints."""
    scene = built.scene
    planes = scene.architecture.planes
    walls = len(scene.architecture.by_role("wall"))
    seconds = sum(run.seconds for run in built.runs)
    return {
        "project": str(project.folder),
        "scenes": list(scenes),
        "summary": f"{len(scene.objects)} objects, {walls} walls, {seconds:.1f} s",
        "objects": [
            {
                "id": o.id,
                "label": o.label,
                "category": o.category,
                "shape": o.shape_id,
                "size_m": [round(float(v), 4) for v in o.size_m],
                "confidence": round(o.confidence, 3),
            }
            for o in scene.objects
        ],
        "planes": [{"id": p.id, "role": p.role} for p in planes],
        "camera": {"confidence": built.camera.confidence, "source": built.camera.source},
        "stages": [{"stage": r.stage, "seconds": round(r.seconds, 3), "cached": r.cached} for r in built.runs],
        "notes": list(built.notes),
        "metrics": dict(scene.metrics),
    }
