"""What people do to how the room looks: the sun, the lamps and the exposure, and the finish of walls, floor and ceiling
chosen by a click; each is one undo step.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_app.commands.edit import supporter_name
from diorama_app.session.client import Client
from diorama_app.strings import _, plural
from diorama_core.editing.sunlight import first_daylight, set_light, switch_lamp, with_sun_from
from diorama_core.errors import EditRefused
from diorama_core.geometry.casting import cast_planes
from diorama_core.render.lamps import lamps_of
from diorama_core.scene.light_settings import PHOTO_LIGHT, LightSettings
from diorama_core.scene.room_edits import set_surface_finish
from diorama_core.scene.types import Scene, SurfaceFinish


def clock(hour: float) -> str:
    """A time of day as a clock shows it."""
    minutes = round(hour * 60)
    return f"{minutes // 60:02d}:{minutes % 60:02d}"


def light_as_photo(client: Client) -> None:
    """Take back everything that was set: the light of the photo."""
    _set(client, _("light as in the photo"), PHOTO_LIGHT)


def use_daylight(client: Client) -> None:
    """Daylight that shines into the room, unless a time of day is set already."""
    scene = client.session.scene
    if scene.light_settings.hour is None:
        settings = first_daylight(scene)
        _set(client, _("daylight at {time}").format(time=clock(settings.hour or 0.0)), settings)


def set_hour(client: Client, hour: float) -> None:
    """Set the time of day; quick changes are one step."""
    scene = client.session.scene
    settings = scene.light_settings if scene.light_settings.hour is not None else first_daylight(scene)
    _set(client, _("time of day {time}").format(time=clock(hour)), replace(settings, hour=hour), merge="hour")


def set_sun_from(client: Client, azimuth_rad: float) -> None:
    """Turn the compass so that the sun shines from a direction; quick changes are one step."""
    settings = with_sun_from(client.session.scene.light_settings, azimuth_rad)
    _set(client, _("direction of the sun"), settings, merge="sun")


def set_exposure(client: Client, exposure_ev: float) -> None:
    """Make the view and pictures brighter or darker, in stops."""
    settings = replace(client.session.scene.light_settings, exposure_ev=exposure_ev)
    _set(client, _("exposure {ev:+.1f}").format(ev=exposure_ev), settings, merge="exposure")


def switch(client: Client, lamp_id: str) -> None:
    """Switch one lamp on or off."""
    scene = client.session.scene
    if not scene.has_object(lamp_id):
        raise EditRefused("this lamp no longer exists")
    on = lamp_id not in (scene.light_settings.lamps_on or ())
    label = _("switch {label} on") if on else _("switch {label} off")
    _set(client, label.format(label=scene.object(lamp_id).label), switch_lamp(scene, lamp_id, on=on))


def switch_all(client: Client, *, on: bool) -> None:
    """Switch all lamps on or off."""
    scene = client.session.scene
    lamps = tuple(o.id for o in lamps_of(scene)) if on else ()
    label = _("switch all lamps on") if on else _("switch all lamps off")
    _set(client, label, replace(scene.light_settings, lamps_on=lamps))


def _set(client: Client, label: str, settings: LightSettings, merge: str = "") -> None:
    client.session.edit(
        label, lambda scene: set_light(scene, settings), by=client, merge_key=f"light {merge}" if merge else None
    )


def surface_under(scene: Scene, origin: Float[np.ndarray, 3], direction: Float[np.ndarray, 3]) -> str | None:
    """Id of the nearest plane on a ray that faces the eye; the others are seen through."""
    facing = tuple(p for p in scene.architecture.planes if float(p.normal @ direction) < 0)
    if not facing:
        return None
    which = int(cast_planes(origin, direction[None], facing)[1][0])
    return facing[which].id if which >= 0 else None


def surface_ids(client: Client, *, all_walls: bool) -> tuple[str, ...]:
    """The surface that is chosen, or with `all_walls` every wall when it is one.

    Raises:
        EditRefused: none is chosen.
    """
    scene, chosen = client.session.scene, client.surface
    if chosen is None or not scene.has_plane(chosen):
        raise EditRefused("no surface is chosen; click a wall, the floor or the ceiling")
    if all_walls and scene.plane(chosen).role == "wall":
        return tuple(p.id for p in scene.architecture.by_role("wall"))
    return (chosen,)


def finish_surfaces(client: Client, finish: SurfaceFinish | None, *, all_walls: bool, merge: str = "") -> None:
    """Finish the chosen surface, or let it look as before with None; one undo step.

    Args:
        client: the browser that asked.
        finish: None for none.
        all_walls: whether every wall gets it.
        merge: steps with the same key become one.
    """
    session = client.session
    chosen = surface_ids(client, all_walls=all_walls)
    names = (
        supporter_name(session.scene, chosen[0])
        if len(chosen) == 1
        else plural("{count} wall", "{count} walls", len(chosen))
    )
    label = _("remove the finish of {names}") if finish is None else _("{pattern} on {names}")
    label = label.format(names=names, pattern="" if finish is None else _(finish.pattern))
    session.edit(
        label,
        lambda scene: set_surface_finish(scene, chosen, finish),
        by=client,
        merge_key=f"finish {' '.join(chosen)} {merge}" if merge else None,
    )
