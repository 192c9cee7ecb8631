"""One thread on which everything that touches the document and the page happens, in order.

viser runs callbacks on an event loop (never block it) or unordered in a thread pool; tasks posted here run one
after another, so edits, undo and drawing never race. Errors meant for people are handled here, once.
"""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Callable
from dataclasses import dataclass

from diorama_core.errors import DioramaError

log = logging.getLogger(__name__)

Task = Callable[[], None]
OnError = Callable[[str], None]


@dataclass(frozen=True)
class _Posted:
    task: Task
    on_error: OnError
    key: str | None


class UiThread:
    """A queue of small tasks and the thread that does them."""

    def __init__(self, on_error: OnError) -> None:
        self._on_error = on_error
        self._queue: queue.SimpleQueue[_Posted | None] = queue.SimpleQueue()
        self._latest: dict[str, _Posted] = {}
        self._lock = threading.Lock()
        self._thread = threading.Thread(target=self._work, daemon=True, name="desk")
        self._thread.start()

    def post(self, task: Task, *, key: str | None = None, on_error: OnError | None = None) -> None:
        """Do `task` soon, after those posted before.

        Args:
            task: quick work; long work belongs in a job.
            key: a newer task with the same key replaces an older one that has not started (a drag's moves).
            on_error: told in one line what went wrong; the whole room by default.
        """
        posted = _Posted(task, on_error or self._on_error, key)
        if key is not None:
            with self._lock:
                waiting = key in self._latest
                self._latest[key] = posted
            if waiting:
                return
        self._queue.put(posted)

    def wait(self, timeout_s: float = 10.0) -> bool:
        """Block until everything posted so far is done; False when that took too long."""
        done = threading.Event()
        self.post(done.set)
        return done.wait(timeout_s)

    def stop(self) -> None:
        """Finish what was posted, then end the thread."""
        self._queue.put(None)
        if threading.current_thread() is not self._thread:
            self._thread.join(timeout=5.0)

    def _work(self) -> None:
        while (posted := self._queue.get()) is not None:
            if posted.key is not None:
                with self._lock:
                    posted = self._latest.pop(posted.key)
            try:
                posted.task()
            except DioramaError as error:
                posted.on_error(str(error))
            except Exception:
                log.exception("an unexpected error in the editor")
                posted.on_error("Something went wrong and nothing was changed; the details are in the server's log.")
