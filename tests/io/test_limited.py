"""Decoding in a process of its own: bounded, restarted, one line."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import Cancelled, InputError, LibraryError
from diorama_core.io import limited
from diorama_core.io.limited import LimitedProcess
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from tests import kept_readers
from tests.processes import runs
from tests.waiting import until


def double(number: int) -> int:
    return 2 * number


def greedy(megabytes: int) -> int:
    return int(np.ones(megabytes * 1_000_000, np.uint8).sum())


def echo(values: np.ndarray) -> np.ndarray:
    print("what libraries print is no answer", flush=True)
    os.write(1, b"nor is this")
    return values


def crash() -> None:
    ctypes.string_at(0)


def refuse() -> None:
    raise LibraryError("a chair has no legs")


def pid() -> int:
    return os.getpid()


def say_and_sleep(path: str) -> None:
    Path(path).write_text(str(os.getpid()))
    time.sleep(120.0)


PROGRAM = """
import sys
from diorama_core.io.limited import LimitedProcess
from tests.io.test_limited import say_and_sleep
LimitedProcess(seconds=200.0).call("a file", say_and_sleep, sys.argv[1])
"""


@pytest.fixture(autouse=True)
def _nothing_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    kept_readers.keep(monkeypatch, kept=False)


@pytest.fixture(scope="module")
def process() -> Iterator[LimitedProcess]:
    """One that the tests end, and start again."""
    made = LimitedProcess(memory=800_000_000, seconds=30.0)
    yield made
    made.close()


def test_it_answers_from_another_process(process: LimitedProcess) -> None:
    assert process.call("x", double, 21) == 42
    assert process.call("x", pid) != os.getpid()
    assert process.call("x", pid) == process.call("x", pid), "one process for all calls"


def test_too_much_memory_is_one_line_and_the_next_call_works(process: LimitedProcess) -> None:
    with pytest.raises(InputError, match=r"room\.png: it needs more memory"):
        process.call("room.png", greedy, 5000)
    assert process.call("x", greedy, 10) == 10_000_000


def test_large_values_go_there_and_back_whatever_is_printed(process: LimitedProcess) -> None:
    values = np.arange(3_000_000, dtype=np.float32)
    assert np.array_equal(process.call("x", echo, values), values)


def test_what_is_too_large_to_be_handed_over_is_one_line(process: LimitedProcess) -> None:
    with pytest.raises(InputError, match=r"room\.png: it needs more memory"):
        process.call("room.png", echo, np.zeros(500_000_000, np.uint8))
    assert process.call("x", double, 1) == 2


def test_a_crash_is_one_line_and_the_next_call_works(process: LimitedProcess) -> None:
    with pytest.raises(InputError, match=r"room\.exr: .*damaged"):
        process.call("room.exr", crash)
    assert process.call("x", double, 1) == 2


def test_what_takes_too_long_is_ended() -> None:
    process, began = LimitedProcess(memory=800_000_000, seconds=2.0), time.monotonic()
    with pytest.raises(InputError, match="takes too long"):
        process.call("room.png", time.sleep, 600.0)
    assert time.monotonic() - began < 300.0
    process.close()


def test_waiting_for_a_processor_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    used = limited.cpu_time(os.getpid())
    assert used is not None
    times = os.times()
    assert times.system > 0.05
    assert used[0] == pytest.approx(times.user + times.system, abs=0.05)
    assert limited.cpu_time(-1) is None
    monkeypatch.setattr(limited, "cpu_time", lambda pid: (1.0, True))  # ready, and never given a turn
    process = LimitedProcess(memory=800_000_000, seconds=0.3)
    process.call("room.png", time.sleep, 1.0)
    process.close()


def test_closing_ends_the_process_and_leaves_no_files_open(process: LimitedProcess) -> None:
    first = process.call("x", pid)
    before = len(os.listdir("/proc/self/fd"))
    for _ in range(2):
        process.close()
        assert not runs(first)
        first = process.call("x", pid)
    until(lambda: len(os.listdir("/proc/self/fd")) <= before, "pipes of processes that ended are closed")


def test_stopping_ends_what_somebody_waits_for(process: LimitedProcess) -> None:
    worker = process.call("x", pid)
    with ThreadPoolExecutor(1) as threads:
        waiting = threads.submit(process.call, "room.png", time.sleep, 600.0)
        until(lambda: process._lock.locked(), "it was asked")
        process.stop()
        with pytest.raises(InputError, match=r"room\.png"):
            waiting.result(60.0)
    until(lambda: not runs(worker), "it has ended")


def test_errors_meant_for_people_arrive_as_they_are(process: LimitedProcess) -> None:
    with pytest.raises(LibraryError, match="a chair has no legs"):
        process.call("x", refuse)
    with pytest.raises(InputError, match=r"x: it cannot be read \(TypeError\)"):
        process.call("x", double, None)


def slowly(steps: int, progress: Progress) -> int:
    for step in range(steps):
        progress.report(step / steps, f"step {step}")
        time.sleep(0.05)
    return steps


def silently(seconds: float, progress: Progress) -> None:
    time.sleep(seconds)


def test_long_work_reports_its_progress(process: LimitedProcess) -> None:
    events: list[ProgressEvent] = []
    assert process.work("x", slowly, 4, progress=Progress(events.append)) == 4
    assert [e.message for e in events] == [f"step {i}" for i in range(4)]
    assert process.call("x", double, 21) == 42, "nothing of it is left over"


def test_a_cancel_ends_the_process_and_the_next_call_works(process: LimitedProcess) -> None:
    token = CancelToken()
    before = process.call("x", pid)
    started = time.monotonic()
    with pytest.raises(Cancelled):
        process.work("x", slowly, 10_000, progress=Progress(lambda event: token.cancel(), token))
    assert time.monotonic() - started < 250.0, "half of what the work takes"
    assert process.call("x", pid) != before


def test_the_limit_of_time_is_between_two_reports(process: LimitedProcess, monkeypatch: pytest.MonkeyPatch) -> None:
    process.call("x", double, 1)  # it has started, which takes longer than what follows
    monkeypatch.setattr(process, "_seconds", 2.0)
    assert process.work("x", slowly, 80, progress=Progress()) == 80, "four seconds in all"
    with pytest.raises(InputError, match="takes too long"):
        process.work("room.glb", silently, 600.0, progress=Progress())


def test_it_ends_with_the_program_whatever_it_does(tmp_path: Path) -> None:
    said = tmp_path / "pid"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parents[2])}
    program = subprocess.Popen([sys.executable, "-c", PROGRAM, str(said)], env=environment)
    until(lambda: said.exists() and said.read_text(), seconds=120.0)
    decoding = int(said.read_text())
    program.kill()
    program.wait()
    until(lambda: not runs(decoding), "the decoding process ends with the program", seconds=30.0)
