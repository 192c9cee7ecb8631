"""Work in a fork of this process that is killed at a given moment, and what it had said until then."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from diorama_core.errors import DioramaError

Say = Callable[[str], None]
Work = Callable[[Say], None]


@dataclass
class Ended:
    """What is known of a process that was killed, or ended before."""

    lines: list[str] = field(default_factory=list)
    """What it said, to the end."""
    finished: bool = False
    children: tuple[int, ...] = ()
    """Processes that it had started when it was killed."""


class FailedError(Exception):
    """The work itself failed."""


def killed(work: Work, after_s: float, *, from_first: bool = False) -> Ended:
    """Run `work` in a fork of this process and kill it.

    Args:
        work: Told how to say what is acknowledged, in lines.
        after_s: From its start, or from its first line.
        from_first: Count from the first line.
    """
    ours, theirs = os.pipe()
    process = os.fork()
    if process == 0:
        os.close(ours)
        _work_and_exit(work, theirs)
    os.close(theirs)
    with os.fdopen(ours, "rb") as pipe:
        said = bytearray()
        if from_first:
            said += os.read(pipe.fileno(), 65536)
        ended = _read_until(pipe.fileno(), said, time.monotonic() + after_s)
        children = () if ended else _children(process)
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
        while not children and (part := os.read(pipe.fileno(), 65536)):  # children may hold the pipe open
            said += part
    os.waitpid(process, 0)
    lines = said.decode().split("\n")[:-1]  # what follows the last line's end is half a line
    if lines and lines[-1].startswith("failed"):
        raise FailedError("\n".join(lines))
    return Ended([line for line in lines if line != "finished"], lines[-1:] == ["finished"], children)


def _work_and_exit(work: Work, pipe: int) -> None:
    def say(line: str) -> None:
        os.write(pipe, f"{line}\n".encode())

    try:
        work(say)
        say("finished")
    except BaseException:  # the process ends here: the line is all that is heard of it
        say("failed " + traceback.format_exc().replace("\n", " | "))
    os._exit(0)


def _read_until(pipe: int, said: bytearray, until: float) -> bool:
    """Take up what is said until a time; whether the process ended before."""
    while (left := until - time.monotonic()) > 0:
        if select.select([pipe], [], [], left)[0]:
            part = os.read(pipe, 65536)
            if not part:
                return True
            said += part
    return False


def _children(process: int) -> tuple[int, ...]:
    path = Path(f"/proc/{process}/task/{process}/children")
    return tuple(map(int, path.read_text().split())) if path.exists() else ()


def unreadable(read: Callable[[], object]) -> bool:
    """Whether what was left behind cannot be read."""
    try:
        read()
    except DioramaError:
        return True
    return False


def duration(work: Work) -> float:
    """How long the work takes when nobody kills it."""
    began = time.monotonic()
    assert killed(work, 600.0).finished
    return time.monotonic() - began
