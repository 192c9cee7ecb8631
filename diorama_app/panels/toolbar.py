"""The row of buttons above the outliner: undo, redo, views, gizmo modes."""

from __future__ import annotations

import viser

from diorama_app.commands import CommandTable
from diorama_app.gestures import Gestures
from diorama_app.page import STYLE, Action, LiveHtml, button, text
from diorama_app.room import Room


class Toolbar:
    """Buttons that run commands by id."""

    def __init__(self, gui: viser.GuiApi, room: Room, commands: CommandTable, gestures: Gestures) -> None:
        self._room, self._commands, self._gestures = room, commands, gestures
        gui.add_html(STYLE)
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the buttons as the history allows."""
        history = self._room.document.history
        undo = f"Undo: {history.current.label}" if history.can_undo else "Nothing to undo"
        self._html.show(
            '<div class="bar">'
            + self._button("undo", "&#8630; Undo", title=undo, disabled=not history.can_undo)
            + self._button("redo", "&#8631; Redo", disabled=not history.can_redo)
            + "</div><div class='bar'>"
            + self._button("view_photo", "Photo view", disabled=self._room.scene.camera is None)
            + self._button("view_room", "Room")
            + self._button("view_top", "Top")
            + "</div><div class='bar'>"
            + self._button("gizmo_floor", "Slide &amp; turn", on=self._gestures.mode == "floor")
            + self._button("gizmo_free", "Free", on=self._gestures.mode == "free")
            + "</div>"
        )

    def _button(self, command_id: str, label: str, *, title: str = "", on: bool = False, disabled: bool = False) -> str:
        command = self._commands[command_id]
        keys = f" ({command.keys})" if command.keys else ""
        return button(
            label, "run", command_id, title=(title + keys) if title else command.tooltip, on=on, disabled=disabled
        )

    def _act(self, action: Action) -> None:
        if action.do == "run" and action.arg in self._commands:
            command = self._commands[action.arg]

            def run() -> None:
                command.run(action.client_id)
                self.refresh()

            self._room.post(action.client_id, run)


def title_bar(room: Room) -> str:
    """Name of the project and how many things are in it."""
    name = text(room.project.name) if room.project is not None else "No project"
    return f"<b>{name}</b> <span class='dim'>{len(room.scene.objects)} objects</span>"
