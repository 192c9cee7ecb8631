"""The light of a scene's pictures: the photo's, or what a person set (time of day, lamps), with its shadows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.geometry.ray_scene import RayScene
from diorama_core.geometry.sun import Daylight, daylight
from diorama_core.geometry.unseen_walls import close_room
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.stretch import relative_scale
from diorama_core.render.appearance import Material, Surface, shape_surfaces
from diorama_core.render.direct_light import DirectLight, LampLight, SunLight
from diorama_core.render.lamps import LAMP_LUMENS, WARM, lamp_place, shining_lamps
from diorama_core.render.lighting import Lighting
from diorama_core.render.world import World, place_surfaces
from diorama_core.scene.types import Scene, SceneObject

SUN_STRENGTH = 4.5
"""Strength of the sun outside the atmosphere, where 1 shows a white surface white: its patches are not blank."""
SKY_WINDOW, SKY_AROUND = 1.1, 0.6
"""Strengths of the noon sky through the largest window, and of what it leaves everywhere in the room."""
WHITE_LUX = 55.0
"""Light of lamps that shows a white surface white: as an eye that is used to lamps sees it."""


def outside_light(scene: Scene) -> Daylight | None:
    """Light from outside as a person set it; None for the light of the photo."""
    settings = scene.light_settings
    return None if settings.hour is None else daylight(settings.hour, settings.north_rad)


def with_settings(base: Lighting, scene: Scene, library: ShapeLibrary, bounds: Float[np.ndarray, "2 3"]) -> Lighting:
    """The light of pictures: what a person set instead of, and on top of, the photo's.

    Args:
        base: The photo's.
        scene: With openings in its walls (`geometry.openings.with_openings`).
        library: Where its shapes are.
        bounds: Corners of the room, metres.
    """
    outside, lamps = outside_light(scene), shining_lamps(scene)
    if outside is None and not lamps:
        return base
    light = base if outside is None else _daytime(scene, outside, bounds)
    index = {o.id: number for number, o in enumerate(scene.objects)}
    blockers = _blockers(close_room(scene), library, without={index[o.id] for o in lamps})
    direct: list[DirectLight] = [_lamp(o, library, blockers) for o in lamps]
    if outside is not None and outside.sun.any():
        direct.append(SunLight(outside.direction, SUN_STRENGTH * outside.sun, blockers))
    return replace(light, direct=tuple(direct))


def _daytime(scene: Scene, outside: Daylight, bounds: Float[np.ndarray, "2 3"]) -> Lighting:
    """Light of the sky through the largest window, and what it leaves all around."""
    size = bounds[1] - bounds[0]
    reach = max(0.5 * float(np.linalg.norm(size)), 0.1)
    around = SKY_AROUND * outside.sky
    windows = [o for o in scene.objects if o.category == "window" and not o.hidden]
    plain = Lighting(
        window_centre=np.array([*bounds.mean(axis=0)[:2], bounds[1][2] + 1.0]),
        window_edges=np.array([[0.3 * size[0], 0.0, 0.0], [0.0, 0.3 * size[1], 0.0]]),
        window_irradiance=np.zeros(3),
        reference_m=max(float(size[2]), 0.1),
        sky=1.1 * around,
        ground=0.75 * around,
        reach_m=reach,
        relights=True,
    )
    if not windows:
        return plain
    window = max(windows, key=lambda o: (float(np.prod(o.size_m[1:])), o.id))
    R = window.pose.R_world_object
    inward = R[:, 0] if (bounds.mean(axis=0) - window.pose.position) @ R[:, 0] >= 0 else -R[:, 0]
    return replace(
        plain,
        window_centre=window.pose.position + inward * 0.12,
        window_edges=np.stack([R[:, 1] * window.size_m[1] / 2, R[:, 2] * window.size_m[2] / 2]),
        window_irradiance=SKY_WINDOW * outside.sky,
        reference_m=1.1 * reach,
        inward=inward,
    )


def _blockers(scene: Scene, library: ShapeLibrary, without: set[int]) -> RayScene:
    """Objects, walls and the ceiling, without what lets light through: panes, clear glass, and lamps that shine."""
    placed = [p for p in place_surfaces(scene, library) if p.instance not in without]
    panes = {number for number, o in enumerate(scene.objects) if o.category in OPENING_CATEGORIES}
    return World(
        [replace(p, surfaces=tuple(_bare(s) for s in _solid(p.surfaces, window=p.instance in panes))) for p in placed]
    ).shadow_caster()


def _solid(surfaces: tuple[Surface, ...], *, window: bool) -> tuple[Surface, ...]:
    """A window's frame: what does not glow with the sky; of one whose panes do not glow, all but its largest part."""
    if not window:
        return surfaces
    frame = tuple(s for s in surfaces if not any(s.material.emissive))
    if len(frame) < len(surfaces) or len(surfaces) < 2:
        return frame if len(frame) < len(surfaces) else ()
    largest = max(surfaces, key=lambda s: s.area_m2)
    return tuple(s for s in surfaces if s is not largest)


def _bare(surface: Surface) -> Surface:
    """Without its picture, which casts no shadow."""
    return replace(surface, material=Material(alpha=surface.material.alpha))


def _lamp(item: SceneObject, library: ShapeLibrary, blockers: RayScene) -> LampLight:
    surfaces = shape_surfaces(library, item.shape_id, scale=relative_scale(item.pose.scale))
    position, radius = lamp_place(item, surfaces)
    return LampLight(position, np.array(WARM) * lamp_strength(item), radius, blockers)


def lamp_strength(item: SceneObject) -> float:
    """Light of a lamp on what faces it one metre away; 1 shows a white surface white."""
    return LAMP_LUMENS[item.category] / (4 * np.pi) / WHITE_LUX
