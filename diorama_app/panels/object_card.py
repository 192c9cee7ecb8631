"""The selected object: its name, what was found, and what is most often done with it; what to do when there is none."""

from __future__ import annotations

import viser

from diorama_app.commands.registry import CommandTable
from diorama_app.panels.toolbar import run_command
from diorama_app.session.client import Client
from diorama_app.web.html import LiveHtml, button, text
from diorama_core.scene.types import SceneObject

ALIGN = {
    "align_left": "Left",
    "align_centre": "Middle",
    "align_right": "Right",
    "align_back": "Far",
    "align_depth": "Centre",
    "align_front": "Near",
}

DO_WITH_IT = {
    "focus": "Focus",
    "duplicate": "Duplicate",
    "mirror": "Mirror",
    "drop": "Drop",
    "lock": "Lock",
    "delete": "Delete",
}


class ObjectCard:
    """At the head of the panel."""

    def __init__(self, gui: viser.GuiApi, client: Client, commands: CommandTable) -> None:
        self._client, self._commands = client, commands
        self._html = LiveHtml(gui, lambda action: run_command(client, commands, action))

    def refresh(self) -> None:
        """Show the selected object, or what to do when there is none."""
        item = self._client.selected
        empty = "" if self._client.surface is not None else self._advice()
        self._html.show(empty if item is None else self._card(item))

    def _advice(self) -> str:
        if self._client.session.unfinished:
            return (
                '<div class="card">There is no room yet. Mark the furniture in the photo, then <b>Build scene</b> in '
                "the <b>Photo</b> tab.</div>"
            )
        if not self._client.session.scene.objects:
            return '<div class="card">The room is empty. Insert furniture from the <b>Library</b> tab.</div>'
        return (
            '<div class="card"><b>Click an object</b> in the view or in the list, or <b>drag it</b> to where it should '
            "be.<br><span class='dim'>Shift-click selects several, Shift-drag selects by rectangle, Esc clears. "
            "Click a wall, the floor or the ceiling to paint or cover it.</span>"
            "</div>"
        )

    def _card(self, item: SceneObject) -> str:
        several = len(self._client.selection)
        more = f' <span class="dim">and {several - 1} more</span>' if several > 1 else ""
        about = [item.category] if item.category != item.label else []
        if item.box_px is not None:
            about.append(f"{100 * item.confidence:.0f} % confidence")
        about += ["locked"] * item.locked + ["hidden"] * item.hidden
        problems = "".join(
            f' <span class="chip bad">{text(w)}</span>' for w in self._client.session.badges.get(item.id, ())
        )
        return (
            f"<p><b>{text(item.label)}</b>{more}{problems}<br><span class='dim'>{text(' · '.join(about))}</span></p>"
            '<div class="three">'
            + "".join(self._command(command, label) for command, label in DO_WITH_IT.items())
            + "</div>"
            + (self._together(item, several) if several > 1 else "")
        )

    def _together(self, item: SceneObject, several: int) -> str:
        align = "".join(self._command(c, label) for c, label in ALIGN.items())
        spread = self._command("distribute", "Distribute evenly") if several > 2 else ""
        return f'<h4>Align with {text(item.label)}</h4><div class="three">{align}</div>' + (
            f'<div class="bar tight">{spread}</div>' if spread else ""
        )

    def _command(self, command_id: str, label: str) -> str:
        return button(label, "run", command_id, title=self._commands[command_id].tooltip)
