"""The light of the room: the photo's, or the sun by time of day and direction; lamps; exposure.

Sliders and the dial move in the page (`static/light.js`), which is told what is set; they are not drawn anew while a
hand is on them.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import viser

from diorama_app.commands import room_looks as lighting
from diorama_app.panels.fields import PageScript, read_number
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_app.web.html import Action, LiveHtml, button, text
from diorama_core.editing.sunlight import sun_azimuth
from diorama_core.errors import InputError
from diorama_core.geometry.sun import sun_direction
from diorama_core.render.lamps import lamps_of
from diorama_core.scene.light_settings import MAX_EXPOSURE_EV
from diorama_core.scene.types import Scene

SHOWN_EV = 2.0
"""The slider of the exposure goes so far each way."""


def _sliders() -> str:
    return f"""
<div class="dio-light">
 <div class="dio-daylight">
  <label class="dio-slider"><span>{text(_("Time of day"))} <b data-clock></b></span>
   <input type="range" data-change="hour" min="0" max="24" step="0.25" aria-label="{text(_("Time of day"))}"></label>
  <div class="dio-compass">
   <svg data-dial role="slider" tabindex="0" aria-label="{text(_("Direction of the sun (°)"))}" aria-valuemin="0"
    aria-valuemax="359" viewBox="-50 -50 100 100"></svg>
   <p class="dim" data-about></p>
  </div>
  <input type="hidden" data-change="sun">
 </div>
 <label class="dio-slider"><span>{text(_("Exposure"))} <b data-exposure></b></span>
  <input type="range" data-change="exposure" min="-{SHOWN_EV:g}" max="{SHOWN_EV:g}" step="0.1"
   aria-label="{text(_("Exposure"))}">
 </label>
</div>
"""


class LightPanel:
    """A folded group below the tree."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        self._folder = gui.add_folder(_("Light"), expand_by_default=False)
        with self._folder:
            self._modes = LiveHtml(gui, self._act)
            self._sliders = LiveHtml(gui, self._act)
            self._lamps = LiveHtml(gui, self._act)
            self._script = PageScript(gui)

    def refresh(self) -> None:
        """Draw what is set."""
        scene = self._client.session.scene
        something = bool(scene.objects or scene.architecture.planes)
        self._folder.visible = something
        if not something:
            return
        settings = scene.light_settings
        as_before = _("As in the photo") if scene.camera is not None else _("Even light")
        self._modes.show(
            '<div class="bar">'
            + button(as_before, "photo", title=_("Reset all light settings"), on=settings.hour is None)
            + button(_("Daylight"), "day", title=_("Sun and sky at a time of day"), on=settings.hour is not None)
            + "</div>"
        )
        self._sliders.show(_sliders())
        self._lamps.show(_lamps(scene))
        about = json.dumps(light_state(scene), separators=(",", ":"))
        sun = self._client.session.viewport.room_light.told or "null"
        self._script.run(f"window.__dioLight.told({about}); window.__dioSun.told({sun});")

    def _act(self, action: Action) -> None:
        merged = action.do in ("hour", "sun", "exposure")
        self._client.post(lambda: self._do(action), key=f"light {action.do}" if merged else None)

    def _do(self, action: Action) -> None:
        client = self._client
        if action.do == "photo":
            lighting.light_as_photo(client)
        elif action.do == "day":
            lighting.use_daylight(client)
        elif action.do == "hour":
            lighting.set_hour(client, float(np.clip(_number(action.pair[1]), 0.0, 24.0)))
        elif action.do == "sun":
            lighting.set_sun_from(client, float(np.radians(_number(action.pair[1]))))
        elif action.do == "exposure":
            ev = float(np.clip(_number(action.pair[1]), -MAX_EXPOSURE_EV, MAX_EXPOSURE_EV))
            lighting.set_exposure(client, ev)
        elif action.do == "lamp":
            lighting.switch(client, action.arg)
        elif action.do == "lamps":
            lighting.switch_all(client, on=action.arg == "on")


def light_state(scene: Scene) -> dict[str, Any]:
    """What a page needs to draw the sliders and the dial: what is set, and the room with its windows from above."""
    settings = scene.light_settings
    floor = scene.architecture.floor
    outline = np.zeros((0, 2)) if floor is None else floor.polygon[:, :2]
    windows = []
    for item in scene.objects:
        if item.category == "window" and not item.hidden:
            across = 0.5 * item.size_m[1] * item.pose.R_world_object[:2, 1]
            ends = item.pose.position[:2] - across, item.pose.position[:2] + across
            windows.append([*_round(ends[0]), *_round(ends[1])])
    hour = settings.hour
    sun = None if hour is None else sun_direction(hour, settings.north_rad)
    return {
        "day": hour is not None,
        "hour": hour,
        "north": round(settings.north_rad, 4),
        "azimuth": None if hour is None else round(sun_azimuth(hour, settings.north_rad), 4),
        "up": None if sun is None else round(float(sun[2]), 4),
        "exposure": settings.exposure_ev,
        "outline": [_round(p) for p in outline],
        "windows": windows,
    }


def _lamps(scene: Scene) -> str:
    lamps, title = lamps_of(scene), f"<h4>{text(_('Lamps'))}</h4>"
    if not lamps:
        return title + f'<p class="dim">{text(_("The room has no lamps. Insert one from the library."))}</p>'
    on = scene.light_settings.lamps_on or ()
    rows = "".join(
        button(
            f'<span class="dio-bulb" aria-hidden="true"></span>{text(o.label)}',
            "lamp",
            o.id,
            title=_("Switch off") if o.id in on else _("Switch on"),
            on=o.id in on,
        )
        for o in lamps
    )
    every = (
        '<div class="bar tight">' + button(_("All on"), "lamps", "on") + button(_("All off"), "lamps", "off") + "</div>"
        if len(lamps) > 1
        else ""
    )
    return f'{title}<div class="bar tight">{rows}</div>{every}'


def _round(point: Any) -> list[float]:
    return [round(float(v), 3) for v in point]


def _number(words: str) -> float:
    number = read_number(words, N_("“{words}” is not a number; write for example 0.5"))
    if not np.isfinite(number):
        raise InputError("the number is not finite; write for example 0.5")
    return number
