"""The bench of rooms from text: its prompts, its measures, its tables."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from diorama_app.cli import main
from diorama_core.editing.relations import RelationKind
from diorama_core.evaluation.benchmarks.text import SERIES, prompts_of, run
from diorama_core.evaluation.metrics.text_scene import Asked, measure
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.taxonomy import category
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from diorama_core.text.compose import compose_room

PROMPT = "a sofa against the wall and a red rug under a coffee table"
ASKED = Asked(
    PROMPT,
    {"sofa": 1, "rug": 1, "coffee table": 1},
    {"rug": ("red",)},
    (("sofa", "against wall", ()), ("rug", "under", ("coffee table",))),
)


@pytest.fixture(scope="module")
def room() -> Scene:
    return compose_room(PROMPT, built_in_library()).scene


def test_prompts_are_64_and_ask_for_what_there_is() -> None:
    prompts = [asked for series in SERIES for asked in prompts_of(series)]
    assert len({asked.prompt for asked in prompts}) == 64
    for asked in prompts:
        names = {*asked.counts, *asked.looks, *asked.rows, *(n for s, _, t in asked.relations for n in (s, *t))}
        assert all(category(name).name == name for name in names)
        assert all(kind in get_args(RelationKind) for _, kind, _ in asked.relations)


def test_a_room_that_has_everything_is_full_marks(room: Scene) -> None:
    result = measure(ASKED, room, built_in_library())
    assert result.all_met, result.failures
    assert result.colliding[0] == result.outside[0] == 0
    assert result.supported[0] == result.supported[1]
    assert 0.0 <= result.accessible <= 1.0
    assert result.navigable > 0.5


def test_what_is_wrong_lowers_its_own_measure(room: Scene) -> None:
    library = built_in_library()
    without = measure(ASKED, edits.remove(room, ["rug_1"]), library)
    assert without.counts == (2, 3)
    assert without.object_relations == (0, 1)
    sofa = room.object("sofa_1")
    middle = np.mean([p.centre for p in room.architecture.by_role("floor")], axis=0)
    free = replace(sofa.pose, position=np.array([*middle[:2], sofa.pose.position[2]]))
    assert measure(ASKED, edits.move(room, "sofa_1", free), library).room_relations == (0, 1)
    floating = edits.move(room, "sofa_1", sofa.pose.move((0.0, 0.0, 0.3)))
    assert measure(ASKED, floating, library).supported[0] < len(room.objects)
    out = measure(ASKED, edits.move(room, "sofa_1", sofa.pose.move((9.0, 0.0, 0.0))), library)
    assert out.outside[0] == 1
    table = room.object("coffee_table_1").pose.position
    into = replace(sofa.pose, position=np.array([*table[:2], sofa.pose.position[2]]))
    assert measure(ASKED, edits.move(room, "sofa_1", into), library).colliding[0] >= 2


def test_the_bench_has_a_row_for_each_series_and_a_sheet() -> None:
    bench, sheet = run(built_in_library(), 2, pictures=True)
    assert [len(t.rows) for t in bench.tables()] == [2, 2]
    assert sheet is not None
    assert sheet.shape[2] == 3
    assert json.loads(json.dumps(bench.to_json()))["bench"] == "text"


def test_the_command_prints_tables(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "text", "--scenes", "2", "--json", str(tmp_path / "text.json")]) == 0
    assert "object-architecture relation" in capsys.readouterr().out
    assert len(json.loads((tmp_path / "text.json").read_text())["prompts"]) == 2
