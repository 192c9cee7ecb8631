"""The strip below the toolbar while something long is running: what, how far, and a button to stop it."""

from __future__ import annotations

import viser

from diorama_app.page import Action, LiveHtml, button, text
from diorama_app.room import Room


class JobStrip:
    """Progress with a message, a bar and cancel. The button is apart from what changes, so that it can be pressed."""

    def __init__(self, gui: viser.GuiApi, room: Room) -> None:
        self._room = room
        self._head = LiveHtml(gui, self._act)
        self._meter = LiveHtml(gui)

    def refresh(self) -> None:
        """Draw the running job; nothing when none runs."""
        status = self._room.jobs.status
        if status is None:
            self._head.show("")
            self._meter.show("")
            return
        cancel = button("Cancel", "cancel", disabled=status.cancelling)
        self._head.show(f'<div class="job"><b class="words">{text(status.title)}</b>{cancel}</div>')
        self._meter.show(
            f'<div class="meter"><i style="width:{round(100 * status.fraction)}%"></i></div>'
            f'<p class="dim" style="margin-top:3px">{text(status.message)}</p>'
        )

    def _act(self, action: Action) -> None:
        if action.do == "cancel":
            self._room.jobs.cancel()
