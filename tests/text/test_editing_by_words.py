"""Commands in words, with and without a language model."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.perception.language.client import LmmSettings, strict_schema
from diorama_core.scene.types import Scene
from diorama_core.synthesis.grammar import furnished_room
from diorama_core.text.edit_plan import EditPlan
from diorama_core.text.edit_prompt import edit_prompt
from diorama_core.text.editing_by_words import ProposedEdits, propose_edits
from tests.perception.language.stub_lmm import Answer, StubLmm, answering


@pytest.fixture(scope="module")
def dining() -> Scene:
    return furnished_room(2, "dining", built_in_library(), outline="box", clutter=6)


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
