"""A progress bar on stderr for commands; plain lines where stderr is not a terminal."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from diorama_core.progress import CancelToken, Progress, ProgressEvent


@contextmanager
def progress_bar() -> Iterator[Progress]:
    """A `Progress` drawn on stderr; Ctrl+C asks the work to stop at its next check, a second one stops at once."""
    token = CancelToken()
    previous = signal.getsignal(signal.SIGINT)

    def stop(number: int, frame: object) -> None:
        if token.cancelled:
            raise KeyboardInterrupt
        token.cancel()

    signal.signal(signal.SIGINT, stop)
    try:
        if sys.stderr.isatty():
            from rich.console import Console  # a tenth of a second to load
            from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn
            from rich.progress import Progress as Bar

            columns = (TextColumn("{task.description:<28}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
            with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
                task = bar.add_task("", total=1.0)
                yield Progress(lambda e: bar.update(task, completed=e.fraction, description=e.message), token)
        else:
            yield Progress(_Lines(), token)
    finally:
        signal.signal(signal.SIGINT, previous)


class _Lines:
    """One line for each new message."""

    def __init__(self) -> None:
        self._last = ""

    def __call__(self, event: ProgressEvent) -> None:
        if event.message != self._last:
            self._last = event.message
            print(f"{event.fraction:4.0%} {event.message}", file=sys.stderr)
