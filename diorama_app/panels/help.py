"""The help dialog: mouse actions and all commands with their keys, from the table of commands."""

from __future__ import annotations

import viser

from diorama_app.commands.registry import Command, CommandTable
from diorama_app.panels.dialog import dialog
from diorama_app.panels.fields import on_press
from diorama_app.session.client import Client
from diorama_app.web.html import STYLE, text

MOUSE = (
    ("Select", "Click"),
    ("Select more", "Shift-click"),
    ("Select in a rectangle", "Shift-drag"),
    ("Move an object", "Drag the object"),
    ("Move, snapping inverted", "Alt-drag"),
    ("Rotate the view", "Drag the background"),
    ("Pan the view", "Right-drag"),
    ("All commands", "Ctrl+K"),
)


def show_help(client: Client, commands: CommandTable) -> None:
    """Open the list over the page."""
    gui: viser.GuiApi = client.viser_client.gui
    with dialog(client, "Mouse and keyboard") as close:
        mouse = "".join(f"<tr><td>{text(a)}</td><td><kbd>{text(b)}</kbd></td></tr>" for a, b in MOUSE)
        keys = "".join(_row(c) for c in commands.all if c.keys)
        rest = ", ".join(text(c.label) for c in commands.all if not c.keys)
        on_press(gui.add_button("Close"), lambda: client.post(close))
        gui.add_html(
            f'{STYLE}<div class="dio" style="columns:2;column-gap:24px"><h4>Mouse</h4><table>{mouse}</table>'
            f"<h4>Keys</h4><table>{keys}</table></div>"
            f'<div class="dio dim">Without a key, in the command palette (Ctrl+K): {rest}.</div>'
        )


def _row(command: Command) -> str:
    return (
        f'<tr title="{text(command.hint)}"><td>{text(command.label)}</td><td><kbd>{text(command.keys)}</kbd></td></tr>'
    )
