"""One table of commands feeds hotkeys, the Ctrl+K palette, buttons, tooltips and the list of shortcuts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import viser

from diorama_app.session.client import Client
from diorama_app.strings import _

Run = Callable[[Client], object]


@dataclass(frozen=True)
class Command:
    """An action that the user can invoke."""

    id: str
    label: str
    run: Run
    """Called on the UI thread with the client that invoked it."""
    hotkey: str | None = None
    modifier: str | None = None
    hint: str = ""

    @property
    def keys(self) -> str:
        """The hotkey in readable form."""
        if self.hotkey is None:
            return ""
        if self.hotkey == "?":
            return "?"
        named = {"escape": "Esc", "delete": "Del", "backspace": "Backspace", "space": "Space"}
        parts = {"cmd/ctrl": "Ctrl", "shift": "Shift", "alt": "Alt"}
        before = [parts[p] for p in self.modifier.split("+")] if self.modifier else []
        return "+".join([*before, named.get(self.hotkey, self.hotkey)])

    @property
    def tooltip(self) -> str:
        """What it does and how to reach it by key."""
        return (self.hint or self.label) + (f" ({self.keys})" if self.keys else "")


class CommandTable:
    """The commands by id, registered once with the page."""

    def __init__(self, commands: tuple[Command, ...]) -> None:
        commands = tuple(replace(c, label=_(c.label), hint=_(c.hint)) for c in commands)
        self.all = commands
        self._by_id = {c.id: c for c in commands}

    def __getitem__(self, command_id: str) -> Command:
        return self._by_id[command_id]

    def __contains__(self, command_id: str) -> bool:
        return command_id in self._by_id

    def register(self, gui: viser.GuiApi, ask: Callable[[Command, int | None], None]) -> None:
        """Put every command on the palette and listen to its hotkey; `ask` is called from viser's event loop."""
        for command in self.all:
            handle = gui.add_command(
                command.label,
                description=command.hint or None,
                hotkey=command.hotkey,
                modifier=command.modifier,
            )
            handle.on_trigger(_asker(command, ask))


def _asker(command: Command, ask: Callable[[Command, int | None], None]) -> Any:
    async def run(event: viser.CommandEvent) -> None:
        ask(command, event.client_id)

    return run
