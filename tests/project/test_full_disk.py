"""A disk that is really full: a small one of its own, in a namespace of its own.

What fails ends in one line, leaves no parts of files, and goes on where it was as soon as there is space.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

BEGIN = """
import subprocess, sys, time
from dataclasses import replace
from pathlib import Path
from diorama_core.errors import DioramaError
from tests.app.small_room import PlainLibrary, furnished_scene, make_project, plain_photo
disk = Path(sys.argv[1])
def sized(size):
    subprocess.run(["mount", "-o", f"remount,size={size}", str(disk)], check=True)
def parts():
    return [p.name for p in disk.rglob("*") if p.name.endswith(".part")]
subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", str(disk)], check=True)
"""
BUILD = """
import diorama_core as diorama
import tests.small_planes
picture = plain_photo(160, 120).rgb
boxes = [{"bbox": [60, 50, 110, 105], "class": "table"}]
refused = 0
for kilobytes in (8, 48, 112, 65536):
    sized(f"{kilobytes}k")
    try:
        diorama.build(picture, boxes=boxes, library=PlainLibrary(), output=disk / "room")
    except DioramaError as error:
        refused += 1
        line = str(error)
        assert "No space left" in line and "\\n" not in line and len(line) < 600, line
        assert parts() == [], parts()
        print(kilobytes, "kB:", line)
    else:
        print(kilobytes, "kB: built")
        break
assert refused >= 3, refused
assert diorama.load(disk / "room", library=PlainLibrary()).scene.objects
assert parts() == []
"""
SAVE = """
from diorama_app.session.autosave import Autosave
from diorama_app.session.recovery import Recovery
from diorama_core.scene.edits import rename
sized("4m")
project = make_project(disk / "demo")
before = project.scene_path.read_bytes()
filler = disk / "filler"
with filler.open("wb", buffering=0) as stream:
    try:
        while stream.write(bytes(4096)):
            pass
    except OSError:
        pass
told = []
saver = Autosave(told.append, Recovery(disk / "unsaved"), on_saved=told.append, retry_s=0.1)
saver.save_soon(project, rename(furnished_scene(), "chair_1", "throne"))
def wait_for(true):
    until = time.monotonic() + 60.0
    while not true() and time.monotonic() < until:
        time.sleep(0.02)
    assert true(), told
wait_for(lambda: told)
assert "No space left" in told[0] and "only in memory" in told[0], told
assert project.scene_path.read_bytes() == before and parts() == []
filler.unlink()
wait_for(lambda: len(told) > 1)
assert told[1] == "All changes are saved now." and len(told) == 2, told
assert project.load_scene().object("chair_1").label == "throne" and parts() == []
saver.stop()
"""
EXPORT = """
from diorama_core.export import export_scene
from diorama_core.export.formats import FORMATS
sized("4m")
for kind in ("glb", "obj", "usda", "mjcf"):
    path = disk / f"room{FORMATS[kind].suffixes[-1]}"
    sized("64m")
    export_scene(furnished_scene(), PlainLibrary(), path, kind)
    whole = path.read_bytes()
    used = sum(p.stat().st_size for p in disk.rglob("*"))
    sized(f"{used // 1024 + 4}k")
    try:
        export_scene(furnished_scene(), PlainLibrary(), path, kind)
    except DioramaError as error:
        assert "No space left" in str(error) and "\\n" not in str(error), error
        print(kind, error)
    assert path.read_bytes() == whole, kind
    hidden = [p.name for p in disk.rglob("*") if p.name.startswith(".")]
    assert hidden == [], (kind, hidden)
    sized("64m")
    for left in disk.iterdir():
        subprocess.run(["rm", "-r", str(left)], check=True)
"""


def run_on_small_disk(tmp_path: Path, code: str) -> str:
    """Run Python where `disk` is a file system of its own; skips where that is not allowed. Returns what it printed."""
    disk = tmp_path / "disk"
    disk.mkdir()
    prefix = ["unshare", "--mount", "--map-root-user"]
    trial = [*prefix, "mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", str(disk)]
    if not shutil.which("unshare") or subprocess.run(trial, capture_output=True).returncode:
        pytest.skip("needs unshare and the right to mount in a namespace")
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "DIORAMA_MODELS": str(tmp_path)}
    command = [*prefix, sys.executable, "-c", BEGIN + code, str(disk)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=600)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


@pytest.mark.slow
def test_a_build_stops_with_one_line_and_resumes_when_there_is_space(tmp_path: Path) -> None:
    said = run_on_small_disk(tmp_path, BUILD).splitlines()
    assert said[-1].endswith("built")


def test_what_could_not_be_saved_is_saved_when_there_is_space(tmp_path: Path) -> None:
    run_on_small_disk(tmp_path, SAVE)


@pytest.mark.slow
def test_an_export_that_does_not_fit_leaves_the_older_file(tmp_path: Path) -> None:
    said = run_on_small_disk(tmp_path, EXPORT)
    assert said.count("No space left") >= 4


READ_ONLY = """
from diorama_app.session.autosave import Autosave
from diorama_app.session.client import Client
from diorama_app.session.recovery import Recovery
from diorama_app.session.session import EditorSession
from diorama_app.commands.edit import rename
from diorama_app.web.viser_adapter import create_server, stop_server
from diorama_app.web.visitors import Visitors
from tests.app.people import join
sized("16m")
project = make_project(disk / "projects" / "demo")
before = project.scene_path.read_bytes()
subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
server = create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1"))
session = EditorSession(server, PlainLibrary(), disk / "projects", Client)
session.autosave.recovery = Recovery(disk / "unsaved")
client = join(session)
told = client.viser_client.told
session.open_project(project)
assert told[-1].startswith("changes will not be saved: ") and "Read-only file system" in told[-1], told
assert len(session.scene.objects) == 5
client.post(lambda: rename(client, "chair_1", "throne"))
assert session.ui_thread.wait()
session.autosave.flush()
assert session.ui_thread.wait()
assert session.scene.object("chair_1").label == "throne"
assert "ot saved" in told[-1] and "only in memory" in told[-1] and "kept" not in told[-1], told
assert project.scene_path.read_bytes() == before
session.close()
stop_server(server)
"""


def test_a_page_on_a_read_only_disk_promises_nothing(tmp_path: Path) -> None:
    run_on_small_disk(tmp_path, READ_ONLY)
