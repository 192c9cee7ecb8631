from __future__ import annotations

import argparse
import json
from pathlib import Path

import pytest
import trimesh

from diorama_app.cli import main
from diorama_app.cli.arguments import unit
from diorama_app.cli.library_add import axis
from diorama_core.library.store import open_library
from tests.cli.running import refused, told


@pytest.fixture(autouse=True)
def _own_libraries(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path / "libraries"))


def test_bad_folders_and_tables_are_one_clear_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    assert "is no folder" in refused(capsys, ["library", "add", str(tmp_path / "nowhere")])
    assert "no model lies there" in refused(capsys, ["library", "add", str(empty)])
    assert main(["library", "add", str(empty), "--dataset", "abo"]) == 1
    assert "no model of abo" in capsys.readouterr().err, "behind what it is read as"
    assert "right angles" in refused(capsys, ["library", "add", str(empty), "--up", "y", "--front=-y"])
    facts = tmp_path / "facts.csv"
    facts.write_text("file,up\ngone.glb,+y\n")
    assert "there is no model 'gone.glb'" in refused(capsys, ["library", "add", str(empty), "--table", str(facts)])


def test_axes_and_units_have_names() -> None:
    assert [axis(a) for a in ("y", "+Z", "-x")] == ["+y", "+z", "-x"]
    with pytest.raises(argparse.ArgumentTypeError, match="no axis"):
        axis("up")
    assert [unit(u) for u in ("m", "CM", "mm", "in", "0.5")] == [1.0, 0.01, 0.001, 0.0254, 0.5]
    with pytest.raises(argparse.ArgumentTypeError):
        unit("-1")


def test_info_tells_surfaces_of_a_built_in_shape(capsys: pytest.CaptureFixture[str]) -> None:
    said = told(capsys, ["library", "info", "bookshelf-oak-four"])
    assert "category" in said
    assert said.count("inside") == 4


@pytest.mark.slow
def test_a_folder_becomes_a_library_that_other_commands_use(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "Old Things"
    folder.mkdir()
    trimesh.Scene(trimesh.creation.box((0.6, 0.3, 0.6))).export(folder / "ottoman.glb")
    (folder / "broken.glb").write_bytes(b"glTF")
    report = json.loads(told(capsys, ["library", "add", str(folder), "--json", "--workers", "1"]))
    assert (report["library"], report["added"], len(report["failed"])) == ("old-things", ["ottoman"], 1)
    assert "ottoman" in told(capsys, ["library", "search", "pouf", "--library", "old-things"])
    assert open_library("old-things+built-in").shape("ottoman").size_m[2] == pytest.approx(0.3, abs=1e-3)
