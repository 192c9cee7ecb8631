"""Progress and cancellation of long work, independent of who shows it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field

from diorama_core.errors import Cancelled

Segments = tuple[tuple[float, float, float, float], ...]
"""Lines over a photo: both ends, x1, y1, x2, y2 in its pixels."""


@dataclass(frozen=True)
class ProgressEvent:
    """One step of a long job, as shown to a person."""

    fraction: float
    """Share of the whole job that is done, 0 to 1."""
    message: str
    """What is happening now, in plain words."""
    found: str = ""
    """What a stage that just ended found, in a few words; empty otherwise."""
    drawn: Segments = ()
    """What it found, as lines over the photo."""


class CancelToken:
    """A flag that one thread sets and a working thread checks."""

    def __init__(self) -> None:
        self._event = threading.Event()

    def cancel(self) -> None:
        """Ask the job to stop at its next check."""
        self._event.set()

    @property
    def is_cancelled(self) -> bool:
        """Whether the job was asked to stop."""
        return self._event.is_set()


def _ignore(event: ProgressEvent) -> None:
    pass


@dataclass(frozen=True)
class Progress:
    """Where long work reports and where it learns that it should stop.

    `Progress()` reports nowhere and is never cancelled.
    """

    on_event: Callable[[ProgressEvent], None] = _ignore
    token: CancelToken = field(default_factory=CancelToken)
    start: float = 0.0
    """Where this part of the job begins on the whole job's scale."""
    end: float = 1.0
    """Where it ends there."""

    def report(self, fraction: float, message: str) -> None:
        """Report that `fraction` (0 to 1) of this part is done; raises `Cancelled` when asked to stop."""
        self.check()
        self.on_event(ProgressEvent(fraction=self._overall_fraction(min(max(fraction, 0.0), 1.0)), message=message))

    def report_finding(self, words: str, drawn: Segments = ()) -> None:
        """Report what this part of the job, which is done, found: words and lines; nothing without words."""
        if words:
            self.on_event(ProgressEvent(fraction=self.end, message=words, found=words, drawn=drawn))

    def check(self) -> None:
        """Raise `Cancelled` when the job was asked to stop."""
        if self.token.is_cancelled:
            raise Cancelled("stopped on request; nothing was changed")

    def part(self, start: float, end: float) -> Progress:
        """The progress of a sub-task that covers `start` to `end` of this one."""
        return Progress(
            on_event=self.on_event,
            token=self.token,
            start=self._overall_fraction(start),
            end=self._overall_fraction(end),
        )

    def parts(self, count: int) -> list[Progress]:
        """The progress of each of so many sub-tasks that take equally long."""
        return [self.part(k / count, (k + 1) / count) for k in range(count)]

    def _overall_fraction(self, fraction: float) -> float:
        """Fraction of the whole job; a part ends exactly where the next one begins."""
        return self.start * (1.0 - fraction) + self.end * fraction


SILENT = Progress()
"""The default of functions that take a progress: reports nowhere and is never cancelled."""
