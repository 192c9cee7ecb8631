"""The selected object's ranked alternatives as pictures; a click swaps."""

from __future__ import annotations

import viser

from diorama_app import editing
from diorama_app.page import Action, LiveHtml, text
from diorama_app.room import Room
from diorama_core.errors import LibraryError
from diorama_core.scene.types import Candidate, SceneObject

SHOWN = 12


class Alternatives:
    """A grid of thumbnails with what they are and how large."""

    def __init__(self, gui: viser.GuiApi, room: Room) -> None:
        self._room = room
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw the alternatives of the selected object."""
        item = self._room.document.selected
        if item is None:
            self._html.show("")
        elif not item.candidates:
            self._html.show(
                "<h4>Alternatives</h4><p class='dim'>None of its own. Find others in the <b>Library</b> tab.</p>"
            )
        else:
            tiles = "".join(self._tile(item, i, c) for i, c in enumerate(item.candidates[:SHOWN]))
            self._html.show(
                f'<h4>Alternatives — click to swap <span class="dim">(cm)</span></h4><div class="grid">{tiles}</div>'
            )

    def _tile(self, item: SceneObject, index: int, candidate: Candidate) -> str:
        current = candidate.shape_id == item.shape_id
        size = [e * s for e, s in zip(candidate.shape_size_m, candidate.pose.scale, strict=True)]
        picture = self._room.thumbnails.html(candidate.shape_id)
        name = text(shape_caption(self._room, candidate.shape_id))
        about = f"{100 * size[1]:.0f} × {100 * size[0]:.0f} × {100 * size[2]:.0f} "
        return (
            f'<button type="button" class="tile {"on" if current else ""}" data-do="swap" data-arg="{index}" '
            f'title="{name}&#10;{about} cm (width, depth, height)&#10;score {candidate.score:.2f}">'
            f"{picture}<b>{name}</b><small>{about}</small>"
            f"<small>{'in use' if current else f'score {candidate.score:.2f}'}</small></button>"
        )

    def _act(self, action: Action) -> None:
        if action.do == "swap" and action.arg.isdigit():
            room = self._room
            room.post(action.client_id, lambda: editing.swap_candidate(room, room.need_selected(), int(action.arg)))


def shape_caption(room: Room, shape_id: str) -> str:
    """What people call a shape; its category at the least."""
    try:
        shape = room.library.shape(shape_id)
    except LibraryError:
        return "missing shape"
    return shape.caption or shape.category
