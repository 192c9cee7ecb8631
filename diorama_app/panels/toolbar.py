"""The rows of buttons above the outliner: undo, redo, views, handles, snapping."""

from __future__ import annotations

import viser

from diorama_app.commands import CommandTable
from diorama_app.guest import Guest
from diorama_app.page import STYLE, Action, LiveHtml, button, text

HALF_MOON = (
    '<svg width="13" height="13" viewBox="0 0 24 24" style="display:block;margin:2px auto" aria-label="Dark or light">'
    '<circle cx="12" cy="12" r="10" fill="none" stroke="currentColor" stroke-width="2.5"/>'
    '<path d="M12 2a10 10 0 0 1 0 20z" fill="currentColor"/></svg>'
)


class Toolbar:
    """Buttons that run commands by id."""

    def __init__(self, gui: viser.GuiApi, guest: Guest, commands: CommandTable) -> None:
        self._guest, self._commands = guest, commands
        gui.add_html(STYLE)
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the buttons as the history allows and the settings say."""
        room, settings = self._guest.room, self._guest.settings
        history = room.document.history
        undo = f"Undo: {history.current.label}" if history.can_undo else "Nothing to undo"
        self._html.show(
            '<div class="bar tight">'
            + self._button("undo", "&#8630; Undo", title=undo, disabled=not history.can_undo)
            + self._button("redo", "&#8631; Redo", disabled=not history.can_redo)
            + self._button("measure", on=self._guest.doing is not None)
            + self._button("theme", HALF_MOON)
            + self._button("help", "?")
            + "</div><div class='bar tight'>"
            + self._button("view_photo", "Photo view", disabled=room.scene.camera is None)
            + self._button("view_room", "Room")
            + self._button("view_top", "Top")
            + self._button("view_front", "Front")
            + self._button("view_left", "Side")
            + "</div><div class='bar tight'>"
            + self._button("gizmo_floor", on=settings.gizmo == "floor")
            + self._button("gizmo_free", on=settings.gizmo == "free")
            + self._button("gizmo_size", on=settings.gizmo == "size")
            + self._button("snap", on=settings.snap)
            + self._button("slide", on=settings.slide)
            + "</div><div class='bar tight'>"
            + self._button("names", on=settings.names)
            + self._button("badges", on=settings.badges)
            + self._button("masks", on=settings.masks, disabled=room.photo is None)
            + self._button("planes", on=settings.planes)
            + "</div>"
        )

    def _button(
        self, command_id: str, label: str = "", *, title: str = "", on: bool = False, disabled: bool = False
    ) -> str:
        command = self._commands[command_id]
        keys = f" ({command.keys})" if command.keys else ""
        return button(
            label or command.label,
            "run",
            command_id,
            title=(title + keys) if title else command.tooltip,
            on=on,
            disabled=disabled,
        )

    def _act(self, action: Action) -> None:
        run_command(self._guest, self._commands, action)


def run_command(guest: Guest, commands: CommandTable, action: Action) -> None:
    """Do what a button with the action "run" asks for."""
    if action.do == "run" and action.arg in commands:
        command = commands[action.arg]

        def run() -> None:
            command.run(guest)
            guest.refresh()

        guest.post(run)


def title_bar(guest: Guest) -> str:
    """Name of the project, how many things are in it, and who else is here."""
    room = guest.room
    name = text(room.project.name) if room.project is not None else "No project"
    others = [g for g in room.guests.values() if g is not guest]
    here = "".join(
        f' <span class="chip" style="border-color:rgb{g.colour}" title="also here">{text(g.name)}</span>'
        for g in others[:4]
    )
    return f"<b>{name}</b> <span class='dim'>{len(room.scene.objects)} objects</span>{here}"
