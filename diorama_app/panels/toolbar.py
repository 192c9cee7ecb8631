"""The buttons over the view: undo, redo, views, handles, snapping. They stay whatever the panels show."""

from __future__ import annotations

import viser

from diorama_app.commands.registry import CommandTable
from diorama_app.session.client import Client
from diorama_app.web.html import STYLE, Action, LiveHtml, button, text

HALF_MOON = (
    '<svg width="13" height="13" viewBox="0 0 24 24" style="display:block;margin:2px auto" aria-label="Dark or light">'
    '<circle cx="12" cy="12" r="10" fill="none" stroke="currentColor" stroke-width="2.5"/>'
    '<path d="M12 2a10 10 0 0 1 0 20z" fill="currentColor"/></svg>'
)

CAMERA = (
    '<svg width="15" height="13" viewBox="0 0 26 22" style="display:block;margin:2px auto" aria-label="Picture" '
    'fill="none" stroke="currentColor" stroke-width="2.4" stroke-linejoin="round">'
    '<path d="M2 6h5l2-4h8l2 4h5v14H2z"/><circle cx="13" cy="12.5" r="4.3"/></svg>'
)


class Toolbar:
    """Buttons that run commands by id."""

    def __init__(self, gui: viser.GuiApi, client: Client, commands: CommandTable) -> None:
        self._client, self._commands = client, commands
        gui.add_html(STYLE)
        self._html = LiveHtml(gui, self._act, floating="dio-toolbar")

    def refresh(self) -> None:
        """Draw the buttons as the history allows and the settings say."""
        session, preferences = self._client.session, self._client.preferences
        history = session.document.history
        undo = f"Undo: {history.current.label}" if history.can_undo else "Nothing to undo"
        self._html.show(
            '<div class="bars" role="toolbar" aria-label="Tools"><div class="bar">'
            + self._button("undo", "&#8630; Undo", title=undo, disabled=not history.can_undo)
            + self._button("redo", "&#8631; Redo", disabled=not history.can_redo)
            + self._button("measure", on=self._client.doing is not None)
            + self._button("picture", CAMERA)
            + self._button("theme", HALF_MOON)
            + self._button("help", "?")
            + "</div><div class='bar'>"
            + self._button("view_photo", "Photo view", disabled=session.scene.camera is None)
            + self._button("view_room", "Room")
            + self._button("view_top", "Top")
            + self._button("view_front", "Front")
            + self._button("view_left", "Side")
            + "</div><div class='bar'>"
            + self._button("gizmo_floor", on=preferences.gizmo == "floor")
            + self._button("gizmo_free", on=preferences.gizmo == "free")
            + self._button("gizmo_size", on=preferences.gizmo == "size")
            + self._button("snap", on=preferences.snap)
            + self._button("slide", on=preferences.slide)
            + "</div><div class='bar'>"
            + self._button("names", on=preferences.names)
            + self._button("badges", on=preferences.badges)
            + self._button("masks", on=preferences.masks, disabled=session.photo is None)
            + self._button("planes", on=preferences.planes)
            + "</div></div>"
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
        run_command(self._client, self._commands, action)


def run_command(client: Client, commands: CommandTable, action: Action) -> None:
    """Do what a button with the action "run" asks for."""
    if action.do == "run" and action.arg in commands:
        command = commands[action.arg]

        def run() -> None:
            command.run(client)
            client.refresh()

        client.post(run)


def title_bar(client: Client) -> str:
    """Name of the project, number of objects, and the other connected clients."""
    session = client.session
    project = session.project
    name = "No project" if project is None else text(session.glances.of("name", lambda: project.name))
    others = [g for g in session.clients.values() if g is not client]
    here = "".join(
        f' <span class="chip" style="border-color:rgb{g.colour}" title="also has this open">{text(g.name)}</span>'
        for g in others[:4]
    )
    return f"<b>{name}</b> <span class='dim'>{len(session.scene.objects)} objects</span>{here}"
