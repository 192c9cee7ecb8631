"""The help dialog: mouse actions and all commands with their keys, from the table of commands."""

from __future__ import annotations

from collections.abc import Sequence

import viser

from diorama_app.commands.registry import Command, CommandTable
from diorama_app.panels.dialog import dialog
from diorama_app.panels.fields import on_press
from diorama_app.session.client import Client
from diorama_app.web.html import text

MOUSE = (
    ("Select", "Click"),
    ("Select more", "Shift-click"),
    ("Select in a rectangle", "Shift-drag"),
    ("Move an object", "Drag it"),
    ("Move, snapping inverted", "Alt-drag"),
    ("Rotate the view", "Drag beside it"),
    ("Pan the view", "Right-drag"),
    ("All commands", "Ctrl+K"),
)


VIEW = ("view_", "focus", "masks", "planes", "names", "badges", "theme")
PROJECT = ("undo", "redo", "save", "measure", "picture", "find_", "start_page", "projects", "tour", "help", "escape")
"""How the ids of the commands in these columns begin; the others are about objects."""


def show_help(client: Client, commands: CommandTable) -> None:
    """Open the list over the page."""
    gui: viser.GuiApi = client.viser_client.gui
    view = [c for c in commands.all if c.id.startswith(VIEW)]
    project = [c for c in commands.all if c.id.startswith(PROJECT)]
    objects = [c for c in commands.all if c not in view and c not in project]
    with dialog(client, "Mouse and keyboard") as close:
        mouse = "".join(f"<tr><td>{text(a)}</td><td><kbd>{text(b)}</kbd></td></tr>" for a, b in MOUSE)
        columns = {"Mouse": mouse, "Objects": _rows(objects), "View": _rows(view), "Project": _rows(project)}
        titled = "".join(f"<section><h4>{name}</h4><table>{rows}</table></section>" for name, rows in columns.items())
        rest = ", ".join(text(c.label) for c in commands.all if not c.keys)
        on_press(gui.add_button("Close"), lambda: client.post(close))
        gui.add_html(
            f'<div class="dio dio-help">{titled}</div>'
            f'<div class="dio dim">Without a key, in the command palette (Ctrl+K): {rest}.</div>'
        )


def _rows(commands: Sequence[Command]) -> str:
    return "".join(
        f'<tr title="{text(c.hint)}"><td>{text(c.label)}</td><td><kbd>{text(c.keys)}</kbd></td></tr>'
        for c in commands
        if c.keys
    )
