"""How large libraries are loaded: sooner, and without what nobody here asks them for.

Open3D loads when it is first used, and its plots for notebooks when somebody calls them: their Dash, Plotly and IPython
take half of the time of importing it.
"""

from __future__ import annotations

import atexit
import contextlib
import gc
import importlib
import os
import sys
from collections.abc import Callable
from threading import Lock
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


_PLOTS = "open3d.visualization.draw_plotly"
_TRIES = 5
"""Open3D looks through the loaded modules, and fails where another thread loads one at that moment."""
_FUNCTIONS = ("get_plotly_fig", "draw_plotly", "draw_plotly_server")


def _without_plots() -> Any:
    """The package, imported with a stand-in for its module of plots."""
    if "open3d" in sys.modules:  # imported by somebody else, plots and all
        return importlib.import_module("open3d")
    stand_in = ModuleType(_PLOTS)
    for name in _FUNCTIONS:
        setattr(stand_in, name, _load_on_call(name))
    sys.modules[_PLOTS] = stand_in
    try:
        return _import()
    finally:
        del sys.modules[_PLOTS]


def _import() -> Any:
    for _ in range(_TRIES - 1):
        try:
            return importlib.import_module("open3d")
        except RuntimeError as error:
            if "changed size during iteration" not in str(error):
                raise
    return importlib.import_module("open3d")


def _load_on_call(name: str) -> Callable[..., Any]:
    def call(*args: Any, **kwargs: Any) -> Any:
        return getattr(importlib.import_module(_PLOTS), name)(*args, **kwargs)

    call.__name__ = name
    return call


class _Open3D:
    """The package's names, which load it, by whichever thread asks first."""

    def __init__(self) -> None:
        self._loading = Lock()

    def __getattr__(self, name: str) -> Any:
        with self._loading:
            value = getattr(_without_plots(), name)
        self.__dict__[name] = value  # found without this call from now on
        return value


o3d: Any = _Open3D()  # Any, as its stubs do not know that arrays are taken for tensors


def load_open3d() -> None:
    """Load the package now, for instance while another thread works."""
    _ = o3d.core


def load_onnxruntime() -> ModuleType:
    """onnxruntime with reports to its makers switched off.

    Since 1.29 it sends sessions, models and errors to a server unless this variable was set before it was first loaded.
    A value that people have set themselves stays.
    """
    os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")
    import onnxruntime

    return onnxruntime
