"""What panels are made of: fields that show the document and write to it, without echoing their own updates, lists to
choose from, scripts, and buttons that take a file, shown or hidden behind something else that starts them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import viser

from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.web.html import run_once, text
from diorama_app.web.viser_adapter import component_uuid
from diorama_core.errors import InputError
from diorama_core.io.text import clean_text

QUIET_COLOUR = (84, 96, 114)
"""Colour of secondary buttons; viser's grey looks disabled."""
GO_COLOUR = (24, 108, 66)
"""Colour of buttons that begin something large; on viser's green the words are black."""


def on_change(handle: Any, act: Callable[[Any], None]) -> None:
    """Call `act(value)` from the event loop when the user changes a field; not when the program does."""

    async def change(event: Any) -> None:
        if event.client_id is not None:
            act(event.target.value)

    handle.on_update(change)


def on_press(handle: Any, act: Callable[[], None]) -> None:
    """Call `act()` from the event loop when the person presses a button."""

    async def press(event: Any) -> None:
        if event.client_id is not None:
            act()

    handle.on_click(press)


def show_value(handle: Any, value: Any) -> None:
    """Put a value into a field if it shows another."""
    if handle.value != value:
        handle.value = value


def enable(handle: Any, possible: bool) -> None:
    """Enable or disable fields."""
    if handle.disabled == possible:
        handle.disabled = not possible


def show_if(visible: bool, *handles: Any) -> None:
    """Show or hide fields, touching only those that differ."""
    for handle in handles:
        if handle.visible != visible:
            handle.visible = visible


def show_options(handle: Any, options: tuple[str, ...], value: str) -> None:
    """Offer these choices in a drop-down, with this one chosen."""
    if tuple(handle.options) != options:
        handle.options = options
    show_value(handle, value if value in options else options[0])


def unique_names(names: list[str]) -> list[str]:
    """The names, with later doubles numbered: 'chair', 'chair (2)'."""
    seen: dict[str, int] = {}
    result = []
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        result.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return result


def options_html(choices: Iterable[tuple[str, str]], chosen: str) -> str:
    """Options of a list, as value and name, with this one chosen."""
    return "".join(
        f'<option value="{text(value)}" {"selected" if value == chosen else ""}>{text(name)}</option>'
        for value, name in choices
    )


def read_number(words: str, refusal: str) -> float:
    """A number as people write it, with a comma or a sign of its unit.

    Raises:
        InputError: the refusal, which names the words.
    """
    try:
        return float(words.replace(",", ".").strip().rstrip("%°").strip())
    except ValueError as error:
        raise InputError(_(refusal).format(words=words[:20])) from error


class PageScript:
    """A script that the page runs where it differs from the one before."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._html = gui.add_html("")
        self._told = ""
        self._runs = 0

    def run(self, script: str, *, again: bool = False) -> None:
        """Run a script; one that ran last only with `again`."""
        if again:
            self._runs += 1
            script = f"{script} /* {self._runs} */"
        if script != self._told:
            self._told = script
            self._html.content = run_once(script)

    def forget(self) -> None:
        """Send the next script even if it is the one before."""
        self._told = ""


Take = Callable[[str, bytes], None]
"""Takes name and content of a file."""


class UploadField:
    """A button that opens the browser's file dialog and hands over what is chosen."""

    def __init__(self, gui: viser.GuiApi, client: Client, label: str, take: Take, **about: Any) -> None:
        """Put the button on the page.

        Args:
            gui: the panel.
            client: whose page it is; `take` is called in its queue.
            label: the button's words.
            take: takes the file.
            **about: further arguments of viser's `add_upload_button`: `mime_type`, `hint`, `color`.
        """
        self.handle = gui.add_upload_button(label, **about)
        self.uuid = component_uuid(self.handle)
        """The page's input is the element `file_upload_<uuid>`."""
        # viser's page draws these buttons even where their `visible` is False.
        self._hidden = gui.add_html(
            f"<style>div:has(> #file_upload_{text(self.uuid)}) {{ display: none; }}</style>", visible=False
        )

        async def upload(event: viser.GuiEvent[viser.GuiUploadButtonHandle]) -> None:
            file = event.target.value
            client.post(lambda: take(clean_text(file.name), file.content))

        self.handle.on_upload(upload)

    def show_if(self, visible: bool) -> None:
        """Show or hide the button."""
        show_if(not visible, self._hidden)

    @property
    def visible(self) -> bool:
        """Whether the page shows the button."""
        return not self._hidden.visible


def add_hidden_upload(gui: viser.GuiApi, client: Client, label: str, take: Take, **about: Any) -> str:
    """Add an upload button that the page does not show, for what is dropped or chosen elsewhere; gives its id.

    Args:
        gui: of the page.
        client: the browser that asked.
        label: for those who do not see the page.
        take: called with the files.
    """
    field = UploadField(gui, client, label, take, **about)
    field.show_if(False)
    return field.uuid
