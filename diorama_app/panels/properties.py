"""Properties of the selection: colour and materials, and name, position, direction and size in numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import viser

from diorama_app.commands import edit as editing
from diorama_app.panels.fields import on_change, read_number, show_if, show_value
from diorama_app.session.client import Client
from diorama_app.session.units import UNITS, Unit, format_length, parse_length, to_unit
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, fold_button, library_text, text
from diorama_core.arrangement.explain import reason_text, strongest
from diorama_core.artefacts import Reason
from diorama_core.editing.clearances import Clearance, clearances
from diorama_core.scene.types import Finish, MaterialSource, SceneObject

SIZE_ORDER = [1, 0, 2]
"""Fields show width, depth, height; the object's axes are depth, width, height."""

FINISHES: dict[Finish | None, tuple[str, str]] = {
    None: (N_("Original"), N_("The original finish of the shape")),
    "matt": (N_("Matt"), N_("No highlights: chalk, felt")),
    "satin": (N_("Satin"), N_("Soft highlights: lacquered wood, leather")),
    "gloss": (N_("Gloss"), N_("Sharp highlights: porcelain, varnish")),
    "metal": (N_("Metal"), N_("Brushed metal in its colour")),
}
"""Label and hint of every finish."""

MATERIAL_SOURCES: dict[MaterialSource, tuple[str, str]] = {
    "photo": (N_("As in the photo"), N_("Pictures and materials taken from the photo")),
    "library": (N_("Of the shape"), N_("The shape's own materials, in the colour chosen above")),
}
"""Label and hint of every source of materials."""

MADE_OPEN = frozenset(("laptop",))
"""Kinds whose shapes stand open and are closed by their joint."""

FIELDS: dict[str, tuple[str, str, tuple[str, str, str]]] = {
    N_("Position"): ("place", N_("Centre of the object's base"), ("x", "y", N_("Height"))),
    N_("Size"): ("size", N_("Width, depth and height of the object"), (N_("Width"), N_("Depth"), N_("Height"))),
}
SIDE_NAMES = {"front": N_("Front"), "back": N_("Back"), "left": N_("Left"), "right": N_("Right")}
"""What the fields are called: the action, a hint, and the name of every axis."""

SHOWN_OVERLAP_M = 0.001
"""Objects that reach less into one another only touch."""


class Properties:
    """Fields of the object selected last."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._colour = gui.add_rgb(_("Colour"), (200, 200, 200), visible=False, hint=_("Paint its main material"))
        self._own = LiveHtml(gui, self._act)
        self._fold = LiveHtml(gui, self._act)
        self._name = gui.add_text(_("Name"), "", visible=False)
        self._fields = LiveHtml(gui, self._act)
        self._why = LiveHtml(gui)
        on_change(self._name, lambda v: self._with(lambda i: editing.rename(client, i, v), "name"))
        on_change(
            self._colour,
            lambda v: client.post(
                lambda: editing.set_colour(client, client.need_selection(), (v[0] / 255, v[1] / 255, v[2] / 255)),
                key="colour",
            ),
        )

    def refresh(self) -> None:
        """Show the selected object; its numbers where the person has unfolded them."""
        item, numbers = self._client.last_selected, self._client.preferences.numbers
        show_if(item is not None, self._colour)
        show_if(item is not None and numbers, self._name)
        fold = fold_button(_("Name, position and size"), "numbers", _("the fields for exact numbers"), unfolded=numbers)
        self._fold.show("" if item is None else fold)
        self._fields.show(self._lengths(item) if item is not None and numbers else "")
        if item is None:
            self._own.show("")
            self._why.show("")
            return
        show_value(self._name, item.label)
        show_value(self._colour, self._visible_colour(item))
        opens = self._client.session.shapes.can_open(item.shape_id)
        self._own.show((_opening(item) if opens else "") + _surface(item))
        self._why.show(_why(strongest(self._client.session.reasons, item.id)))

    def _visible_colour(self, item: SceneObject) -> tuple[int, int, int]:
        """The paint of an object, or else the main material's colour from the photo, or else the shape's own."""
        seen = next((m.colour for m in item.visible_materials if m.main), None)
        colour = item.colour if item.colour is not None else seen
        if colour is not None:
            r, g, b = (round(255 * c) for c in colour)
            return r, g, b
        return self._client.session.shapes.main_colour(item.shape_id)

    def _lengths(self, item: SceneObject) -> str:
        """Fields of place, size and direction, each with what it measures."""
        unit = self._client.preferences.unit
        rows = []
        for name, (do, hint, axes) in FIELDS.items():
            values = editing.base_position(item) if do == "place" else item.size_m[SIZE_ORDER]
            named = text(_(name))
            cells = "".join(
                f'<label>{axis}<input data-change="{do}" data-arg="{k}" inputmode="decimal" '
                f'aria-label="{named}: {axis}" value="{text(_length(float(values[k]), unit))}"></label>'
                for k, axis in enumerate(text(_(axis)) for axis in axes)
            )
            rows.append(_heading(_(name), _(hint), unit) + _grid(cells))
        rows.append(self._distances(item, unit))
        turn = round(float(np.degrees(item.pose.yaw_rad)), 1) + 0.0  # no minus before a zero
        units = "".join(f"<option {'selected' if u == unit else ''}>{u}</option>" for u in UNITS)
        direction, named = text(_("Direction (°)")), text(_("Unit"))
        cells = (
            f'<label>{direction}<input data-change="turn" value="{turn:g}" aria-label="{direction}" '
            f'inputmode="decimal" title="{text(_("Where its front points, around the vertical axis"))}"></label>'
            f'<label>{named}<select data-change="unit" aria-label="{named}">{units}</select></label>'
        )
        return "".join(rows) + _grid(cells)

    def _distances(self, item: SceneObject, unit: Unit) -> str:
        """Fields of the free length on each side, up to the nearest wall or neighbour."""
        scene = self._client.session.scene

        def cell(c: Clearance) -> str:
            other, overlaps = editing.supporter_name(scene, c.other), c.distance_m < -SHOWN_OVERLAP_M
            title = (_("Overlaps {other} by {length}") if overlaps else _("Distance to {other}")).format(
                other=other, length=_length(abs(c.distance_m), unit)
            )
            side = text(_(SIDE_NAMES[c.side]))
            return (
                f'<label class="{"bad" if overlaps else ""}">{side}<input data-change="gap" data-arg="{c.side}" '
                f'inputmode="decimal" aria-label="{text(_("Distance"))}: {side}" title="{text(title)}" '
                f'value="{text(_length(max(c.distance_m, 0.0), unit))}"></label>'
            )

        cells = "".join(map(cell, clearances(scene, item.id)))
        hint = _("Free distance on each side to the nearest wall or neighbour; type a value to move the object")
        return (
            _heading(_("Distances"), hint, unit) + _grid(cells).replace('class="fields"', 'class="fields four"')
            if cells
            else ""
        )

    def _enter(self, do: str, axis: str, words: str) -> None:
        """Something was written into one of the fields; what cannot be used goes back to what it was."""
        client = self._client
        object_id = client.need_selected()
        item = client.session.scene.object(object_id)
        try:
            if do == "turn":
                degrees = read_number(words, N_("“{words}” is not an angle; write for example 90"))
                editing.set_yaw(client, object_id, degrees)
            elif do == "gap":
                editing.set_distance(client, object_id, axis, parse_length(words, client.preferences.unit))
            elif axis in ("0", "1", "2"):
                place = do == "place"
                values = np.array(editing.base_position(item) if place else item.size_m[SIZE_ORDER])
                values[int(axis)] = parse_length(words, client.preferences.unit)
                if place:
                    editing.set_base_position(client, object_id, values)
                else:
                    editing.set_size(client, object_id, values[SIZE_ORDER])
        finally:
            now = client.last_selected
            if now is not None:
                self._fields.show(self._lengths(now), again=True)

    def _with(self, act: Callable[[str], None], field: str) -> None:
        """Do something to the object selected now, dropping keystrokes that a newer one of the field overtook."""
        chosen = self._client.selection[-1:]
        if chosen:
            self._client.post(lambda: act(chosen[0]), key=f"{field} {chosen[0]}")

    def _act(self, action: Action) -> None:
        client = self._client
        if action.do in ("place", "size", "turn", "gap"):
            client.post(lambda: self._enter(action.do, *action.pair))
        elif action.do == "unit":
            unit = next((u for u in UNITS if u == action.pair[1]), None)
            client.post(lambda: client.change_preferences(unit=unit or client.preferences.unit))
        elif action.do == "open":
            client.post(lambda: editing.set_open(client, client.need_selected(), _share(action.pair[1])), key="open")
        elif action.do == "own":
            client.post(lambda: editing.set_colour(client, client.need_selection(), None))
        elif action.do == "finish":
            finish = next((f for f in FINISHES if f == action.arg), None)
            client.post(lambda: editing.set_finish(client, client.need_selection(), finish))
        elif action.do == "materials":
            source: MaterialSource = "photo" if action.arg == "photo" else "library"
            client.post(lambda: editing.set_material_source(client, client.need_selection(), source))
        elif action.do == "numbers":
            client.post(lambda: client.change_preferences(numbers=not client.preferences.numbers))


def _surface(item: SceneObject) -> str:
    """Buttons for the source of its materials, for the finish of the main one, and one that takes the paint off."""
    finishes = "".join(
        button(_(label), "finish", finish or "", title=_(hint), on=item.finish == finish)
        for finish, (label, hint) in FINISHES.items()
    )
    remove = button(_("Original colours"), "own", title=_("Remove the paint")) if item.colour is not None else ""
    paint = f'<div class="bar tight wide">{remove}</div>' if remove else ""
    sources = "".join(
        button(_(label), "materials", source, title=_(hint), on=item.material_source == source)
        for source, (label, hint) in MATERIAL_SOURCES.items()
    )
    taken = f'<h4>{text(_("Materials"))}</h4><div class="bar tight">{sources}</div>'
    below = f'{paint}<h4>{text(_("Finish"))}</h4><div class="bar tight one-row">{finishes}</div>'
    return (taken if item.photo_materials else "") + below


def _why(reasons: Sequence[Reason]) -> str:
    """What decided most about an object when it was built, in plain words; empty where that is not known."""
    lines = "".join(f"<li>{library_text(reason_text(reason))}</li>" for reason in reasons)
    hint = _("What influenced this object most when the scene was built from the photo, and by how much")
    return f'<h4 title="{text(hint)}">{text(_("Why"))}</h4><ul class="why">{lines}</ul>' if lines else ""


def _opening(item: SceneObject) -> str:
    """How far doors, drawers and lids stand open; how far those are closed that are made open."""
    percent = round(100 * item.open_share)
    word = _("Close") if item.category in MADE_OPEN else _("Open")
    return (
        f'<label class="dio-slider"><span>{text(word)} <b>{percent} %</b></span><input type="range" data-change="open" '
        f'min="0" max="100" step="5" value="{percent}" data-unit=" %" aria-label="{text(word)}"></label>'
    )


def _share(words: str) -> float:
    percent = read_number(words, N_("“{words}” is not a percentage; write for example 50"))
    return float(np.clip(percent, 0.0, 100.0)) / 100.0


def _heading(name: str, hint: str, unit: Unit) -> str:
    return f'<h4 title="{text(hint)}">{text(name)}{"" if unit == "ft-in" else f" ({unit})"}</h4>'


def _grid(cells: str) -> str:
    return f'<div class="fields">{cells}</div>'


def _length(metres: float, unit: Unit) -> str:
    return format_length(metres, unit) if unit == "ft-in" else f"{to_unit(metres, unit) + 0.0:g}"
