"""The rooms of a home: which are seen, what they are called, and another project's room that joins at a door."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import viser

from diorama_app.panels.fields import options_html
from diorama_app.projects import manage
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import DOOR
from diorama_core.library.user_library import ProjectShapes
from diorama_core.project.storage import Project
from diorama_core.scene.edits import set_room
from diorama_core.scene.types import Scene

PICTURE_PX = 190
"""Longer side of the plan of a project that joins."""


class HomePanel:
    """A folded list of rooms below the tree; there where a scene has rooms, or a door at which one may join."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._joining: Path | None = None
        self._door = ""
        """Id of the chosen door of the project that joins."""
        self._folder = gui.add_folder(_("Home"), expand_by_default=False)
        with self._folder:
            self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)))

    def refresh(self) -> None:
        """Draw the rooms, and what is chosen to join."""
        client, scene = self._client, self._client.session.scene
        client.rooms &= {r.id for r in scene.rooms}
        self._folder.visible = bool(scene.rooms) or any(o.category == DOOR for o in scene.objects)
        if self._folder.visible:
            self._html.show(self._rooms(scene) + self._join(scene))

    def _rooms(self, scene: Scene) -> str:
        if not scene.rooms:
            return ""
        shown, storeys = self._client.rooms, sorted({r.storey for r in scene.rooms})
        bar = button(text(_("Whole home")), "show", on=not shown)
        for number in storeys if len(storeys) > 1 else ():
            ids = {r.id for r in scene.rooms if r.storey == number}
            bar += button(text(_("Storey {number}").format(number=number)), "storey", number, on=shown == ids)
        rows = "".join(
            f"<tr><td>{button(text(r.name), 'show', r.id, title=_('Show this room alone'), on=shown == {r.id})}</td>"
            f"<td>{_area_m2(scene, r.floor):.1f} m²</td><td><input data-change='name' data-arg='{text(r.id)}' "
            f"value='{text(r.name)}' aria-label='{text(_('Name of {name}').format(name=r.name))}'></td></tr>"
            for r in scene.rooms
        )
        return f'<div class="bar tight">{bar}</div><table>{rows}</table>'

    def _join(self, scene: Scene) -> str:
        """The choice of a project, its plan to choose a door from, and the button that joins it at the selected one."""
        session = self._client.session
        here = None if session.project is None else session.project.folder
        others = [f for f in manage.recent_projects(session.projects_dir) if f != here and (f / "scene.json").exists()]
        title = _("Join another project")
        offered = [("", title), *((manage.address_of(f), manage.name_of(f)) for f in others)]
        chosen = "" if self._joining is None else manage.address_of(self._joining)
        options = options_html(offered, chosen)
        made = f'<select data-change="project" aria-label="{text(title)}">{options}</select>'
        if self._joining not in others:
            return made
        other = Project.open(self._joining).load_scene()
        selected = self._client.last_selected
        is_door = selected is not None and selected.category == DOOR
        hint = _("Click the door in the plan, then the same door in the room")
        join = button(text(_("Join here")), "join", disabled=not (self._door and is_door))
        return f"{made}<p>{text(hint)}</p>{_plan(other, self._door)}<div class='bar'>{join}</div>"

    def _do(self, action: Action) -> None:
        client, session = self._client, self._client.session
        rooms = session.scene.rooms
        match action.do:
            case "show":
                client.rooms = frozenset(r.id for r in rooms if r.id == action.arg)
            case "storey":
                client.rooms = frozenset(r.id for r in rooms if str(r.storey) == action.arg)
            case "name":
                room, name = action.pair
                label = _("rename a room to {name}").format(name=name)
                session.edit(label, lambda s: set_room(s, room, name=name), by=client)
            case "project":
                self._joining, self._door = manage.find_project(session.projects_dir, action.pair[1]), ""
            case "pick":
                self._door = action.arg
            case "join":
                self._join_here()
        client.refresh()

    def _join_here(self) -> None:
        from diorama_core.editing.homes import join_project

        client, session, door = self._client, self._client.session, self._client.need_selected()
        if session.project is None or self._joining is None:
            raise EditRefused(_("choose a project to join first"))
        other = Project.open(self._joining)
        made, pictures = join_project(session.project, session.scene, other, door, self._door)
        if isinstance(session.library, ProjectShapes):
            session.library.show(session.project.shapes_folder)
        session.add_textures(dict(pictures))
        session.edit(_("join {name}").format(name=other.name), lambda s: made.scene, by=client)
        self._joining, self._door = None, ""


def _area_m2(scene: Scene, floor: str) -> float:
    x, y = scene.plane(floor).polygon[:, :2].T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2)


def _plan(scene: Scene, chosen: str) -> str:
    """A project from above, its doors to be clicked."""
    from diorama_core.editing.footprints import footprint_of
    from diorama_core.export.plan import room_lines

    room = room_lines(scene.architecture.planes, [o for o in scene.objects if not o.hidden], scene)
    every = np.concatenate([*room.floors, *room.walls, np.zeros((0, 2))]) if room.floors or room.walls else np.eye(2)
    low, high = every.min(axis=0) - 0.3, every.max(axis=0) + 0.3
    scale = PICTURE_PX / float((high - low).max())

    def path(outline: np.ndarray) -> str:
        points = (outline - (low[0], high[1])) * (scale, -scale)
        return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points) + "Z"

    floors, walls = "".join(map(path, room.floors)), "".join(map(path, room.walls))
    doors = "".join(
        f'<path class="{"on" if o.id == chosen else ""}" data-do="pick" data-arg="{text(o.id)}" role="button" '
        f'tabindex="0" aria-label="{text(o.id)}" d="{path(_wider(footprint_of(o)))}"/>'
        for o in scene.objects
        if o.category == DOOR
    )
    width, height = (high - low) * scale
    return (
        f'<svg class="joins" width="{width:.0f}" height="{height:.0f}"><path d="{floors}"/>'
        f'<path class="wall" fill-rule="evenodd" d="{walls}"/>{doors}</svg>'
    )


def _wider(quad: np.ndarray) -> np.ndarray:
    """A door's footprint, thick enough for a finger."""
    sides = np.roll(quad, -1, axis=0) - quad
    thin = sides[int(np.linalg.norm(sides, axis=1).argmin())]
    away = thin / max(float(np.linalg.norm(thin)), 1e-6) * 0.15
    middle = quad.mean(axis=0)
    return quad + np.sign((quad - middle) @ away)[:, None] * away
