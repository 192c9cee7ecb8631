"""What browsers see of a running job: its start and end at once, its progress a few times a second."""

from __future__ import annotations

import time
from collections.abc import Callable

from diorama_app.session.jobs import JobStatus, Outcome
from diorama_app.session.ui_thread import UiThread

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

    def changed(self, status: JobStatus) -> None:
        """The status of the running job differs. May be called from any thread."""
        now = time.monotonic()
        begins = status.fraction == 0.0
        if begins or status.cancelling or now - self._reported_at > REPORT_INTERVAL_S:
            self._reported_at = now
            self._ui_thread.post(self._on_start if begins else self._on_progress, key="job")

    def ended(self, outcome: Outcome) -> None:
        """The job is over. May be called from any thread."""
        self._ui_thread.post(lambda: self._on_end(outcome))
