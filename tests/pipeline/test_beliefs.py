from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.arrangement.support_hypotheses import MEASURED, REASONED, ObservationNoise, SupportHypothesis
from diorama_core.arrangement.supports import DecidedSupports, SupportChoice
from diorama_core.artefacts import Cuboid, Inputs, LabelledBox, ObjectGeometry, PosedCandidates
from diorama_core.library.taxonomy import category
from diorama_core.pipeline.beliefs import BeliefSettings, with_beliefs
from diorama_core.pipeline.scene_steps import FinishedScene
from diorama_core.provenance import ScaleSource
from diorama_core.scene.belief import Belief
from diorama_core.scene.room_edits import KNOWN_LENGTH_SIGMA
from diorama_core.scene.types import Scene, Support
from tests.app.small_room import PlainLibrary, furnished_scene, plain_photo

BOX = (240.0, 200.0, 440.0, 420.0)
PLAIN = BeliefSettings(present=(0.0, 1.0), front=1.0, front_compared=0.0)


def choice(edge: Support, **probabilities: float) -> SupportChoice:
    return SupportChoice(SupportHypothesis(edge, "object", category("lamp")), {}, probabilities)


def beliefs_of(
    scene: Scene,
    *,
    boxes: tuple[LabelledBox, ...] = (),
    posed: tuple[PosedCandidates, ...] = (),
    choices: dict[str, SupportChoice] | None = None,
    noise: ObservationNoise = REASONED,
    settings: BeliefSettings = PLAIN,
    feet: bool = True,
) -> dict[str, Belief]:
    cuboids = tuple(
        Cuboid(o.id, o.pose.R_world_object, o.pose.position, o.size_m, 1.0, foot_seen=feet) for o in scene.objects
    )
    geometry = ObjectGeometry(scene.camera, cuboids, (), next(iter(ScaleSource)))
    decided = DecidedSupports(scene, choices or {}, ())
    inputs = Inputs(plain_photo(), boxes)
    found = with_beliefs(FinishedScene(scene, {}), inputs, geometry, posed, decided, noise, PlainLibrary(), settings)
    return {o.id: o.belief for o in found.objects}


def test_kinds_share_by_their_best_candidates() -> None:
    scene = furnished_scene()
    chair = scene.object("chair_1")
    table = replace(chair.candidates[0], shape_id="table_a", score=0.45)
    both = replace(chair, candidates=(*chair.candidates, table))
    scene = replace(scene, objects=tuple(both if o.id == "chair_1" else o for o in scene.objects))
    kinds = beliefs_of(scene, settings=replace(PLAIN, kind=1.0))["chair_1"].kinds
    assert kinds == (("chair", pytest.approx(0.9 / 1.35, abs=1e-3)), ("table", pytest.approx(0.45 / 1.35, abs=1e-3)))
    sharper = beliefs_of(scene, settings=replace(PLAIN, kind=2.0))["chair_1"].kinds
    assert sharper[0] == ("chair", pytest.approx(0.8, abs=1e-3)), "nobody named it"
    boxed = tuple(replace(o, box_px=BOX) if o.id == "chair_1" else o for o in scene.objects)
    named = beliefs_of(
        replace(scene, objects=boxed), boxes=(LabelledBox(BOX, "chair", "chair"),), settings=replace(PLAIN, kind=2.0)
    )
    assert named["chair_1"].kinds == kinds


def test_planes_and_the_scale_have_deviations() -> None:
    scene = furnished_scene()
    cuboids = tuple(Cuboid(o.id, o.pose.R_world_object, o.pose.position, o.size_m, 1.0) for o in scene.objects)
    geometry = ObjectGeometry(scene.camera, cuboids, (), next(iter(ScaleSource)), scale_sigma=0.07)
    finished, decided = FinishedScene(scene, {}), DecidedSupports(scene, {}, ())

    def believed(inputs: Inputs, noise: ObservationNoise) -> Scene:
        return with_beliefs(finished, inputs, geometry, (), decided, noise, PlainLibrary(), PLAIN)

    alone = believed(Inputs(plain_photo()), REASONED)
    assert alone.scale_sigma == 0.07
    assert {p.role: p.sigma_m for p in alone.architecture.planes if p.role != "wall"}["floor"] == 0.0
    walls = {p.sigma_m for p in alone.architecture.by_role("wall")}
    assert walls <= set(PLAIN.wall_m)
    said = believed(replace(Inputs(plain_photo()), camera_height_m=1.5), REASONED)
    assert said.scale_sigma == KNOWN_LENGTH_SIGMA
    measured = believed(Inputs(plain_photo()), MEASURED)
    assert measured.scale_sigma == MEASURED.along
    assert max(p.sigma_m or 0.0 for p in measured.architecture.by_role("wall") if p.is_seen) < min(PLAIN.wall_m)


def test_headings_become_quarter_turns_from_where_it_faces() -> None:
    scene = furnished_scene()
    headings = np.zeros(24)
    headings[round(scene.object("chair_1").pose.yaw_rad / (2 * np.pi / 24)) % 24 - 24 + 6] = 1.0
    posed = (PosedCandidates("chair_1", scene.object("chair_1").candidates, 1.0, headings=tuple(headings)),)
    assert beliefs_of(scene, posed=posed)["chair_1"].fronts == (0.0, 1.0, 0.0, 0.0)
    compared = beliefs_of(scene, posed=posed, settings=replace(PLAIN, front_compared=0.6))["chair_1"].fronts
    assert compared == (0.6, 0.4, 0.0, 0.0)
    assert beliefs_of(scene)["chair_1"].fronts == ()
    assert beliefs_of(scene, posed=posed)["lamp_1"].fronts == (1.0, 0.0, 0.0, 0.0), "a lamp has no front"


def test_the_supporter_that_it_has_is_first_however_likely() -> None:
    choices = {"lamp_1": choice(Support("lamp_1", "table_1"), floor=0.7, table_1=0.3)}
    assert beliefs_of(furnished_scene(), choices=choices)["lamp_1"].supporters == (("table_1", 0.3), ("floor", 0.7))


def test_what_a_person_drew_is_there_and_what_a_detector_found_is_likely_there() -> None:
    scene = furnished_scene()
    seen = replace(scene.object("chair_1"), box_px=BOX)
    scene = replace(scene, objects=tuple(seen if o.id == "chair_1" else o for o in scene.objects))
    drawn = beliefs_of(scene, boxes=(LabelledBox(BOX, "chair", "chair"),))
    found = beliefs_of(scene, boxes=(LabelledBox(BOX, "chair", "chair", 0.7, guessed=True),))
    assert drawn["chair_1"].present == 1.0
    assert found["chair_1"].present == pytest.approx(0.7)


def test_what_was_measured_is_nearer_to_the_truth_than_what_was_reasoned() -> None:
    reasoned, hidden, measured = (
        beliefs_of(furnished_scene(), noise=noise, feet=feet)["chair_1"]
        for noise, feet in ((REASONED, True), (REASONED, False), (MEASURED, True))
    )
    assert measured.place_sigma_m < reasoned.place_sigma_m < hidden.place_sigma_m
    assert measured.size_sigma < reasoned.size_sigma < hidden.size_sigma
