"""Level 360 degree pictures of empty rooms, every surface in a colour of its own."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, UInt8

from diorama_core.geometry.sphere import directions

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
