from __future__ import annotations

import argparse
import json
from pathlib import Path

import pytest

from diorama_app.cli import main
from diorama_app.cli.build import add_build
from diorama_app.cli.many_photos import REPORT
from tests.cli.room_photo import write_room
from tests.cli.running import refused, told
from tests.few_shapes import stored_seats
from tests.processes import quick_workers

__all__ = ["quick_workers"]


@pytest.mark.usefixtures("quick_workers")
def test_a_folder_becomes_projects_and_a_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    photos, output = tmp_path / "photos", tmp_path / "out"
    photos.mkdir()
    _, boxes = write_room(photos, marked=1)
    boxes.rename(photos / "room.boxes.json")
    (photos / "broken.jpg").write_text("no picture")
    command = ["build", str(photos), "--out", str(output), "--workers", "1", "--profile", "embedded"]
    command += ["--library", stored_seats(), "--json"]
    assert main(command) == 1
    said = capsys.readouterr()
    rows = {Path(row["photo"]).name: row for row in json.loads(said.out)["photos"]}
    assert rows["room.png"]["state"] == "built"
    assert rows["room.png"]["result"]["objects"]
    assert rows["broken.jpg"]["state"] == "failed"
    assert "failed: broken.jpg: " in said.err
    assert "1 of 2 photos failed" in said.err
    assert "broken.jpg" in (output / REPORT).read_text()
    (photos / "broken.jpg").unlink()
    assert "1 of 1 photos became scenes (1 were finished before)" in told(capsys, command[:-1])
    assert main(["picture", str(output / "room"), "-o", str(tmp_path / "room.png"), "--size", "64x48"]) == 0


@pytest.mark.parametrize(
    ("option", "value"), [("--boxes", "b.json"), ("--fov", "60"), ("--arrangements", "2"), ("--depth", "d.png")]
)
def test_options_of_one_photo_are_refused_for_a_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], option: str, value: str
) -> None:
    write_room(tmp_path)
    assert f"{option} is for one photo" in refused(
        capsys, ["build", str(tmp_path), "--out", str(tmp_path / "out"), option, value]
    )


def test_options_of_a_folder_are_refused_for_one_photo(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    photo, _ = write_room(tmp_path)
    assert "for a folder of photos" in refused(
        capsys, ["build", str(photo), "-o", str(tmp_path / "out"), "--workers", "2"]
    )


@pytest.mark.parametrize("spelled", ["-o", "--output", "--out"])
def test_the_output_has_three_spellings(spelled: str) -> None:
    parser = argparse.ArgumentParser()
    add_build(parser.add_subparsers())
    assert parser.parse_args(["build", "photos", spelled, "rooms"]).output == Path("rooms")
