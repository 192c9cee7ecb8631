"""Commands with libraries other than the built-in one."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_app.cli import main
from diorama_core.library.catalogue import built_in_library
from diorama_core.render.views import StudioView, render_shape
from tests.cli.room_photo import write_room
from tests.cli.running import refused, told
from tests.few_shapes import stored_seats


@pytest.fixture(scope="module")
def mine() -> str:
    return stored_seats()


def test_listing_and_searching_a_stored_library(mine: str, capsys: pytest.CaptureFixture[str]) -> None:
    def ids(*words: str) -> list[str]:
        return [row["id"] for row in json.loads(told(capsys, ["library", *words, "--json"]))]

    listed = ids("list", "--library", mine)
    assert len(listed) == 4
    assert all(i.startswith("my-") for i in listed)
    found = ids("search", "couches", "--library", f"built-in+{mine}", "-k", "200")
    assert any(i.startswith("my-sofa") for i in found)
    assert any(not i.startswith("my-") for i in found)


def test_searching_by_a_picture(mine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    built_in = built_in_library()
    sofa = built_in.in_category("sofa")[0]
    Image.fromarray(render_shape(built_in, sofa.id, (120, 120), StudioView(0.4, 0.25))).save(tmp_path / "sofa.png")
    command = ["library", "search", "--image", str(tmp_path / "sofa.png"), "--library", mine, "-k", "1", "--json"]
    assert json.loads(told(capsys, command))[0]["id"] == f"my-{sofa.id}"


def test_unknown_nouns_are_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["library", "search", "chifforobe"]) == 0
    assert "nearest is 'wardrobe'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["search", "chair", "--library", "nobody's"], "cannot be called"),
        (["search", "chair", "--library", "absent"], "no library 'absent'; available: built-in"),
        (["search"], "in words or with --image"),
        (["search", "chair", "--image", "absent.png"], "absent.png cannot be read"),
        (["build", "--workers", "0"], "at least one"),
    ],
)
def test_mistakes_are_told_in_one_line(arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert says in refused(capsys, ["library", *arguments])


def test_a_project_keeps_to_its_library(mine: str, tmp_path: Path) -> None:
    photo, boxes = write_room(tmp_path)
    project = tmp_path / "room"
    assert main(["build", str(photo), "--boxes", str(boxes), "-o", str(project), "--library", mine]) == 0
    scene = json.loads((project / "scene.json").read_text())
    assert scene["objects"]
    assert all(o["shape"].startswith("my-") for o in scene["objects"])
    assert json.loads((project / "project.json").read_text())["library"] == mine
    assert main(["export", str(project), "--format", "glb", "-o", str(tmp_path / "room.glb")]) == 0
    assert main(["picture", str(project), "-o", str(tmp_path / "top.png"), "--view", "top", "--size", "160x120"]) == 0
    assert np.asarray(Image.open(tmp_path / "top.png")).std() > 5
    assert main(["optimise", str(project)]) == 0
