"""The room: its surfaces to choose from, its height and the offsets of its walls; mounted objects; the measured length,
and a field for the true length.
"""

from __future__ import annotations

import viser

from diorama_app.commands.edit import supporter_name
from diorama_app.commands.measure import length_m, rescale_measured, stop_measuring
from diorama_app.session.client import Client
from diorama_app.session.units import format_length, parse_length
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.scene.room_edits import ceiling_height, move_plane, set_ceiling_height


class RoomSize:
    """A folded list of lengths below the tree."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._folder = gui.add_folder(_("Room"), expand_by_default=False)
        with self._folder:
            self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the height of the room and a field for every wall."""
        scene, unit = self._client.session.scene, self._client.preferences.unit
        walls = scene.architecture.by_role("wall")
        height = ceiling_height(scene)
        self._folder.visible = height is not None
        if height is None:
            return
        rows = _row(_("Height"), "height", "", format_length(height, unit), _("Height of the room"))
        hint = _("Distance to move it outward; a negative one moves it inward")
        rows += "".join(_row(supporter_name(scene, w.id).capitalize(), "wall", w.id, "", hint) for w in walls)
        names = {p.id: text(supporter_name(scene, p.id).capitalize()) for p in scene.architecture.planes}
        hint = _("Paint, paper, tiles or boards")
        surfaces = "".join(
            button(name, "surface", i, title=hint, on=i == self._client.surface) for i, name in names.items()
        )
        self._html.show(
            f'<h4>{text(_("Surfaces"))}</h4><div class="bar tight">{surfaces}</div>'
            f"<h4>{text(_('Size'))}</h4><table>{rows}</table>"
        )

    def _act(self, action: Action) -> None:
        if action.do == "surface":
            self._client.post(lambda: self._choose(action.arg))
        else:
            self._client.post(lambda: self._do(action.do, *action.pair))

    def _choose(self, plane_id: str) -> None:
        self._client.select_surface(plane_id)
        self._client.open_tab("Object")

    def _do(self, what: str, plane_id: str, words: str) -> None:
        client = self._client
        if what not in ("height", "wall") or not words.strip():
            return
        length = parse_length(words, client.preferences.unit)
        shown = format_length(length, client.preferences.unit)
        if what == "height":
            label = _("room height {length}").format(length=shown)
            client.session.edit(label, lambda s: set_ceiling_height(s, length), by=client)
        elif client.session.scene.has_plane(plane_id):
            name = supporter_name(client.session.scene, plane_id)
            label = _("move {name} by {length}").format(name=name, length=shown)
            client.session.edit(label, lambda s: move_plane(s, plane_id, length), by=client)


def _row(name: str, do: str, arg: str, value: str, hint: str) -> str:
    empty = "" if value else f'placeholder="{text(_("move by…"))}"'
    return (
        f"<tr><td>{text(name)}</td><td><input data-change={do} data-arg='{text(arg)}' value='{text(value)}' {empty} "
        f"aria-label='{text(name)}' title='{text(hint)}' style='width:110px'></td></tr>"
    )


class Tape:
    """Shown while two points are marked."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the length, and ask for the true one."""
        length = length_m(self._client.doing)
        if length is None:
            self._html.show("")
            return
        shown = text(format_length(length, self._client.preferences.unit))
        self._html.show(
            f'<div class="card">{_("<b>{length}</b> between the two points.").format(length=shown)}'
            '<div style="display:flex;gap:4px;margin-top:6px;align-items:center">'
            f'<input data-change="true" placeholder="{text(_("true length, such as 2.4 m"))}" '
            f'aria-label="{text(_("True length"))}" '
            f'title="{text(_("Rescale the scene to this length"))}">{button(_("Done"), "done")}</div></div>'
        )

    def _act(self, action: Action) -> None:
        client = self._client

        def finish() -> None:
            stop_measuring(client)
            client.refresh()

        if action.do == "true" and action.pair[1].strip():
            words = action.pair[1]
            client.post(lambda: rescale_measured(client, parse_length(words, client.preferences.unit)))
        elif action.do == "done":
            client.post(finish)
