"""Light that the objects of a scene give: lamps shine from their bulbs and shades, windows let daylight in.

Where a person set the time of day, the sun shines too, and of the lamps those that are switched on.

Strengths are photometric. Programs whose cameras have no exposure show a luminance of 1 as white: for them a file's
lights are divided by the luminance that each is to show white, as in the pictures (`diorama_core.render`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from diorama_core.geometry.sun import daylight
from diorama_core.render.appearance import Surface
from diorama_core.render.lamps import LAMP_LUMENS, WARM, lamp_place
from diorama_core.render.lighting import MEAN_IRRADIANCE
from diorama_core.render.scene_light import SKY_AROUND, WHITE_LUX
from diorama_core.scene.types import Scene, SceneObject

WINDOW_LUX = 2000.0
"""Daylight that falls through a window, in lumens per square metre of it."""
MAIN_LUX = 600.0
"""Illuminance by a room's main light at strength 1: that of a bright room."""
WHITE_NITS = MAIN_LUX / (2.0 * MEAN_IRRADIANCE) / np.pi
"""Luminance that pictures of a photo's room show white, in the units of the main light."""
SUN_LUX = 110_000.0
"""Illuminance by the sun outside the atmosphere, where the time of day is set."""
UNHINDERED = 0.85
"""Share of the light in pictures that furniture and corners do not hold off (.84 and .87 in two rooms)."""
MAIN_SHARE = 0.4
"""Share of a photo's main light at unit exposure: furniture holds a part off, and photographed ones show it.
By it pictures of seven rooms in three.js differ least from ours (9.0 at 1, 7.6 at .4)."""
EVENLY = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / np.sqrt(3)
"""Where four parallel lights come from that together light surfaces of all directions alike, within a fifth."""
DAYLIGHT: tuple[float, float, float] = (0.92, 0.96, 1.0)
"""Linear colour of light from the sky."""


@dataclass(frozen=True, eq=False)
class ExportLight:
    """A light that belongs to an object."""

    kind: Literal["lamp", "window"]
    """A lamp shines to all sides from a point, a window from its face into the room."""
    owner: str
    """Id of the object."""
    T_world: Float[np.ndarray, "4 4"]
    """Rigid; the light shines along its -Z, as the lights of glTF and USD do; +Y is its height, +X its width."""
    lumens: float
    colour: tuple[float, float, float]
    """Linear, its largest component 1."""
    radius_m: float
    """Radius of a lamp's glowing part; 0 for windows."""
    size_m: tuple[float, float] = (0.0, 0.0)
    """Width and height of a window; 0 for lamps."""
    white_nits: float = WHITE_NITS
    """Luminance that a program without exposure should show white in this light."""

    @property
    def candela(self) -> float:
        """Luminous intensity along -Z: of a point to all sides, of a window's face as a Lambertian emitter."""
        return self.lumens / (4 * np.pi if self.kind == "lamp" else np.pi)


def lights_of(
    scene: Scene, objects: Iterable[SceneObject], surfaces: Mapping[str, tuple[Surface, ...]]
) -> tuple[ExportLight, ...]:
    """Lights of the objects that are lamps or windows.

    Args:
        scene: Says where the room is, so that windows shine into it.
        objects: The objects that are shown.
        surfaces: What each looks like, by id, in its shape's frame.
    """
    lights, on = [], scene.light_settings.lamps_on
    for item in objects:
        if item.category in LAMP_LUMENS:
            if on is None or item.id in on:
                lights.append(_lamp(item, surfaces[item.id], WHITE_NITS if on is None else WHITE_LUX / np.pi))
        elif item.category == "window":
            lights.append(_window(scene, item))
    return tuple(lights)


@dataclass(frozen=True, eq=False)
class MainLight:
    """The sun as a person set it, or else the photo's main light, as a light infinitely far away."""

    T_world: Float[np.ndarray, "4 4"]
    """Rigid, in the room's middle; the light shines along its -Z."""
    lux: float
    colour: tuple[float, float, float]
    """Linear, its largest component 1."""

    @property
    def white_nits(self) -> float:
        """As of `ExportLight`: without shadows the sun would blank a room, so it shows white what faces it."""
        return max(WHITE_NITS / MAIN_SHARE, self.lux / np.pi)


@dataclass(frozen=True, eq=False)
class EvenLight:
    """Light from all sides of a room at unit exposure: as points within it, or as parallel lights without shadows."""

    positions: Float[np.ndarray, "n 3"]
    candela: float
    """Intensity of each point."""
    T_world: Float[np.ndarray, "m 4 4"]
    """Of the parallel lights, as of `MainLight`."""
    lux: float
    """Illuminance by each parallel light; pi shows white what faces it."""


def even_irradiance(scene: Scene, others: Iterable[ExportLight] = ()) -> float:
    """Light that reaches a room's walls, floor and ceiling evenly in our pictures; 1 shows white what is white.

    Args:
        scene: With the room.
        others: Lights of its objects. The light that the photo tells holds them already.
    """
    settings = scene.light_settings
    if settings.hour is not None:
        return SKY_AROUND * float(daylight(settings.hour, settings.north_rad).sky.mean())
    directed = 0.0 if scene.light is None else 2.0 * scene.light.strength * MEAN_IRRADIANCE
    received = sum(light.lumens / light.white_nits for light in others) / (np.pi * _room_area(scene))
    return max(MEAN_IRRADIANCE - directed / 4.0 - received, 0.0)


def even_light_of(scene: Scene, others: Iterable[ExportLight] = ()) -> EvenLight | None:
    """The even part of a room's light; None without a room. Arguments are those of `even_irradiance`."""
    if not scene.architecture.planes:
        return None
    # A point of I candela sends 4 pi I lumens to the walls; what gets pi lux shows white.
    lux = np.pi * UNHINDERED * even_irradiance(scene, others)
    places, total = _spread(_corners(scene)), lux * _room_area(scene) / (4.0 * np.pi)
    return EvenLight(places, total / len(places), np.array([_shining_from(z, scene) for z in EVENLY]), lux)


def _corners(scene: Scene) -> Float[np.ndarray, "k 3"]:
    return np.concatenate([p.polygon for p in scene.architecture.planes])


def _room_area(scene: Scene) -> float:
    """Area of walls, floor and ceiling in square metres, of those that are missing too."""
    corners = _corners(scene)
    try:
        return float(ConvexHull(corners).area)
    except QhullError:  # a floor alone
        width, depth, height = np.ptp(corners, axis=0)
        return float(2 * (width * depth + depth * height + height * width))


def _spread(corners: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, "n 3"]:
    """Points above furniture towards the room's four corners: from its middle what faces a wall would be black."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    return np.array([low + (high - low) * [x, y, 0.6] for x in (0.3, 0.7) for y in (0.3, 0.7)])


def main_light_of(scene: Scene) -> MainLight | None:
    """The sun where a person set the time of day and it is up, else the room's main light where the photo tells one."""
    settings = scene.light_settings
    if settings.hour is not None:
        outside = daylight(settings.hour, settings.north_rad)
        strongest = float(outside.sun.max())
        if strongest <= 0.0:
            return None
        red, green, blue = (float(c) for c in outside.sun / strongest)
        return MainLight(_shining_from(outside.direction, scene), SUN_LUX * strongest, (red, green, blue))
    if scene.light is None or scene.light.strength <= 0.0:
        return None
    T = _shining_from(np.array(scene.light.direction), scene)
    return MainLight(T, MAIN_LUX * scene.light.strength, scene.light.colour)


def _shining_from(z: Float[np.ndarray, "3"], scene: Scene) -> Float[np.ndarray, "4 4"]:
    across = np.cross([0.0, 1.0, 0.0] if abs(z[1]) < 0.9 else [1.0, 0.0, 0.0], z)
    T = np.eye(4)
    T[:3, 2], T[:3, 0] = z, across / np.linalg.norm(across)
    T[:3, 1] = np.cross(T[:3, 2], T[:3, 0])
    T[:3, 3] = _middle(scene)
    return T


def _lamp(item: SceneObject, surfaces: tuple[Surface, ...], white_nits: float) -> ExportLight:
    T = np.eye(4)
    T[:3, 3], radius = lamp_place(item, surfaces)
    return ExportLight("lamp", item.id, T, LAMP_LUMENS[item.category], WARM, radius, white_nits=white_nits)


def _window(scene: Scene, item: SceneObject) -> ExportLight:
    """A rectangle just in front of the window's face that looks into the room."""
    depth, width, height = (float(v) for v in item.size_m)
    R = item.pose.R_world_object
    inward = R[:, 0] if (_middle(scene) - item.pose.position) @ R[:, 0] >= 0 else -R[:, 0]
    T = np.eye(4)
    T[:3, 2], T[:3, 1] = -inward, R[:, 2]
    T[:3, 0] = np.cross(T[:3, 1], T[:3, 2])
    T[:3, 3] = item.pose.position + inward * (depth / 2 + 0.01)
    settings = scene.light_settings
    share = 1.0 if settings.hour is None else float(daylight(settings.hour, settings.north_rad).sky.max())
    return ExportLight("window", item.id, T, share * WINDOW_LUX * width * height, DAYLIGHT, 0.0, (width, height))


def _middle(scene: Scene) -> Float[np.ndarray, "3"]:
    if scene.architecture.planes:
        corners = _corners(scene)
        return (corners.min(axis=0) + corners.max(axis=0)) / 2
    return np.zeros(3) if scene.camera is None else scene.camera.position
