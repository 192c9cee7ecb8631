"""Opening the editor loads what it needs and no more: seconds of start-up hide in a stray import."""

from __future__ import annotations

import subprocess
import sys
import threading
import time

import pytest

from diorama_app.session import preload as warming
from diorama_core.library.ingest import known_shapes

HEAVY = (
    "torch",
    "sklearn",
    "open3d",
    "cv2",
    "onnxruntime",
    "openai",
    "diorama_core.pipeline.run",
    "diorama_core.pipeline.presets",
    "diorama_core.evaluation",
)


def test_the_server_starts_without_the_pipeline_and_the_networks() -> None:
    code = f"import sys, diorama_app.serve; print(*[m for m in {HEAVY!r} if m in sys.modules])"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert loaded == []


def test_open3d_loads_while_other_threads_load_modules() -> None:
    script = """
import sys, types
from diorama_app.session.preload import load_open3d

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
    monkeypatch.setattr(warming, "LEARN", "import time; time.sleep(60)")
    stopped = threading.Event()
    beside = threading.Thread(target=warming.learn_shapes, args=(stopped,), daemon=True)
    beside.start()
    time.sleep(0.3)
    assert beside.is_alive()
    stopped.set()
    beside.join(timeout=10.0)
    assert not beside.is_alive()


def test_nothing_is_learnt_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(known_shapes, "are_known", lambda: True)
    monkeypatch.setattr(warming, "LEARN", "raise SystemExit('learnt again')")
    monkeypatch.setattr(subprocess, "Popen", None)
    warming.learn_shapes(threading.Event())
