"""What a program does before it loads large libraries, so that they load sooner."""

from __future__ import annotations

import atexit
import contextlib
import gc
import importlib
import sys
from types import ModuleType
from typing import Any

GARBAGE_EVERY = 10_000
"""New objects between two searches for garbage: nearly all that importing makes stays, so the usual 700 cost time."""
SWITCH_S = 1e-4
"""Time for which a thread keeps the interpreter while another waits: numpy gives it up with every large array, and gets
it back after the usual 5 ms only, however short its own work was."""
LATER = ("networkx",)
"""What trimesh loads for functions that are rarely called; that takes longer than trimesh itself."""


def load_quickly() -> None:
    """Look for garbage less often, and not when the program ends; let threads take turns more often; load trimesh
    without what it rarely needs; and load USD's library, where it is installed, before other threads compute.
    """
    sys.setswitchinterval(SWITCH_S)
    gc.set_threshold(GARBAGE_EVERY)
    atexit.register(gc.freeze)  # the last search, through all that was imported, takes a fifth of a second
    # When it starts, USD's library lets other threads run while it holds the lock of the operating system's loader.
    # numpy asks for that lock in sums of large arrays without letting others run: both would wait for ever.
    with contextlib.suppress(ImportError):
        importlib.import_module("pxr.Tf")
    if "trimesh" in sys.modules:
        return
    stand_ins = {name: _LoadedOnUse(name) for name in LATER if name not in sys.modules}
    sys.modules.update(stand_ins)
    try:
        importlib.import_module("trimesh")
    finally:
        for name in stand_ins:
            del sys.modules[name]


class _LoadedOnUse(ModuleType):
    """Stands for a module until somebody asks for one of its names."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # what the import system asks of every module
            raise AttributeError(name)
        return getattr(importlib.import_module(self.__name__), name)
