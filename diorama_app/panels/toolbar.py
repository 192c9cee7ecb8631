"""The tools over the view: one row of the frequent ones, the others in a menu. They stay whatever the panels show."""

from __future__ import annotations

from functools import partial

import viser

from diorama_app.commands.registry import CommandTable
from diorama_app.panels.fields import PageScript
from diorama_app.session.client import Client, Measuring, Playing
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, text

ICONS = {
    "undo": '<path d="M9 5 4 10l5 5M4 10h10a6 6 0 0 1 0 12h-3"/>',
    "redo": '<path d="m15 5 5 5-5 5m5-5H10a6 6 0 0 0 0 12h3"/>',
    "measure": '<path d="m3 16 13-13 5 5L8 21zM8 11l2.5 2.5M12 7l2.5 2.5"/>',
    "picture": '<path d="M3 7h4l2-3h6l2 3h4v13H3z"/><circle cx="12" cy="13" r="4"/>',
    "more": '<path d="M5 12h.01M12 12h.01M19 12h.01" stroke-width="3"/>',
}

SPARE = (("gizmo_floor", "gizmo_free", "gizmo_size", "snap"), ("measure", "help"))
"""Tools that are in the menu instead where the view is narrow."""

MENU: dict[str, tuple[str, ...]] = {
    N_("View"): ("view_top", "view_front", "view_left", "view_right", "walk", "play", "focus"),
    N_("Show"): ("names", "badges", "masks", "planes"),
    N_("While moving"): ("slide",),
    N_("Page"): ("theme",),
}

SWITCHES = ("snap", "slide", "names", "badges", "masks", "planes")
"""Commands that switch the preference of the same name."""


class Toolbar:
    """Buttons that run commands by id."""

    def __init__(self, gui: viser.GuiApi, client: Client, commands: CommandTable) -> None:
        self._client, self._commands = client, commands
        self._html = LiveHtml(gui, self._act, floating="dio-toolbar")
        walk = PageScript(gui)
        client.start_walk = lambda floor: walk.run(f"window.__dioWalk.begin({floor.json});", again=True)

    def refresh(self) -> None:
        """Draw the buttons as the history allows and the settings say."""
        session = self._client.session
        undone = session.document.next_undo(partial(session.is_of, self._client))
        undo = _("Nothing to undo") if undone is None else _("Undo: {label}").format(label=undone.label)
        spare_handles, spare_tools = (
            "".join(self._tool(i, "?" if i == "help" else "", kind="spare ") for i in ids) for ids in SPARE
        )
        more = text(_("More tools"))
        self._html.show(
            f'<div class="bars" role="toolbar" aria-label="{text(_("Tools"))}"><div class="bar">'
            + self._tool("undo", title=undo)
            + self._tool("redo")
            + f'</div><div class="bar spare">{spare_handles}</div><div class="bar">'
            + self._tool("view_photo", _("Photo"))
            + self._tool("view_room", _("Room"))
            + self._tool("view_plan")
            + f'</div><div class="bar">{self._tool("picture")}{spare_tools}'
            + f'<button type="button" data-menu="1" aria-haspopup="true" aria-expanded="false" aria-label="{more}" '
            f'title="{more}">{_icon("more")}</button></div></div>{self._menu()}'
        )

    def _menu(self) -> str:
        moved = "".join(self._item(i) for ids in SPARE for i in ids)
        groups = "".join(f"<h4>{text(_(name))}</h4>{''.join(self._item(i) for i in ids)}" for name, ids in MENU.items())
        return f'<div class="menu"><div class="elsewhere"><h4>{text(_("Tools"))}</h4>{moved}</div>{groups}</div>'

    def _tool(self, command_id: str, label: str = "", *, title: str = "", kind: str = "") -> str:
        """A button of the row: an icon with a name for readers, or words."""
        command = self._commands[command_id]
        keys = f" ({command.keys})" if command.keys else ""
        words = label or command.label
        made = button(
            _icon(command_id) if command_id in ICONS else words,
            "run",
            command_id,
            title=(title + keys) if title else command.tooltip,
            on=self._is_on(command_id),
            disabled=not self._is_possible(command_id),
        )
        name = "" if words.isalpha() and command_id not in ICONS else f'aria-label="{text(command.label)}" '
        return made.replace("<button ", f"<button {name}", 1).replace('class="', f'class="{kind}', 1)

    def _item(self, command_id: str) -> str:
        """A line of the menu: a switch that leaves it open, or something that closes it."""
        command = self._commands[command_id]
        keys = f"<kbd>{text(command.keys)}</kbd>" if command.keys else ""
        made = button(
            f"<span>{text(command.label)}</span>{keys}",
            "run",
            command_id,
            title=command.tooltip,
            on=self._is_on(command_id),
            disabled=not self._is_possible(command_id),
        )
        switched = command_id in SWITCHES or command_id == "theme"
        state = f'aria-pressed="{str(self._is_on(command_id)).lower()}"' if switched else 'data-closes="1"'
        return made.replace("<button ", f'<button aria-label="{text(command.label)}" {state} ', 1)

    def _is_on(self, command_id: str) -> bool:
        preferences = self._client.preferences
        if command_id.startswith("gizmo_"):
            return preferences.gizmo == command_id.removeprefix("gizmo_")
        if command_id == "measure":
            return isinstance(self._client.doing, Measuring)
        if command_id == "play":
            return isinstance(self._client.doing, Playing)
        if command_id == "view_plan":
            return self._client.plan
        if command_id == "theme":
            return preferences.dark
        return command_id in SWITCHES and bool(getattr(preferences, command_id))

    def _is_possible(self, command_id: str) -> bool:
        session = self._client.session
        document, is_mine = session.document, partial(session.is_of, self._client)
        needed = {
            "undo": document.next_undo(is_mine) is not None,
            "redo": document.next_redo(is_mine) is not None,
            "view_photo": session.scene.camera is not None,
            "masks": session.photo is not None,
            "focus": bool(self._client.selection),
        }
        return needed.get(command_id, True)

    def _act(self, action: Action) -> None:
        run_command(self._client, self._commands, action)


def _icon(name: str) -> str:
    return f'<svg viewBox="0 0 24 24" aria-hidden="true">{ICONS[name]}</svg>'


def run_command(client: Client, commands: CommandTable, action: Action) -> None:
    """Do what a button with the action "run" asks for."""
    if action.do == "run" and action.arg in commands:
        command = commands[action.arg]

        def run() -> None:
            command.run(client)
            client.refresh()

        client.post(run)


def title_bar(client: Client) -> str:
    """Name of the project and the other connected clients."""
    session = client.session
    project = session.project
    name = text(_("No project")) if project is None else text(session.glances.get("name", lambda: project.name))
    others = [g for g in session.clients.values() if g is not client]
    here = "".join(
        f' <span class="chip" style="border-color:rgb{g.colour}" '
        f'title="{text(_("also has this project open"))}">{text(g.name)}</span>'
        for g in others[:4]
    )
    return f"<b>{name}</b>{here}"
