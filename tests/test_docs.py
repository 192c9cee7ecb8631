"""The code on the page about Python runs as it stands there, from the first block to the last."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import diorama_core as diorama
from diorama_core.library.catalogue import base_id
from tests.cli.room_photo import write_room

DOCS = Path(__file__).parents[1] / "docs"
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def executed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The names that the page's blocks define, executed one after another beside `room.jpg` and `boxes.json`."""
    folder = tmp_path_factory.mktemp("page")
    photo, _ = write_room(folder, marked=1)
    photo.rename(folder / "room.jpg")
    page = DOCS / "python.md"
    names: dict[str, Any] = {"__name__": "page"}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for block in BLOCK.finditer(page.read_text()):
            line = page.read_text()[: block.start(1)].count("\n")
            exec(compile("\n" * line + block.group(1), str(page), "exec", dont_inherit=True), names)
    return {**names, "folder": folder}


@pytest.mark.slow
def test_the_page_s_files_and_values_are_there(executed: dict[str, Any]) -> None:
    assert (executed["folder"] / "room.glb").stat().st_size > 1000
    assert executed["again"].scene == executed["optimised"].scene
    assert executed["picture"].shape == (240, 320, 3)


@pytest.mark.slow
def test_the_page_s_retrieval_stage_ran(executed: dict[str, Any]) -> None:
    mine, stage = executed["mine"], executed["NearestSize"](executed["library"])
    assert repr(stage) in {run.used for run in mine.built.runs if run.stage == "retrieval"}
    sizes = {c.object_id: c.size_m for c in mine.built.geometry.cuboids}
    for item in mine.scene.objects:
        shapes = executed["library"].in_category(item.category)
        off = {s.id: float(np.abs(np.log(sizes[item.id] / s.size_m)).sum()) for s in shapes}
        assert {base_id(c.shape_id) for c in item.candidates} <= set(sorted(off, key=lambda i: off[i])[: stage.count])


@pytest.mark.slow
def test_the_page_s_wrapped_stage_ran(executed: dict[str, Any]) -> None:
    used = {run.stage: run.used for run in executed["bare"].built.runs}
    assert used["objects"].startswith("WithoutRugs(other=EmbeddedMasks(")


def test_the_page_names_everything_public() -> None:
    text = (DOCS / "python.md").read_text()
    assert all(f"`{name}`" in text for name in diorama.__all__)
