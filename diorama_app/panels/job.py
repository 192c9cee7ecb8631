"""The status of the running job below the toolbar: title, progress, pause and cancel."""

from __future__ import annotations

import viser

from diorama_app.commands.optimise import pause
from diorama_app.session.client import Client
from diorama_app.web.html import Action, LiveHtml, button, text


class JobStrip:
    """Progress with a message, a bar and cancel. The button is apart from what changes, so that it can be pressed."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._head = LiveHtml(gui, self._act)
        self._meter = LiveHtml(gui)

    def refresh(self) -> None:
        """Draw the running job; nothing when none runs."""
        session = self._client.session
        status = session.jobs.status
        if status is None:
            self._head.show("")
            self._meter.show("")
            return
        buttons = button("Cancel", "cancel", disabled=status.cancelling, title="Stop without changing anything")
        run = session.layout_run
        if status.kind == "optimise" and run is not None and not status.cancelling:
            buttons = button("Resume" if run.paused else "Pause", "pause") + buttons
        self._head.show(f'<div class="job"><b class="words">{text(status.title)}</b>{buttons}</div>')
        self._meter.show(
            f'<div class="meter"><i style="width:{round(100 * status.fraction)}%"></i></div>'
            f'<p class="dim" style="margin-top:3px">{text(status.message)}</p>'
        )

    def _act(self, action: Action) -> None:
        session = self._client.session

        def toggle() -> None:
            if session.layout_run is not None:
                pause(session, not session.layout_run.paused)

        if action.do == "cancel":
            session.jobs.cancel()
        elif action.do == "pause":
            self._client.post(toggle)
