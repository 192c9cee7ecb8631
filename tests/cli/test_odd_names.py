"""Names that are no UTF-8, through the commands."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

from diorama_core.project.storage import Project
from tests.app.small_room import furnished_scene, make_project
from tests.cli.room_photo import write_room
from tests.few_shapes import stored_seats


def _run(*command: bytes) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([os.fsencode(sys.executable), b"-m", b"diorama_app.cli", *command], capture_output=True)


def test_a_photo_and_its_project_may_be_called_anything(tmp_path: Path) -> None:
    """A project built from `caf\\xe9.jpg` could never be opened again."""
    photo, boxes = write_room(tmp_path, marked=1)
    named, output = os.fsencode(tmp_path) + b"/caf\xe9.png", os.fsencode(tmp_path) + b"/r\xf6om"
    os.rename(photo, named)
    given = (b"--boxes", os.fsencode(boxes), b"--profile", b"embedded", b"--library", os.fsencode(stored_seats()))
    done = _run(b"build", named, *given, b"-o", output, b"--json")
    assert done.returncode == 0, done.stderr
    json.loads(done.stdout)
    project = Project.open(Path(os.fsdecode(output)))
    assert project.name == "r\\xf6om"
    assert project.load_inputs() is not None


def test_an_export_of_a_project_with_any_name(tmp_path: Path) -> None:
    project = make_project(tmp_path / os.fsdecode(b"r\xf6om"), replace(furnished_scene(), objects=(), supports=()))
    done = _run(b"export", os.fsencode(project.folder), b"--format", b"svg")
    assert done.returncode == 0, done.stderr
