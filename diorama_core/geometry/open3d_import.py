"""Open3D without its plots for notebooks, whose Dash, Plotly and IPython take half of the time of importing it.

It loads when it is first used, the plots when somebody calls them.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from threading import Lock
from types import ModuleType
from typing import Any

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
        setattr(stand_in, name, _loaded_on_call(name))
    sys.modules[_PLOTS] = stand_in
    try:
        return _imported()
    finally:
        del sys.modules[_PLOTS]


def _imported() -> Any:
    for _ in range(_TRIES - 1):
        try:
            return importlib.import_module("open3d")
        except RuntimeError as error:
            if "changed size during iteration" not in str(error):
                raise
    return importlib.import_module("open3d")


def _loaded_on_call(name: str) -> Callable[..., Any]:
    def call(*args: Any, **kwargs: Any) -> Any:
        return getattr(importlib.import_module(_PLOTS), name)(*args, **kwargs)

    call.__name__ = name
    return call


class _LoadedOnUse:
    """The package's names, which load it, by whichever thread asks first."""

    def __init__(self) -> None:
        self._loading = Lock()

    def __getattr__(self, name: str) -> Any:
        with self._loading:
            value = getattr(_without_plots(), name)
        self.__dict__[name] = value  # found without this call from now on
        return value


o3d: Any = _LoadedOnUse()  # Any, as its stubs do not know that arrays are taken for tensors


def load_open3d() -> None:
    """Load the package now, for instance while another thread works."""
    _ = o3d.core
