"""Preloads in the background, once the page is shown, what the first build or optimisation needs."""

from __future__ import annotations

import subprocess
import sys
import threading

WARM_UP_AFTER_S = 10.0
"""Loading takes two seconds of one core, which the browser needs while the page opens."""

LEARN = """import os
getattr(os, "nice", int)(15)
from diorama_core.library.ingest.known_shapes import known_shapes
known_shapes()"""
"""Half a minute of a core, once on a machine, that the first upload of a model would wait for."""


def warm_up(stopped: threading.Event) -> None:
    """Wait until pages have come up, then load; not at all when stopped before."""
    if stopped.wait(WARM_UP_AFTER_S):
        return
    from diorama_core.geometry.open3d_import import load_open3d

    load_open3d()
    if stopped.is_set():
        return
    import diorama_core.project.build
    import diorama_core.text.pictures  # noqa: F401  # loading it is the whole work

    learn_shapes(stopped)


def learn_shapes(stopped: threading.Event) -> None:
    """Have the reliefs of the built-in shapes taken by a process that gives way to all others; ended when stopped."""
    from diorama_core.library.ingest.known_shapes import are_known

    if are_known():
        return
    learning = subprocess.Popen(
        [sys.executable, "-c", LEARN], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    while learning.poll() is None:
        if stopped.wait(1.0):
            learning.terminate()
            learning.wait()
