"""Questions about files that may mean several things: what they are, and how a depth map is to be read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeVar

from diorama_app.panels.fields import on_press
from diorama_app.panels.messages import dialog
from diorama_app.projects.dropped import Dropped, Reading
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.web.html import text
from diorama_core.perception.inputs.depth.scale import AmbiguousDepthError, DepthAnswer

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
