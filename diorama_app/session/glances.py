"""What the page shows of the disk, looked up at most every few seconds for everybody.

Every look-up lets other threads run first. Some in each redraw of twenty browsers took more time than the drawing.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable
from typing import Any, TypeVar

from cachetools import TTLCache

T = TypeVar("T")

FRESH_S = 3.0
"""What was seen counts for so long; another program's changes are shown with the next redraw after that."""


class Glances:
    """Used from the UI thread only."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._seen: TTLCache[Hashable, Any] = TTLCache(maxsize=64, ttl=FRESH_S, timer=clock)

    def of(self, what: Hashable, look: Callable[[], T]) -> T:
        """What `look` gives, or gave a moment ago for the same `what`; what it raises is raised each time."""
        seen = self._seen.get(what)  # it may grow old between two questions
        if seen is None:
            seen = self._seen[what] = (look(),)
        found: T = seen[0]
        return found

    def forget(self) -> None:
        """Look again at everything: it was changed here."""
        self._seen.clear()
