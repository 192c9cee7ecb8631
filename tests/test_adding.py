"""The examples of `docs/adding.md` work as they stand there."""

from __future__ import annotations

import argparse
import csv
import re
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import diorama_core as diorama
from diorama_core.artefacts import RankedShapes
from diorama_core.export import formats
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.furniture import articulation
from diorama_core.library.furniture.model import built
from diorama_core.progress import Progress
from diorama_core.protocols import RetrievalStage
from tests.export.scenes import scene_of

PAGE = Path(__file__).parents[1] / "docs" / "adding.md"
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL)
EXAMPLE = PAGE.parents[1] / "assets" / "example" / "project"
MAX_LINES = 30


def module_of(block: str, name: str, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """A block as a module that can be imported."""
    module = ModuleType(name)
    monkeypatch.setitem(sys.modules, name, module)
    exec(compile(block, str(PAGE), "exec", dont_inherit=True), module.__dict__)
    return module


def test_every_example_is_short() -> None:
    assert len(BLOCKS) == 6
    assert [len(block.splitlines()) for block in BLOCKS if len(block.splitlines()) > MAX_LINES] == []


def test_a_shape(monkeypatch: pytest.MonkeyPatch) -> None:
    (drum,) = module_of(BLOCKS[0], "drums", monkeypatch).DESIGNS
    solids = np.concatenate([solid.vertices for _, solid in built(drum)])
    assert np.ptp(solids, axis=0) == pytest.approx(drum.size_m, abs=1e-6)
    pieces = articulation._articulated(drum)
    assert [(joint.name, joint.kind) for joint in pieces.joints] == [("lid", "hinge")]


def test_a_format(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module_of(BLOCKS[2], "diorama_core.export.csv", monkeypatch)
    row = eval(BLOCKS[3], vars(formats))
    scene, library = scene_of("primitives")
    formats.export_scene(scene, library, tmp_path / "room.csv", row)
    with (tmp_path / "room.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert sorted(row["category"] for row in rows) == sorted(item.category for item in scene.objects)
    assert all(float(row["height_m"]) > 0 for row in rows)


def test_a_command(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser()
    module_of(BLOCKS[4], "diorama_app.cli.count", monkeypatch).add_count(parser.add_subparsers())
    arguments = parser.parse_args(["count", str(EXAMPLE)])
    arguments.run(arguments)
    counts = [int(line.split()[0]) for line in capsys.readouterr().out.splitlines()]
    assert sum(counts) == len(diorama.load(EXAMPLE).scene.objects)


class Fixed:
    """A retrieval stage that ranks the same chairs for everything."""

    def retrieve(self, inputs, objects, geometry, progress):
        chairs = built_in_library().in_category("chair")
        return (RankedShapes("chair_1", tuple((shape.id, 1.0) for shape in chairs)),)


def test_a_stage(monkeypatch: pytest.MonkeyPatch) -> None:
    library = built_in_library()
    stage = module_of(BLOCKS[5], "styled", monkeypatch).InOneStyle(Fixed(), library, "rustic")
    assert isinstance(stage, RetrievalStage)
    (row,) = stage.retrieve(None, (), None, Progress())
    (before,) = Fixed().retrieve(None, (), None, Progress())
    assert sorted(row.ranked) == sorted(before.ranked)
    styles = [library.shape(shape_id).style == "rustic" for shape_id, _ in row.ranked]
    assert styles == sorted(styles, reverse=True)
    assert True in styles
