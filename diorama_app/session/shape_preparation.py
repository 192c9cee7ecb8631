"""Convex parts of the room's shapes, worked out in the background, so that the first drag does not wait for them."""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Iterable

from diorama_core.library.record import ShapeLibrary

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
