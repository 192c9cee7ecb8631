"""Messages over the page: toasts with an undo button, the prompt for a pending click, and dialogs, one at a time.

Such are questions about files that may mean several things: what they are, and how a depth map is to be read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import TypeVar

import viser

from diorama_app.panels.fields import on_press
from diorama_app.projects.dropped import Dropped, Reading
from diorama_app.session.client import Client, Measuring, Placing, Playing
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.perception.inputs.depth.scale import AmbiguousDepthError, DepthAnswer

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


Answer = TypeVar("Answer")


def ask_which(client: Client, name: str, dropped: Dropped, then: Callable[[Reading], None]) -> None:
    """Ask what was dropped, and go on with the answer.

    Args:
        client: the browser that asked.
        name: of what was dropped.
        dropped: what it may be.
        then: called with the answer.
    """
    choices = [(_capital(reading.words), reading) for reading in dropped.readings]
    _ask(client, _("What is {name}?").format(name=name), dropped.unread(), choices, then)


def ask_depth(client: Client, unknown: AmbiguousDepthError, then: Callable[[DepthAnswer], None]) -> None:
    """Ask how a depth map is to be read, and go on with the answer."""
    if not unknown.choices:
        raise unknown
    choices = [(_capital(answer.words), answer) for answer in unknown.choices]
    _ask(client, _("How should the depth be read?"), str(unknown).split(";", 1)[0], choices, then)


def _capital(words: str) -> str:
    return _(words)[:1].upper() + _(words)[1:]


def _ask(
    client: Client, title: str, words: str, choices: Sequence[tuple[str, Answer]], then: Callable[[Answer], None]
) -> None:
    gui = client.viser_client.gui
    with dialog(client, title) as close:
        if words:
            gui.add_html(f"<p>{text(_(words))}.</p>")
        for label, answer in choices:
            on_press(gui.add_button(label), partial(client.post, partial(_answer, close, then, answer)))


def _answer(close: Callable[[], None], then: Callable[[Answer], None], answer: Answer) -> None:
    close()
    then(answer)
