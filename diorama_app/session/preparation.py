"""Preparation in the background: what the first build or optimisation needs, once the page is shown, and convex parts
of the room's shapes, so that the first drag does not wait for them.
"""

from __future__ import annotations

import logging
import queue
import subprocess
import sys
import threading
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from diorama_core.library.record import ShapeLibrary  # loads trimesh, which the port need not wait for

WARM_UP_AFTER_S = 10.0
"""Loading takes two seconds of one core, which the browser needs while the page opens."""

LEARN = """import os
getattr(os, "nice", int)(15)
from diorama_core.library.ingest.known_shapes import load_known_shapes
load_known_shapes()"""
"""Half a minute of a core, once on a machine, that the first upload of a model would wait for."""


def warm_up(stopped: threading.Event) -> None:
    """Wait until pages have come up, then load; not at all when stopped before."""
    if stopped.wait(WARM_UP_AFTER_S):
        return
    from diorama_core.io.large_libraries import load_open3d

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


log = logging.getLogger(__name__)


class Preparer:
    """A thread that prepares shapes for dragging without collisions. Safe between threads."""

    def __init__(self, library: ShapeLibrary) -> None:
        self._library = library
        self._queue: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._asked: set[str] = set()
        self._ready: set[str] = set()
        self._thread: threading.Thread | None = None
        self._stopping = False

    def want(self, shape_ids: Iterable[str]) -> None:
        """Prepare these shapes soon."""
        fresh = [i for i in dict.fromkeys(shape_ids) if i not in self._asked]
        self._asked.update(fresh)
        for shape_id in fresh:
            self._queue.put(shape_id)
        if fresh and self._thread is None:
            self._thread = threading.Thread(target=self._work, daemon=True, name="preparing shapes")
            self._thread.start()

    def ready(self, shape_ids: Iterable[str]) -> bool:
        """Whether all of these are prepared."""
        return self._ready.issuperset(shape_ids)

    def stop(self) -> None:
        """End the thread, after the shape that it prepares at this moment."""
        self._stopping = True
        self._queue.put(None)
        if self._thread is not None:
            self._thread.join(timeout=5.0)

    def _work(self) -> None:
        from diorama_core.layout.problem.parts import parts_of_shape

        while (shape_id := self._queue.get()) is not None and not self._stopping:
            try:
                parts_of_shape(self._library, self._library.shape(shape_id))
            except Exception:  # a gesture will find out; the thread goes on with the next
                log.exception("the shape %s cannot be prepared", shape_id)
                continue
            self._ready.add(shape_id)
