from __future__ import annotations

import asyncio
from types import SimpleNamespace

import pytest
import viser

from diorama_app.commands.registry import Command, CommandTable


@pytest.mark.parametrize(
    ("hotkey", "modifier", "keys"),
    [
        (None, None, ""),
        ("S", "cmd/ctrl", "Ctrl+S"),
        ("Z", "cmd/ctrl+shift", "Ctrl+Shift+Z"),
        ("escape", None, "Esc"),
        ("delete", None, "Del"),
        ("?", "shift", "?"),
    ],
)
def test_keys_are_written_as_people_write_them(hotkey, modifier, keys) -> None:
    command = Command("x", "Do it", lambda client: None, hotkey, modifier, "Does it")
    assert command.keys == keys
    assert command.tooltip == ("Does it" + (f" ({keys})" if keys else ""))
    assert Command("x", "Do it", lambda client: None).tooltip == "Do it"


class Palette(viser.GuiApi):
    """Remembers the commands that are put on it, and what listens to each."""

    def __init__(self) -> None:
        self.handlers: list = []

    def add_command(self, label, **options):
        def listen(handler):
            self.handlers.append((label, options, handler))

        return SimpleNamespace(on_trigger=listen)


def test_every_command_is_registered_and_asks_for_itself() -> None:
    asked, palette = [], Palette()
    table = CommandTable((Command("a", "A", lambda c: None, "A"), Command("b", "B", lambda c: None, hint="hint")))
    table.register(palette, lambda command, client: asked.append((command.id, client)))
    assert [(label, o["hotkey"], o["description"]) for label, o, _ in palette.handlers] == [
        ("A", "A", None),
        ("B", None, "hint"),
    ]
    for _, _, handler in palette.handlers:
        asyncio.run(handler(viser.CommandEvent(None, 7, handler)))
    assert asked == [("a", 7), ("b", 7)]
    assert "a" in table
    assert "c" not in table
    assert table["b"].label == "B"
    with pytest.raises(KeyError):
        table["c"]
