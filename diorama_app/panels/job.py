"""The strip below the toolbar while something long is running: what, how far, and buttons to pause and stop it."""

from __future__ import annotations

import viser

from diorama_app.guest import Guest
from diorama_app.optimising import pause
from diorama_app.page import Action, LiveHtml, button, text


class JobStrip:
    """Progress with a message, a bar and cancel. The button is apart from what changes, so that it can be pressed."""

    def __init__(self, gui: viser.GuiApi, guest: Guest) -> None:
        self._guest = guest
        self._head = LiveHtml(gui, self._act)
        self._meter = LiveHtml(gui)

    def refresh(self) -> None:
        """Draw the running job; nothing when none runs."""
        room = self._guest.room
        status = room.jobs.status
        if status is None:
            self._head.show("")
            self._meter.show("")
            return
        buttons = button("Cancel", "cancel", disabled=status.cancelling, title="Stop and change nothing")
        run = room.layout_run
        if status.kind == "optimise" and run is not None and not status.cancelling:
            buttons = button("Go on" if run.paused else "Pause", "pause") + buttons
        self._head.show(f'<div class="job"><b class="words">{text(status.title)}</b>{buttons}</div>')
        self._meter.show(
            f'<div class="meter"><i style="width:{round(100 * status.fraction)}%"></i></div>'
            f'<p class="dim" style="margin-top:3px">{text(status.message)}</p>'
        )

    def _act(self, action: Action) -> None:
        room = self._guest.room

        def toggle() -> None:
            if room.layout_run is not None:
                pause(room, not room.layout_run.paused)

        if action.do == "cancel":
            room.jobs.cancel()
        elif action.do == "pause":
            self._guest.post(toggle)
