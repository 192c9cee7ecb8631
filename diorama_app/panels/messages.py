"""Messages over the page: toasts with an undo button, the prompt for a pending click, and dialogs, one at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import viser

from diorama_app.session.client import Client, Measuring, Placing, Playing
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, button, text

SHOWN_S = 30.0
"""A page fades a message 6 or 15 s after it has drawn it (`.dio-toast` in `static/panels.css`). The server ends it
later: a slow page that still loads draws it late, and would never show what ended before."""


class Toasts:
    """Shows the newest message for a few seconds; stays while the next click has a meaning of its own."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, self._act, floating="dio-said")
        self._doing = LiveHtml(gui, self._act, floating="dio-doing")
        self._offered: Callable[[], None] | None = None
        self._said = 0
        """Number of messages that were shown."""
        client.toast, client.offer = self.say, self.offer

    def say(self, message: str, undo: bool) -> None:
        """Show a message, in place of the one before."""
        again = button(_("Undo"), "undo") if undo else ""
        self._show(f'<div class="dio-toast"><span>{text(_(message))}</span>{again}</div>')

    def offer(self, message: str, label: str, do: Callable[[], None]) -> None:
        """Show a message with a button that does something; it stays longer than others."""
        self._offered = do
        self._client.to_say = None  # the line of the step itself comes later, and would take the offer's place
        action = button(text(label), "offered")
        line = f'<div class="dio-toast long" role="alert"><span>{text(_(message))}</span>{action}</div>'
        self._show(line)

    def _show(self, line: str) -> None:
        """Show a line for some seconds; a page that is drawn anew later does not show it again."""
        self._said = number = self._said + 1
        self._html.show(line, again=True)

        def end() -> None:
            if number == self._said:
                self._html.show("")

        client = self._client
        client.session.ui_thread.post(end, client_id=client.id, after_s=SHOWN_S, awaited=False)

    def refresh(self) -> None:
        """Say what a click in the view does now."""
        doing = self._client.doing
        words = ""
        if isinstance(doing, Placing):
            words = _("Click where to place it: the floor, a table or a wall")
        elif isinstance(doing, Measuring) and len(doing.points) < 2:
            words = (_("Click the first point"), _("Click the second point"))[len(doing.points)]
        elif isinstance(doing, Playing):
            words = _("Click an object to push it")
        stop = button("Esc", "stop", title=_("Stop"))
        above = "bottom:calc(var(--dio-below, 0px) + 112px)"
        line = f'<div class="dio-toast stay" style="{above}"><span>{text(words)}</span>{stop}</div>'
        self._doing.show(line if words else "")

    def _act(self, action: Action) -> None:
        client = self._client

        def stop() -> None:
            if isinstance(client.doing, Playing):
                client.doing.end()
            client.doing = None
            client.view.show_measure((), "")
            client.refresh()

        def act() -> None:
            do, self._offered = self._offered, None
            self._html.show("")
            if do is not None:
                do()

        if action.do == "offered":
            client.post(act)
        elif action.do == "undo":
            client.post(lambda: client.session.undo(client))
        elif action.do == "stop":
            client.post(stop)


@contextmanager
def dialog(client: Client, title: str) -> Iterator[Callable[[], None]]:
    """What is made inside the block is in a dialog, in place of one that is open; gives what closes it."""
    client.close_dialog()

    def close() -> None:
        client.dialog = None
        modal.close()

    with client.viser_client.gui.add_modal(title) as modal:
        client.dialog = close
        yield close
