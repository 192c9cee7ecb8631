"""Garbage is looked for less often, and less is imported, once a program is about to load much."""

from __future__ import annotations

import gc
import subprocess
import sys

from diorama_core.io.quick_imports import GARBAGE_EVERY, load_quickly


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
from diorama_core.io.quick_imports import load_quickly
load_quickly()
"""


def test_nothing_is_searched_for_garbage_when_the_program_ends() -> None:
    ended = subprocess.run([sys.executable, "-c", ENDING], check=True, capture_output=True, text=True)
    assert int(ended.stdout) > 10_000


PROGRAM = """
import sys
from diorama_core.io.quick_imports import LATER, load_quickly
load_quickly()
import trimesh
assert "trimesh" in sys.modules and not set(LATER) & set(sys.modules), sorted(set(LATER) & set(sys.modules))
assert trimesh.graph.nx.Graph([(1, 2)]).number_of_edges() == 1
assert set(LATER) <= set(sys.modules)
import networkx.algorithms
"""


def test_what_trimesh_rarely_needs_is_loaded_when_it_does() -> None:
    subprocess.run([sys.executable, "-c", PROGRAM], check=True)
