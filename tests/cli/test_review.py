from __future__ import annotations

import json
from pathlib import Path

import pytest

from diorama_app.cli import main, review
from diorama_core.project.storage import Project
from diorama_core.scene.belief import Belief
from tests.cli.running import refused, told
from tests.review.doubtful_room import believed

DOUBT = Belief(kinds=(("chair", 0.6), ("stool", 0.4)))


@pytest.fixture
def room(tmp_path: Path) -> Path:
    from diorama_core.library.catalogue import built_in_library
    from diorama_core.synthesis.grammar import furnish_room

    project = Project.create(tmp_path / "room")
    scene = furnish_room(2, "dining", built_in_library(), outline="box", clutter=4)
    chair = next(o for o in scene.objects if o.category == "chair")
    project.save_scene(believed(scene, {chair.id: DOUBT}))
    return project.folder


def asked(room: Path, capsys: pytest.CaptureFixture[str]) -> list[dict]:
    return json.loads(told(capsys, ["review", str(room), "--json"]))["questions"]


def test_questions_are_told_and_answers_taken_without_anybody_there(room: Path, capsys) -> None:
    (question,) = asked(room, capsys)
    assert [c["value"] for c in question["choices"]] == ["chair", "stool"]
    assert main(["review", str(room), "--answer", f"{question['id']}=stool"]) == 0
    assert asked(room, capsys) == []
    scene = Project.open(room).load_scene()
    assert scene.object(question["object_id"]).category == "stool"


def test_a_person_answers_by_number_and_is_told_what_is_no_answer(room: Path, capsys, monkeypatch) -> None:
    replies = iter(["unicorn", "2"])
    monkeypatch.setattr(review.sys.stdin, "isatty", lambda: True)
    monkeypatch.setattr("builtins.input", lambda _: next(replies))
    assert main(["review", str(room)]) == 0
    said = capsys.readouterr()
    assert "unicorn" in said.err + said.out
    assert "0 questions left" in said.out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [([], "--json"), (["--answer", "chair"], "write it as"), (["--answer", "kind:x=y"], "again")],
)
def test_what_cannot_be_done_is_one_line(room: Path, capsys, arguments: list[str], words: str) -> None:
    assert words in refused(capsys, ["review", str(room), *arguments])
