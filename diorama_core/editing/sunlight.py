"""How people set the sun: the compass so that it shines into the room, and its azimuth turned by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.errors import EditRefused
from diorama_core.geometry.sun import sun_direction
from diorama_core.scene.light_settings import LightSettings
from diorama_core.scene.types import Scene

FIRST_HOUR = 10.0
"""The time of day that is offered first: the sun is half high, and not straight behind the window."""


def set_light(scene: Scene, settings: LightSettings) -> Scene:
    """The scene in another light; lamps that are gone are forgotten."""
    if settings.lamps_on is not None:
        lamps = tuple(dict.fromkeys(i for i in settings.lamps_on if scene.has_object(i)))
        settings = replace(settings, lamps_on=lamps)
    return replace(scene, light_settings=settings)


def first_daylight(scene: Scene) -> LightSettings:
    """Daylight whose noon sun stands before the largest window, or where the room is open, or where the photo's is."""
    return replace(scene.light_settings, hour=FIRST_HOUR, north_rad=_sun_heading_rad(scene) - sun_azimuth(12.0, 0.0))


def sun_azimuth(hour: float, north_rad: float) -> float:
    """Direction from which the sun shines, counter-clockwise from the world's +X."""
    x, y, _ = sun_direction(hour, north_rad)
    return float(np.arctan2(y, x))


def with_sun_from(settings: LightSettings, azimuth_rad: float) -> LightSettings:
    """The compass turned so that the sun shines from a direction at the time of day that is set.

    Raises:
        EditRefused: no time of day is set.
    """
    if settings.hour is None:
        raise EditRefused("the light is that of the photo; choose a time of day first")
    north = azimuth_rad - sun_azimuth(settings.hour, 0.0)
    return replace(settings, north_rad=float(np.arctan2(np.sin(north), np.cos(north))))


def switch_lamp(scene: Scene, lamp_id: str, *, on: bool) -> LightSettings:
    """The settings with one lamp on or off; the others stay as they are."""
    lit = [i for i in scene.light_settings.lamps_on or () if i != lamp_id]
    return replace(scene.light_settings, lamps_on=(*lit, lamp_id) if on else tuple(lit))


def _sun_heading_rad(scene: Scene) -> float:
    windows = [o for o in scene.objects if o.category == "window" and not o.hidden]
    corners = [p.polygon for p in scene.architecture.planes]
    if windows and corners:
        middle = np.concatenate(corners).mean(axis=0)
        window = max(windows, key=lambda o: (float(np.prod(o.size_m[1:])), o.id))
        away = window.pose.R_world_object[:, 0]
        away = -away if (middle - window.pose.position) @ away > 0 else away
    elif scene.light is not None:
        away = np.array(scene.light.direction)
    else:
        away = np.array([0.0, -1.0, 0.0])
    return float(np.arctan2(away[1], away[0]))
