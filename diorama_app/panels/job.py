"""The strip of the running job over the view: title, stage, what was found so far, time left, pause and cancel."""

from __future__ import annotations

import json
import time
from typing import Any

import viser

from diorama_app.commands.optimise import pause
from diorama_app.panels.fields import PageScript
from diorama_app.session.client import Client
from diorama_app.session.jobs import JobStatus
from diorama_app.strings import SOURCE_LANGUAGE, _, language
from diorama_app.web.html import Action, LiveHtml

MIN_SHARE, MIN_S = 0.08, 4.0
"""Before, nothing can be said about the time that is left."""
FOUND_SHOWN = 4


class JobStrip:
    """Tells the page what runs (`static/job.js` draws it) and does what its buttons ask for."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        sender = LiveHtml(gui, self._act)
        sender.show('<button type="button" id="dio-job-send" style="display:none" tabindex="-1"></button>')
        self._script = PageScript(gui)
        self._tell(None)

    def refresh(self) -> None:
        """Show the running job; nothing when none runs."""
        session = self._client.session
        status, run = session.jobs.status, session.layout_run
        self._client.view.canvas.show_lines(() if status is None else status.drawn)
        if status is None:
            self._tell(None)
            return
        stage = _(status.message)  # one with numbers in it stays English
        can_pause = status.kind == "optimise" and run is not None and not status.cancelling
        self._tell(
            {
                "title": status.title,
                "percent": round(100 * status.fraction),
                "stage": stage[:1].upper() + stage[1:],
                "lang": "en" if stage == status.message and language() != SOURCE_LANGUAGE else "",
                "left": time_left(status, time.monotonic()),
                "found": " · ".join(status.found[-FOUND_SHOWN:]),
                "pause": (_("Resume") if run is not None and run.is_paused else _("Pause")) if can_pause else "",
                "cancelling": status.cancelling,
            }
        )

    def _tell(self, job: dict[str, Any] | None) -> None:
        self._script.run(f"window.__dioJob({json.dumps(job)})")

    def _act(self, action: Action) -> None:
        session = self._client.session

        def toggle() -> None:
            if session.layout_run is not None:
                pause(session, not session.layout_run.is_paused)

        if action.do == "cancel":
            session.jobs.cancel()
        elif action.do == "pause":
            self._client.post(toggle)


def time_left(status: JobStatus, now: float) -> str:
    """In words, by what was done so far at `now` (s, monotonic); empty while nothing can be said."""
    spent = now - status.started_at
    if status.cancelling or not MIN_SHARE <= status.fraction < 1.0 or spent < MIN_S:
        return ""
    left = spent * (1.0 - status.fraction) / status.fraction
    if left < 60.0:
        return _("about {seconds} s left").format(seconds=max(5, round(left / 5) * 5))
    return _("about {minutes} min left").format(minutes=round(left / 60))
