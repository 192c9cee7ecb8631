"""Commands in words, with and without a language model."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.perception.language.client import LmmSettings, strict_schema
from diorama_core.scene.types import Scene
from diorama_core.text.edit_plan import EditPlan
from diorama_core.text.editing_by_words import ProposedEdits, propose_edits
from diorama_core.text.language import edit_prompt
from tests.perception.language.stub_lmm import Answer, StubLmm, answering


def asked(scene: Scene, command: str, *answers: Answer, timeout_s: float = 5.0, delay_s: float = 0.0) -> ProposedEdits:
    with answering(StubLmm(list(answers), delay_s=delay_s)) as stub:
        settings = LmmSettings(stub.address, "stub", timeout_s=timeout_s, re_asks=1)
        return propose_edits(command, scene, built_in_library(), language_model=settings)


def test_several_clauses_are_one_proposal(dining: Scene) -> None:
    proposed = propose_edits("remove two chairs and add a plant in the corner; make it red", dining, built_in_library())
    assert len(proposed.edits) == 3
    assert proposed.scene.object("plant_2").colour is not None
    assert sum(o.category == "chair" for o in proposed.scene.objects) == 3
    assert "plant_2" in proposed.changed


def test_nothing_is_half_done(dining: Scene) -> None:
    with pytest.raises(EditRefused, match="no piano"):
        propose_edits("remove two chairs and remove the piano", dining, built_in_library())


def test_a_model_translates_and_may_name_what_it_adds(dining: Scene) -> None:
    wall, on_it = {"relation": "against wall", "targets": []}, {"relation": "on", "targets": ["new1"]}
    table = {"do": "insert", "what": "side table", "count": 1, "places": [wall], "name": "new1"}
    vase_on_it = {"do": "insert", "what": "vase", "count": 1, "places": [on_it], "name": ""}
    plan = {"edits": [table, vase_on_it], "not_understood": []}
    proposed = asked(dining, "somewhere to put flowers", json.dumps(plan))
    assert proposed.translator == "stub"
    vase = next(o for o in proposed.scene.objects if o.category == "vase" and not dining.has_object(o.id))
    edge = proposed.scene.support_of(vase.id)
    assert edge is not None
    assert proposed.scene.object(edge.parent).category == "side table"


@pytest.mark.parametrize(
    "answer",
    [
        "no JSON at all",
        json.dumps({"edits": [{"do": "explode", "objects": ["table_1"]}]}),
        json.dumps({"edits": [{"do": "remove", "objects": ["unicorn_1"]}], "not_understood": []}),
        json.dumps({"edits": [], "not_understood": ["remove the rug"]}),
        500,
    ],
    ids=["prose", "absurd edit", "unknown id", "gives up", "down"],
)
def test_bad_replies_leave_it_to_the_grammar(dining: Scene, answer: Answer) -> None:
    proposed = asked(dining, "remove the rug", answer)
    assert proposed.translator == "grammar"
    assert not proposed.scene.has_object("rug_1")
    assert "without the language model" in proposed.notes[0]


def test_a_slow_model_leaves_it_to_the_grammar(dining: Scene) -> None:
    proposed = asked(dining, "remove the rug", "{}", timeout_s=0.3, delay_s=1.0)
    assert proposed.translator == "grammar"


def test_what_neither_understands_is_refused(dining: Scene) -> None:
    with pytest.raises(EditRefused, match="sing a song"):
        asked(dining, "sing a song", json.dumps({"edits": [], "not_understood": ["sing a song"]}))


def test_the_schema_is_strict_and_the_prompt_names_every_object(dining: Scene) -> None:
    schema = json.dumps(strict_schema(EditPlan))
    assert "anyOf" in schema
    assert schema.count('"additionalProperties": false') >= 9
    assert all(f'"{o.id}"' in edit_prompt("x", dining) for o in dining.objects)


def test_endless_commands_are_refused(dining: Scene, tmp_path: Path) -> None:
    with pytest.raises(EditRefused, match="characters"):
        propose_edits("remove " * 400, dining, built_in_library())


def _refusal(command: str, scene: Scene) -> str:
    """Why a command is refused; empty where it is done."""
    try:
        propose_edits(command, scene, built_in_library(), selected=tuple(o.id for o in scene.objects[-1:]))
    except EditRefused as refused:
        return str(refused)
    return ""


def _crowd(scene: Scene, count: int, label: str = "armchair", category: str = "armchair") -> Scene:
    """The scene with many objects of one kind, far from everything."""
    item = next(o for o in scene.objects if o.category == "chair")
    many = [replace(item, id=f"{category}_{n}", label=label, category=category) for n in range(1, count + 1)]
    return replace(scene, objects=(*scene.objects, *many))


def test_an_edit_may_be_of_as_many_objects_as_a_scene_has(dining: Scene) -> None:
    """More than 500 were an internal error."""
    crowd = _crowd(dining, 600)
    proposed = propose_edits("make all armchairs red", crowd, built_in_library())
    assert sum(o.colour is not None for o in proposed.scene.objects if o.category == "armchair") == 600


@pytest.mark.parametrize(
    "command",
    [
        "add a " + "very " * 40 + "large red sofa",
        "replace the table with a " + "big " * 40 + "table",
        "make the table " + "light " * 40 + "blue",
        "paint the walls " + "dark " * 40 + "green",
        "add " + "a nice " * 60 + "lamp",
        "change all chairs into " + "small " * 60,
        "turn the table toward the " + "old " * 60 + "chair",
        "put a vase on the " + "x" * 500,
        "add 5000000000000000000000 chairs",
        "move the table " + "9" * 300 + " m to the left",
    ],
)
def test_long_commands_are_done_or_refused_in_one_line(dining: Scene, command: str) -> None:
    line = _refusal(command, dining)
    assert len(line) < 400
    assert "\n" not in line


def test_objects_of_long_names_are_done_or_refused_in_one_line(dining: Scene) -> None:
    crowd = _crowd(dining, 2, label="armchair " * 50)
    for command in (
        "make the armchair wooden",
        "replace the armchair with a stool",
        "turn the armchair toward the table",
    ):
        assert "\n" not in _refusal(command, crowd)
