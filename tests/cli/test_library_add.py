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


@pytest.fixture(autouse=True)
def _own_libraries(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DIORAMA_LIBRARIES", str(tmp_path / "libraries"))


def one_line(capsys: pytest.CaptureFixture[str], arguments: list[str]) -> str:
    assert main(arguments) == 1
    said = capsys.readouterr()
    assert said.out == ""
    return said.err


def test_bad_folders_and_tables_are_one_clear_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    assert "is no folder" in one_line(capsys, ["library", "add", str(tmp_path / "nowhere")])
    assert "no model lies there" in one_line(capsys, ["library", "add", str(empty)])
    assert "no model of abo" in one_line(capsys, ["library", "add", str(empty), "--dataset", "abo"])
    assert "right angles" in one_line(capsys, ["library", "add", str(empty), "--up", "y", "--front=-y"])
    facts = tmp_path / "facts.csv"
    facts.write_text("file,up\ngone.glb,+y\n")
    assert "there is no model 'gone.glb'" in one_line(capsys, ["library", "add", str(empty), "--table", str(facts)])


def test_axes_and_units_have_names() -> None:
    assert [axis(a) for a in ("y", "+Z", "-x")] == ["+y", "+z", "-x"]
    with pytest.raises(argparse.ArgumentTypeError, match="no axis"):
        axis("up")
    assert [unit(u) for u in ("m", "CM", "mm", "in", "0.5")] == [1.0, 0.01, 0.001, 0.0254, 0.5]
    with pytest.raises(argparse.ArgumentTypeError):
        unit("-1")


def test_info_tells_surfaces_of_a_built_in_shape(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["library", "info", "bookshelf-oak-four"]) == 0
    said = capsys.readouterr().out
    assert "category" in said
    assert said.count("inside") == 4


@pytest.mark.slow
def test_a_folder_becomes_a_library_that_other_commands_use(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "Old Things"
    folder.mkdir()
    trimesh.Scene(trimesh.creation.box((0.6, 0.3, 0.6))).export(folder / "ottoman.glb")
    (folder / "broken.glb").write_bytes(b"glTF")
    assert main(["library", "add", str(folder), "--json", "--workers", "1"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert (report["library"], report["added"], len(report["failed"])) == ("old-things", ["ottoman"], 1)
    assert main(["library", "search", "pouf", "--library", "old-things"]) == 0
    assert "ottoman" in capsys.readouterr().out
    assert open_library("old-things+built-in").shape("ottoman").size_m[2] == pytest.approx(0.3, abs=1e-3)
