"""The support of the selected object; an impossible choice is refused with the reason."""

from __future__ import annotations

import viser

from diorama_app.commands import edit as editing
from diorama_app.panels.fields import on_change, show_if, show_options, unique_names
from diorama_app.panels.outliner import plane_name
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_core.scene.types import Scene

NOTHING = N_("nothing")
NO_WALL = N_("no wall")
LIES, HANGS = N_("stands or lies"), N_("is fastened")


class Supports:
    """Drop-downs of supporter, relation and wall."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._ids: dict[str, str] = {}
        self._walls: dict[str, str] = {}
        hint = _("The object or surface that supports it, and with which it moves")
        self._parent = gui.add_dropdown(_("Stands on"), [_(NOTHING)], visible=False, hint=hint)
        ways = [_(LIES), _(HANGS)]
        self._relation = gui.add_dropdown(_("How"), ways, visible=False, hint=_("Kind of support"))
        self._wall = gui.add_dropdown(_("Against"), [_(NO_WALL)], visible=False, hint=_("The wall it stands against"))
        on_change(self._parent, lambda name: client.post(lambda: self._choose(name)))
        on_change(self._relation, lambda name: client.post(lambda: self._relate(name)))
        on_change(self._wall, lambda name: client.post(lambda: self._adhere(name)))

    def refresh(self) -> None:
        """Show the supporter of the selected object."""
        item, scene = self._client.last_selected, self._client.session.scene
        show_if(item is not None, self._parent)
        edge = None if item is None else scene.support_of(item.id)
        show_if(edge is not None, self._relation)
        standing = edge is not None and edge.relation == "placed on"
        show_if(standing and bool(scene.architecture.by_role("wall")), self._wall)
        if item is None:
            return
        self._ids = supporters(scene, item.id)
        names = {parent: name for name, parent in self._ids.items()}
        nothing, lies, hangs, no_wall = map(_, (NOTHING, LIES, HANGS, NO_WALL))
        show_options(self._parent, (nothing, *self._ids), names.get(edge.parent, nothing) if edge else nothing)
        show_options(self._relation, (lies, hangs), lies if edge is None or standing else hangs)
        self._walls = {plane_name(scene, p): p.id for p in scene.architecture.by_role("wall")}
        against = edge.adheres_to[0] if edge is not None and edge.adheres_to else None
        here = next((name for name, wall in self._walls.items() if wall == against), no_wall)
        show_options(self._wall, (no_wall, *self._walls), here)

    def _choose(self, name: str) -> None:
        client = self._client
        object_id = client.need_selected()
        try:
            if name == _(NOTHING):
                editing.detach(client, object_id)
            elif name in self._ids:
                editing.attach(client, object_id, self._ids[name])
        finally:
            self.refresh()  # a refused choice reverts to the current support

    def _relate(self, name: str) -> None:
        try:
            editing.set_relation(self._client, self._client.need_selected(), name == _(HANGS))
        finally:
            self.refresh()

    def _adhere(self, name: str) -> None:
        try:
            editing.set_adherence(self._client, self._client.need_selected(), self._walls.get(name))
        finally:
            self.refresh()


def supporters(scene: Scene, object_id: str) -> dict[str, str]:
    """Display names mapped to ids of planes and objects that can support an object."""
    planes = [p for p in scene.architecture.planes if p.role != "ceiling" or scene.children_of(p.id)]
    others = [o for o in scene.objects if o.id != object_id]
    names = unique_names([plane_name(scene, p) for p in planes] + [o.label for o in others])
    return dict(zip(names, [p.id for p in planes] + [o.id for o in others], strict=True))
