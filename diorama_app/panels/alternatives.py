"""Shapes to swap to: the object's ranked candidates, or a search of the library; hover to preview."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import viser

from diorama_app.commands.swap import SIZE_MODES, alike, preview_swap, swap
from diorama_app.panels.fields import on_change, show_if, show_value
from diorama_app.session.client import Client
from diorama_app.session.preferences import SizeMode
from diorama_app.session.session import EditorSession
from diorama_app.session.units import format_size
from diorama_app.strings import N_, _
from diorama_app.viewport.thumbnails import Paint
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.errors import LibraryError
from diorama_core.library.record import Shape
from diorama_core.library.search import search
from diorama_core.scene.types import Candidate, SceneObject

SHOWN, FIRST_SHOWN = 12, 4
"""What is found, and how many of it are shown before somebody asks for more: two rows."""
SIZE_NAMES: dict[SizeMode, str] = {
    "as found": N_("As in photo"),
    "same box": N_("Same box"),
    "in proportion": N_("In proportion"),
    "catalogue": N_("Original"),
}
SIZE_HINTS: dict[SizeMode, str] = {
    "as found": N_("The size measured in the photo; scaled evenly where unknown"),
    "same box": N_("Stretched to the size of the replaced object"),
    "in proportion": N_("Scaled evenly to about the size of the replaced object"),
    "catalogue": N_("The original size in the library"),
}


class Alternatives:
    """A search field, how to take size and colour, and a grid of thumbnails."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._html = LiveHtml(gui, self._act)
        self._words = gui.add_text(
            _("Swap for"), "", visible=False, hint=_("Words to search for; empty shows the ranked alternatives")
        )
        on_change(self._words, lambda v: client.post(self.refresh, key="swap search"))
        self._options = LiveHtml(gui, self._act)
        self._of: str | None = None
        self._all = False
        """Whether all of them are shown, not only the first."""

    def refresh(self) -> None:
        """Draw the alternatives of the selected object."""
        item = self._client.last_selected
        show_if(item is not None, self._words)
        if item is None:
            self._options.show("")
            self._html.show("")
            return
        if self._of != item.id:
            self._of, self._all = item.id, False
            show_value(self._words, "")
        self._options.show(self._choices(item))
        words = self._words.value.strip()
        self._html.show(self._results(item, words) if words else self._own(item))

    def _choices(self, item: SceneObject) -> str:
        preferences = self._client.preferences
        sizes = "".join(
            button(_(SIZE_NAMES[m]), "size", m, title=_(SIZE_HINTS[m]), on=preferences.size_mode == m)
            for m in SIZE_MODES
        )
        count = len(alike(self._client.session.scene, item))
        every, hint = _("All {count}").format(count=count), _("Swap all objects with this shape")
        same = button(every, "alike", title=hint, on=preferences.all_alike)
        hint = _("Keep the colour of the replaced object")
        keep = button(_("Keep colour"), "keep", title=hint, on=preferences.keep_colour)
        return (
            f'<h4>{text(_("Size when swapped"))}</h4><div class="bar tight">{sizes}</div>'
            f'<div class="bar tight">{keep}{same if count > 1 else ""}</div>'
        )

    def _own(self, item: SceneObject) -> str:
        if not item.candidates:
            return self._similar(item)
        return self._grid([self._candidate(item, c) for c in item.candidates[:SHOWN]])

    def _grid(self, tiles: Sequence[str]) -> str:
        shown = tiles if self._all else tiles[:FIRST_SHOWN]
        more = (
            "" if len(shown) == len(tiles) else button(_("{count} more").format(count=len(tiles) - len(shown)), "all")
        )
        unit = "" if self._client.preferences.unit == "ft-in" else f" ({self._client.preferences.unit})"
        grid = f'<h4>{text(_("Alternatives"))}{unit}</h4><div class="grid two">{"".join(shown)}</div>'
        return f'{grid}<div class="bar tight">{more}</div>'

    def _similar(self, item: SceneObject) -> str:
        """For what was inserted by hand: the library's shapes of its category, most alike in size first."""
        same = self._client.session.offer.in_category(item.category)
        size = np.sort(np.asarray(item.size_m))
        near = sorted(same, key=lambda s: float(np.abs(np.log(np.sort(np.asarray(s.size_m)) / size)).sum()))
        if len(near) < 2:
            return f"<p class='dim'>{text(_('The library has no other shape of this category. Search it above.'))}</p>"
        return self._grid([self._shape(item, s) for s in near[:SHOWN]])

    def _results(self, item: SceneObject, words: str) -> str:
        shapes = search(self._client.session.offer, words, k=SHOWN)
        if not shapes:
            none = _("Nothing in the library matches “{words}”. Try another word.").format(words=words)
            return f'<p class="dim">{text(none)}</p>'
        return f'<div class="grid two">{"".join(self._shape(item, s) for s in shapes)}</div>'

    def _candidate(self, item: SceneObject, candidate: Candidate) -> str:
        size = [e * s for e, s in zip(candidate.shape_size_m, candidate.pose.scale, strict=True)]
        return self._tile(item, candidate.shape_id, size)

    def _shape(self, item: SceneObject, shape: Shape) -> str:
        return self._tile(item, shape.id, list(shape.size_m))

    def _tile(self, item: SceneObject, shape_id: str, size: list[float]) -> str:
        current = shape_id == item.shape_id
        caption, key = shape_caption(self._client.session, shape_id), text(shape_id)
        shown = format_size(size[1], size[0], size[2], self._client.preferences.unit)
        hint = _("Swap for {name}\n{size} (width, depth, height)").format(name=caption, size=shown)
        used = f"<small>{text(_('in use'))}</small>" if current else ""
        return (
            f'<button type="button" class="tile {"on" if current else ""}" data-do="swap" data-arg="{key}" '
            f'data-peek="{key}" title="{text(hint)}">'
            f"{self._client.session.thumbnails.html(shape_id, self._paint(item))}<b>{text(caption)}</b>"
            f"<small>{text(shown)}</small>{used}</button>"
        )

    def _paint(self, item: SceneObject) -> Paint:
        return (item.colour, item.finish) if self._client.preferences.keep_colour else (None, None)

    def _act(self, action: Action) -> None:
        client = self._client
        if action.do == "swap":
            client.post(lambda: swap(client, client.need_selected(), action.arg))
        elif action.do == "peek":
            client.post(lambda: self._peek(action.arg), key="peek")
        elif action.do == "size" and action.arg in SIZE_MODES:
            client.post(lambda: client.change_preferences(size_mode=action.arg))
        elif action.do == "all":
            self._all = True
            client.post(self.refresh)
        elif action.do == "alike":
            client.post(lambda: client.change_preferences(all_alike=not client.preferences.all_alike))
        elif action.do == "keep":
            client.post(lambda: client.change_preferences(keep_colour=not client.preferences.keep_colour))

    def _peek(self, shape_id: str) -> None:
        client = self._client
        if not client.selection:
            return
        if shape_id:
            preview_swap(client, client.need_selected(), shape_id)
        else:
            client.session.refresh()


def shape_caption(session: EditorSession, shape_id: str) -> str:
    """Display name of a shape; at least its category."""
    try:
        shape = session.records.shape(shape_id)
    except LibraryError:
        return _("missing shape")
    return shape.caption or _(shape.category)
