"""The library panel: a catalogue by category, style and size, with favourites, recent ones and models of one's own."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING, get_args

import viser

from diorama_app.commands.import_model import import_model
from diorama_app.commands.insert import insert_shape, start_placing, stop_placing, toggle_favourite
from diorama_app.panels.fields import UploadField, on_change, options_html
from diorama_app.panels.own_models import OwnShelf
from diorama_app.session.client import Client, Placing
from diorama_app.session.units import format_size
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.library.browsing import Filters, Shelf, SizeClass, browse, one_of_each
from diorama_core.library.record import Shape
from diorama_core.library.search import search
from diorama_core.library.taxonomy import ROOMS
from diorama_core.library.user_library import UserLibrary
from diorama_core.scene.types import HomeRoom, Scene

if TYPE_CHECKING:
    from diorama_core.editing.free_space import FreeSpace

SHOWN = 24
"""Tiles at first, and more with every press of the button below them."""
SEARCHED = 240
SHELVES: dict[Shelf, tuple[str, str]] = {
    "all": (N_("All"), N_("The whole library")),
    "favourites": ("★", N_("Your favourites")),
    "recent": (N_("Recent"), N_("What you inserted last")),
    "own": (N_("Mine"), N_("Models of your own")),
}
EMPTY: dict[Shelf, str] = {
    "all": N_("Nothing in the library passes these filters."),
    "favourites": N_("No favourites yet. Press ☆ on a tile."),
    "recent": N_("Nothing yet. What you insert appears here."),
    "own": N_("No models of your own yet. Add a file above."),
}
SIZE_NAMES: dict[SizeClass, str] = {
    "small": N_("Up to 0.5 m"),
    "medium": N_("0.5 to 1.5 m"),
    "large": N_("Above 1.5 m"),
}

WAYS = N_("Drag a shape into the view. <b>Insert</b> puts it on the floor in view; <b>Place</b> waits for your click.")
WAYS_WITH_SUPPORT = N_(
    "Drag a shape into the view. <b>Insert</b> puts it on the floor in view, or a small one on the selected {label}; "
    "<b>Place</b> waits for your click."
)


class LibraryPanel:
    """A search field, filters, and a grid of what was found."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._filters = Filters()
        self._mine = OwnShelf(client)
        self._most = SHOWN
        self._words = gui.add_text(_("Search"), "", hint=_("For example: armchair, round table, blue"))
        on_change(self._words, lambda v: client.post(self._search, key="search"))
        self._choices = LiveHtml(gui, self._act)
        UploadField(gui, client, _("Add a model file"), lambda name, content: import_model(client, name, content))
        self._where = LiveHtml(gui)
        self._html = LiveHtml(gui, self._act)
        self._drawn: tuple[object, ...] = ()
        self._drawn_of: tuple[Scene | None, tuple[HomeRoom, ...]] = (None, ())
        """The scene and the room whose free space the tiles tell of."""
        self._free: FreeSpace | None = None
        """Free space of that room; None while it is not measured."""
        self._without_place: dict[str, bool] = {}

    def refresh(self) -> None:
        """Draw the filters and what was found."""
        selected, preferences = self._client.last_selected, self._client.preferences
        where = _(WAYS if selected is None else WAYS_WITH_SUPPORT)
        if isinstance(self._client.doing, Placing):
            where = _("<b>Click in the view</b> where it should be; Esc cancels.")
        label = "" if selected is None else text(selected.label)
        self._where.show(f'<p class="dim">{where.format(label=label)}</p>')
        words, shapes = self._words.value.strip(), self._client.session.library.shapes()
        scene = self._client.session.scene if self._filters.any or words else None
        rooms = () if scene is None else self._client.room().rooms
        recent = preferences.recent if self._filters.shelf == "recent" else ()
        mine = self._mine.models
        drawn = (words, preferences.unit, shapes, self._filters, self._most, preferences.favourites, recent, mine)
        if drawn == self._drawn and scene is self._drawn_of[0] and rooms == self._drawn_of[1]:
            return  # a hundred tiles, the same as before
        self._drawn, self._drawn_of, self._free = drawn, (scene, rooms), None
        self._choices.show(self._choice_html(shapes))
        matches = self._find(words, shapes)
        on_own_shelf = self._filters.shelf == "own"

        def tile(shape: Shape) -> str:
            return self._tile(shape, told=scene is not None, own=on_own_shelf)

        shown = matches[: self._most]
        tiles = self._mine.folder_tiles(shown, tile) if on_own_shelf else "".join(map(tile, shown))
        tiles = tiles if on_own_shelf or not tiles else f'<div class="grid two">{tiles}</div>'
        more = (
            button(_("{count} more").format(count=len(matches) - self._most), "more")
            if len(matches) > self._most
            else ""
        )
        unknown = _("Nothing in the library matches “{words}”. Try another word.").format(words=words)
        nothing = unknown if words and not self._filters.any else _(EMPTY[self._filters.shelf])
        below = f'{tiles}<div class="bar" style="margin-top:6px">{more}</div>'
        head = self._mine.head() if on_own_shelf else ""
        self._html.show(head + (below if tiles else f"<p class='dim'>{text(nothing)}</p>"))

    def _choice_html(self, shapes: tuple[Shape, ...]) -> str:
        chosen = self._filters
        shelves = "".join(button(_(n), "shelf", s, title=_(t), on=chosen.shelf == s) for s, (n, t) in SHELVES.items())
        count = Counter(s.category for s in shapes)
        categories = [("", _("Every category")), *((c, f"{_(c).capitalize()} ({n})") for c, n in sorted(count.items()))]
        rooms = [("", _("Every room")), *((r, _(r).capitalize()) for r in ROOMS)]
        styles = [
            ("", _("Every style")),
            *((s, _(s).capitalize()) for s in sorted({s.style for s in shapes if s.style})),
        ]
        sizes = [("", _("Every size")), *((s, _(name)) for s, name in SIZE_NAMES.items())]
        fitting = button(_("Fits here"), "fitting", title=_("Only what fits into this room"), on=chosen.fitting)
        return (
            f'<div class="bar tight">{shelves}{fitting}</div><div class="filters">'
            + _select("category", _("Category"), categories, chosen.category)
            + _select("room", _("Room"), rooms, chosen.room)
            + _select("style", _("Style"), styles, chosen.style)
            + _select("size", _("Size"), sizes, chosen.size or "")
            + "</div>"
        )

    def _find(self, words: str, shapes: tuple[Shape, ...]) -> tuple[Shape, ...]:
        session, preferences = self._client.session, self._client.preferences
        library = session.library
        if words:
            shapes = tuple(search(library, words, k=SEARCHED if self._filters.any else SHOWN))
        deleted = self._mine.models.deleted
        shapes = tuple(s for s in shapes if s.id not in deleted)
        if words and not self._filters.any:
            return shapes
        if not self._filters.any:
            return one_of_each(shapes)
        return browse(
            shapes,
            self._filters,
            favourites=preferences.favourites,
            recent=preferences.recent,
            is_own=frozenset(s.id for s in library.uploads()).__contains__
            if isinstance(library, UserLibrary)
            else lambda shape_id: False,
            has_place=self._has_place,
        )

    def _has_place(self, shape: Shape) -> bool:
        """Whether a shape finds a place in the room as it is now."""
        if self._free is None:
            from diorama_core.editing.free_space import free_space  # OpenCV; opening a project does without it

            self._free, self._without_place = free_space(self._client.room()), {}
        if shape.id not in self._without_place:
            self._without_place[shape.id] = not self._free.has_place_for(shape)
        return not self._without_place[shape.id]

    def _tile(self, shape: Shape, *, told: bool, own: bool) -> str:
        size, preferences = shape.size_m, self._client.preferences
        name = self._mine.models.names.get(shape.id) or shape.caption or _(shape.category)
        about = text(format_size(size[1], size[0], size[2], preferences.unit))
        too_large = told and not self._has_place(shape)
        marked = shape.id in preferences.favourites
        label = _("Favourite: {name}").format(name=name)
        hint = _("Remove from favourites") if marked else _("Add to favourites")
        star = (
            f'<button type="button" class="star" data-do="favourite" data-arg="{text(shape.id)}" '
            f'aria-pressed="{"true" if marked else "false"}" aria-label="{text(label)}" title="{text(hint)}">'
            f"{'★' if marked else '☆'}</button>"
        )
        hint = _("No free place is large enough")
        fit = f'<span class="chip" title="{text(hint)}">{text(_("too large"))}</span>' if too_large else ""
        return (
            f'<div class="tile" draggable="true" data-grab="{text(shape.id)}" title="{text(name)}&#10;{about}">{star}'
            f"{self._client.session.thumbnails.html(shape.id)}<b>{text(name)}</b><small>{about}</small>{fit}"
            '<div class="bar" style="margin:4px 0 0 0">'
            + button(_("Insert"), "insert", shape.id, title=_("Insert {name}").format(name=name))
            + button(_("Place"), "place", shape.id, title=_("Then click where to place it"))
            + "</div>"
            + (self._mine.fields(shape) if own else "")
            + "</div>"
        )

    def _search(self) -> None:
        self._most = SHOWN
        self.refresh()

    def _act(self, action: Action) -> None:
        self._client.post(lambda: self._do(action))

    def _do(self, action: Action) -> None:
        client, filters = self._client, self._filters
        if action.do == "insert":
            insert_shape(client, action.arg)
        elif action.do in ("place", "grab"):
            start_placing(client, action.arg)
        elif action.do == "release":
            stop_placing(client)
        elif action.do == "favourite":
            toggle_favourite(client, action.arg)
        elif action.do == "more":
            self._most += SHOWN
            self.refresh()
        elif self._mine.do(action):
            self.refresh()
        else:
            chosen = action.pair[1]
            if action.do == "shelf":
                filters = replace(filters, shelf=next((s for s in get_args(Shelf) if s == action.arg), "all"))
            elif action.do == "fitting":
                filters = replace(filters, fitting=not filters.fitting)
            elif action.do == "category":
                filters = replace(filters, category=chosen)
            elif action.do == "room":
                filters = replace(filters, room=chosen if chosen in ROOMS else "")
            elif action.do == "style":
                filters = replace(filters, style=chosen)
            elif action.do == "size":
                filters = replace(filters, size=next((s for s in get_args(SizeClass) if s == chosen), None))
            self._filters, self._most = filters, SHOWN
            self.refresh()


def _select(do: str, name: str, options: list[tuple[str, str]], chosen: str) -> str:
    return f'<select data-change="{do}" aria-label="{text(name)}">{options_html(options, chosen)}</select>'
