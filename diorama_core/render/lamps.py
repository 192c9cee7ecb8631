"""Lamps of a scene: which objects are lamps, where their light comes from and how much there is of it.

A photo does not tell how bright a lamp is, so each category has the luminous flux of a usual one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.geometry.sun import daylight
from diorama_core.library.taxonomy import column
from diorama_core.render.appearance import Surface
from diorama_core.scene.types import Scene, SceneObject

LAMP_LUMENS: Mapping[str, float] = column("lumens")
"""Luminous flux of a usual lamp of each category; categories that are not listed give no light."""
WARM: tuple[float, float, float] = (1.0, 0.78, 0.54)
"""Linear colour of a bulb of about 3000 K."""
SHADE_GLOW = 0.4
"""Brightness of the shade of a lamp that shines, where 1 is white."""
PANE_GLOW = 0.45
"""Brightness of a pane before the noon sky, where 1 is white."""


def lamps_of(scene: Scene) -> tuple[SceneObject, ...]:
    """The lamps of a scene, hidden ones too."""
    return tuple(o for o in scene.objects if o.category in LAMP_LUMENS)


def shining_lamps(scene: Scene) -> tuple[SceneObject, ...]:
    """The lamps that a person switched on and that are shown."""
    on = scene.light_settings.lamps_on or ()
    return tuple(o for o in lamps_of(scene) if o.id in on and not o.hidden)


def lamp_place(item: SceneObject, surfaces: tuple[Surface, ...]) -> tuple[Float[np.ndarray, "3"], float]:
    """Where the light of a lamp comes from in the world, and the radius of what glows.

    Args:
        item: The lamp.
        surfaces: What it looks like, in its shape's frame: its emissive parts give the light, or else its middle.
    """
    glowing = [s for s in surfaces if any(s.material.emissive)]
    world = item.pose.apply(np.concatenate([s.vertices for s in glowing])) if glowing else item.corners_world
    low, high = world.min(axis=0), world.max(axis=0)
    return (low + high) / 2, float(np.clip(0.25 * (high - low).min(), 0.005, 0.08))


def as_lit(item: SceneObject, surfaces: tuple[Surface, ...], scene: Scene) -> tuple[Surface, ...]:
    """Surfaces of an object as it glows: lamps that are switched off are dark, panes are as bright as the sky."""
    settings = scene.light_settings
    if item.category in LAMP_LUMENS:
        if settings.lamps_on is None:
            return surfaces
        return _light_shade(surfaces) if item.id in settings.lamps_on else _glowing(surfaces, np.zeros(3))
    if item.category in OPENING_CATEGORIES and settings.hour is not None:
        return _glowing(surfaces, PANE_GLOW * daylight(settings.hour, settings.north_rad).sky)
    return surfaces


def shade_of(surfaces: tuple[Surface, ...]) -> Surface | None:
    """The shade of a lamp: what lies around its bulb, unless it is of metal; None where it has none."""
    bulbs = [s for s in surfaces if any(s.material.emissive)]
    others = [s for s in surfaces if not any(s.material.emissive)]
    if not bulbs or not others:
        return None
    points = np.concatenate([s.vertices for s in bulbs])
    bulb = (points.min(axis=0) + points.max(axis=0)) / 2

    def away(surface: Surface) -> float:
        low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
        return float(np.linalg.norm((low + high) / 2 - bulb))

    shade = min(others, key=away)
    return None if shade.material.metallic >= 0.5 else shade


def _light_shade(surfaces: tuple[Surface, ...]) -> tuple[Surface, ...]:
    """Surfaces of a lamp that shines: its shade glows."""
    shade = shade_of(surfaces)
    if shade is None:
        return surfaces
    return tuple(_with_glow(s, SHADE_GLOW * np.array(WARM)) if s is shade else s for s in surfaces)


def _glowing(surfaces: tuple[Surface, ...], colour: Float[np.ndarray, "3"]) -> tuple[Surface, ...]:
    return tuple(_with_glow(s, colour) if any(s.material.emissive) else s for s in surfaces)


def _with_glow(surface: Surface, colour: Float[np.ndarray, "3"]) -> Surface:
    red, green, blue = (float(c) for c in colour)
    return replace(surface, material=replace(surface.material, emissive=(red, green, blue)))
