"""Garbage is looked for less often, and less is imported, once a program is about to load much. Open3D loads without
its plots, which load when they are called. onnxruntime tells nobody what it runs.
"""

from __future__ import annotations

import gc
import subprocess
import sys

import pytest

from diorama_core.io.large_libraries import GARBAGE_EVERY, load_quickly


def test_garbage_is_looked_for_less_often_and_threads_take_turns_more_often() -> None:
    before, turns = gc.get_threshold(), sys.getswitchinterval()
    gc.set_threshold(700, *before[1:])  # other tests of this process may have called it
    sys.setswitchinterval(0.005)
    try:
        load_quickly()
        assert gc.get_threshold() == (GARBAGE_EVERY, *before[1:])
        assert gc.isenabled()
        assert sys.getswitchinterval() < 0.001
    finally:
        gc.set_threshold(*before)
        sys.setswitchinterval(turns)


ENDING = """
import atexit, gc
atexit.register(lambda: print(gc.get_freeze_count()))
from diorama_core.io.large_libraries import load_quickly
load_quickly()
"""


def test_nothing_is_searched_for_garbage_when_the_program_ends() -> None:
    ended = subprocess.run([sys.executable, "-c", ENDING], check=True, capture_output=True, text=True)
    assert int(ended.stdout) > 10_000


PROGRAM = """
import sys
from diorama_core.io.large_libraries import LATER, load_quickly
load_quickly()
import trimesh
assert "trimesh" in sys.modules and not set(LATER) & set(sys.modules), sorted(set(LATER) & set(sys.modules))
assert trimesh.graph.nx.Graph([(1, 2)]).number_of_edges() == 1
assert set(LATER) <= set(sys.modules)
import networkx.algorithms
"""


def test_what_trimesh_rarely_needs_is_loaded_when_it_does() -> None:
    subprocess.run([sys.executable, "-c", PROGRAM], check=True)


def test_usd_is_loaded_before_other_threads_compute() -> None:
    """Loaded while another thread added large arrays, it stopped the whole program, five times of six."""
    pytest.importorskip("pxr", reason="an optional extra")
    script = """
import sys, threading
import numpy as np
from diorama_core.io.large_libraries import load_quickly

load_quickly()
assert "pxr.Tf" in sys.modules
over = threading.Event()

def compute():
    numbers = np.ones(200_000)
    while not over.is_set():
        numbers * 2.0 - numbers - 1.0

threads = [threading.Thread(target=compute) for _ in range(2)]
for thread in threads:
    thread.start()
from pxr import Gf, Kind, Sdf, Usd, UsdGeom, UsdLux, UsdPhysics, UsdShade, Vt
over.set()
"""
    subprocess.run([sys.executable, "-c", script], check=True, timeout=300)


SCRIPT = """
import sys
import numpy as np
from diorama_core.io.large_libraries import o3d
print("dash" in sys.modules or "IPython" in sys.modules, "open3d.visualization.draw_plotly" in sys.modules)
cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(np.eye(3)))
print(type(o3d.visualization.get_plotly_fig([cloud])).__name__, "dash" in sys.modules)
"""


def test_plots_load_on_call() -> None:
    run = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True, timeout=120)
    assert run.stdout.split() == ["False", "False", "Figure", "True"]


def test_reports_are_switched_off_before_it_is_loaded() -> None:
    code = """
import os, sys
from diorama_core.models.runtime import providers
assert "onnxruntime" not in sys.modules
providers()
assert "onnxruntime" in sys.modules and os.environ["ORT_DISABLE_TELEMETRY"] == "1"
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, env={})
    assert done.returncode == 0, done.stderr[-2000:]
