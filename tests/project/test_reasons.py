"""Reasons are kept with their project as data; a damaged file is named and costs nothing else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from diorama_core.artefacts import Reason
from diorama_core.project.reasons import NAME, load_reasons, save_reasons
from diorama_core.project.storage import Project

WEAK = Reason("chair_1", "place", "layout", 1.5, "cm", "it rests on something, clear of the others")
STRONG = Reason("chair_1", "kind", "word", 5.25, "nats", "named “chair” by you")
OTHER = Reason("table_1", "kind", "word", 5.0, "nats", "named “table” by you")


def test_reasons_come_back_by_object_strongest_first(tmp_path: Path) -> None:
    project = Project.create(tmp_path / "room")
    assert load_reasons(project) == ((), "")
    save_reasons(project, (WEAK, STRONG, OTHER))
    assert load_reasons(project) == ((STRONG, WEAK, OTHER), "")
    document = json.loads((project.folder / NAME).read_text("utf-8"))
    assert document["objects"]["chair_1"][0] == {
        "decision": "kind",
        "term": "word",
        "amount": 5.25,
        "unit": "nats",
        "sentence": "named “chair” by you",
    }


@pytest.mark.parametrize(
    "content",
    [
        "{",
        "[]",
        '{"format": "diorama-reasons", "version": 2}',
        '{"format": "diorama-reasons", "version": 1, "objects": {"a": [{"decision": "mood"}]}}',
        '{"format": "diorama-reasons", "version": 1, "objects": {"a": 3}}',
    ],
)
def test_a_damaged_file_is_named_in_one_line(tmp_path: Path, content: str) -> None:
    project = Project.create(tmp_path / "room")
    (project.folder / NAME).write_text(content, "utf-8")
    found, damage = load_reasons(project)
    assert not found
    assert NAME in damage
    assert "\n" not in damage
