"""The strip below the toolbar while something long is running: what, how far, and a button to stop it."""

from __future__ import annotations

import viser

from diorama_app.page import Action, LiveHtml, button, text
from diorama_app.room import Room


class JobStrip:
    """Progress with a message, a bar and cancel."""

    def __init__(self, gui: viser.GuiApi, room: Room) -> None:
        self._room = room
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the running job; nothing when none runs."""
        status = self._room.jobs.status
        if status is None:
            self._html.show("")
            return
        percent = round(100 * status.fraction)
        self._html.show(
            '<div class="card"><div class="job"><div class="words">'
            f"<b>{text(status.title)}</b><br><span class='dim'>{text(status.message)}</span></div>"
            + button("Cancel", "cancel", disabled=status.cancelling)
            + f'</div><div class="meter"><i style="width:{percent}%"></i></div></div>'
        )

    def _act(self, action: Action) -> None:
        if action.do == "cancel":
            self._room.jobs.cancel()
