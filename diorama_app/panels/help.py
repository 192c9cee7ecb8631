"""The help dialog: mouse actions and all commands with their keys, from the table of commands."""

from __future__ import annotations

from collections.abc import Sequence

import viser

from diorama_app.commands.registry import Command, CommandTable
from diorama_app.panels.fields import on_press
from diorama_app.panels.messages import dialog
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_app.web.html import text

MOUSE = (
    (N_("Select"), N_("Click")),
    (N_("Select more"), N_("Shift-click")),
    (N_("Select in a rectangle"), N_("Shift-drag")),
    (N_("Move an object"), N_("Drag it")),
    (N_("Move, snapping inverted"), N_("Alt-drag")),
    (N_("Rotate the view"), N_("Drag background")),
    (N_("Pan the view"), N_("Right-drag")),
    (N_("All commands"), "Ctrl+K"),
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
    with dialog(client, _("Mouse and keyboard")) as close:
        mouse = "".join(f"<tr><td>{text(_(a))}</td><td><kbd>{text(_(b))}</kbd></td></tr>" for a, b in MOUSE)
        columns = {
            _("Mouse"): mouse,
            _("Objects"): _rows(objects),
            _("View"): _rows(view),
            _("Project"): _rows(project),
        }
        titled = "".join(
            f"<section><h4>{text(name)}</h4><table>{rows}</table></section>" for name, rows in columns.items()
        )
        rest = ", ".join(text(c.label) for c in commands.all if not c.keys)
        others = _("Commands without a key, in the command palette (Ctrl+K): {commands}.").format(commands=rest)
        on_press(gui.add_button(_("Close")), lambda: client.post(close))
        gui.add_html(f'<div class="dio dio-help">{titled}</div><div class="dio dim">{others}</div>')


def _rows(commands: Sequence[Command]) -> str:
    return "".join(
        f'<tr title="{text(c.hint)}"><td>{text(c.label)}</td><td><kbd>{text(c.keys)}</kbd></td></tr>'
        for c in commands
        if c.keys
    )
