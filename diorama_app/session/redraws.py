"""What browsers see, and how often: redraws of panels, the progress of a running job, and looks at the disk for
everybody.

Drawing the panels of one browser takes milliseconds; of twenty, at every edit of twenty people, more than there is. An
edit therefore marks the panels of all as out of date, and each browser's are drawn as a task of its own, between which
other people's edits take their turn.

Every look-up lets other threads run first. Some in each redraw of twenty browsers took more time than the drawing.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from cachetools import TTLCache

from diorama_app.session.jobs import JobStatus, Outcome
from diorama_app.session.ui_thread import UiThread

if TYPE_CHECKING:
    from diorama_app.session.connected_client import ConnectedClient

EVERY_S = 0.1
"""Between two redraws of one browser."""
WATCHING_S = 0.15
"""After somebody's edit the others' panels wait so long: what moved is on their screens first."""
SHARE = 0.4
"""Share of the time that is spent on drawing at most; with many browsers mere watchers are drawn for less often."""


class Redraws:
    """Used from the UI thread only."""

    def __init__(self, ui_thread: UiThread, is_connected: Callable[[int], bool]) -> None:
        self._ui_thread = ui_thread
        self._is_connected = is_connected
        self._drawn_at: dict[int, float] = {}
        self._took_s = 0.0
        """What a redraw takes, a running mean."""

    def ask(self, clients: Iterable[ConnectedClient], first: ConnectedClient | None = None) -> None:
        """Draw these browsers' panels soon; those of whoever caused it at once unless that was done just now."""
        all_of_them = list(clients)
        known = {g.id for g in all_of_them}
        self._drawn_at = {i: t for i, t in self._drawn_at.items() if i in known}
        every_s = max(EVERY_S, len(all_of_them) * self._took_s / SHARE)
        now = time.monotonic()
        for client in sorted(all_of_them, key=lambda g: g is not first):
            due_s = self._drawn_at.get(client.id, -every_s) + (EVERY_S if client is first else every_s) - now
            if first is not None and client is not first:
                due_s = max(due_s, WATCHING_S)
            if due_s <= 0 and (client is first or len(all_of_them) == 1):
                self._draw(client)
            else:
                self._ui_thread.post(
                    partial(self._draw, client),
                    key="redraw",
                    client_id=("redraw", client.id),
                    after_s=max(0.0, due_s),
                )

    def _draw(self, client: ConnectedClient) -> None:
        if not self._is_connected(client.id):
            return  # went away meanwhile
        began = time.monotonic()
        client.refresh()
        now = self._drawn_at[client.id] = time.monotonic()
        self._took_s += 0.1 * (now - began - self._took_s)


REPORT_INTERVAL_S = 0.15


class JobReports:
    """Hands what a job says, in the job's thread, to the page, in the UI thread."""

    def __init__(
        self,
        ui_thread: UiThread,
        *,
        on_start: Callable[[], None],
        on_progress: Callable[[], None],
        on_end: Callable[[Outcome], None],
    ) -> None:
        """Reports of all jobs of a session.

        Args:
            ui_thread: runs the three others.
            on_start: a job begins.
            on_progress: its status differs; at most once every `REPORT_INTERVAL_S`.
            on_end: it ended, and how.
        """
        self._ui_thread = ui_thread
        self._on_start, self._on_progress, self._on_end = on_start, on_progress, on_end
        self._reported_at = 0.0

    def update(self, status: JobStatus) -> None:
        """The status of the running job differs. May be called from any thread."""
        now = time.monotonic()
        begins = status.fraction == 0.0
        if begins or status.cancelling or now - self._reported_at > REPORT_INTERVAL_S:
            self._reported_at = now
            self._ui_thread.post(self._on_start if begins else self._on_progress, key="job")

    def end(self, outcome: Outcome) -> None:
        """The job is over. May be called from any thread."""
        self._ui_thread.post(lambda: self._on_end(outcome))


T = TypeVar("T")

FRESH_S = 3.0
"""What was seen counts for so long; another program's changes are shown with the next redraw after that."""


class Glances:
    """Used from the UI thread only."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._seen: TTLCache[Hashable, Any] = TTLCache(maxsize=64, ttl=FRESH_S, timer=clock)

    def get(self, what: Hashable, look: Callable[[], T]) -> T:
        """The value of `look`, or its value a moment ago for the same `what`; what it raises is raised each time."""
        seen = self._seen.get(what)  # it may grow old between two questions
        if seen is None:
            seen = self._seen[what] = (look(),)
        value: T = seen[0]
        return value

    def forget(self) -> None:
        """Look again at everything: it was changed here."""
        self._seen.clear()
