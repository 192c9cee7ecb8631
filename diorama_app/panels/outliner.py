"""The support tree: a click selects, a drag changes the support, buttons lock and hide."""

from __future__ import annotations

import json
import time
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import viser

from diorama_app.commands import edit as editing
from diorama_app.panels.toolbar import title_bar
from diorama_app.session.client import Client
from diorama_app.strings import _, plural
from diorama_app.viewport.decorations import is_unsure
from diorama_app.web.html import Action, LiveHtml, button, run_once, text
from diorama_core.editing.support_changes import why_not_on
from diorama_core.errors import EditRefused
from diorama_core.library.taxonomy import resolve
from diorama_core.scene.support import descendants
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

LONGEST_DRAG_S = 15.0
"""The list is drawn again after this long, in case a browser left in the middle of a drag."""

_MARK = """
const takers = %s;
for (const row of document.querySelectorAll('.dio [role=tree] .row')) {
  row.classList.toggle('takes', takers.includes(row.dataset.drop));
}
"""

Cursors = Sequence[tuple[str, tuple[int, int, int], tuple[str, ...]]]


@dataclass(frozen=True)
class _Tree:
    """Everything a row may show."""

    scene: Scene
    selection: tuple[str, ...]
    badges: Mapping[str, tuple[str, ...]]
    others: Cursors = ()

    @cached_property
    def entry(self) -> str:
        """The row that the tab key reaches; arrows go on from there."""
        return next(iter((*self.selection[-1:], *(o.id for o in self.scene.objects))), "")


class Outliner:
    """Planes and objects, nested by support edges."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)))
        self._takers = gui.add_html("")
        self._paused_until = 0.0

    def refresh(self) -> None:
        """Draw the tree of the current scene, except while a row is dragged, since a redraw ends the drag."""
        if time.monotonic() < self._paused_until:
            return
        client, session = self._client, self._client.session
        others = [(g.name, g.colour, g.selection) for g in session.clients.values() if g is not client]
        self._html.show(
            f"<p>{title_bar(client)}</p>" + tree_html(session.scene, client.selection, session.badges, others)
        )

    def _mark(self, ids: Sequence[str]) -> None:
        """Mark rows as places to drop onto; without drawing the tree anew, which would end the drag."""
        self._takers.content = run_once(_MARK % json.dumps(list(ids)))

    def _do(self, action: Action) -> None:
        client, scene = self._client, self._client.session.scene
        if action.do == "grab":
            self._paused_until = time.monotonic() + LONGEST_DRAG_S
            self._mark(takers(scene, action.arg) if scene.has_object(action.arg) else ())
            return
        if action.do in ("drop", "release"):
            self._paused_until = 0.0
            self._mark(())
        if action.do == "release":
            self.refresh()
            return
        if action.do == "drop":
            child, parent = action.pair
            if not scene.has_object(child):
                raise EditRefused("drag a row of the list onto another")
            editing.attach(client, child, parent)
            return
        if action.do == "start":
            client.open_tab("Photo")
            return
        if action.do == "surface":
            client.select_surface(action.arg)
            client.open_tab("Object")
            return
        if action.do == "check":
            client.select(to_check(scene, client.session.badges))
            return
        if action.do == "rename":
            object_id, name = action.pair
            if scene.has_object(object_id):
                editing.rename(client, object_id, name)
            return
        if not scene.has_object(action.arg):
            return
        item = scene.object(action.arg)
        if action.do == "select" and action.add:
            client.toggle(item.id)
        elif action.do == "select":
            client.select((item.id,))
        elif action.do == "lock":
            editing.set_locked(client, (item.id,), not item.locked)
        elif action.do == "hide":
            editing.set_hidden(client, (item.id,), not item.hidden)


def takers(scene: Scene, object_id: str) -> tuple[str, ...]:
    """Ids of the planes and objects that usually carry an object of its kind and size, but for what does so now."""
    edge, mount = scene.support_of(object_id), resolve(scene.object(object_id).category).category.mount
    without = {object_id, *descendants(scene, object_id), "" if edge is None else edge.parent}
    planes = (p.id for p in scene.architecture.planes if p.role in ("floor", mount))
    every = (*planes, *(o.id for o in scene.objects))
    return tuple(i for i in every if i not in without and not why_not_on(scene, object_id, i))


def plane_name(scene: Scene, plane: Plane) -> str:
    """Display name of a plane; walls are numbered."""
    return editing.supporter_name(scene, plane.id).capitalize()


def tree_html(
    scene: Scene,
    selection: tuple[str, ...],
    badges: Mapping[str, tuple[str, ...]] | None = None,
    others: Cursors = (),
) -> str:
    """The rows, nested; every name escaped.

    Args:
        scene: as it is.
        selection: ids.
        badges: words by object id.
        others: what other people have selected.
    """
    if not scene.objects and not scene.architecture.planes:
        start = button(_("Start with a photo"), "start", title=_("Upload one, or describe a room in words"))
        none = text(_("Nothing here yet."))
        return f'<div class="card">{none}<div class="bar" style="margin:6px 0 0 0">{start}</div></div>'
    tree = _Tree(scene, selection, badges or {}, others)
    planes = sorted(scene.architecture.planes, key=lambda p: p.role != "floor" and not scene.children_of(p.id))
    parts = [_plane_row(scene, p) + _children(tree, scene.children_of(p.id)) for p in planes]
    loose = [o.id for o in scene.objects if scene.support_of(o.id) is None]
    if loose:
        parts.append(_heading(_("Without support")))
        parts.append(_children(tree, tuple(loose)))
    rows = f'<div role="tree" aria-label="{text(_("Objects of the scene"))}">{"".join(parts)}</div>'
    none = f'<p class="dim">{_("No furniture yet. Insert some from the <b>Library</b> tab.")}</p>'
    return _summary(tree) + rows + ("" if scene.objects else none)


def to_check(scene: Scene, badges: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """Ids of the objects that have a problem, or of whose pose the photo says little."""
    return tuple(o.id for o in scene.objects if o.id in badges or is_unsure(o))


def _summary(tree: _Tree) -> str:
    """The number of objects, and of those that a person should look at."""
    count = plural("{count} object", "{count} objects", len(tree.scene.objects))
    doubtful = len(to_check(tree.scene, tree.badges))
    if not doubtful:
        return f'<p class="dim">{text(count)}</p>'
    hint = _("Select the objects that collide, float, are outside the room or are uncertain")
    show = button(_("Show"), "check", title=hint)
    style, check = "padding:5px 9px;margin-bottom:6px", text(_("{count} to check").format(count=doubtful))
    return f'<div class="job card warn" style="{style}"><span class="words"><b>{count}</b> · {check}</span>{show}</div>'


def _children(tree: _Tree, ids: tuple[str, ...]) -> str:
    rows = []
    for object_id in ids:
        item = tree.scene.object(object_id)
        rows.append(_row(tree, item) + _children(tree, tree.scene.children_of(object_id)))
    return f'<div class="tree" role="group">{"".join(rows)}</div>' if rows else ""


def _plane_row(scene: Scene, plane: Plane) -> str:
    key = text(plane.id)
    return _heading(
        plane_name(scene, plane),
        f'data-drop="{key}" data-do="surface" data-arg="{key}" title="{text(_("Click to paint or cover it"))}"',
    )


def _heading(name: str, attributes: str = "") -> str:
    return (
        f'<div class="row" role="treeitem" aria-expanded="true" tabindex="-1" {attributes}>'
        f'<span class="name dim">{text(name)}</span></div>'
    )


def _row(tree: _Tree, item: SceneObject) -> str:
    hue = zlib.crc32(item.category.encode()) % 360
    key, selected, name = text(item.id), item.id in tree.selection, item.label
    cursors = "".join(
        f'<span class="who" style="background:rgb{colour}" title="{text(name)}"></span>'
        for name, colour, theirs in tree.others
        if item.id in theirs
    )
    lock = (_("Unlock {name}") if item.locked else _("Lock {name}")).format(name=name)
    hide = (_("Show {name}") if item.hidden else _("Hide {name}")).format(name=name)
    return (
        f'<div class="row {"on" if selected else ""} {"off" if item.hidden else ""}" role="treeitem" '
        f'aria-selected="{"true" if selected else "false"}" tabindex="{0 if item.id == tree.entry else -1}" '
        f'data-do="select" data-arg="{key}" data-grab="{key}" data-drop="{key}" draggable="true" '
        f'data-rename="{text(item.label)}">'
        f'<span class="dot" style="background:hsl({hue} 45% 58%)"></span>'
        f'<span class="name" title="{text(_("{name} (F2 renames)").format(name=name))}">{text(name)}</span>'
        f"{cursors}{_chips(tree, item)}"
        + _tool("lock", key, LOCK % (CLOSED if item.locked else OPEN), lock, item.locked)
        + _tool("hide", key, EYE % (STRUCK if item.hidden else ""), hide, item.hidden)
        + "</div>"
    )


def _chips(tree: _Tree, item: SceneObject) -> str:
    problems = tree.badges.get(item.id, ())
    chips = ""
    if problems:  # names need the room that a second chip would take
        more = f" +{len(problems) - 1}" if len(problems) > 1 else ""
        chips = (
            f'<span class="chip bad" title="{text(", ".join(map(_, problems)))}">{text(_(problems[0]))}{more}</span>'
        )
    elif is_unsure(item):
        share = item.confidence if item.belief is None else min(item.confidence, item.belief.right)
        hint = _("{percent} % sure; review it, or compare it with the photo").format(percent=round(100 * share))
        chips += f'<span class="chip" title="{text(hint)}">{text(_("uncertain"))}</span>'
    return chips


def _tool(do: str, key: str, icon: str, title: str, on: bool) -> str:
    return (
        f'<button type="button" class="tool {"on" if on else ""}" data-do="{do}" data-arg="{key}" tabindex="-1" '
        f'title="{text(title)}" aria-label="{text(title)}">{icon}</button>'
    )
