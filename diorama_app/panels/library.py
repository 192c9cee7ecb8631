"""The whole library: search by words, insert, or swap the selected object for what is found."""

from __future__ import annotations

import viser

from diorama_app import editing
from diorama_app.page import Action, LiveHtml, button, text
from diorama_app.panels.fields import on_change
from diorama_app.room import Room
from diorama_core.library.record import Shape
from diorama_core.library.search import search

SHOWN = 18


class LibraryPanel:
    """A search field and a grid of what was found."""

    def __init__(self, gui: viser.GuiApi, room: Room) -> None:
        self._room = room
        self._words = gui.add_text("Search", "", hint="For example: armchair, round table, blue")
        on_change(self._words, lambda value, client: room.post(client, self.refresh, key="search"))
        self._html = LiveHtml(gui, self._act)

    def refresh(self) -> None:
        """Draw what was found."""
        words = self._words.value.strip()
        found = self._found(words)
        selected = self._room.document.selected
        if not found:
            self._html.show(f"<p class='dim'>Nothing in the library is like “{text(words)}”. Try a plainer word.</p>")
            return
        swap = f"Swap the selected {selected.label} for it" if selected is not None else ""
        tiles = "".join(self._tile(shape, swap) for shape in found)
        advice = "Insert puts it on the floor you look at" + (
            f", or on the selected {text(selected.label)}." if selected is not None else "."
        )
        self._html.show(f'<p class="dim">{advice}</p><div class="grid">{tiles}</div>')

    def _found(self, words: str) -> list[Shape]:
        library = self._room.library
        if not words:
            firsts: dict[str, Shape] = {}
            for shape in library.shapes():
                firsts.setdefault(shape.category, shape)
            return list(firsts.values())
        return list(search(library, words, k=SHOWN))

    def _tile(self, shape: Shape, swap: str) -> str:
        size = shape.size_m
        name = text(shape.caption or shape.category)
        return (
            f'<div class="tile" title="{name}&#10;{size[1]:.2f} × {size[0]:.2f} × {size[2]:.2f} m">'
            f"{self._room.thumbnails.html(shape.id)}<b>{name}</b>"
            '<div class="bar" style="margin:4px 0 0 0">'
            + button("Insert", "insert", shape.id, title=f"Insert: {shape.caption}")
            + (button("Swap", "swap", shape.id, title=swap) if swap else "")
            + "</div></div>"
        )

    def _act(self, action: Action) -> None:
        room = self._room

        def insert() -> None:
            view = room.views.get(action.client_id)
            editing.insert_shape(room, action.arg, None if view is None else view.looked_at)

        if action.do == "insert":
            room.post(action.client_id, insert)
        elif action.do == "swap":
            room.post(action.client_id, lambda: editing.swap_shape(room, room.need_selected(), action.arg))
