"""Waiting for what other threads and processes do, where nothing tells when they have done it."""

from __future__ import annotations

import time
from collections.abc import Callable


def until(holds: Callable[[], object], what: object = "", *, seconds: float = 60.0) -> None:
    """Wait until something holds, looking a hundred times a second; `what` is said when it never does."""
    deadline = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < deadline, f"did not come about in {seconds:g} s: {what or holds}"
        time.sleep(0.01)
