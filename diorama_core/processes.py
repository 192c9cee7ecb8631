"""Work done in processes beside this one, which are kept for the next: threads share one interpreter, so that steps of
little arrays gain nothing from a second core.

They are started ahead (`prepare`), load what they will need while nothing waits for them, and end with this process or
when nobody asked them for a while. What cannot be sent to them, or is lost with them, is done here: results are equal.
"""

from __future__ import annotations

import ctypes
import logging
import os
import threading
import time
import warnings
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from multiprocessing import parent_process
from pickle import PicklingError
from typing import Any, TypeVar

from loky import cpu_count, get_reusable_executor
from loky.process_executor import ShutdownExecutorError

from diorama_core.io.large_libraries import load_quickly
from diorama_core.progress import SILENT, Progress

Result = TypeVar("Result")
log = logging.getLogger(__name__)

MAX_PROCESSES = 3
"""More gain little: the longest piece of work ends last."""
IDLE_S = 300.0
"""Time without work after which they end."""
MAX_GROWTH_BYTES = 8e8
"""One that has become larger by so much is replaced: shapes that were asked for stay in its memory."""
ORPHAN_S = 1.0
"""Time between two looks at whether the process that started one is still there."""


class _Pool:
    """Processes beside this one."""

    def __init__(self) -> None:
        self._pool: Any = None
        self._started: Future[None] | None = None

    @property
    def count(self) -> int:
        """How many there may be; a process that is one of several, which share the processors already, has none."""
        return 0 if parent_process() is not None else min(cpu_count() - 1, MAX_PROCESSES)

    def start(self, load: Callable[[], None]) -> None:
        """Start them, unless they are there."""
        count = self.count
        if count < 1:
            return
        warnings.filterwarnings("ignore", "A worker (stopped|was restarted)", UserWarning)  # that is what is wanted
        self._pool = get_reusable_executor(
            count,
            timeout=IDLE_S,
            initializer=_begin,
            initargs=(load,),
            env={"LOKY_MAX_MEMORY_LEAK_SIZE": str(MAX_GROWTH_BYTES)},
        )
        self._started = self._pool.submit(_nothing)

    @property
    def ready(self) -> bool:
        """Whether one has loaded what it needs."""
        return self._started is not None and self._started.done() and self._started.exception() is None

    def call(self, function: Callable[..., Result], arguments: tuple[Any, ...]) -> Result:
        """The function's result from one of them."""
        result: Result = self._pool.submit(function, *arguments).result()
        return result


_POOL = _Pool()


def prepare(load: Callable[[], None]) -> None:
    """Start the processes, unless they are there; none on a machine of one core.

    Args:
        load: Called in each before its first work; the same function every time.
    """
    _POOL.start(load)


def are_ready() -> bool:
    """Whether one of them has loaded what it needs, so that work is given to it."""
    return _POOL.ready


def call_beside(function: Callable[..., Result], *arguments: Any) -> Result:
    """The function's result, from a process beside this one where there is one; waits for it.

    Args:
        function: Found by its module and name, as are those of the arguments; its own exceptions pass through.
        arguments: Picklable, or the work is done here.
    """
    if not are_ready():
        return function(*arguments)
    try:
        return _POOL.call(function, arguments)
    except (PicklingError, BrokenProcessPool, ShutdownExecutorError) as error:
        log.debug("done here, not beside: %s", error)
        return function(*arguments)


def map_beside(
    function: Callable[..., Result],
    arguments: Sequence[tuple[Any, ...]],
    progress: Progress = SILENT,
    message: str = "",
) -> list[Result]:
    """The function's results for several arguments, in order: some from processes, some from here.

    Args:
        function: As in `call_beside`.
        arguments: For each call; the longest ones first.
        progress: Told after every call made here; `Cancelled` drops the calls that have not begun.
        message: What is told.
    """
    results: list[Any] = [None] * len(arguments)
    waiting = deque(range(len(arguments)))

    def draw(call: Callable[..., Result], progress: Progress) -> None:
        while waiting:
            try:
                k = waiting.popleft()
            except IndexError:  # another thread drew the last one
                return
            results[k] = call(function, *arguments[k])
            progress.report(1.0 - len(waiting) / len(arguments), message)

    others = max(min(_POOL.count, len(arguments) - 1), 0)
    with ThreadPoolExecutor(max(others, 1)) as threads:
        try:
            beside = [threads.submit(draw, call_beside, SILENT) for _ in range(others)]
            draw(_call_here, progress)
            for thread in beside:
                thread.result()
        except BaseException:
            waiting.clear()
            raise
    return results


def _call_here(function: Callable[..., Result], *arguments: Any) -> Result:
    return function(*arguments)


def _begin(load: Callable[[], None]) -> None:
    """What a process does first."""
    threading.Thread(target=_end_with_parent, args=(os.getppid(),), daemon=True, name="end-with-parent").start()
    load_quickly()
    load()


def _end_with_parent(parent: int) -> None:
    """End this process when the one that started it was killed; where a system does not tell, being idle ends it.

    loky hands its processes nothing to wait on, so the parent is looked at.
    """
    while os.getppid() == parent:
        time.sleep(ORPHAN_S)
    os._exit(1)


def _nothing() -> None:
    """Done as soon as a process has begun."""


def give_back_memory() -> None:
    """Ask the allocator of the GNU C library to hand free memory back: what many threads freed it keeps otherwise."""
    with suppress(OSError, AttributeError):
        ctypes.CDLL("libc.so.6").malloc_trim(0)
