"""The surface that is chosen: paint, paper, tiles or boards, in a colour, a size and a direction."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import get_args

import numpy as np
import viser

from diorama_app.commands.edit import supporter_name
from diorama_app.commands.insert import put_opening
from diorama_app.commands.room_looks import finish_surfaces
from diorama_app.panels.fields import read_number
from diorama_app.projects.pictures import encode_picture, jpeg_uri
from diorama_app.session.client import Client
from diorama_app.session.units import format_length
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.errors import EditRefused, InputError
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.scene.types import Plane, SurfaceFinish, SurfacePattern

SAMPLE_M = (0.9, 0.68)
"""Width and height of the sample of a pattern."""
SAMPLE_PX = (108, 82)
DIRECTIONS_DEG = (0, 45, 90)


class Surfaces:
    """Shown while a surface is chosen."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._samples = gui.add_html("")
        self._html = LiveHtml(gui, self._act)
        self._all_walls = False
        self._outlined: Plane | None = None

    def refresh(self) -> None:
        """Draw what the chosen surface can be finished with, and its outline in the view."""
        plane = self._plane()
        if plane is not self._outlined:
            self._outlined = plane
            self._client.view.show_surface(plane)
        if plane is not None and not self._samples.content:
            self._samples.content = _sample_styles()
        self._html.show("" if plane is None else self._card(plane))

    def _plane(self) -> Plane | None:
        chosen, scene = self._client.surface, self._client.session.scene
        return scene.plane(chosen) if chosen is not None and scene.has_plane(chosen) else None

    def _card(self, plane: Plane) -> str:
        from diorama_core.appearance.surface_finish import KINDS, USUAL  # OpenCV; opening a project does without it
        from diorama_core.geometry.planes import plane_rectangle

        scene, unit = self._client.session.scene, self._client.preferences.unit
        wide, high = (format_length(float(e), unit) for e in plane_rectangle(plane)[2])
        name = supporter_name(scene, plane.id).capitalize()
        parts = [f'<p><b>{text(name)}</b><br><span class="dim">{text(wide)} × {text(high)}</span></p>']
        if plane.role == "wall" and len(scene.architecture.by_role("wall")) > 1:
            parts.append(
                '<div class="bar tight">'
                + button(_("This wall"), "one", title=_("Change only this wall"), on=not self._all_walls)
                + button(_("All walls"), "all", title=_("Change all walls together"), on=self._all_walls)
                + "</div>"
            )
        if plane.role == "wall":
            label, hint = _("Add {kind}"), _("Add {kind} to this wall")
            openings = (
                button(label.format(kind=_(c)), "opening", c, title=hint.format(kind=_(c))) for c in OPENING_CATEGORIES
            )
            parts.append(f'<div class="bar">{"".join(openings)}</div>')
        finish = plane.finish
        before = _("As in the photo") if scene.camera is not None else _("Plain")
        parts.append('<div class="bar">' + button(before, "before", title=_("No finish"), on=finish is None) + "</div>")
        offered = dict.fromkeys((*USUAL[plane.role], *([finish.pattern] if finish is not None else [])))
        parts.append('<div class="grid">' + "".join(_tile(p, KINDS[p].name, finish) for p in offered) + "</div>")
        if finish is not None:
            parts.append(_details(finish))
        return "".join(parts)

    def _act(self, action: Action) -> None:
        self._client.post(lambda: self._do(action), key="finish" if action.do == "own" else None)

    def _do(self, action: Action) -> None:
        from diorama_core.appearance.patterns import COLOURS
        from diorama_core.appearance.surface_finish import usual_finish

        plane = self._plane()
        if plane is None:
            raise EditRefused("no surface is chosen; click a wall, the floor or the ceiling")
        finish = plane.finish
        if action.do in ("one", "all"):
            self._all_walls = action.do == "all"
            self.refresh()
        elif action.do == "opening" and action.arg in OPENING_CATEGORIES:
            put_opening(self._client, action.arg, plane.id, plane.polygon[:, :2].mean(axis=0))
            self._client.select(self._client.selection)
        elif action.do == "before":
            self._set(None)
        elif action.do == "pattern" and action.arg in get_args(SurfacePattern):
            self._set(usual_finish(next(p for p in get_args(SurfacePattern) if p == action.arg)))
        elif finish is None:
            raise EditRefused("choose a pattern first")
        elif action.do == "colour" and action.arg in COLOURS:
            self._set(replace(finish, colour=COLOURS[action.arg]))
        elif action.do == "own":
            self._set(replace(finish, colour=_colour(action.pair[1])), merge="colour")
        elif action.do == "turn":
            self._set(replace(finish, direction_rad=float(np.radians(float(action.arg)))))
        elif action.do in ("scale", "direction"):
            self._enter(finish, action)

    def _enter(self, finish: SurfaceFinish, action: Action) -> None:
        """A number was written; what cannot be used goes back to what it was."""
        try:
            number = _number(action.pair[1])
            if action.do == "scale":
                self._set(replace(finish, scale=number / 100.0))
            else:
                self._set(replace(finish, direction_rad=float(np.radians(number % 360.0))))
        finally:
            plane = self._plane()
            self._html.show("" if plane is None else self._card(plane), again=True)

    def _set(self, finish: SurfaceFinish | None, merge: str = "") -> None:
        finish_surfaces(self._client, finish, all_walls=self._all_walls, merge=merge)


def _tile(pattern: SurfacePattern, name: str, finish: SurfaceFinish | None) -> str:
    on = finish is not None and finish.pattern == pattern
    return (
        f'<button type="button" class="tile {"on" if on else ""}" data-do="pattern" data-arg="{pattern}" '
        f'aria-pressed="{"true" if on else "false"}"><span class="sample {pattern}"></span>'
        f'<b style="height:auto">{text(_(name))}</b></button>'
    )


def _details(finish: SurfaceFinish) -> str:
    """Colour, size and direction of a finish."""
    from diorama_core.appearance.patterns import COLOURS
    from diorama_core.appearance.surface_finish import KINDS

    kind = KINDS[finish.pattern]
    swatches = "".join(
        button(
            f'<span class="swatch" style="background:{_hex(COLOURS[name])}"></span>',
            "colour",
            name,
            title=_(name).capitalize(),
            on=COLOURS[name] == finish.colour,
        )
        for name in kind.colours
    )
    picker = (
        f'<label>{text(_("Any colour"))}<input type="color" data-change="own" value="{_hex(finish.colour)}"></label>'
    )
    percent, angle, hint = (
        text(_("Size (%)")),
        text(_("Direction (°)")),
        _("Rotation of the pattern, counter-clockwise"),
    )
    size = (
        f'<label>{percent}<input data-change="scale" value="{100 * finish.scale:g}" inputmode="decimal" '
        f'aria-label="{percent}" title="{text(_("Of the pattern, relative to its usual size"))}"></label>'
    )
    degrees = round(float(np.degrees(finish.direction_rad)), 1) + 0.0
    turn = (
        f'<label>{angle}<input data-change="direction" value="{degrees:g}" inputmode="decimal" '
        f'aria-label="{angle}" title="{text(hint)}"></label>'
        if kind.directed
        else ""
    )
    quick = "".join(
        button(f"{d}°", "turn", d, title=_("Turn to {angle}°").format(angle=d), on=degrees == d) for d in DIRECTIONS_DEG
    )
    bar = f'<div class="bar tight">{quick}</div>' if kind.directed else ""
    fields = f'<div class="fields">{picker}{size}{turn}</div>'
    return f'<h4>{text(_("Colour"))}</h4><div class="swatches">{swatches}</div>{fields}{bar}'


@cache
def _sample_styles() -> str:
    """A style sheet with a picture of every pattern, sent to a page once."""
    from PIL import Image

    from diorama_core.appearance.surface_finish import KINDS, finish_picture, usual_finish

    rules = []
    for pattern in KINDS:
        picture = Image.fromarray(finish_picture(usual_finish(pattern), "floor", SAMPLE_M)).resize(SAMPLE_PX)
        uri = jpeg_uri(encode_picture(picture, "JPEG", quality=80))
        rules.append(f".dio .sample.{pattern} {{ background-image: url({uri}) }}")
    return f"<style>{''.join(rules)}</style>"


def _hex(colour: tuple[float, float, float]) -> str:
    return "#" + "".join(f"{round(255 * c):02x}" for c in colour)


def _colour(words: str) -> tuple[float, float, float]:
    digits = words.strip().removeprefix("#")
    try:
        if len(digits) != 6:
            raise ValueError(words)
        red, green, blue = (int(digits[i : i + 2], 16) / 255 for i in (0, 2, 4))
    except ValueError as error:
        raise InputError(_("“{words}” is not a colour; write for example #c08040").format(words=words[:20])) from error
    return red, green, blue


def _number(words: str) -> float:
    number = read_number(words, N_("“{words}” is not a number; write for example 100"))
    if not np.isfinite(number):
        raise InputError("the number is not finite; write for example 100")
    return number
