"""What holds the selected object up: shown and chosen; an impossible choice is refused with the reason."""

from __future__ import annotations

import viser

from diorama_app import editing
from diorama_app.panels.fields import on_change, show_if, show_value, unique_names
from diorama_app.panels.outliner import plane_name
from diorama_app.room import Room
from diorama_core.scene.types import Scene

NOTHING = "nothing"


class Supports:
    """A drop-down of everything an object could stand on."""

    def __init__(self, gui: viser.GuiApi, room: Room) -> None:
        self._room = room
        self._ids: dict[str, str] = {}
        self._parent = gui.add_dropdown(
            "Stands on", [NOTHING], visible=False, hint="What holds it up: it moves along with that"
        )
        on_change(self._parent, self._chosen)

    def refresh(self) -> None:
        """Show the supporter of the selected object."""
        item = self._room.document.selected
        show_if(item is not None, self._parent)
        if item is None:
            return
        scene = self._room.scene
        self._ids = supporters(scene, item.id)
        edge = scene.support_of(item.id)
        names = {parent: name for name, parent in self._ids.items()}
        current = names.get(edge.parent, NOTHING) if edge is not None else NOTHING
        options = (NOTHING, *self._ids)
        if self._parent.options != options:
            self._parent.options = options
        show_value(self._parent, current)

    def _chosen(self, name: str, client_id: int) -> None:
        room = self._room

        def do() -> None:
            object_id = room.need_selected()
            try:
                if name == NOTHING:
                    editing.detach(room, object_id)
                elif name in self._ids:
                    editing.attach(room, object_id, self._ids[name])
            finally:
                self.refresh()  # a refused choice goes back to what holds

        room.post(client_id, do)


def supporters(scene: Scene, object_id: str) -> dict[str, str]:
    """Names people read, to ids of the planes and objects that could be asked to hold an object up."""
    planes = [p for p in scene.architecture.planes if p.role != "ceiling" or scene.children_of(p.id)]
    others = [o for o in scene.objects if o.id != object_id]
    names = unique_names([plane_name(scene, p) for p in planes] + [o.label for o in others])
    return dict(zip(names, [p.id for p in planes] + [o.id for o in others], strict=True))
