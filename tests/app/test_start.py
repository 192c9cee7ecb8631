"""Opening the editor loads what it needs and no more: seconds of start-up hide in a stray import."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from diorama_app.projects.example import EXAMPLE
from diorama_app.session import preparation
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.ingest import known_shapes
from diorama_core.project.storage import Project
from tests.app.small_room import make_project

NEVER_AT_START = (
    "torch",
    "sklearn",
    "open3d",
    "cv2",
    "onnxruntime",
    "openai",
    "huggingface_hub",
    "tokenizers",
    "diorama_core.pipeline.run",
    "diorama_core.pipeline.presets",
    "diorama_core.evaluation",
)
NOT_BEFORE_LISTENING = (*NEVER_AT_START, "trimesh", "scipy", "fcl", "manifold3d", "networkx", "diorama_app.app")
COMMAND_LINE = (*NOT_BEFORE_LISTENING, "numpy", "PIL", "pydantic", "viser", "rich")


def _loaded(code: str, *arguments: object) -> list[list[str]]:
    """What each line printed by a fresh interpreter lists."""
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return [
        line.split() for line in subprocess.run(command, capture_output=True, text=True, check=True).stdout.split("\n")
    ]


def test_help_loads_nothing_but_the_command_line() -> None:
    code = f"""
import atexit, sys
atexit.register(lambda: print("heavy:", *[m for m in {COMMAND_LINE!r} if m in sys.modules]))
from diorama_app.cli import main
main(["--help"])
"""
    assert _loaded(code)[-2] == ["heavy:"]


def test_the_port_opens_before_the_editor_loads_and_the_editor_without_the_pipeline(tmp_path: Path) -> None:
    library = built_in_library()
    for item in Project.open(EXAMPLE / "project").load_scene().objects:
        library.shape(item.shape_id)  # as an installation prepares all
    code = f"""
import os, socket, sys
from pathlib import Path
import diorama_app.serve as serving

create_server = serving.create_server
def listening(**settings):
    server = create_server(**settings)
    socket.create_connection(("127.0.0.1", server.get_port()), timeout=60).close()
    print(*[m for m in {NOT_BEFORE_LISTENING!r} if m in sys.modules])
    return server

serving.create_server = listening
running = serving.start(projects_dir=Path(sys.argv[1]))
print(*[m for m in {NEVER_AT_START!r} if m in sys.modules])
print(len(running.session.scene.objects), flush=True)
running.stop()
os._exit(0)
"""
    before_listening, at_start, objects = _loaded(code, tmp_path)[:3]
    assert before_listening == []
    assert at_start == []
    assert int(objects[0]) > 0


def test_open3d_loads_while_other_threads_load_modules() -> None:
    script = """
import sys, types
from diorama_core.io.large_libraries import load_open3d

def meanwhile(frame, event, arg):
    def at_each_line(frame, event, arg):
        if len(added) < 3:
            added.append(name := f"added_meanwhile_{len(added)}")
            sys.modules[name] = types.ModuleType(name)
        return at_each_line
    return at_each_line if frame.f_code.co_name == "_insert_pybind_names" else None

added = []
sys.settrace(meanwhile)
load_open3d()
sys.settrace(None)
from open3d.t.geometry import RaycastingScene
RaycastingScene()
print(len(added))
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert int(done.stdout) > 0


def test_what_the_first_upload_needs_is_learnt_beside_and_ends_with_the_server(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(known_shapes, "are_known", lambda: False)
    monkeypatch.setattr(preparation, "LEARN", "import time; time.sleep(60)")
    stopped = threading.Event()
    beside = threading.Thread(target=preparation.learn_shapes, args=(stopped,), daemon=True)
    beside.start()
    time.sleep(0.3)  # the process is started meanwhile, of which nothing tells
    assert beside.is_alive()
    stopped.set()
    beside.join(timeout=60.0)
    assert not beside.is_alive()


def test_nothing_is_learnt_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(known_shapes, "are_known", lambda: True)
    monkeypatch.setattr(preparation, "LEARN", "raise SystemExit('learnt again')")
    monkeypatch.setattr(subprocess, "Popen", None)
    preparation.learn_shapes(threading.Event())


@pytest.mark.slow
def test_the_program_ends_well_while_it_still_loads(tmp_path: Path) -> None:
    project = make_project(tmp_path / "projects" / "demo")
    script = """
import sys
from pathlib import Path
from diorama_app.projects.example import EXAMPLE
from diorama_app.session import preparation
from diorama_core.library.catalogue import built_in_library
from diorama_app.serve import start
from diorama_core.project.storage import Project
from tests.app.small_room import PlainLibrary
preparation.WARM_UP_AFTER_S = 0.0
running = start(project=Path(sys.argv[1]), projects_dir=Path(sys.argv[1]).parent, library=PlainLibrary())
running.stop()
"""
    command = [sys.executable, "-c", script, str(project.folder)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
    assert "Memory Statistics" not in done.stdout, "Open3D was torn down while it was being loaded"


BUSY = """
import sys, time
from pathlib import Path
from diorama_app import serve
from tests.app.small_room import PlainLibrary, make_project

serve.warm_up = lambda stopped: time.sleep(600)
serve.MAX_LOADING_S = 0.1
folder = make_project(Path(sys.argv[1]) / "demo").folder
more = {"open_browser": False, "low_graphics": True, "token": None, "library": PlainLibrary()}
serve.serve(project=folder, projects_dir=folder.parent, host="127.0.0.1", port=0, **more)
"""


@pytest.mark.posix
def test_stopping_does_not_wait_for_libraries_that_are_still_loading(tmp_path: Path) -> None:
    command = [sys.executable, "-c", BUSY, str(tmp_path)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        assert "Diorama is at" in process.stdout.readline()
        process.terminate()
        assert process.wait(60) == 0
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
