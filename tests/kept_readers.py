"""Processes that read files (`io.limited`) go on from one test to the next: to start one costs up to two seconds."""

from __future__ import annotations

import os
import subprocess
from typing import Any

import pytest

from diorama_core.io import limited
from diorama_core.io.limited import LimitedProcess

MAX_IDLE = 3
OWN = "PYTEST_CURRENT_TEST"

Key = tuple[Any, ...]
_idle: list[tuple[Key, subprocess.Popen[bytes], limited._Messages]] = []
"""The latest last."""
_started, _close, _end = LimitedProcess._started, LimitedProcess.close, LimitedProcess._end


def _key(process: LimitedProcess) -> Key:
    """Memory and environment, with which a process was started."""
    return process._memory, tuple(sorted((k, v) for k, v in os.environ.items() if k != OWN))


def started(self: LimitedProcess) -> limited._Messages:
    """In place of `LimitedProcess._started`: an idle process of the same environment, or a new one."""
    if self._process is None:
        for k, (key, process, messages) in enumerate(_idle):
            if key == _key(self) and process.poll() is None:
                self._process, self._messages = process, messages
                del _idle[k]
                break
    return _started(self)


def close(self: LimitedProcess) -> None:
    """In place of `LimitedProcess.close`: what it read with waits for the next."""
    with self._lock:
        if self._process is None or self._messages is None:
            return
        _idle.append((_key(self), self._process, self._messages))
        self._process = self._messages = None
    if len(_idle) > MAX_IDLE:
        end(_idle.pop(0))


def keep(patch: pytest.MonkeyPatch, *, kept: bool = True) -> None:
    """Keep processes, or start and end them as the program does."""
    patch.setattr(LimitedProcess, "_started", started if kept else _started)
    patch.setattr(LimitedProcess, "close", close if kept else _close)


def end(*idle: tuple[Key, subprocess.Popen[bytes], limited._Messages]) -> None:
    """End processes."""
    for _, process, messages in idle:
        ending = LimitedProcess()
        ending._process, ending._messages = process, messages
        _end(ending)


def end_all() -> None:
    """End what waits for the next test."""
    end(*_idle)
    _idle.clear()
