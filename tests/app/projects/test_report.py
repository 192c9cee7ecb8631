from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from diorama_app.projects.report import build_report, write_arrangements
from diorama_core.api import Reconstruction
from diorama_core.artefacts import (
    LayoutReport,
)
from diorama_core.pipeline.runner import StageRun
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.progress import Progress
from diorama_core.project.storage import Project
from diorama_core.protocols import RefinementStage
from diorama_core.retrieval import appearance_similarity
from diorama_core.scene.schema import scene_from_json
from diorama_core.scene.types import Scene
from tests.app.small_room import PlainLibrary, furnished_scene, make_project
from tests.built import built_scene


class CountingLayout:
    """Returns the scene as it is, with as many overlapping pairs as were dictated for each call."""

    def __init__(self, *pairs: int) -> None:
        self.pairs = list(pairs)

    def optimise(self, scene: Scene, progress: Progress, preview: object = None) -> tuple[Scene, LayoutReport]:
        return scene, LayoutReport("feasible", {}, {"overlapping_pairs": float(self.pairs.pop(0))}, 0.1)


RUNS = (StageRun("pose", "Fit", 1.25, cached=False), StageRun("layout", "Feasible", 0.5, cached=True))


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    class Unlike:
        def __init__(self, library) -> None:
            pass

        def form_agreement(self, a, b) -> float:
            return 0.0

    monkeypatch.setattr(appearance_similarity, "EmbeddedSimilarity", Unlike)
    project: Project = make_project(tmp_path / "room")

    def made(*pairs: int, refinement: RefinementStage | None = None):
        built, library = replace(built_scene(furnished_scene()), runs=RUNS, notes=("a note",)), PlainLibrary()
        return Reconstruction(
            scene=replace(furnished_scene(), metrics=(("structure", 1.0),)),
            library=library,
            textures={},
            built=built,
            stages=replace(
                embedded_stages(built.inputs, library), layout=CountingLayout(*pairs), refinement=refinement
            ),
            layout=LayoutReport("feasible", {}, {"overlapping_pairs": 1.0}, 0.1),
            project=project,
        )

    return made


def test_other_arrangements_are_written_unless_they_have_less_room(room) -> None:
    built = room(1, 0)
    names = write_arrangements(built, 3, Progress())
    assert names[0] == "scene.json"
    assert names[1:] == tuple(f"arrangements/scene_{k}.json" for k in range(2, len(names) + 1))
    assert len(names) >= 2
    second = scene_from_json((built.project.folder / names[1]).read_text())
    assert second.object("table_1").shape_id == "table_b"
    assert dict(second.metrics) == {"overlapping_pairs": 1.0}


def test_other_arrangements_are_fitted_to_the_masks_as_the_first_one_is(room) -> None:
    class Marking:
        def refine(self, scene, report, observed, objects, progress):
            assert [o.shape_id for o in observed.objects] == [o.shape_id for o in scene.objects]
            return scene, replace(report, after={**report.after, "objects_seen": float(len(objects))})

    built = room(1, 0, refinement=Marking())
    second = scene_from_json((built.project.folder / write_arrangements(built, 2, Progress())[1]).read_text())
    assert dict(second.metrics)["objects_seen"] == float(len(built.built.objects))


def test_an_arrangement_in_which_more_overlaps_is_left_out(room) -> None:
    names = write_arrangements(room(5, 5, 5, 5), 2, Progress())
    assert names == ("scene.json",)
    assert write_arrangements(room(), 1, Progress()) == ("scene.json",)


def test_the_report_is_json_and_says_what_was_built(room) -> None:
    report = json.loads(json.dumps(build_report(room(), ("scene.json",))))
    assert report["summary"] == "5 objects, 4 walls, 1.8 s"
    assert [o["id"] for o in report["objects"]] == [o.id for o in furnished_scene().objects]
    assert report["objects"][0]["size_m"] == [0.8, 1.4, 0.74]
    assert report["stages"] == [
        {"stage": "pose", "seconds": 1.25, "cached": False},
        {"stage": "layout", "seconds": 0.5, "cached": True},
    ]
    assert report["metrics"] == {"structure": 1.0}
    assert report["notes"] == ["a note"]
    assert {"project", "scenes", "planes", "camera"} <= set(report)
