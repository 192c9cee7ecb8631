from __future__ import annotations

import argparse
import os
import shlex
import signal
import time
from pathlib import Path

import pytest

from diorama_app.cli import command_parser
from diorama_app.cli.arguments import (
    command,
    field_of_view,
    intrinsics,
    positive,
    print_note,
    progress_bar,
    projects_folder,
    size,
    view,
)
from diorama_core.errors import Cancelled


@pytest.mark.parametrize(
    ("read", "text", "value"),
    [
        (positive, "2.5", 2.5),
        (field_of_view, "66", 66.0),
        (intrinsics, "500,510,320,240.5", (500.0, 510.0, 320.0, 240.5)),
        (intrinsics, "500,510,-3,240", (500.0, 510.0, -3.0, 240.0)),
        (view, "orbit:-30", "orbit:-30"),
        (view, "turntable", "turntable"),
        (size, "1024X768", (1024, 768)),
    ],
)
def test_good_words_are_read(read, text: str, value: object) -> None:
    assert read(text) == value


@pytest.mark.parametrize(
    ("read", "text"),
    [
        (positive, "0"), (positive, "-1"), (positive, "inf"), (positive, "nan"),
        (field_of_view, "4"), (field_of_view, "151"),
        (intrinsics, "500"), (intrinsics, "500,500,320,240,1"), (intrinsics, "0,500,320,240"), (intrinsics, "a,b,c,d"),
        (view, "orbit:"), (view, "orbit:inf"), (view, "below"), (view, "photo:3"),
        (size, "1024"), (size, "15x100"), (size, "100x9000"), (size, "axb"),
    ],
)  # fmt: skip
def test_bad_words_are_refused_naming_them(read, text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match=text.split(":")[0]):
        read(text)


def test_a_command_runs_its_function_and_shows_its_example(capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser()
    made = command(parser.add_subparsers(), "go", lambda a: 7, "diorama go --far", "Goes.")
    made.add_argument("--far", action="store_true")
    a = parser.parse_args(["go", "--far", "--verbose"])
    assert a.run(a) == 7
    assert a.far
    assert a.verbose
    with pytest.raises(SystemExit):
        parser.parse_args(["go", "--fa"])
    with pytest.raises(SystemExit):
        parser.parse_args(["go", "--help"])
    assert "example:\n  diorama go --far" in capsys.readouterr().out


def test_notes_go_to_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    print_note("the floor was guessed")
    captured = capsys.readouterr()
    assert captured.err == "diorama: note: the floor was guessed\n"
    assert captured.out == ""


def test_projects_are_where_they_were_or_among_the_documents(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr("platformdirs.user_documents_path", lambda: tmp_path / "Papers")
    assert projects_folder(tmp_path / "given") == tmp_path / "given"
    assert projects_folder(None) == tmp_path / "Papers" / "Diorama"
    (tmp_path / "Diorama").mkdir()
    assert projects_folder(None) == tmp_path / "Diorama"


def interrupt() -> None:
    """As Ctrl+C does; the handler runs at the next instruction."""
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(0.01)


@pytest.mark.posix
def test_without_a_terminal_every_new_message_is_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_bar() as progress:
        for fraction, message in ((0.0, "Reading"), (0.3, "Reading"), (0.5, "Building"), (1.0, "Building")):
            progress.report(fraction, message)
    assert capsys.readouterr().err.splitlines() == ["  0% Reading", " 50% Building"]


def interrupted(times: int) -> None:
    """Work that Ctrl+C is pressed in."""
    with progress_bar() as progress:
        progress.report(0.1, "a")
        for _ in range(times):
            interrupt()
        progress.report(0.2, "b")


@pytest.mark.posix
def test_ctrl_c_stops_at_the_next_check_and_a_second_one_at_once() -> None:
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(Cancelled):
        interrupted(1)
    with pytest.raises(KeyboardInterrupt):
        interrupted(2)
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize(
    "line",
    [
        "serve room --host 127.0.0.1 --port 8080 --projects rooms --no-open --low-graphics --token T",
        "build a.jpg -o room --depth d.png --fov 60 --boxes b.json --masks m.png --profile embedded --arrangements 3",
        "build a.jpg -o room --intrinsics 500,500,320,240 --library built-in --seed 0 --explain why.json --flat",
        "build a.jpg -o room --detector boxes.onnx --depth-network depth.onnx",
        "build photos --out rooms --workers 2 --ray auto",
        "optimise room --recipe all-in-one --json",
        "text 'a reading corner' -o room",
        *(f"export room --format {f} -o room.x" for f in ("glb", "usda", "csv", "occupancy", "robot", "game")),
        "import room.glb -o room",
        "picture room -o room.png --view orbit:30 --size 640x480",
        "library add models --name mine --ray auto",
        "library search 'oak chair' --image chair.jpg -k 10",
        *(f"library {words}" for words in ("build", "list", "info ID", "sheet")),
        *(f"models {words}" for words in ("list", "verify", "check", "path", "pull micro", "pull paper")),
        "edit room 'make all chairs wooden' --yes",
        "api --port 8000",
        "bench system --scenes 4 --seed 1 --json rows.json --substitute room,height",
        "bench photos a.json --photos pictures --unnamed --perturbed --folds 5 --json rows.json",
        "bench questions --scenes 4",
        "review room --json --answer chair.front=180",
        "mcp room --http 8000",
        *(f"project {words}" for words in ("list", "copy room", "zip room", "unzip room.zip")),
        "doctor",
    ],
)
def test_the_commands_that_others_rely_on_are_understood(line: str) -> None:
    command_parser().parse_args(shlex.split(line))
