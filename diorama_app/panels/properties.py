"""Properties of the selection: name, position, rotation, size, colour; align and distribute several."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import viser

from diorama_app.commands import edit as editing
from diorama_app.commands.registry import CommandTable
from diorama_app.panels.fields import on_change, show_if, show_label, show_options, show_value
from diorama_app.panels.toolbar import run_command
from diorama_app.session.client import Client
from diorama_app.session.units import UNITS, format_length, from_unit, in_unit, parse_lengths
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.errors import InputError
from diorama_core.scene.types import Finish, MaterialSource, SceneObject

SIZE_ORDER = [1, 0, 2]
"""Fields show width, depth, height; the object's axes are depth, width, height."""

FINISHES: dict[Finish | None, tuple[str, str]] = {
    None: ("Original", "The original finish of the shape"),
    "matt": ("Matt", "No highlights: chalk, felt"),
    "satin": ("Satin", "Soft highlights: lacquered wood, leather"),
    "gloss": ("Gloss", "Sharp highlights: porcelain, varnish"),
    "metal": ("Metal", "Brushed metal in its colour"),
}
"""Label and hint of every finish."""

MATERIAL_SOURCES: dict[MaterialSource, tuple[str, str]] = {
    "photo": ("As in the photo", "Pictures and materials taken from the photo"),
    "library": ("Library's", "The shape's own materials, in the colour chosen above"),
}
"""Label and hint of every source of materials."""

ALIGN = {
    "align_left": "Left",
    "align_centre": "Middle",
    "align_right": "Right",
    "align_back": "Far",
    "align_depth": "Centre",
    "align_front": "Near",
}


class Properties:
    """Fields of the object selected last."""

    def __init__(self, gui: viser.GuiApi, client: Client, commands: CommandTable) -> None:
        self._client, self._commands = client, commands
        self._header = LiveHtml(gui, self._act)
        self._name = gui.add_text("Name", "", visible=False)
        where, size = "Centre of its base: x, y, height", "Width, depth, height"
        self._place = gui.add_vector3("Position (m)", (0.0, 0.0, 0.0), step=0.01, visible=False, hint=where)
        self._place_words = gui.add_text("Position (ft)", "", visible=False, hint=where)
        self._yaw = gui.add_number(
            "Rotation (°)", 0.0, step=1.0, visible=False, hint="Direction of its front, around the vertical axis"
        )
        self._size = gui.add_vector3("Size (m)", (1.0, 1.0, 1.0), step=0.01, visible=False, hint=size)
        self._size_words = gui.add_text("Size (ft)", "", visible=False, hint=size)
        self._unit = gui.add_dropdown("Unit", list(UNITS), visible=False, hint="Unit of all lengths")
        self._colour = gui.add_rgb("Colour", (200, 200, 200), visible=False, hint="Paints its main material")
        self._own = LiveHtml(gui, self._act)
        on_change(self._name, lambda v: self._with(lambda i: editing.rename(client, i, v), "name"))
        on_change(
            self._place, lambda v: self._with(lambda i: editing.set_base_position(client, i, self._m(v)), "place")
        )
        on_change(self._place_words, lambda v: self._written(v, "place", editing.set_base_position, None))
        on_change(self._yaw, lambda v: self._with(lambda i: editing.set_yaw(client, i, v), "yaw"))
        on_change(
            self._size,
            lambda v: self._with(lambda i: editing.set_size(client, i, self._m(v)[SIZE_ORDER]), "size"),
        )
        on_change(self._size_words, lambda v: self._written(v, "size", editing.set_size, SIZE_ORDER))
        on_change(self._unit, lambda v: client.post(lambda: client.change_preferences(unit=v)))
        on_change(
            self._colour,
            lambda v: client.post(
                lambda: editing.set_colour(client, client.need_selection(), (v[0] / 255, v[1] / 255, v[2] / 255)),
                key="colour",
            ),
        )

    def refresh(self) -> None:
        """Show the selected object, or what to do when there is none."""
        item, unit = self._client.selected, self._client.preferences.unit
        there, feet = item is not None, unit == "ft-in"
        show_if(there, self._name, self._yaw, self._unit, self._colour)
        show_if(there and not feet, self._place, self._size)
        show_if(there and feet, self._place_words, self._size_words)
        self._header.show(self._advice() if item is None else self._card(item))
        show_options(self._unit, UNITS, unit)
        if item is None:
            self._own.show("")
            return
        show_value(self._name, item.label)
        base, size = editing.base_position(item), item.size_m[SIZE_ORDER]
        if feet:
            self._show_words(self._place_words, base)
            self._show_words(self._size_words, size)
        else:
            show_label(self._place, f"Position ({unit})")
            show_label(self._size, f"Size ({unit})")
            show_value(self._place, tuple(in_unit(float(v), unit) for v in base))
            show_value(self._size, tuple(in_unit(float(v), unit) for v in size))
        show_value(self._yaw, round(float(np.degrees(item.pose.yaw_rad)), 1))
        if item.colour is not None:
            show_value(self._colour, tuple(round(255 * c) for c in item.colour))
        self._own.show(_surface(item))

    def _show_words(self, field: viser.GuiTextHandle, lengths_m: np.ndarray) -> None:
        try:
            if np.abs(np.array(parse_lengths(field.value, "ft-in")) - lengths_m).max() < 1e-3:
                return  # the same length, however it was written
        except InputError:
            pass
        show_value(field, ", ".join(format_length(float(v), "ft-in") for v in lengths_m))

    def _m(self, values: tuple[float, float, float]) -> np.ndarray:
        return np.array([from_unit(v, self._client.preferences.unit) for v in values])

    def _written(
        self,
        words: str,
        field: str,
        act: Callable[[Client, str, np.ndarray], None],
        order: list[int] | None,
    ) -> None:
        try:
            values = np.array(parse_lengths(words, "ft-in"))
        except InputError:
            return  # still being typed
        self._with(lambda i: act(self._client, i, values if order is None else values[order]), field)

    def _with(self, act: Callable[[str], None], field: str) -> None:
        """Do something to the object selected now, dropping keystrokes that a newer one of the field overtook."""
        chosen = self._client.selection[-1:]
        if chosen:
            self._client.post(lambda: act(chosen[0]), key=f"{field} {chosen[0]}")

    def _advice(self) -> str:
        if not self._client.session.scene.objects:
            return '<div class="card">The room is empty. Insert furniture from the <b>Library</b> tab.</div>'
        return (
            '<div class="card"><b>Click an object</b> in the view or in the list, or <b>drag it</b> to where it should '
            "be.<br><span class='dim'>Shift-click selects several, Shift-drag selects by rectangle, Esc clears.</span>"
            "</div>"
        )

    def _card(self, item: SceneObject) -> str:
        several = len(self._client.selection)
        more = f' <span class="dim">and {several - 1} more</span>' if several > 1 else ""
        photo_layer = f" · {100 * item.confidence:.0f}% confidence" if item.box_px is not None else ""
        problems = "".join(
            f' <span class="chip bad">{text(w)}</span>' for w in self._client.session.badges.get(item.id, ())
        )
        return (
            f"<p><b>{text(item.label)}</b>{more}{problems}<br><span class='dim'>{text(item.category)}{photo_layer}"
            f"{' · locked' if item.locked else ''}{' · hidden' if item.hidden else ''}</span></p>"
            '<div class="bar tight">'
            + self._command("focus", "Focus")
            + self._command("duplicate", "Duplicate")
            + self._command("drop", "Drop")
            + self._command("mirror", "Mirror")
            + self._command("delete", "Delete")
            + "</div>"
            + (self._together(several) if several > 1 else "")
        )

    def _together(self, several: int) -> str:
        align = "".join(self._command(c, label) for c, label in ALIGN.items())
        spread = self._command("distribute", "Distribute evenly") if several > 2 else ""
        return f'<h4>Align with {text(self._client.selected.label)}</h4><div class="bar tight">{align}</div>' + (  # type: ignore[union-attr]
            f'<div class="bar tight">{spread}</div>' if spread else ""
        )

    def _command(self, command_id: str, label: str) -> str:
        return button(label, "run", command_id, title=self._commands[command_id].tooltip)

    def _act(self, action: Action) -> None:
        client = self._client
        if action.do == "own":
            client.post(lambda: editing.set_colour(client, client.need_selection(), None))
        elif action.do == "finish":
            finish = next((f for f in FINISHES if f == action.arg), None)
            client.post(lambda: editing.set_finish(client, client.need_selection(), finish))
        elif action.do == "materials":
            source: MaterialSource = "photo" if action.arg == "photo" else "library"
            client.post(lambda: editing.set_material_source(client, client.need_selection(), source))
        else:
            run_command(client, self._commands, action)


def _surface(item: SceneObject) -> str:
    """Buttons for the source of its materials, for the finish of the main one, and one that takes the paint off."""
    finishes = "".join(
        button(label, "finish", finish or "", title=hint, on=item.finish == finish)
        for finish, (label, hint) in FINISHES.items()
    )
    own = button("Original colours", "own", title="Removes the paint") if item.colour is not None else ""
    paint = f'<div class="bar tight">{own}</div>' if own else ""
    sources = "".join(
        button(label, "materials", source, title=hint, on=item.material_source == source)
        for source, (label, hint) in MATERIAL_SOURCES.items()
    )
    taken = f'<div class="bar tight"><span class="dim lead">Materials</span>{sources}</div>'
    return f"{taken if item.photo_materials else ''}{paint}" + (
        f'<div class="bar tight"><span class="dim lead">Finish</span>{finishes}</div>'
    )
