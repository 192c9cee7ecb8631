from __future__ import annotations

import json
from pathlib import Path

import pytest

from diorama_app.cli import main, words
from diorama_core.library.catalogue import built_in_library
from diorama_core.project.storage import Project
from diorama_core.synthesis.grammar import furnish_room
from tests.cli.running import refused, told
from tests.perception.language.stub_lmm import StubLmm, answering


@pytest.fixture(autouse=True)
def _no_model(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DIORAMA_LMM_BASE_URL", raising=False)


@pytest.fixture
def room(tmp_path: Path) -> Path:
    project = Project.create(tmp_path / "room")
    project.save_scene(furnish_room(2, "dining", built_in_library(), outline="box", clutter=4))
    return project.folder


def test_edits_are_listed_made_and_saved(room: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = told(capsys, ["edit", str(room), "make all chairs wooden and paint the walls light blue", "--yes"])
    assert "make the walls light blue" in said
    assert "swap for" in said
    scene = Project.open(room).load_scene()
    assert len({p.colour for p in scene.architecture.by_role("wall")}) == 1
    assert len({o.shape_id for o in scene.objects if o.category == "chair"}) == 1


def test_nobody_to_ask_means_nothing_is_done(room: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (room / "scene.json").read_bytes()
    assert main(["edit", str(room), "remove the table"]) == 1
    assert "--yes" in capsys.readouterr().err
    assert (room / "scene.json").read_bytes() == before


@pytest.mark.parametrize(("answer", "done"), [("y", True), ("", False), ("no", False)])
def test_a_person_is_asked(room: Path, monkeypatch: pytest.MonkeyPatch, answer: str, done: bool) -> None:
    before = len(Project.open(room).load_scene().objects)
    monkeypatch.setattr(words.sys.stdin, "isatty", lambda: True)
    monkeypatch.setattr("builtins.input", lambda _: answer)
    assert main(["edit", str(room), "remove all chairs"]) == 0
    assert (len(Project.open(room).load_scene().objects) < before) == done


def test_json_is_one_document_and_makes_the_edits_only_with_yes(room: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (room / "scene.json").read_bytes()
    report = json.loads(told(capsys, ["edit", str(room), "a rug under the table", "--json"]))
    assert (report["done"], report["translator"], report["edits"][0]["do"]) == (False, "grammar", "insert")
    assert (room / "scene.json").read_bytes() == before
    assert json.loads(told(capsys, ["edit", str(room), "a rug under the table", "--json", "--yes"]))["done"]
    assert (room / "scene.json").read_bytes() != before


@pytest.mark.parametrize("words", ["", "remove the piano", "fly to the moon", "remove all chairs and dance"])
def test_failures_are_one_clear_line_and_change_nothing(
    room: Path, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = (room / "scene.json").read_bytes()
    assert refused(capsys, ["edit", str(room), words, "--yes"])
    assert (room / "scene.json").read_bytes() == before


def test_a_language_model_translates_where_there_is_one(
    room: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("DIORAMA_CACHE", str(tmp_path / "cache"))
    plan = {"edits": [{"do": "remove", "objects": ["chair_1"]}], "not_understood": []}
    with answering(StubLmm([json.dumps(plan)])) as stub:
        monkeypatch.setenv("DIORAMA_LMM_BASE_URL", stub.address)
        monkeypatch.setenv("DIORAMA_LMM_MODEL", "stub")
        report = json.loads(told(capsys, ["edit", str(room), "one seat too many, I think", "--json", "--yes"]))
    assert report["translator"] == "stub"
    assert report["lines"] == ["remove chair 1"]
    assert not Project.open(room).load_scene().has_object("chair_1")
