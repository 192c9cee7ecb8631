"""The found room drawn over its photo, to judge it by eye: every plane in its own colour, edges, names."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Int, UInt8

from diorama_core.geometry.casting import camera_rays, cast_planes
from diorama_core.scene.types import Camera, Plane

CAST_SIDE_PX = 640
"""Planes are looked up at no more than this many pixels a side."""
TINT = 0.33
_FLOOR, _CEILING = (64, 190, 90), (110, 120, 245)
_WALLS = ((240, 160, 30), (225, 60, 90), (30, 170, 215), (200, 90, 220), (235, 215, 50), (60, 215, 190))
_UNSURE = 0.3
"""Planes of less confidence than this are guesses, and named so."""


def planes_over_photo(
    photo: UInt8[np.ndarray, "h w 3"], planes: tuple[Plane, ...], camera: Camera
) -> UInt8[np.ndarray, "h w 3"]:
    """The photo with the planes that each pixel would show in the empty room, their edges, names and distances.

    Args:
        photo: The picture the room was made from, at any size.
        planes: The room.
        camera: The photo's camera.
    """
    height, width = photo.shape[:2]
    labels = _labels(planes, camera.resize(width, height))
    colours = np.array([*plane_colours(planes), (90, 90, 90)], dtype=np.float64)
    drawn = (1.0 - TINT) * photo + TINT * colours[labels]
    picture = drawn.astype(np.uint8)
    line = max(1, round(max(height, width) / 500))
    for index in sorted(set(np.unique(labels).tolist()) - {-1}):
        outline, _ = cv2.findContours((labels == index).astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
        cv2.drawContours(picture, outline, -1, (255, 255, 255), line, cv2.LINE_AA)
    for index, plane in enumerate(planes):
        _name(picture, labels == index, plane, camera, line)
    return picture


def plane_colours(planes: tuple[Plane, ...]) -> list[tuple[int, int, int]]:
    """Green for floors, blue for ceilings, and a hue of its own for each wall."""
    colours, wall = [], 0
    for plane in planes:
        if plane.role == "wall":
            colours.append(_WALLS[wall % len(_WALLS)])
            wall += 1
        else:
            colours.append(_FLOOR if plane.role == "floor" else _CEILING)
    return colours


def _labels(planes: tuple[Plane, ...], camera: Camera) -> Int[np.ndarray, "h w"]:
    """Index of the plane in each pixel, -1 where none is."""
    k = camera.intrinsics
    share = min(1.0, CAST_SIDE_PX / max(k.width, k.height))
    small = camera.resize(max(1, round(k.width * share)), max(1, round(k.height * share)))
    origin, rays = camera_rays(small)
    labels = cast_planes(origin, rays, planes)[1]
    full = cv2.resize(labels.astype(np.float32), (k.width, k.height), interpolation=cv2.INTER_NEAREST)
    return full.astype(np.int64)


def _name(picture: UInt8[np.ndarray, "h w 3"], seen: np.ndarray, plane: Plane, camera: Camera, line: int) -> None:
    """A plane's name and distance in the middle of what is seen of it, where there is room for that."""
    room = cv2.distanceTransform(np.pad(seen.astype(np.uint8), 1), cv2.DIST_L2, 5)[1:-1, 1:-1]
    row, column = np.unravel_index(int(room.argmax()), room.shape)
    scale = 0.5 * line
    away = abs(float(camera.position @ plane.normal) - plane.offset)
    text = f"{plane.id} {away:.2f} m" + (" (guess)" if plane.confidence < _UNSURE else "")
    (width, height), _ = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, scale, line)
    if room[row, column] < height:
        return
    left = int(np.clip(column - width / 2, 2, max(2, picture.shape[1] - width - 2)))
    shadow = [((dx, dy), (0, 0, 0)) for dx in (-line, line) for dy in (-line, line)]
    for (dx, dy), colour in (*shadow, ((0, 0), (255, 255, 255))):
        place = (left + dx, int(row + height / 2) + dy)
        cv2.putText(picture, text, place, cv2.FONT_HERSHEY_SIMPLEX, scale, colour, line, cv2.LINE_AA)
