"""Toast messages with an undo button, and the prompt for a pending click."""

from __future__ import annotations

import viser

from diorama_app.session.client import Client, Measuring, Placing
from diorama_app.web.html import Action, LiveHtml, button, text


class Toasts:
    """Shows the newest message for a few seconds; stays while the next click has a meaning of its own."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, self._act, floating="dio-said")
        self._doing = LiveHtml(gui, self._act, floating="dio-doing")
        client.toast = self.say

    def say(self, message: str, undo: bool) -> None:
        """Show a message, in place of the one before."""
        again = button("Undo", "undo") if undo else ""
        self._html.show(f'<div class="dio-toast"><span>{text(message)}</span>{again}</div>', again=True)

    def refresh(self) -> None:
        """Say what a click in the view does now."""
        doing = self._client.doing
        words = ""
        if isinstance(doing, Placing):
            words = "Click where to place it: the floor, a table or a wall"
        elif isinstance(doing, Measuring) and len(doing.points) < 2:
            words = ("Click the first point", "Click the second point")[len(doing.points)]
        stop = button("Esc", "stop", title="Stop")
        self._doing.show(
            f'<div class="dio-toast stay" style="bottom:64px"><span>{words}</span>{stop}</div>' if words else ""
        )

    def _act(self, action: Action) -> None:
        client = self._client

        def stop() -> None:
            client.doing = None
            client.view.show_measure((), "")
            client.refresh()

        if action.do == "undo":
            client.post(lambda: client.session.undo(client))
        elif action.do == "stop":
            client.post(stop)
