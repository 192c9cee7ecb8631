"""The selected object: its name, what was found, and what is most often done with it; what to do when there is none."""

from __future__ import annotations

import viser

from diorama_app.commands.registry import CommandTable
from diorama_app.panels.toolbar import run_command
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_app.web.html import LiveHtml, button, text
from diorama_core.scene.types import SceneObject

ALIGN = {
    "align_left": N_("Left"),
    "align_centre": N_("Middle"),
    "align_right": N_("Right"),
    "align_back": N_("Far"),
    "align_depth": N_("Centre"),
    "align_front": N_("Near"),
}

DO_WITH_IT = {
    "focus": N_("Focus"),
    "duplicate": N_("Duplicate"),
    "mirror": N_("Mirror"),
    "drop": N_("Drop"),
    "lock": N_("Lock"),
    "delete": N_("Delete"),
}

UNFINISHED = N_(
    "There is no room yet. Mark the furniture in the photo, then press <b>Build scene</b> in the <b>Photo</b> tab."
)
NONE_SELECTED = N_("<b>Click an object</b> in the view or in the list, or <b>drag it</b> to where it should be.")
MORE_WAYS = N_(
    "Shift-click selects several objects, Shift-drag selects in a rectangle, Esc clears the selection. "
    "Click a wall, the floor or the ceiling to paint or cover it."
)


class ObjectCard:
    """At the head of the panel."""

    def __init__(self, gui: viser.GuiApi, client: Client, commands: CommandTable) -> None:
        self._client, self._commands = client, commands
        self._html = LiveHtml(gui, lambda action: run_command(client, commands, action))

    def refresh(self) -> None:
        """Show the selected object, or what to do when there is none."""
        item = self._client.last_selected
        empty = "" if self._client.surface is not None else self._advice()
        self._html.show(empty if item is None else self._card(item))

    def _advice(self) -> str:
        if self._client.session.is_unbuilt:
            return f'<div class="card">{_(UNFINISHED)}</div>'
        if not self._client.session.scene.objects:
            return f'<div class="card">{_("The room is empty. Insert furniture from the <b>Library</b> tab.")}</div>'
        return f"<div class='card'>{_(NONE_SELECTED)}<br><span class='dim'>{_(MORE_WAYS)}</span></div>"

    def _card(self, item: SceneObject) -> str:
        several = len(self._client.selection)
        more = (
            f' <span class="dim">{text(_("and {count} more").format(count=several - 1))}</span>' if several > 1 else ""
        )
        about = [_(item.category)] if item.category != item.label else []
        if item.box_px is not None:
            about.append(_("{percent} % confidence").format(percent=round(100 * item.confidence)))
        about += [_("locked")] * item.locked + [_("hidden")] * item.hidden
        problems = "".join(
            f' <span class="chip bad">{text(_(w))}</span>' for w in self._client.session.badges.get(item.id, ())
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
        spread = self._command("distribute", N_("Distribute evenly")) if several > 2 else ""
        return f'<h4>{text(_("Align with {label}").format(label=item.label))}</h4><div class="three">{align}</div>' + (
            f'<div class="bar tight">{spread}</div>' if spread else ""
        )

    def _command(self, command_id: str, label: str) -> str:
        return button(_(label), "run", command_id, title=self._commands[command_id].tooltip)
