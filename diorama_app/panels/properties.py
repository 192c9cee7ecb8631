"""The selected object: name, place, turn, size, what it stands on."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import viser

from diorama_app import editing
from diorama_app.commands import CommandTable
from diorama_app.page import Action, LiveHtml, button, text
from diorama_app.panels.fields import on_change, show_if, show_value
from diorama_app.room import Room
from diorama_core.scene.types import SceneObject

SIZE_ORDER = [1, 0, 2]
"""People say width, depth, height; the object's axes are depth, width, height."""


class Properties:
    """Fields of the object selected last."""

    def __init__(self, gui: viser.GuiApi, room: Room, commands: CommandTable) -> None:
        self._room, self._commands = room, commands
        self._header = LiveHtml(gui, self._act)
        self._name = gui.add_text("Name", "", visible=False)
        self._place = gui.add_vector3(
            "Place (m)", (0.0, 0.0, 0.0), step=0.01, visible=False, hint="Middle of its underside: x, y, height"
        )
        self._yaw = gui.add_number(
            "Turn (°)", 0.0, step=1.0, visible=False, hint="Heading of its front about the vertical"
        )
        self._size = gui.add_vector3("Size (m)", (1.0, 1.0, 1.0), step=0.01, visible=False, hint="Width, depth, height")
        on_change(
            self._name, lambda value, client: self._with(client, lambda i: editing.rename(room, i, value), "name")
        )
        on_change(
            self._place,
            lambda value, client: self._with(
                client, lambda i: editing.set_base_position(room, i, np.array(value)), "place"
            ),
        )
        on_change(self._yaw, lambda value, client: self._with(client, lambda i: editing.set_yaw(room, i, value), "yaw"))
        on_change(
            self._size,
            lambda value, client: self._with(
                client, lambda i: editing.set_size(room, i, np.array(value)[SIZE_ORDER]), "size"
            ),
        )

    def refresh(self) -> None:
        """Show the selected object, or what to do when there is none."""
        item = self._room.document.selected
        show_if(item is not None, self._name, self._place, self._yaw, self._size)
        self._header.show(self._advice() if item is None else self._card(item))
        if item is None:
            return
        show_value(self._name, item.label)
        show_value(self._place, tuple(round(float(v), 3) for v in editing.base_position(item)))
        show_value(self._yaw, round(float(np.degrees(item.pose.yaw_rad)), 1))
        show_value(self._size, tuple(round(float(v), 3) for v in item.size_m[SIZE_ORDER]))

    def _with(self, client_id: int, act: Callable[[str], None], field: str) -> None:
        """Do something to the object selected now, dropping keystrokes that a newer one of the field overtook."""
        chosen = self._room.document.selection[-1:]
        if chosen:
            self._room.post(client_id, lambda: act(chosen[0]), key=f"{field} {chosen[0]}")

    def _advice(self) -> str:
        if not self._room.scene.objects:
            return '<div class="card">The room is empty. Insert furniture from the <b>Library</b> tab.</div>'
        return (
            '<div class="card"><b>Click an object</b> in the view or in the list to move it, swap it or '
            "change its size.<br><span class='dim'>Shift-click selects several; Esc clears.</span></div>"
        )

    def _card(self, item: SceneObject) -> str:
        several = len(self._room.document.selection)
        more = f' <span class="dim">and {several - 1} more</span>' if several > 1 else ""
        evidence = f" · {100 * item.confidence:.0f}% sure" if item.box_px is not None else ""
        return (
            f"<p><b>{text(item.label)}</b>{more}<br><span class='dim'>{text(item.category)}{evidence}"
            f"{' · locked' if item.locked else ''}{' · hidden' if item.hidden else ''}</span></p>"
            '<div class="bar">'
            + self._command("focus", "Focus")
            + self._command("duplicate", "Duplicate")
            + self._command("delete", "Delete")
            + "</div>"
        )

    def _command(self, command_id: str, label: str) -> str:
        return button(label, "run", command_id, title=self._commands[command_id].tooltip)

    def _act(self, action: Action) -> None:
        if action.do == "run" and action.arg in self._commands:
            self._room.post(action.client_id, lambda: self._commands[action.arg].run(action.client_id))
