"""Level 360 degree pictures of empty rooms, every surface in a colour of its own."""

from __future__ import annotations

import io
import json

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image

from diorama_core.geometry.sphere import directions, sphere_pixels

COLOURS = np.array(
    [[226, 221, 208], [156, 174, 192], [214, 226, 176], [192, 156, 178], [171, 195, 169], [229, 214, 199]]
)
FLOOR, CEILING = np.array([120, 84, 60]), np.array([244, 244, 240])
BOX = np.array([[-1.2, -1.8], [2.1, -1.8], [2.1, 1.3], [-1.2, 1.3]])
L_SHAPE = np.array([[-1.2, -1.8], [2.4, -1.8], [2.4, 0.7], [1.0, 0.7], [1.0, 2.2], [-1.2, 2.2]])


def room_sphere(
    outline: Float[np.ndarray, "n 2"], ceiling: float, R: Float[np.ndarray, "3 3"] | None = None, width: int = 1024
) -> UInt8[np.ndarray, "h w 3"]:
    """What is seen from the middle, the floor 1 below and the ceiling above.

    Args:
        outline: of the room, counter-clockwise.
        ceiling: its height above the camera.
        R: from the picture's frame to the room's.
        width: pixels.
    """
    away = directions(width) @ (np.eye(3) if R is None else R).T
    reach, shown = np.full(away.shape[:2], np.inf), np.zeros(away.shape, np.uint8)
    for number, (a, b) in enumerate(zip(outline, np.roll(outline, -1, axis=0), strict=True)):
        along = b - a
        cross = away[..., 0] * along[1] - away[..., 1] * along[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (a[0] * along[1] - a[1] * along[0]) / cross
            s = (a[0] * away[..., 1] - a[1] * away[..., 0]) / cross
        met = (t > 0) & (s >= 0) & (s <= 1) & (t < reach)
        reach[met], shown[met] = t[met], COLOURS[number]
    shown[reach * away[..., 2] > ceiling] = CEILING
    shown[reach * away[..., 2] < -1.0] = FLOOR
    return shown


def sphere_with_wardrobe(height_m: float) -> tuple[bytes, bytes]:
    """A PNG of the box with a wardrobe against a wall, and its box as JSON; the camera is so high above the floor."""
    picture = room_sphere(BOX, 0.85)
    size, centre = np.array([0.6, 1.0, 2.0]), np.array([2.1 * height_m - 0.3, 0.3, 1.0 - height_m])
    corners = centre + size / 2 * np.stack(np.meshgrid([-1, 1], [-1, 1], [-1, 1]), axis=-1).reshape(-1, 3)
    at = sphere_pixels(corners, picture.shape[1])
    x1, y1, x2, y2 = (round(float(v)) for v in (*at.min(axis=0), *at.max(axis=0)))
    picture[y1:y2, x1:x2] = [150, 110, 70]
    encoded = io.BytesIO()
    Image.fromarray(picture).save(encoded, "PNG")
    return encoded.getvalue(), json.dumps([{"bbox": [x1, y1, x2, y2], "class": "wardrobe"}]).encode()
