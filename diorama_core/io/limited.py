"""Decoding of untrusted files in a separate process, with limits of memory and time.

Decoders of pictures and depth maps are native code that reads untrusted bytes. There a bomb ends in one clear
line, a crash takes nothing along, and the thread that serves everybody does not wait for a large picture.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import queue
import struct
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any, ParamSpec, TypeVar

from diorama_core.errors import DioramaError, InputError
from diorama_core.progress import SILENT, Progress, ProgressEvent

P = ParamSpec("P")
R = TypeVar("R")

MAX_MEMORY = 2_000_000_000
"""Address space of the process, code and libraries (up to half a gigabyte) included."""
MAX_SECONDS = 60.0
"""Processor time; waiting for a processor does not count."""

_GLANCE_S = 0.2
"""How often a cancel, and the end of the program, is looked for."""
_TOO_MUCH = "it needs more memory than a file of this kind should, or is damaged; reduce it or save it again"
_TOO_LONG = "reading it takes too long; reduce it or save it again"
_LENGTH = struct.Struct("!Q")
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class _Messages:
    """Messages over two pipes. A thread reads them, so that one can wait for a time on every system.

    Args:
        reads: where messages come from.
        writes: where they go to.
        at_end: called when the other side is gone.
    """

    def __init__(self, reads: IO[bytes], writes: IO[bytes], at_end: Callable[[], object]) -> None:
        self._reads, self._writes, self._at_end = reads, writes, at_end
        self._received: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()
        threading.Thread(target=self._read, daemon=True, name="messages").start()

    def send(self, message: object) -> None:
        """Raises `OSError` when the other side is gone."""
        data = pickle.dumps(message, pickle.HIGHEST_PROTOCOL)
        self._writes.write(_LENGTH.pack(len(data)))
        self._writes.write(data)
        self._writes.flush()

    def receive(self, wait_s: float | None = None) -> Any:
        """The next message; raises `queue.Empty` when none comes in that time, `EOFError` when none ever will."""
        data = self._received.get(timeout=wait_s)
        if data is None:
            raise EOFError
        return pickle.loads(data)

    def close(self) -> None:
        """Nothing is sent any more."""
        with contextlib.suppress(OSError):
            self._writes.close()

    def _read(self) -> None:
        try:
            with self._reads, contextlib.suppress(OSError, ValueError, MemoryError):
                while len(head := self._reads.read(_LENGTH.size)) == _LENGTH.size:
                    (size,) = _LENGTH.unpack(head)
                    data = self._reads.read(size)
                    if len(data) < size:
                        break
                    self._received.put(data)
        finally:
            self._received.put(None)
            self._at_end()


class LimitedProcess:
    """One process that is started when it is first needed, and again after it had to be ended. Thread-safe."""

    def __init__(self, *, memory: int = MAX_MEMORY, seconds: float = MAX_SECONDS) -> None:
        self._memory, self._seconds = memory, seconds
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._messages: _Messages | None = None

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
        return self._ask(name, (function, args, kwargs), SILENT)

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
        return self._ask(name, (function, args, None), progress)

    def _ask(self, name: str, task: tuple[Any, Any, Any], progress: Progress) -> Any:
        with self._lock:
            messages = self._start()
            try:
                messages.send(task)
                good, value = self._answer_from(messages, name, progress)
            except (EOFError, OSError) as error:
                self._end()
                raise InputError(f"{name}: {_TOO_MUCH}") from error
            except BaseException:
                self._end()  # an answer that nobody waits for must not be taken for the next one's
                raise
        if good:
            return value
        raise value if isinstance(value, DioramaError) else InputError(f"{name}: {value or _TOO_MUCH}")

    def _answer_from(self, messages: _Messages, name: str, progress: Progress) -> tuple[bool, Any]:
        """The last message; the ones before it are steps of progress."""
        quiet, used = 0.0, self._cpu_time()
        while True:
            try:
                good, value = messages.receive(_GLANCE_S)
            except queue.Empty:
                before, used = used, self._cpu_time()
                quiet += _GLANCE_S if before is None or used is None or not used[1] else used[0] - before[0]
                if quiet >= self._seconds:
                    raise InputError(f"{name}: {_TOO_LONG}") from None
            else:
                if good is not None:
                    return good, value
                quiet = 0.0
                progress.report(*value)
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

    def _start(self) -> _Messages:
        if self._process is not None and self._process.poll() is None and self._messages is not None:
            return self._messages
        self._end()
        environment = {**os.environ, **dict.fromkeys(_THREADS, "1"), "PYTHONPATH": os.pathsep.join(sys.path)}
        self._process = subprocess.Popen(
            [sys.executable, "-m", __name__, str(self._memory)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment,
        )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._messages = _Messages(self._process.stdout, self._process.stdin, lambda: None)
        return self._messages

    def _end(self) -> None:
        if self._process is not None:
            with contextlib.suppress(OSError):
                self._process.kill()
            self._process.wait()
        if self._messages is not None:
            self._messages.close()
        self._process = self._messages = None


def cpu_time(pid: int) -> tuple[float, bool] | None:
    """Seconds of a processor that a process has used, and whether it is ready for more; None where nobody says.

    On a busy machine a process that is ready waits for its turn: that is not its own time.
    """
    try:
        state, *fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[10]) + int(fields[11])) / os.sysconf("SC_CLK_TCK"), state == "R"
    except (OSError, ValueError, IndexError):
        return None


def _serve(memory: int) -> None:
    """Answer calls until the program that asks is gone, whatever is being decoded then."""
    reads, writes = (os.fdopen(os.dup(k), mode) for k, mode in ((0, "rb"), (1, "wb")))
    os.dup2(os.open(os.devnull, os.O_RDWR), 0)
    os.dup2(2, 1)  # libraries may print
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with contextlib.suppress(OSError, AttributeError):
        os.nice(5)  # people's edits come first
    messages = _Messages(reads, writes, lambda: os._exit(1))
    with contextlib.suppress(EOFError, OSError, KeyboardInterrupt):
        while True:
            function, args, kwargs = messages.receive()
            if kwargs is None:
                args, kwargs = (*args, Progress(lambda event: _tell(messages, event))), {}
            messages.send(_answer(function, args, kwargs))


def _tell(messages: _Messages, event: ProgressEvent) -> None:
    messages.send((None, (event.fraction, event.message)))


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
    _serve(int(sys.argv[1]))
