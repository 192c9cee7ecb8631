"""The tree of what stands on what; a click selects, the two small buttons lock and hide."""

from __future__ import annotations

import zlib

import viser

from diorama_app import editing
from diorama_app.page import Action, LiveHtml, text
from diorama_app.panels.toolbar import title_bar
from diorama_app.room import Room
from diorama_core.scene.types import Plane, Scene, SceneObject

EYE = (
    '<svg width="15" height="15" viewBox="0 0 24 24" fill="none" stroke="currentColor" stroke-width="2">'
    '<path d="M2 12s4-7 10-7 10 7 10 7-4 7-10 7-10-7-10-7z"/><circle cx="12" cy="12" r="3"/>%s</svg>'
)
LOCK = (
    '<svg width="15" height="15" viewBox="0 0 24 24" fill="none" stroke="currentColor" stroke-width="2">'
    '<rect x="5" y="11" width="14" height="9" rx="2"/><path d="%s"/></svg>'
)
STRUCK = '<path d="M4 4l16 16"/>'
CLOSED, OPEN = "M8 11V8a4 4 0 0 1 8 0v3", "M8 11V8a4 4 0 0 1 7.5-2"


class Outliner:
    """Planes and objects, nested by support edges."""

    def __init__(self, gui: viser.GuiApi, room: Room) -> None:
        self._room = room
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the tree of the current scene."""
        self._html.show(f"<p>{title_bar(self._room)}</p>" + _tree(self._room.scene, self._room.document.selection))

    def _act(self, action: Action) -> None:
        room = self._room

        def do() -> None:
            if not room.scene.has_object(action.arg):
                return
            item = room.scene.object(action.arg)
            if action.do == "select" and action.add:
                room.toggle(item.id)
            elif action.do == "select":
                room.select((item.id,))
            elif action.do == "lock":
                editing.set_locked(room, item.id, not item.locked)
            elif action.do == "hide":
                editing.set_hidden(room, item.id, not item.hidden)

        room.post(action.client_id, do)


def plane_name(scene: Scene, plane: Plane) -> str:
    """What people call a plane: walls are numbered."""
    same = scene.architecture.by_role(plane.role)
    number = f" {[p.id for p in same].index(plane.id) + 1}" if len(same) > 1 else ""
    return plane.role.capitalize() + number


def _tree(scene: Scene, selection: tuple[str, ...]) -> str:
    if not scene.objects and not scene.architecture.planes:
        return '<div class="card">Nothing here yet. Upload a photo of a room in the <b>Photo</b> panel.</div>'
    parts = []
    for plane in scene.architecture.planes:
        children = scene.children_of(plane.id)
        if children or plane.role == "floor":
            parts.append(_plane_row(scene, plane) + _children(scene, children, selection))
    loose = [o.id for o in scene.objects if scene.support_of(o.id) is None]
    if loose:
        parts.append('<div class="row" style="cursor:default"><span class="dim name">Held up by nothing</span></div>')
        parts.append(_children(scene, tuple(loose), selection))
    if not scene.objects:
        parts.append('<p class="dim">No furniture yet. Insert some from the <b>Library</b>.</p>')
    return "".join(parts)


def _children(scene: Scene, ids: tuple[str, ...], selection: tuple[str, ...]) -> str:
    rows = []
    for object_id in ids:
        item = scene.object(object_id)
        rows.append(_row(item, item.id in selection) + _children(scene, scene.children_of(object_id), selection))
    return f'<div class="tree">{"".join(rows)}</div>' if rows else ""


def _plane_row(scene: Scene, plane: Plane) -> str:
    name = text(plane_name(scene, plane))
    return f'<div class="row" style="cursor:default"><span class="name dim">{name}</span></div>'


def _row(item: SceneObject, selected: bool) -> str:
    hue = zlib.crc32(item.category.encode()) % 360
    key = text(item.id)
    return (
        f'<div class="row {"on" if selected else ""} {"off" if item.hidden else ""}" data-do="select" data-arg="{key}">'
        f'<span class="dot" style="background:hsl({hue} 45% 58%)"></span>'
        f'<span class="name" title="{text(item.label)}">{text(item.label)}</span>'
        + _tool("lock", key, LOCK % (CLOSED if item.locked else OPEN), "Unlock" if item.locked else "Lock", item.locked)
        + _tool("hide", key, EYE % (STRUCK if item.hidden else ""), "Show" if item.hidden else "Hide", item.hidden)
        + "</div>"
    )


def _tool(do: str, key: str, icon: str, title: str, on: bool) -> str:
    return (
        f'<button type="button" class="tool {"on" if on else ""}" data-do="{do}" data-arg="{key}" '
        f'title="{title}" aria-label="{title}">{icon}</button>'
    )
