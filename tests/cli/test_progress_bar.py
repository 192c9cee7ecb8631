from __future__ import annotations

import os
import signal
import time

import pytest

from diorama_app.cli.progress_bar import progress_bar
from diorama_core.errors import Cancelled

pytestmark = pytest.mark.posix


def interrupt() -> None:
    """As Ctrl+C does; the handler runs at the next instruction."""
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(0.01)


def test_without_a_terminal_every_new_message_is_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_bar() as progress:
        for fraction, message in ((0.0, "Reading"), (0.3, "Reading"), (0.5, "Building"), (1.0, "Building")):
            progress.report(fraction, message)
    assert capsys.readouterr().err.splitlines() == ["  0% Reading", " 50% Building"]


def interrupted(times: int) -> None:
    """Work that Ctrl+C is pressed in."""
    with progress_bar() as progress:
        progress.report(0.1, "a")
        for _ in range(times):
            interrupt()
        progress.report(0.2, "b")


def test_ctrl_c_stops_at_the_next_check_and_a_second_one_at_once() -> None:
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(Cancelled):
        interrupted(1)
    with pytest.raises(KeyboardInterrupt):
        interrupted(2)
    assert signal.getsignal(signal.SIGINT) is before
