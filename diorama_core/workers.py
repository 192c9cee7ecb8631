"""Many independent pieces of work on many cores: a pool of processes here, or Ray on other machines; or two threads.

The same function runs in the first two. It must be importable by name (defined at the top of a module) and its items
and results must be picklable. One piece that fails, or kills the process it runs in, never stops the others.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from itertools import islice
from multiprocessing import get_context, parent_process
from typing import Any, Generic, Protocol, TypeVar, runtime_checkable

from diorama_core.errors import DioramaError, InputError, UnavailableError
from diorama_core.progress import SILENT, Progress

Item = TypeVar("Item")
Result = TypeVar("Result")

_AHEAD = 2
"""Pieces handed out per process, so that none waits for the next."""


class WorkerDied(DioramaError):  # noqa: N818  # as its siblings in `errors`
    """The process of one piece of work ended without an answer (killed for memory, or a crash in native code)."""


@dataclass(frozen=True)
class FinishedItem(Generic[Item, Result]):
    """One finished piece of work: its value, or why there is none."""

    item: Item
    value: Result | None
    error: Exception | None = None

    def unwrap(self) -> Result:
        """The value; raises the piece's own error."""
        if self.error is not None:
            raise self.error
        return self.value  # type: ignore[return-value]  # without an error the value is the function's own


@runtime_checkable
class Workers(Protocol):
    """Where pieces of work are done."""

    def map(self, function: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[FinishedItem[Item, Result]]:
        """`function` of every item, as they finish, in no particular order.

        Items are drawn as they are needed, so there may be very many. Closing the iterator drops what has not started.
        """
        ...

    @property
    def count(self) -> int:
        """How many pieces are done at once."""
        ...


def workers(ray_address: str | None = None, count: int | None = None) -> Workers:
    """Ray at an address, or this machine's cores.

    Args:
        ray_address: `auto`, `HOST:PORT`, `ray://HOST:PORT` of a running cluster, or `local` to start Ray here; None
            for a plain pool of processes.
        count: Processes on this machine; all cores by default. A cluster knows its own size.

    Raises:
        UnavailableError: when Ray is asked for and not installed, or no cluster answers.
        InputError: when the count is not positive.
    """
    if count is not None and count < 1:
        raise InputError(f"{count} processes: ask for at least one")
    return LocalWorkers(count or os.cpu_count() or 1) if ray_address is None else RayWorkers(ray_address, count)


@dataclass(frozen=True)
class LocalWorkers:
    """Processes on this machine, started anew for each `map`. Each has a queue of its own: one that dies takes only the
    piece it worked on with it."""

    count: int

    def map(self, function: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[FinishedItem[Item, Result]]:
        """See `Workers.map`."""
        waiting = iter(items)
        processes = [_Process[Item, Result](function) for _ in range(self.count)]
        try:
            while True:
                for _ in range(_AHEAD):
                    for process in processes:
                        if len(process.running) < _AHEAD:
                            process.submit(*islice(waiting, 1))
                running = [future for process in processes for future in process.running]
                if not running:
                    return
                wait(running, return_when=FIRST_COMPLETED)
                for process in processes:
                    yield from process.finish()
        finally:
            for process in processes:
                process.end()


class _Process(Generic[Item, Result]):
    """One process, replaced when it dies, and the pieces that wait for it, the first of which it works on."""

    def __init__(self, function: Callable[[Item], Result]) -> None:
        self._function = function
        self._pool: ProcessPoolExecutor | None = None
        self.running: dict[Future[Result], Item] = {}

    def submit(self, *items: Item) -> None:
        """Queue pieces."""
        for item in items:
            # Fresh processes: a fork would copy the locks of threads that do not exist in the child.
            self._pool = self._pool or ProcessPoolExecutor(
                1, mp_context=get_context("spawn"), initializer=_end_with_parent
            )
            try:
                future = self._pool.submit(self._function, item)
            except BrokenProcessPool as error:  # it died just now: `finish` finds out what it worked on
                future = Future()
                future.set_exception(error)
            self.running[future] = item

    def finish(self) -> Iterator[FinishedItem[Item, Result]]:
        """The pieces that are done, or that it died of."""
        done = [future for future in self.running if future.done()]
        broken = next((f for f in done if isinstance(f.exception(), BrokenProcessPool)), None)
        for future in done:
            if broken is None or not isinstance(future.exception(), BrokenProcessPool):
                yield _finish(self.running.pop(future), future)
        if broken is not None:
            yield _finish(self.running.pop(broken), broken)
            self._restart()

    def _restart(self) -> None:
        """A new process for the pieces that the dead one had not begun."""
        self.end()
        left, self.running, self._pool = list(self.running.values()), {}, None
        self.submit(*left)

    def end(self) -> None:
        """Drop what has not begun, and let it go."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)


def _end_with_parent() -> None:
    """End this process when the one that started it was killed; it would wait for work for ever."""
    parent = parent_process()
    assert parent is not None

    def wait_for_end() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=wait_for_end, daemon=True, name="end-with-parent").start()


def _finish(item: Item, future: Future[Result]) -> FinishedItem[Item, Result]:
    error = future.exception()
    if isinstance(error, BrokenProcessPool):
        return FinishedItem(
            item, None, WorkerDied("the process ended without an answer; it may have run out of memory")
        )
    if isinstance(error, Exception):
        return FinishedItem(item, None, error)
    return FinishedItem(item, future.result())


def _call(function: Callable[[Item], Result], item: Item) -> Result:
    """Ray takes plain functions only, and callers also bring partial ones. Other pieces use the other processors."""
    os.environ.setdefault("LOKY_MAX_CPU_COUNT", "1")
    return function(item)


class RayWorkers:
    """The cores of a Ray cluster. Every machine needs this version of Diorama, and the same folders to read.

    Args:
        address: as in `workers`.
        count: cores used by Ray where it is started here; a running cluster decides itself.

    Raises:
        UnavailableError: when Ray is not installed, or no cluster answers.
    """

    def __init__(self, address: str, count: int | None = None) -> None:
        try:
            import ray
        except ImportError as error:
            raise UnavailableError("--ray needs Ray, which is not installed: pip install 'diorama[cluster]'") from error
        self._ray: Any = ray
        if not ray.is_initialized():
            os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # nobody is told that Diorama runs
            os.environ.setdefault("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")  # else Ray warns about its own future
            cores = {"num_cpus": count} if address == "local" and count else {}
            try:
                ray.init(address=address, log_to_driver=False, include_dashboard=False, logging_level="error", **cores)
            except (ConnectionError, ValueError, RuntimeError) as error:
                reason = str(error).splitlines()[0]
                raise UnavailableError(
                    f"no Ray cluster answers at '{address}' ({reason}); give the address that 'ray start' printed, "
                    "or 'local'"
                ) from error

    @property
    def count(self) -> int:
        """Cores of the cluster."""
        return max(int(self._ray.cluster_resources().get("CPU", 1)), 1)

    def map(self, function: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[FinishedItem[Item, Result]]:
        """See `Workers.map`."""
        ray = self._ray
        remote = ray.remote(_call).options(max_retries=0)
        shared = ray.put(function)  # it may carry much, such as a library's records
        waiting, running = iter(items), dict[Any, Item]()
        try:
            while True:
                for item in islice(waiting, self.count * _AHEAD - len(running)):
                    running[remote.remote(shared, item)] = item
                if not running:
                    return
                finished, _ = ray.wait(list(running), num_returns=1)
                for reference in finished:
                    yield self._answer(reference, running.pop(reference))
        finally:
            for reference in running:
                ray.cancel(reference, force=True)

    def _answer(self, reference: Any, item: Item) -> FinishedItem[Item, Any]:
        from ray.exceptions import RayError, RayTaskError

        try:
            return FinishedItem(item, self._ray.get(reference))
        except RayTaskError as error:
            return FinishedItem(item, None, error.cause if isinstance(error.cause, Exception) else error)
        except RayError as error:
            return FinishedItem(item, None, WorkerDied(f"the process ended without an answer ({type(error).__name__})"))


def map_threads(
    work: Callable[[Item], Result], items: Sequence[Item], progress: Progress = SILENT, message: str = ""
) -> list[Result]:
    """Work on all items, two at a time; results in order, so that threads change nothing.

    Args:
        work: Done with each item.
        items: What there is to do.
        progress: Told after every item; `Cancelled` drops the items that have not begun.
        message: What is told.
    """
    results: list[Result] = []
    with ThreadPoolExecutor(max_workers=2) as pool:
        try:
            for result in pool.map(work, items):
                results.append(result)
                progress.report(len(results) / len(items), message)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return results
