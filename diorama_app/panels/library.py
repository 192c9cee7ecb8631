"""The library panel: search by words, insert at the centre of the view, or place by a click."""

from __future__ import annotations

import viser

from diorama_app.commands.import_model import import_model
from diorama_app.commands.insert import insert_shape, start_placing
from diorama_app.panels.fields import on_change
from diorama_app.session.client import Client
from diorama_app.session.units import format_size
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.library.record import Shape
from diorama_core.library.search import search

SHOWN = 24


class LibraryPanel:
    """A search field and a grid of what was found."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._words = gui.add_text("Search", "", hint="For example: armchair, round table, blue")
        on_change(self._words, lambda v: client.post(self.refresh, key="search"))
        upload = gui.add_upload_button(
            "Add a model file", hint="GLB, OBJ, PLY, STL or FBX; then click where to place it"
        )

        async def uploaded(event: viser.GuiEvent[viser.GuiUploadButtonHandle]) -> None:
            file = event.target.value
            client.post(lambda: import_model(client, file.name, file.content))

        upload.on_upload(uploaded)
        self._where = LiveHtml(gui)
        self._html = LiveHtml(gui, self._act)
        self._drawn: tuple[object, ...] = ()

    def refresh(self) -> None:
        """Draw what was found."""
        selected = self._client.selected
        where = "on the floor in view" + (f", or on the selected {text(selected.label)}" if selected else "")
        self._where.show(
            f'<p class="dim"><b>Insert</b> puts it {where}; <b>Place</b> waits for your click in the view.</p>'
        )
        words = self._words.value.strip()
        drawn = (words, self._client.preferences.unit, self._client.session.library.shapes())
        if drawn == self._drawn:
            return  # a hundred tiles, the same as before
        self._drawn = drawn
        tiles = "".join(self._tile(shape) for shape in self._found(words))
        nothing = f"<p class='dim'>Nothing in the library matches “{text(words)}”. Try another word.</p>"
        self._html.show(f'<div class="grid">{tiles}</div>' if tiles else nothing)

    def _found(self, words: str) -> list[Shape]:
        library = self._client.session.library
        if not words:
            firsts: dict[str, Shape] = {}
            for shape in library.shapes():
                firsts.setdefault(shape.category, shape)
            return list(firsts.values())
        return list(search(library, words, k=SHOWN))

    def _tile(self, shape: Shape) -> str:
        size = shape.size_m
        name = text(shape.caption or shape.category)
        about = text(format_size(size[1], size[0], size[2], self._client.preferences.unit))
        return (
            f'<div class="tile" title="{name}&#10;{about}">'
            f"{self._client.session.thumbnails.html(shape.id)}<b>{name}</b><small>{about}</small>"
            '<div class="bar" style="margin:4px 0 0 0">'
            + button("Insert", "insert", shape.id, title=f"Insert: {shape.caption}")
            + button("Place", "place", shape.id, title="Then click where to place it")
            + "</div></div>"
        )

    def _act(self, action: Action) -> None:
        client = self._client
        if action.do == "insert":
            client.post(lambda: insert_shape(client, action.arg))
        elif action.do == "place":
            client.post(lambda: start_placing(client, action.arg))
