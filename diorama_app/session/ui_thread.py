"""One thread on which everything that touches the document and the page happens.

viser runs callbacks on an event loop (never block it) or unordered in a thread pool; tasks posted here run one after
another, so edits, undo and drawing never race. Every browser has a bounded queue of its own, and the queues take turns:
one that floods the server waits for itself. Errors meant for people are handled here, once.
"""

from __future__ import annotations

import heapq
import logging
import threading
import time
from collections import OrderedDict, deque
from collections.abc import Callable, Hashable
from concurrent.futures import Future
from dataclasses import dataclass, field
from itertools import count
from typing import TypeVar

from diorama_app.strings import _
from diorama_core.errors import DioramaError, UnavailableError

log = logging.getLogger(__name__)

MAX_WAITING = 64
"""Maximum pending tasks of one browser; further ones are dropped and the user is notified."""

MAX_ANSWER_S = 30.0
"""Within which another thread gets an answer: an edit of a large scene takes a second."""

T = TypeVar("T")
Task = Callable[[], object]
OnError = Callable[[str], None]


@dataclass
class _Posted:
    task: Task
    on_error: OnError
    client_id: Hashable | None
    key: str | None
    awaited: bool = True


@dataclass(order=True)
class _Delayed:
    due: float
    number: int
    posted: _Posted = field(compare=False)


class UiThread:
    """Queues of small tasks and the thread that does them. May be used from any thread."""

    def __init__(self, on_error: OnError) -> None:
        self._on_error = on_error
        self._changed = threading.Condition()
        self._queues: OrderedDict[Hashable | None, deque[_Posted]] = OrderedDict()
        """Queues of the browsers that asked for something, the one whose turn it is first; None is the server's own."""
        self._keyed: dict[tuple[Hashable | None, str], _Posted] = {}
        self._delayed: list[_Delayed] = []
        self._numbers = count()
        self._busy = self._stopping = False
        self._thread = threading.Thread(target=self._work, daemon=True, name="desk")
        self._thread.start()

    def post(
        self,
        task: Task,
        *,
        key: str | None = None,
        on_error: OnError | None = None,
        client_id: Hashable | None = None,
        after_s: float = 0.0,
        awaited: bool = True,
    ) -> None:
        """Do `task` soon, after those posted before for the same browser.

        Args:
            task: quick work; long work belongs in a job.
            key: a newer task with the same key replaces an older one that has not started (a drag's moves).
            on_error: told in one line what went wrong; everybody by default.
            client_id: the browser whose queue it joins; the server's own when None.
            after_s: how long it waits at least.
            awaited: whether `wait` waits for it; a message that leaves the page is no work.
        """
        posted = _Posted(task, on_error or self._on_error, client_id, key, awaited)
        with self._changed:
            waiting = None if key is None else self._keyed.get((client_id, key))
            if waiting is not None:
                waiting.task, waiting.on_error = task, posted.on_error
                return
            if client_id is not None and len(self._queues.get(client_id, ())) >= MAX_WAITING:
                self._refuse(posted)
                return
            if key is not None:
                self._keyed[(client_id, key)] = posted
            if after_s > 0:
                heapq.heappush(self._delayed, _Delayed(time.monotonic() + after_s, next(self._numbers), posted))
            else:
                self._enqueue(posted)
            self._changed.notify_all()

    def ask(self, task: Callable[[], T]) -> T:
        """Do `task` there and wait for what it gives, or raises. Never called from the thread itself.

        Raises:
            UnavailableError: the thread was busy for too long; the task may still be done.
        """
        answer: Future[T] = Future()

        def answer_task() -> None:
            try:
                answer.set_result(task())
            except BaseException as error:  # raised again by whoever waits for it
                answer.set_exception(error)

        self.post(answer_task)
        try:
            return answer.result(MAX_ANSWER_S)
        except TimeoutError as error:
            if answer.done():
                raise
            raise UnavailableError("the editor is busy; try again in a moment") from error

    def forget(self, client_id: Hashable) -> None:
        """Drop what waits for a browser that went away."""
        with self._changed:
            self._queues.pop(client_id, None)
            self._delayed = [d for d in self._delayed if d.posted.client_id != client_id]
            heapq.heapify(self._delayed)
            for key in [k for k in self._keyed if k[0] == client_id]:
                del self._keyed[key]
            self._changed.notify_all()

    @property
    def waiting(self) -> int:
        """How many tasks wait."""
        with self._changed:
            return sum(len(q) for q in self._queues.values()) + len(self._delayed)

    def wait(self, timeout_s: float = 60.0) -> bool:
        """Block until nothing is left to do; False when that took too long."""
        with self._changed:
            return self._changed.wait_for(
                lambda: not (self._busy or any(d.posted.awaited for d in self._delayed) or any(self._queues.values())),
                timeout_s,
            )

    def stop(self) -> None:
        """Finish what was posted and is awaited, then end the thread."""
        with self._changed:
            self._stopping = True
            self._delayed = sorted(d for d in self._delayed if d.posted.awaited)
            self._changed.notify_all()
        if threading.current_thread() is not self._thread:
            self._thread.join(timeout=5.0)

    def _enqueue(self, posted: _Posted) -> None:
        self._queues.setdefault(posted.client_id, deque()).append(posted)

    def _refuse(self, posted: _Posted) -> None:
        key, told = (None, f"refused {posted.client_id!r}"), posted.on_error
        if key in self._keyed:
            return
        message = f"the server is busy with your last {MAX_WAITING} actions; later ones were ignored"
        self._keyed[key] = refusal = _Posted(lambda: told(message), told, None, key[1])
        self._enqueue(refusal)

    def _next(self) -> _Posted | None:
        """The next task, waiting for it; None when the UI thread is stopped and everything is done."""
        with self._changed:
            self._busy = False
            while True:
                now = time.monotonic()
                while self._delayed and (self._delayed[0].due <= now or self._stopping):
                    self._enqueue(heapq.heappop(self._delayed).posted)
                client_id = next((c for c, q in self._queues.items() if q), self)
                if client_id is not self:
                    break
                self._queues.clear()
                self._changed.notify_all()
                if self._stopping:
                    return None
                self._changed.wait(self._delayed[0].due - now if self._delayed else None)
            posted = self._queues[client_id].popleft()
            self._queues.move_to_end(client_id)
            if posted.key is not None:
                self._keyed.pop((posted.client_id, posted.key), None)
            self._busy = True
            return posted

    def _work(self) -> None:
        while (posted := self._next()) is not None:
            try:
                posted.task()
            except DioramaError as error:
                posted.on_error(str(error))
            except Exception:  # one task must not end the thread that serves everybody
                log.exception("an unexpected error in the editor")
                posted.on_error(_("Something went wrong; earlier changes are safe. See the server's log."))
