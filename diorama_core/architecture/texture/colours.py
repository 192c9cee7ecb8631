"""Plain colours of the room's planes, taken from the photo where each plane is seen."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from jaxtyping import Bool, Int, UInt8

from diorama_core.architecture.texture.floor_material import floor_colour, white_level
from diorama_core.artefacts import DetectedObject
from diorama_core.geometry.casting import camera_rays, cast_planes
from diorama_core.scene.types import Camera, Plane, PlaneRole

GRID_PX = 240
MIN_PIXELS = 40
MIN_FREE = 0.2
"""A wall of which less is unhidden in the photo has no colour of its own: what is left is panes, shelves and rims."""
_PLAIN: dict[PlaneRole, tuple[float, float, float]] = {
    "floor": (0.62, 0.56, 0.50),
    "wall": (0.86, 0.85, 0.83),
    "ceiling": (0.93, 0.93, 0.92),
}


def visible_planes(planes: tuple[Plane, ...], camera: Camera, step: int) -> Int[np.ndarray, "hs ws"]:
    """Index of the plane seen by every `step`-th pixel of the empty room; -1 where none is."""
    origin, rays = camera_rays(camera, step)
    return cast_planes(origin, rays, planes)[1]


def object_pixels(shape: tuple[int, int], objects: tuple[DetectedObject, ...]) -> Bool[np.ndarray, "h w"]:
    """Where objects are, with a margin for their shadows and for masks that are a little small."""
    union = np.zeros(shape, np.uint8)
    for detected in objects:
        union |= detected.mask.astype(np.uint8)
    radius = max(2, round(0.008 * max(shape)))
    return cv2.dilate(union, np.ones((2 * radius + 1, 2 * radius + 1), np.uint8)).astype(bool)


def _doubtful(shape: tuple[int, int], objects: tuple[DetectedObject, ...]) -> Bool[np.ndarray, "h w"]:
    """The boxes of objects whose outlines are only a guess: a door's frame may be taken for the wall beside it."""
    within = np.zeros(shape, dtype=bool)
    for detected in objects:
        if detected.mask_confidence < 1.0:
            x1, y1, x2, y2 = (max(round(v), 0) for v in detected.box)
            within[y1:y2, x1:x2] = True
    return within


def colour_planes(
    planes: tuple[Plane, ...], rgb: UInt8[np.ndarray, "h w 3"], camera: Camera, objects: tuple[DetectedObject, ...]
) -> tuple[Plane, ...]:
    """The planes with the colour that most of their visible pixels have.

    A plane that is hardly seen takes the colour of the one of its role that is seen best, else a plain one.

    Args:
        planes: of the room, in the world.
        rgb: the photo, sRGB, eight bits.
        camera: of the photo, in the world.
        objects: with masks of shape (h, w), which hide the planes.
    """
    step = max(1, max(rgb.shape[:2]) // GRID_PX)
    seen = visible_planes(planes, camera, step)
    grid = (slice(step // 2, None, step), slice(step // 2, None, step))
    free = ~object_pixels((rgb.shape[0], rgb.shape[1]), objects)[grid]
    small = rgb[grid]
    white = white_level(rgb)
    sure = free & ~_doubtful((rgb.shape[0], rgb.shape[1]), objects)[grid]

    def colour_mask(index: int, role: PlaneRole) -> Bool[np.ndarray, "hs ws"]:
        is_plane, surely = (seen == index) & free, (seen == index) & sure
        return surely if role != "floor" and surely.sum() >= MIN_PIXELS else is_plane

    colours = [_colour_of(plane.role, small, colour_mask(i, plane.role), white) for i, plane in enumerate(planes)]
    shown = [int((seen == i).sum()) for i in range(len(planes))]
    unhidden = [int(((seen == i) & free).sum()) for i in range(len(planes))]
    by_role: dict[PlaneRole, tuple[float, float, float]] = {}
    for i in sorted(range(len(planes)), key=lambda k: -unhidden[k]):
        if (colour := colours[i]) is not None:
            by_role.setdefault(planes[i].role, colour)
    hidden = [p.role == "wall" and n < MIN_FREE * m for p, n, m in zip(planes, unhidden, shown, strict=True)]
    known_colours = [None if lost else colour for colour, lost in zip(colours, hidden, strict=True)]
    return tuple(
        replace(p, colour=c or by_role.get(p.role, _PLAIN[p.role])) for p, c in zip(planes, known_colours, strict=True)
    )


def _colour_of(
    role: PlaneRole, rgb: UInt8[np.ndarray, "h w 3"], where: Bool[np.ndarray, "h w"], white: float
) -> tuple[float, float, float] | None:
    pixels = rgb[where]
    if len(pixels) < MIN_PIXELS:
        return None
    return floor_colour(pixels, np.argwhere(where).astype(np.float64), white) if role == "floor" else _typical(pixels)


def _typical(pixels: UInt8[np.ndarray, "n 3"]) -> tuple[float, float, float]:
    """Median colour of the half of the pixels nearest to the overall median: robust to objects left in view."""
    values = pixels.astype(np.float64)
    distance = np.abs(values - np.median(values, axis=0)).sum(axis=1)
    core = values[distance <= np.median(distance)]
    red, green, blue = np.median(core, axis=0) / 255.0
    return float(red), float(green), float(blue)
