"""Processes that read files (`io.limited`) go on from one test to the next: to start one costs up to two seconds."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from typing import Any

import pytest

from diorama_core.io import limited
from diorama_core.io.limited import LimitedProcess

MAX_IDLE = 3
OWN = "PYTEST_CURRENT_TEST"

Key = tuple[Any, ...]
_idle: list[tuple[Key, subprocess.Popen[bytes], limited._Messages]] = []
"""The latest last."""
_keys: dict[int, Key] = {}
"""By a process's id."""
_one_at_a_time = threading.Lock()
_started, _close, _stop, _end = (
    LimitedProcess._start, LimitedProcess.close, LimitedProcess.stop, LimitedProcess._end,
)  # fmt: skip


def _key(process: LimitedProcess) -> Key:
    """What a process was started with: its memory, folder, modules and environment."""
    environment = tuple(sorted((k, v) for k, v in os.environ.items() if k != OWN))
    return process._memory, os.getcwd(), tuple(sys.path), environment


def started(self: LimitedProcess) -> limited._Messages:
    """In place of `LimitedProcess._start`: an idle process of the same environment, or a new one."""
    with _one_at_a_time:
        if self._process is None:
            for k, (key, process, messages) in enumerate(_idle):
                if key == _key(self) and process.poll() is None:
                    self._process, self._messages = process, messages
                    del _idle[k]
                    break
        before = self._process
        messages = _started(self)
        if self._process is not None and self._process is not before:
            _keys[self._process.pid] = _key(self)
        return messages


def close(self: LimitedProcess) -> None:
    """In place of `LimitedProcess.close`: what it read with waits for the next."""
    with self._lock, _one_at_a_time:
        if self._process is None or self._messages is None:
            return
        _idle.append((_keys[self._process.pid], self._process, self._messages))
        self._process = self._messages = None
        if len(_idle) > MAX_IDLE:
            end(_idle.pop(0))


def stop(self: LimitedProcess) -> None:
    """In place of `LimitedProcess.stop`: a process that reads is ended, one that waits is kept."""
    (_stop if self._lock.locked() else close)(self)


def keep(patch: pytest.MonkeyPatch, *, kept: bool = True) -> None:
    """Keep processes, or start and end them as the program does."""
    patch.setattr(LimitedProcess, "_start", started if kept else _started)
    patch.setattr(LimitedProcess, "close", close if kept else _close)
    patch.setattr(LimitedProcess, "stop", stop if kept else _stop)


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
