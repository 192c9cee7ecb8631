"""Decoding of untrusted files in a separate process, with limits of memory and time.

Decoders of pictures and depth maps are native code that reads untrusted bytes. There a bomb ends in one clear
line, a crash takes nothing along, and the thread that serves everybody does not wait for a large picture.
"""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from diorama_core.errors import DioramaError, InputError
from diorama_core.progress import Progress, ProgressEvent

P = ParamSpec("P")
R = TypeVar("R")

MAX_MEMORY = 2_000_000_000
"""Address space of the process, code and libraries (up to half a gigabyte) included."""
MAX_SECONDS = 60.0
"""Of work; the time in which it waits for a processor does not count."""

_GLANCE_S = 0.2
"""How often a cancel, and the end of the program, is looked for."""
_TOO_MUCH = "it needs more memory than a file of this kind should, or is damaged; reduce it or save it again"
_TOO_LONG = "reading it takes too long; reduce it or save it again"
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class LimitedProcess:
    """One process that is started when it is first needed, and again after it had to be ended. Thread-safe."""

    def __init__(self, *, memory: int = MAX_MEMORY, seconds: float = MAX_SECONDS) -> None:
        self._memory, self._seconds = memory, seconds
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._connection: Connection | None = None

    def call(self, name: str, function: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> R:
        """`function(*args, **kwargs)` in the process.

        Args:
            name: what is read, for messages.
            function: importable by name, as are its arguments.
            args: handed over.
            kwargs: handed over.

        Raises:
            InputError: the limit of memory or time was reached, or the process crashed.
            DioramaError: what the function raised.
        """
        return self._asked(name, (function, args, kwargs), None)

    def work(self, name: str, function: Callable[..., R], *args: Any, progress: Progress) -> R:
        """`function(*args, progress)` in the process, for long work that reports its progress.

        The limit of time is that between two reports. A cancel ends the process at once.

        Args:
            name: what is read, for messages.
            function: importable by name, as are its arguments.
            args: handed over.
            progress: told what the function reports.

        Raises:
            InputError, DioramaError: as `call`.
            Cancelled: when asked to stop.
        """
        return self._asked(name, (function, args, None), progress)

    def _asked(self, name: str, task: tuple[Any, Any, Any], progress: Progress | None) -> Any:
        with self._lock:
            connection = self._started()
            try:
                connection.send(task)
                good, value = self._answer_from(connection, name, progress)
            except (EOFError, OSError) as error:
                self._end()
                raise InputError(f"{name}: {_TOO_MUCH}") from error
            except BaseException:
                self._end()  # an answer that nobody waits for must not be taken for the next one's
                raise
        if good:
            return value
        raise value if isinstance(value, DioramaError) else InputError(f"{name}: {value or _TOO_MUCH}")

    def _answer_from(self, connection: Connection, name: str, progress: Progress | None) -> tuple[bool, Any]:
        """The last message; the ones before it are steps of progress."""
        quiet, used = 0.0, self._cpu_time()
        while True:
            if not connection.poll(_GLANCE_S):
                before, used = used, self._cpu_time()
                quiet += _GLANCE_S if before is None or used is None or not used[1] else used[0] - before[0]
                if quiet >= self._seconds:
                    raise InputError(f"{name}: {_TOO_LONG}")
            else:
                good, value = connection.recv()
                if good is not None:
                    return good, value
                quiet = 0.0
                if progress is not None:
                    progress.report(*value)
            if progress is not None:
                progress.check()

    def _cpu_time(self) -> tuple[float, bool] | None:
        return None if self._process is None else cpu_time(self._process.pid)

    def close(self) -> None:
        """End the process after what it does now; a later call starts another."""
        with self._lock:
            self._end()

    def stop(self) -> None:
        """End the process now; whoever waits for it gets an `InputError`."""
        process = self._process
        if process is not None:
            with contextlib.suppress(OSError):
                process.kill()

    def _started(self) -> Connection:
        if self._process is not None and self._process.poll() is None and self._connection is not None:
            return self._connection
        self._end()
        ours, theirs = socket.socketpair()
        environment = {**os.environ, **dict.fromkeys(_THREADS, "1"), "PYTHONPATH": os.pathsep.join(sys.path)}
        command = [sys.executable, "-m", __name__, str(theirs.fileno()), str(self._memory), str(os.getpid())]
        self._process = subprocess.Popen(
            command,
            pass_fds=(theirs.fileno(),),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=environment,
        )
        theirs.close()
        self._connection = Connection(ours.detach())
        return self._connection

    def _end(self) -> None:
        if self._connection is not None:
            with contextlib.suppress(OSError):
                self._connection.close()
        if self._process is not None:
            with contextlib.suppress(OSError):
                self._process.kill()
            self._process.wait()
        self._process = self._connection = None


def cpu_time(pid: int) -> tuple[float, bool] | None:
    """Seconds of a processor that a process has used, and whether it is ready for more; None where nobody says.

    On a busy machine a process that is ready waits for its turn: that is not its own time.
    """
    try:
        state, *fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[10]) + int(fields[11])) / os.sysconf("SC_CLK_TCK"), state == "R"
    except (OSError, ValueError, IndexError):
        return None


def _end_with(program: int) -> None:
    """End this process when the program is killed, also while it loads or decodes something."""
    while os.getppid() == program:
        time.sleep(_GLANCE_S)
    os._exit(1)


def _serve(handle: int, memory: int, program: int) -> None:
    """Answer calls until the other side is gone."""
    threading.Thread(target=_end_with, args=(program,), daemon=True, name="end-with-parent").start()
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with contextlib.suppress(OSError, AttributeError):
        os.nice(5)  # people's edits come first
    connection = Connection(handle)
    with contextlib.suppress(EOFError, OSError, KeyboardInterrupt):
        while True:
            function, args, kwargs = connection.recv()
            if kwargs is None:
                args, kwargs = (*args, Progress(lambda event: _tell(connection, event))), {}
            connection.send(_answer(function, args, kwargs))


def _tell(connection: Connection, event: ProgressEvent) -> None:
    connection.send((None, (event.fraction, event.message)))


def _answer(function: Callable[..., Any], args: tuple, kwargs: dict[str, Any]) -> tuple[bool, Any]:
    try:
        return True, function(*args, **kwargs)
    except DioramaError as error:
        return False, type(error)(str(error))
    except MemoryError:
        return False, ""
    except Exception as error:  # decoders of untrusted bytes raise almost anything
        return False, f"it cannot be read ({type(error).__name__}); save it again"


if __name__ == "__main__":
    _serve(int(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))
