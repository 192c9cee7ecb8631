"""Questions about a file that may mean several things: what it is, and the unit of its depth."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeVar

from diorama_app.panels.dialog import dialog
from diorama_app.panels.fields import on_press
from diorama_app.session.client import Client
from diorama_app.web.html import text
from diorama_core.perception.inputs.depth.units import UnknownUnitError
from diorama_core.perception.inputs.sorting import Recognised

Answer = TypeVar("Answer")


def ask_which(client: Client, name: str, found: Sequence[Recognised], then: Callable[[Recognised], None]) -> None:
    """Ask what a file is, and go on with the answer."""
    _ask(client, f"What is {name}?", "", [(what.words.capitalize(), what) for what in found], then)


def ask_unit(client: Client, unknown: UnknownUnitError, then: Callable[[float], None]) -> None:
    """Ask for the unit of a depth map, and go on with units per metre."""
    if not unknown.choices:
        raise unknown
    choices = [(words.capitalize(), scale) for scale, words in unknown.choices]
    _ask(client, "Which unit has the depth?", str(unknown).split(";", 1)[0], choices, then)


def _ask(
    client: Client, title: str, words: str, choices: Sequence[tuple[str, Answer]], then: Callable[[Answer], None]
) -> None:
    gui = client.viser_client.gui
    with dialog(client, title) as close:
        if words:
            gui.add_html(f"<p>{text(words)}.</p>")
        for label, answer in choices:
            on_press(gui.add_button(label), partial(client.post, partial(_answered, close, then, answer)))


def _answered(close: Callable[[], None], then: Callable[[Answer], None], answer: Answer) -> None:
    close()
    then(answer)
