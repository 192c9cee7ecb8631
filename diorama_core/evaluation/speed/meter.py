"""What work costs: processor time, which a busy machine changes little, and memory; and a yardstick for machines."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from diorama_core.errors import UnavailableError
from diorama_core.processes import give_back_memory
from diorama_core.progress import Progress, ProgressEvent

YARDSTICK_REPEATS = 5


@dataclass(frozen=True)
class Cost:
    """What one piece of work took."""

    seconds: float
    """Processor time of all threads together."""
    peak_mb: float | None = None
    """Resident memory at its highest, above where it was before; None where the system does not tell."""


def cost_of(work: Callable[[], object], repeats: int = 1) -> Cost:
    """Processor time and memory of the cheapest of some runs."""
    costs = []
    for _ in range(repeats):
        meter = _Meter()
        work()
        costs.append(meter.read())
    return min(costs, key=lambda c: c.seconds)


class StageClock:
    """Costs of the named stages of a build, read off its progress: each says when it begins and when it is done."""

    def __init__(self, stages: tuple[str, ...]) -> None:
        self.costs: dict[str, Cost] = {}
        self._begins = {f"{name}…": name for name in stages}
        self._running: tuple[str, _Meter] | None = None

    def watch(self, progress: Progress) -> Progress:
        """A progress to hand to the build: goes nowhere else, stops when the given one is stopped."""
        return Progress(on_event=self._note, token=progress.token)

    def _note(self, event: ProgressEvent) -> None:
        ended = event.message == "done" or event.message.endswith(": done")
        if self._running is not None and (ended or event.message in self._begins):
            name, meter = self._running
            self.costs[name], self._running = meter.read(), None
        if event.message in self._begins:
            self._running = (self._begins[event.message], _Meter())


class _Meter:
    """Starts when it is made."""

    def __init__(self) -> None:
        give_back_memory()
        self._before_mb = _begin_peak_mb()
        self._begun = time.process_time()

    def read(self) -> Cost:
        seconds, peak = time.process_time() - self._begun, _status_mb("VmHWM")
        known = self._before_mb is not None and peak is not None
        return Cost(seconds, max(0.0, (peak or 0.0) - (self._before_mb or 0.0)) if known else None)


def yardstick_s() -> float:
    """Processor seconds of a fixed piece of work, part Python and part numpy: how slow this machine is just now.

    Costs divided by it can be compared between machines, and between a quiet and a busy one.
    """
    return min(cost_of(_work).seconds for _ in range(YARDSTICK_REPEATS))


def _work() -> float:
    points = np.linspace(0.0, 1.0, 300_000).reshape(-1, 3)
    total = 0.0
    for k in range(4):
        order = np.argsort(np.sin(1000.0 * (k + 1) * points[:, 0]))
        total += float(np.sqrt((points[order] * points).sum(axis=1)).sum())
    words = {str(k): k for k in range(60_000)}
    return total + sum(words[str(k)] for k in range(0, 60_000, 7))


def growth_exponent(points: list[tuple[float, float]]) -> float:
    """Slope of log time over log quantity, least squares; 0 for fewer than two points."""
    if len(points) < 2:
        return 0.0
    x, y = np.log(np.maximum(np.array(points).T, 1e-9))
    return float(np.polyfit(x, y, 1)[0])


def process_peak_mb() -> float:
    """Peak memory of this process.

    Raises:
        UnavailableError: the system does not tell (Windows).
    """
    try:
        import resource
    except ImportError as error:
        raise UnavailableError("this system does not tell how much memory a process took; run it elsewhere") from error
    scale = 1024.0 if sys.platform != "darwin" else 1024.0**2
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / scale


def _begin_peak_mb() -> float | None:
    """Forget the highest memory so far (Linux), and tell the memory now."""
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return None
    return _status_mb("VmRSS")


def _status_mb(key: str) -> float | None:
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
    except OSError:
        return None
    return next((float(line.split()[1]) / 1024 for line in lines if line.startswith(f"{key}:")), None)
