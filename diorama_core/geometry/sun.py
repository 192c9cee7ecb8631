"""The sun and the sky: where the sun stands at a time of day, the strength and colour of its light and that of the sky,
and the bright patches on floor and walls where it falls through windows.

The day is an equinox at 45 degrees north: the sun rises at six in the east, stands half-way up in the south at noon and
sets at six in the west, so that it shines into windows on every side but the north.

For views that cannot afford shadows. Furniture shades them by the boxes around it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from shapely import convex_hull, unary_union
from shapely.geometry import GeometryCollection, MultiPoint, MultiPolygon, Polygon, box
from shapely.geometry.base import BaseGeometry

from diorama_core.geometry.openings import OPENING_CATEGORIES, wall_of
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.unseen_walls import LightOpening, unseen_parts
from diorama_core.scene.types import Plane, Scene

LATITUDE_RAD = np.radians(45.0)
OPTICAL_DEPTH = np.array([0.10, 0.18, 0.33])
"""Optical depth of the clear atmosphere straight up, for red, green and blue."""
NIGHT_SKY = np.array([0.035, 0.045, 0.075])
"""Light of the sky at night relative to noon: enough to find one's way."""
DAY_SKY = np.array([0.94, 0.97, 1.0])
TWILIGHT_RAD, FULL_DAY_RAD = np.radians(-8.0), np.radians(25.0)
"""Elevations of the sun between which the sky brightens."""


@dataclass(frozen=True, eq=False)
class Daylight:
    """Light from outside, linear; 1 is the sun outside the atmosphere and the sky at noon."""

    direction: Float[np.ndarray, "3"]
    """Unit vector toward the sun in the world."""
    sun: Float[np.ndarray, "3"]
    """Colour of the sun's direct light on what faces it; 0 while it is down."""
    sky: Float[np.ndarray, "3"]


def sun_direction(hour: float, north_rad: float) -> Float[np.ndarray, "3"]:
    """Unit vector toward the sun in the world; below the horizon at night.

    Args:
        hour: local solar time, 0 to 24.
        north_rad: direction of north, counter-clockwise from +X.
    """
    angle = (hour - 12.0) * np.pi / 12.0
    east, north = -np.sin(angle), -np.sin(LATITUDE_RAD) * np.cos(angle)
    up = np.cos(LATITUDE_RAD) * np.cos(angle)
    c, s = np.cos(north_rad), np.sin(north_rad)
    return np.array([north * c + east * s, north * s - east * c, up])


def daylight(hour: float, north_rad: float) -> Daylight:
    """The light from outside at a time of day; arguments as for `sun_direction`."""
    direction = sun_direction(hour, north_rad)
    elevation = float(np.arcsin(np.clip(direction[2], -1.0, 1.0)))
    risen = np.clip((elevation - TWILIGHT_RAD) / (FULL_DAY_RAD - TWILIGHT_RAD), 0.0, 1.0)
    level = risen * risen * (3.0 - 2.0 * risen)
    sky = NIGHT_SKY + level * (DAY_SKY - NIGHT_SKY)
    return Daylight(direction, _direct(elevation), sky)


def _direct(elevation_rad: float) -> Float[np.ndarray, "3"]:
    """What the atmosphere lets through (air mass of Kasten and Young, 1989); 0 below the horizon."""
    if elevation_rad <= 0.0:
        return np.zeros(3)
    degrees = np.degrees(elevation_rad)
    air_mass = 1.0 / (np.sin(elevation_rad) + 0.50572 * (degrees + 6.07995) ** -1.6364)
    return np.exp(-OPTICAL_DEPTH * air_mass)


MIN_AREA_M2 = 0.01
LIFT_M = 0.006
"""Patches lie so far before their plane."""
FRAME_SHARE = 0.06
"""Share of a window's width and height on each side that its frame takes."""
SHADELESS = (*OPENING_CATEGORIES, "rug", "curtain")
"""What lies flat in the sun, or lets it through."""


def sun_patches(scene: Scene, direction: Float[np.ndarray, "3"]) -> list[Float[np.ndarray, "_ 3"]]:
    """Outlines of the sun's patches, counter-clockwise seen from inside the room.

    Args:
        scene: with the windows that let it in; where none is known, through usual ones in the walls nobody saw.
        direction: unit vector toward the sun.
    """
    openings = (*_windows(scene), *unseen_parts(scene).openings)
    lit = [o for o in openings if float(o.normal @ direction) < 0.0]  # the sun is behind the wall
    planes = [p for p in scene.architecture.planes if p.role != "ceiling"]
    patches = []
    for plane in planes:
        through = [o for o in lit if float(o.normal @ plane.normal) < 0.99]
        shade = _shade(scene, direction, plane) if through else None
        for opening in through:
            patches += list(_sunlit_patches(opening.corners, direction, plane, shade))
    return patches


def _windows(scene: Scene) -> Iterable[LightOpening]:
    """What the panes of visible windows leave open in their walls."""
    walls = scene.architecture.by_role("wall")
    for item in scene.objects:
        wall = wall_of(item, walls, scene) if item.category == "window" and not item.hidden else None
        if wall is None:
            continue
        half = (0.5 - FRAME_SHARE) * item.size_m
        R, centre = item.pose.R_world_object, item.pose.position
        corners = [
            centre + R[:, 1] * y * half[1] + R[:, 2] * z * half[2] for y, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        yield LightOpening(np.array(corners), wall.normal)


def _shade(scene: Scene, direction: Float[np.ndarray, "3"], plane: Plane) -> BaseGeometry | None:
    """What furniture keeps the sun from on a plane, in the plane's axes; None where the sun does not meet it."""
    slope = float(plane.normal @ direction)
    if slope <= 1e-3:
        return None
    axes = np.stack(plane_axes(plane.normal), axis=1)
    shadows = []
    for item in scene.objects:
        if item.hidden or item.category in SHADELESS:
            continue
        before = np.maximum(item.corners_world @ plane.normal - plane.offset, 0.0)
        cast = (item.corners_world - (before / slope)[:, None] * direction) @ axes
        shadows.append(convex_hull(MultiPoint(cast)))
    return unary_union(shadows)


def _sunlit_patches(
    opening: Float[np.ndarray, "n 3"], direction: Float[np.ndarray, "3"], plane: Plane, shade: BaseGeometry | None
) -> Iterable[Float[np.ndarray, "_ 3"]]:
    """Parts of a plane that the sun reaches through an opening."""
    slope = float(plane.normal @ direction)
    if slope <= 1e-3:
        return
    travel = (opening @ plane.normal - plane.offset) / slope
    if (travel <= 0.0).any():  # partly behind the plane
        return
    axes = np.stack(plane_axes(plane.normal), axis=1)
    shadow = Polygon((opening - travel[:, None] * direction) @ axes)
    outline = Polygon(plane.polygon @ axes)
    if not (shadow.is_valid and outline.is_valid):
        return
    common = shadow.intersection(outline)
    if shade is not None:
        common = common.difference(shade)
    for part in _without_holes(common):
        if part.area >= MIN_AREA_M2:
            flat = np.array(part.exterior.coords)[:-1]
            if not part.exterior.is_ccw:
                flat = flat[::-1]
            yield flat @ axes.T + (plane.offset + LIFT_M) * plane.normal


def _without_holes(shape: BaseGeometry) -> Iterable[Polygon]:
    """Polygons that cover the same, each with one outline: one with a hole is cut in two through it."""
    if isinstance(shape, MultiPolygon | GeometryCollection):
        for part in shape.geoms:
            yield from _without_holes(part)
    elif isinstance(shape, Polygon) and shape.interiors:
        (left, low, right, high), middle = shape.bounds, shape.interiors[0].centroid.x
        for side in (box(left, low, middle, high), box(middle, low, right, high)):
            yield from _without_holes(shape.intersection(side))
    elif isinstance(shape, Polygon):
        yield shape
