"""One order for all: correcting nothing changes nothing, and a step runs only for what is wanted."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest

from diorama_core.arrangement.explain import strongest
from diorama_core.artefacts import ArchitectureEstimate, Inputs, LabelledBox, PosedCandidates
from diorama_core.editing.reconstructed import replace_object
from diorama_core.geometry.planes import plane_rectangle
from diorama_core.pipeline import plan
from diorama_core.pipeline.plan import DEFAULTS, PLAN, assemble, evaluate
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.reconstruct_object import reconstruct_object
from diorama_core.pipeline.run import Built
from diorama_core.pipeline.runner import Runner
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.pipeline.steps import Derivation, LayoutStep, StageStep
from diorama_core.progress import Progress
from diorama_core.project.build import build_project
from diorama_core.project.reasons import load_reasons
from diorama_core.project.storage import Project
from diorama_core.provenance import RoomMethod, RoomSource
from diorama_core.scene.schema import scene_to_json
from diorama_core.scene.types import Architecture, Candidate, Pose, Support
from diorama_core.synthesis.layout_rooms import box_library
from tests.primitives import PrimitiveLibrary
from tests.synthetic_rooms import box_room, cuboid, look, shoot

LIBRARY = box_library()
PRIMITIVES = PrimitiveLibrary()
ITEMS = (
    cuboid("table", (0.0, 2.6, 0), (0.8, 1.4, 0.72)),
    cuboid("tray", (0.0, 2.6, 0.72), (0.4, 0.4, 0.05)),
    cuboid("ball", (0.0, 2.6, 0.77), (0.2, 0.2, 0.2)),
)
SHOT = shoot(look(0, 14, 1.5, 70, (160, 120)), box_room(-2.2, 2.2, 4.0, 2.6), ITEMS, ("table", "object", "toy"))
EDGES = (Support("table", "floor"), Support("tray", "table"), Support("ball", "tray"))


@pytest.fixture(scope="module", autouse=True)
def _embedded_only(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DIORAMA_MODELS", str(tmp_path_factory.mktemp("models")))
        patch.delenv("DIORAMA_LMM_BASE_URL", raising=False)
        yield


def room_inputs(*, depth: bool) -> Inputs:
    """A room with a table, a box on it and a chair, each in a box with a name."""
    cuboids = (
        cuboid("table", (0.2, 2.6, 0.0), (0.8, 1.2, 0.72)),
        cuboid("box", (0.1, 2.5, 0.72), (0.25, 0.3, 0.2)),
        cuboid("chair", (-1.0, 2.2, 0.0), (0.45, 0.45, 0.9), 30.0),
    )
    names = ("table", "box", "chair")
    shot = shoot(look(size=(320, 240)), box_room(-2.0, 2.0, 4.0, 2.6), cuboids, names)
    boxes = tuple(LabelledBox(o.box, o.category, o.label) for o in shot.objects)
    return replace(shot.inputs, boxes=boxes, instances=None, depth_m=shot.inputs.depth_m if depth else None)


@dataclass(frozen=True, eq=False)
class Room:
    """A project and what its build gave."""

    inputs: Inputs
    project: Project
    built: Built


@pytest.fixture(scope="module", params=[False, True], ids=["photo", "depth"])
def room(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Room:
    inputs, project = room_inputs(depth=request.param), Project.create(tmp_path_factory.mktemp("plan") / "room")
    return Room(inputs, project, build_project(project, inputs, LIBRARY))


def test_the_pictures_of_planes_have_their_planes_proportions(room: Room) -> None:
    textured = [p for p in room.built.scene.architecture.planes if p.texture is not None]
    assert textured
    for plane in textured:
        assert plane.texture is not None
        height, width = room.built.textures[plane.texture].shape[:2]
        across, up = plane_rectangle(plane)[2]
        assert width / height == pytest.approx(across / up, rel=0.02)


def test_correcting_nothing_gives_the_same_scene_byte_for_byte(room: Room) -> None:
    project, built = room.project, room.built
    scene_file = project.scene_path.read_bytes()
    inputs = project.load_inputs()
    assert inputs is not None

    again = build_project(project, inputs, LIBRARY)
    assert project.scene_path.read_bytes() == scene_file
    assert all(run.cached for run in again.runs if run.stage not in ("layout", "refinement"))

    assert len(built.scene.objects) == 3
    saved = {path.name for path in project.stages_folder.glob("*.zip")}
    for item in built.objects:
        box = LabelledBox(item.box, item.category, item.label)
        cache = project.stages_folder
        found = reconstruct_object(built.scene, inputs, LIBRARY, box, item.id, cache=cache)
        assert scene_to_json(replace_object(built.scene, item.id, found, LIBRARY)).encode() == scene_file
        here, there = found.item.candidates[0].pose, built.observed.object(item.id).candidates[0].pose
        assert np.allclose(here.position, there.position, atol=1e-9)
    assert {path.name for path in project.stages_folder.glob("*.zip")} == saved, "no stage is run again"


@pytest.mark.parametrize("room", [False], ids=["photo"], indirect=True)
def test_a_corrected_object_is_measured_in_the_room_that_the_build_had(room: Room, tmp_path: Path) -> None:
    inputs, built, cache = room.inputs, room.built, tmp_path / "stages"
    stages = stages_for("auto", inputs, LIBRARY)
    x1, y1, x2, y2 = inputs.boxes[2].box
    box = LabelledBox((x1 + 2, y1 + 1, x2 - 2, y2), "chair", "chair")
    found = reconstruct_object(built.scene, inputs, LIBRARY, box, built.objects[2].id, cache=cache)
    assert not found.as_built
    assert found.support is not None
    assert found.support.parent == "floor"
    names = {path.name.rsplit("-", 1)[0] for path in cache.glob("*.zip")}
    assert names == {"camera", "objects", "naming", "geometry", "architecture", *(["graph"] if stages.graph else [])}


def test_every_object_has_reasons_for_its_kind_place_and_support(room: Room) -> None:
    built, project = room.built, room.project
    by_decision = {
        item.id: {r.decision for r in built.reasons if r.object_id == item.id} for item in built.scene.objects
    }
    assert all({"kind", "place", "support"} <= decisions for decisions in by_decision.values()), by_decision
    chair = next(item for item in built.scene.objects if item.category == "chair")
    (word,) = [r for r in built.reasons if r.object_id == chair.id and r.term == "word"]
    assert word.sentence == "named “chair” by you"
    assert word.amount > 3.0
    assert len(strongest(built.reasons, chair.id)) == 2
    kept, damage = load_reasons(project)
    assert not damage
    assert {(r.object_id, r.decision, r.term) for r in kept} == {
        (r.object_id, r.decision, r.term) for r in built.reasons
    }
    measured = built.inputs.depth_m is not None
    assert any(r.term == "depth" for r in built.reasons) == measured
    assert any(r.term == "outline" for r in built.reasons) != measured


class Counting:
    """A stage that records which of its methods were called."""

    def __init__(self, stage: object, calls: list[str]) -> None:
        self.stage, self.calls = stage, calls

    def __repr__(self) -> str:
        return repr(self.stage)

    def __getattr__(self, name: str) -> object:
        method = getattr(self.stage, name)

        def counted(*given: object, **more: object) -> object:
            self.calls.append(name)
            return method(*given, **more)

        return counted if callable(method) else method


def test_only_the_steps_that_lead_to_what_is_wanted_run() -> None:
    inputs, calls = room_inputs(depth=False), list[str]()
    plain = embedded_stages(inputs, LIBRARY)
    counted = {s.name: getattr(plain, s.name) for s in PLAN if isinstance(s, StageStep)}
    counting: dict[str, Any] = {n: Counting(stage, calls) for n, stage in counted.items() if stage is not None}
    stages = replace(plain, **counting)
    known = evaluate(stages, {"given": inputs}, ("outlined_objects",), Runner(None), Progress())
    assert calls == ["segment"]
    evaluate(stages, known, ("supported_geometry",), Runner(None), Progress())
    assert calls == ["segment", "estimate", "name", "measure"]


def test_an_unknown_artefact_is_named() -> None:
    inputs = room_inputs(depth=False)
    with pytest.raises(KeyError, match="skeleton"):
        evaluate(embedded_stages(inputs, LIBRARY), {"given": inputs}, ("skeleton",), Runner(None))


def test_every_step_takes_what_an_earlier_one_gives() -> None:
    known = {"given", "library", "stages", *DEFAULTS}
    for step in PLAN:
        assert set(step.takes) <= known, step
        assert step.gives not in known
        known.add(step.gives)
    fields = set(Stages.__dataclass_fields__)
    assert {s.name for s in PLAN if isinstance(s, StageStep | LayoutStep)} == fields - {"filler"}


def test_a_step_beside_the_others_is_waited_for_where_it_is_needed() -> None:
    inputs, free, order = room_inputs(depth=False), Event(), list[str]()

    def slow(stages: Stages) -> str:
        order.append("slow begun")
        assert free.wait(60.0), "the step after it waited for it"
        order.append("slow done")
        return "slow"

    def other(stages: Stages) -> str:
        free.set()
        return "other"

    def both(one: str, two: str) -> str:
        order.append("both known")
        return one + two

    steps = (
        Derivation(slow, ("stages",), "slow", beside=True),
        Derivation(other, ("stages",), "other"),
        Derivation(both, ("slow", "other"), "both"),
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(plan, "PLAN", steps)
        found = evaluate(embedded_stages(inputs, LIBRARY), {"given": inputs}, ("both",), Runner(None))
    assert found["both"] == "slowother"
    assert order == ["slow begun", "slow done", "both known"]


def test_the_plan_ends_at_the_scene_that_a_build_gives(room: Room) -> None:
    built = room.built
    assert built.stages is not None
    given = {"given": room.inputs, "library": LIBRARY}
    found = evaluate(built.stages, given, ("scene", "textures"), Runner(room.project.stages_folder))
    assert scene_to_json(found["scene"]) == scene_to_json(built.scene)
    assert found["textures"].keys() == built.textures.keys()


def test_the_page_about_how_it_works_has_every_stage_in_the_order_of_the_plan() -> None:
    page = (Path(__file__).parents[2] / "docs" / "how-it-works.md").read_text()
    diagram = page.split("```")[1]
    names = [step.name for step in PLAN if isinstance(step, (StageStep, LayoutStep))]
    lines = [re.search(rf"^  [a-z_, ]*\b{name}\b", diagram, re.MULTILINE) for name in names]
    places = [line.end() for line in lines if line is not None]
    assert len(places) == len(names)
    assert places == sorted(places)
    assert all(re.search(rf"\*\*[^*]*\b{name}\b", page, re.IGNORECASE) for name in names if "_" not in name)


def posed(object_id: str, *shapes: str) -> PosedCandidates:
    """Ranked shapes, each where its rank says."""
    made = tuple(
        Candidate(s, PRIMITIVES.shape(s).size_m, 1.0 - k / 10, Pose.upright((k, 2.6, 0.5)))
        for k, s in enumerate(shapes)
    )
    return PosedCandidates(object_id, made, 0.7)


def scene_of(*found: PosedCandidates, edges=EDGES, colours=None):
    estimate = ArchitectureEstimate(Architecture(SHOT.planes), edges, 1.0, RoomSource(RoomMethod.GIVEN))
    return assemble(SHOT.objects, SHOT.geometry, estimate, found, PRIMITIVES, colours or {})


def test_every_object_is_its_best_candidate_with_all_it_came_from() -> None:
    colour = (0.1, 0.2, 0.3)
    scene = scene_of(
        posed("table", "table", "chair"), posed("tray", "ball"), posed("ball", "ball"), colours={"table": colour}
    )
    table = scene.object("table")
    assert (table.shape_id, table.confidence, table.colour) == ("table", 0.7, colour)
    assert [c.shape_id for c in table.candidates] == ["table", "chair"]
    assert table.pose == table.candidates[0].pose
    assert table.box_px == SHOT.objects[0].box
    assert table.mask_id == SHOT.objects[0].mask_id
    assert scene.supports == EDGES
    assert scene.camera == SHOT.camera
    assert scene.architecture.planes == SHOT.planes


def test_an_unknown_object_takes_the_category_and_the_name_of_its_shape() -> None:
    scene = scene_of(posed("tray", "ball"))
    assert scene.object("tray").category == "toy"
    assert (SHOT.objects[1].label, scene.object("tray").label) == ("object", "toy")


def test_what_found_no_shape_is_left_out_and_hands_on_what_it_held() -> None:
    scene = scene_of(posed("table", "table"), posed("ball", "ball"), PosedCandidates("tray", (), 0.0))
    assert not scene.has_object("tray")
    assert scene.support_of("ball").parent == "table"
    floor_only = scene_of(posed("ball", "ball"))
    assert floor_only.support_of("ball").parent == "floor"


def test_an_edge_that_leads_nowhere_is_dropped() -> None:
    lost = (replace(EDGES[0], parent="nowhere"), *EDGES[1:])
    scene = scene_of(posed("table", "table"), posed("ball", "ball"), edges=lost)
    assert scene.support_of("table") is None
    assert scene.support_of("ball").parent == "table"
    assert np.isfinite(scene.object("ball").pose.position).all()
