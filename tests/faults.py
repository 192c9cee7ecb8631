"""Faults injected where files are written: a full disk, a kill at any flush or rename, a clock that jumps."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import pytest


class Killed(BaseException):
    """The program ends here, as by SIGKILL: no handler of errors sees it."""


@dataclass
class Faults:
    """What is wrong with the world at the moment."""

    full: bool = False
    """Whether the disk takes nothing."""
    kill_at: int | None = None
    """How many flushes and renames go well before the program is killed; None: all."""
    ahead_s: float = 0.0
    """How far the clock is ahead."""

    @contextmanager
    def injected(self) -> Iterator[None]:
        """While it lasts, the program meets these faults."""
        flush, rename, now, parts = os.fsync, os.replace, time.time, time.gmtime

        def step() -> None:
            if self.full:
                raise OSError(28, "No space left on device")
            if self.kill_at is not None:
                self.kill_at -= 1
                if self.kill_at < 0:
                    self.kill_at = None
                    raise Killed

        def fsync(handle: int) -> None:
            step()
            flush(handle)

        def replace(source: str, target: str) -> None:
            step()
            rename(source, target)
            os.utime(target, (time.time(), time.time()))

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(os, "fsync", fsync)
            patch.setattr(os, "replace", replace)
            patch.setattr(time, "time", lambda: now() + self.ahead_s)
            patch.setattr(time, "gmtime", lambda at_s=None: parts(time.time() if at_s is None else at_s))
            yield
