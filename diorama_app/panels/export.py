"""The scene for other programs: every format with what it keeps and where it opens, its options, one button."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby
from typing import TYPE_CHECKING, TypeVar

import viser

from diorama_app.panels.fields import options_html
from diorama_app.projects.formats import EXPORT_FORMATS, GUIDES, Choice
from diorama_app.reconstruction.written_files import download_suffix, export
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, switch, text
from diorama_core.export import Format

if TYPE_CHECKING:
    from diorama_core.export.gathering import Compression, ExportOptions, LightUnits

TEXTURE_SIZES = (0, 2048, 1024, 512, 256)
"""Longest side in pixels; 0 leaves pictures as they are."""
ChoiceName = TypeVar("ChoiceName", bound=str)
SWITCHES: dict[Choice, tuple[str, str]] = {
    "ceiling": (N_("Without ceiling"), N_("To look into the room from above")),
    "selection": (N_("Only selection"), N_("The selected objects without the room around them")),
    "photo": (N_("With photo"), N_("Opening the file brings it back; everyone who has the file can see it")),
    "welded": (N_("Welded"), N_("Nothing moves: every object is fixed where it stands")),
}
"""What is switched on and off: name and explanation."""
IMPOSSIBLE: dict[Choice, str] = {
    "selection": N_("Select objects first"),
    "photo": N_("There is no photo in this project"),
}
"""What is said instead while a switch has no effect."""
COMPRESSIONS: dict[Compression, tuple[str, str]] = {
    "none": (N_("none"), N_("Every program reads it")),
    "meshopt": ("Meshopt", N_("Smaller, for three.js and Babylon.js; Blender does not read it")),
    "draco": ("Draco", N_("Smallest, for Blender, Unity, Unreal and three.js")),
}
"""Name and explanation."""
LIGHTS: dict[LightUnits, tuple[str, str]] = {
    "unit": (N_("as here"), N_("For programs whose camera has no exposure")),
    "photometric": (N_("in lumens and lux"), N_("For cameras with an exposure")),
    "none": (N_("none"), N_("The room is lit in the other program")),
}
"""Name and explanation."""


class ExportPanel:
    """A list of formats; the one that is chosen shows its options and the button."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._format = next(iter(GUIDES))
        self._on: set[str] = set()
        self._texture_px = 0
        self._compression: Compression = "none"
        self._lights: LightUnits = "unit"
        self._html = LiveHtml(gui, lambda action: client.post(lambda: self._do(action)))

    def refresh(self) -> None:
        """Draw the list."""
        body = ""
        for group, names in groupby(GUIDES, key=lambda name: GUIDES[name].group):
            body += f"<h4>{text(_(group))}</h4>" + "".join(self._row(EXPORT_FORMATS[name]) for name in names)
        self._html.show(body)

    def _row(self, one: Format) -> str:
        chosen = one.name == self._format
        row = (
            f'<div class="row {"on" if chosen else ""}" style="padding-left:9px" role="button" tabindex="0" '
            f'data-do="choose" data-arg="{text(one.name)}" title="{text(_keeps(one))}">'
            f'<span class="name" style="white-space:normal">{text(_(one.title))}'
            f'<br><span class="dim">{text(_(GUIDES[one.name].opens_in))}</span></span>'
            f'<span class="dim">{text(download_suffix(one))}</span></div>'
        )
        return row + (self._details(one) if chosen else "")

    def _details(self, one: Format) -> str:
        """What the chosen format keeps, its options, and the button."""
        choices = GUIDES[one.name].choices
        switches = "".join(self._switch(choice) for choice in SWITCHES if choice in choices)
        packing = (
            _choice(_("Compression"), "compression", COMPRESSIONS, self._compression)
            if "compression" in choices
            else ""
        )
        lights = _choice(_("Lights"), "lights", LIGHTS, self._lights) if "lights" in choices else ""
        pictures = self._texture_field() if "textures" in choices else ""
        fields = pictures + packing + lights
        missing = f'<p class="bad">{text(_(one.missing))}</p>' if one.missing else ""
        ready = not one.missing and self._client.session.jobs.status is None
        label = _("Export {suffix}").format(suffix=text(download_suffix(one)))
        go = button(label, "export", one.name, on=ready, disabled=not ready)
        return (
            f'<div class="card" style="margin:2px 0 8px"><p>{text(_keeps(one))}.</p>'
            f'{switches}{fields}{missing}<div class="bar wide" style="margin:8px 0 0">{go}</div></div>'
        )

    def _switch(self, choice: Choice) -> str:
        name, hint = SWITCHES[choice]
        possible = self._is_possible(choice)
        hint = hint if possible else IMPOSSIBLE[choice]
        return switch(_(name), _(hint), choice, on=self._is_on(choice), disabled=not possible)

    def _texture_field(self) -> str:
        names = {str(px): _("at most {px} pixels").format(px=px) if px else _("as they are") for px in TEXTURE_SIZES}
        return _field(_("Textures"), "textures", names, str(self._texture_px))

    def _is_possible(self, choice: Choice) -> bool:
        if choice == "photo":
            return self._client.session.photo is not None
        return choice != "selection" or bool(self._client.selection)

    def _is_on(self, choice: Choice) -> bool:
        return choice in self._on and self._is_possible(choice)

    def _do(self, action: Action) -> None:
        if action.do == "choose" and action.arg in GUIDES:
            self._format = action.arg
        elif action.do == "switch" and action.arg in SWITCHES:
            self._on ^= {action.arg}
        elif action.do == "textures" and action.pair[1] in map(str, TEXTURE_SIZES):
            self._texture_px = int(action.pair[1])
        elif action.do == "compression":
            self._compression = next((one for one in COMPRESSIONS if one == action.pair[1]), self._compression)
        elif action.do == "lights":
            self._lights = next((one for one in LIGHTS if one == action.pair[1]), self._lights)
        elif action.do == "export":
            export(self._client, self._format, self._options())
        self.refresh()

    def _options(self) -> ExportOptions:
        """What is switched on, as far as the format knows it."""
        from diorama_core.export.gathering import ExportOptions

        choices = GUIDES[self._format].choices
        on = {choice for choice in choices if self._is_on(choice)}
        return ExportOptions(
            ceiling="ceiling" not in on,
            only=frozenset(self._client.selection) if "selection" in on else None,
            max_texture_px=(self._texture_px or None) if "textures" in choices else None,
            compression=self._compression if "compression" in choices else "none",
            lights=self._lights if "lights" in choices else "unit",
            photo="photo" in on,
            bodies="welded" if "welded" in on else "free",
        )


def _keeps(one: Format) -> str:
    return _("Keeps {content}").format(content=_(one.keeps))


def _choice(label: str, change: str, choices: Mapping[ChoiceName, tuple[str, str]], chosen: ChoiceName) -> str:
    """A list to choose from, and below it what is chosen."""
    below = f'<p class="dim" style="margin:3px 0 0;font-size:11.5px">{text(_(choices[chosen][1]))}</p>'
    return _field(label, change, {one: _(name) for one, (name, hint) in choices.items()}, chosen) + below


def _field(label: str, change: str, names: Mapping[str, str], chosen: str) -> str:
    """A label and a list to choose from."""
    options = options_html(names.items(), chosen)
    return (
        '<label style="display:flex;align-items:center;gap:8px;margin-top:6px">'
        f'<span style="flex:0 0 82px">{text(label)}</span>'
        f'<select data-change="{change}" aria-label="{text(label)}" style="flex:1">{options}</select></label>'
    )
