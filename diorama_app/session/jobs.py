"""Background jobs: one at a time, in a thread of its own, with progress and cancel."""

from __future__ import annotations

import logging
import os
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Literal

from diorama_app.strings import N_, _
from diorama_core.errors import Cancelled, DioramaError, EditRefused
from diorama_core.io.large_libraries import load_open3d
from diorama_core.progress import CancelToken, Progress, ProgressEvent, Segments

log = logging.getLogger(__name__)

JobKind = Literal[
    "build",
    "optimise",
    "export",
    "outline",
    "import",
    "text",
    "pull",
    "find",
    "join",
    "picture",
    "words",
    "example",
    "play",
]
PERCEIVING: frozenset[JobKind] = frozenset({"build", "outline", "text"})
"""Kinds that run the pipeline, which needs Open3D."""

COMPUTING: frozenset[JobKind] = PERCEIVING | {"import", "find", "join", "optimise", "picture"}
"""Kinds that keep a processor busy until they end, and hold much memory meanwhile."""
AT_ONCE = max(2, os.cpu_count() or 2)
"""Of those, over all projects of a server: more would only make each of them slower, and memory run out."""
_TURNS = threading.BoundedSemaphore(AT_ONCE)
WAIT_S = 0.2
"""Between two looks at whether a job that waits for its turn was cancelled."""


@dataclass(frozen=True)
class JobStatus:
    """The displayed status of a job."""

    kind: JobKind
    title: str
    fraction: float = 0.0
    message: str = N_("Starting")
    cancelling: bool = False
    found: tuple[str, ...] = ()
    """What was found so far, in a few words each."""
    drawn: Segments = ()
    """What was found so far, as lines over the photo."""
    started_at: float = field(default_factory=time.monotonic)
    """On the monotonic clock (s)."""


@dataclass(frozen=True)
class Outcome:
    """How a job ended."""

    kind: JobKind
    error: str | None = None
    cancelled: bool = False
    in_favour: bool = False
    """Whether it was cancelled for something else that the person does, which tells enough."""


@contextmanager
def _turn(progress: Progress) -> Iterator[None]:
    """Wait until another job may compute; raises `Cancelled` on request."""
    if not _TURNS.acquire(blocking=False):
        progress.report(0.0, _("Waiting for the work of other projects"))
        while not _TURNS.acquire(timeout=WAIT_S):
            progress.check()
    try:
        yield
    finally:
        _TURNS.release()


class Jobs:
    """Runs at most one job.

    `on_change` is called from the thread that starts, reports or cancels the job, `on_end` from the job's own.
    """

    def __init__(self, on_change: Callable[[JobStatus], None], on_end: Callable[[Outcome], None]) -> None:
        self._on_change = on_change
        self._on_end = on_end
        self._lock = threading.Lock()
        self._status: JobStatus | None = None
        self._token = CancelToken()
        self._in_favour = False
        self._thread: threading.Thread | None = None

    @property
    def status(self) -> JobStatus | None:
        """The running job, or None."""
        return self._status

    def start(self, kind: JobKind, title: str, work: Callable[[Progress], None]) -> None:
        """Run `work` in the background; refused while another job runs."""
        with self._lock:
            if self._status is not None:
                raise EditRefused(_("{title} is still running; cancel it or wait").format(title=self._status.title))
            self._status = JobStatus(kind, title)
            self._token = CancelToken()
        progress = Progress(on_event=self._report, token=self._token)
        self._thread = threading.Thread(target=self._run, args=(work, progress), daemon=True, name=f"job {kind}")
        self._on_change(self._status)
        self._thread.start()

    def cancel(self, *, in_favour: bool = False) -> None:
        """Ask the running job to stop; it does at its next check.

        Nothing is said where it stops in favour of something else that the person does.
        """
        self._in_favour = in_favour
        self._token.cancel()
        self._change(lambda status: replace(status, cancelling=True, message=_("Stopping")))

    def wait(self, timeout_s: float) -> bool:
        """Block until no job runs; False when that took too long."""
        thread = self._thread
        if thread is not None:
            thread.join(timeout_s)
        return self._status is None

    def _report(self, event: ProgressEvent) -> None:
        def update(status: JobStatus) -> JobStatus:
            if status.cancelling:
                return status
            found = (*status.found, event.found) if event.found else status.found
            message = status.message if event.found else event.message
            drawn = (*status.drawn, *event.drawn)
            return replace(status, fraction=event.fraction, message=message, found=found, drawn=drawn)

        self._change(update)

    def _change(self, changed: Callable[[JobStatus], JobStatus]) -> None:
        """Change the running job's status, if one still runs: one that just ended must not come back."""
        with self._lock:
            before = self._status
            if before is None:
                return
            after = self._status = changed(before)
        if after is not before:
            self._on_change(after)

    def _run(self, work: Callable[[Progress], None], progress: Progress) -> None:
        status = self._status
        assert status is not None
        outcome = Outcome(status.kind)
        try:
            if status.kind not in COMPUTING:
                work(progress)
            else:
                with _turn(progress):
                    if status.kind in PERCEIVING:
                        load_open3d()
                    work(progress)
        except Cancelled:
            outcome = Outcome(status.kind, cancelled=True, in_favour=self._in_favour)
        except DioramaError as error:
            outcome = Outcome(status.kind, error=str(error))
        except Exception:  # the thread ends here: the outcome is all that is heard of it
            log.exception("%s failed", status.title)
            outcome = Outcome(
                status.kind,
                error=_("{title} failed unexpectedly; nothing was changed. See the server's log.").format(
                    title=status.title
                ),
            )
        finally:
            with self._lock:
                self._status = None
        self._on_end(outcome)
        from diorama_core.processes import give_back_memory  # takes a tenth of a second, for which nobody waits

        give_back_memory()
