"""Names that are no UTF-8, through the commands."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from diorama_core.project.storage import Project
from tests.cli.room_photo import write_room
from tests.few_shapes import stored_seats

PROGRAM = """
import sys, tests.small_planes
from diorama_app.cli import main
then = sys.argv.index("then")
assert main(sys.argv[1:then]) == 0
print()
sys.exit(main(sys.argv[then + 1:]))
"""


def test_a_photo_and_its_project_may_be_called_anything(tmp_path: Path) -> None:
    """A project built from `caf\\xe9.jpg` could never be opened again."""
    photo, boxes = write_room(tmp_path, marked=1)
    named, output = os.fsencode(tmp_path) + b"/caf\xe9.png", os.fsencode(tmp_path) + b"/r\xf6om"
    os.rename(photo, named)
    build = [b"build", named, b"--boxes", os.fsencode(boxes), b"--profile", b"embedded", b"-o", output, b"--json"]
    command = [*build, b"--library", os.fsencode(stored_seats()), b"then", b"export", output, b"--format", b"svg"]
    done = subprocess.run([os.fsencode(sys.executable), b"-c", PROGRAM.encode(), *command], capture_output=True)
    assert done.returncode == 0, done.stderr
    json.loads(done.stdout.rpartition(b"\n\n")[0])
    project = Project.open(Path(os.fsdecode(output)))
    assert project.name == "r\\xf6om"
    assert project.load_inputs() is not None
    assert list(project.folder.rglob("*.svg"))
