"""Which objects a rectangle on the screen takes in."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.scene.types import Scene


def objects_in(
    scene: Scene,
    low: tuple[float, float],
    high: tuple[float, float],
    R_world_camera: Float[np.ndarray, "3 3"],
    position: Float[np.ndarray, 3],
    fov_rad: float,
    aspect: float,
) -> tuple[str, ...]:
    """Ids of visible objects whose centre projects into the rectangle (0 to 1 from the top left).

    Centres are tested so that a rectangle around a chair does not select the table, and large objects need not fit.

    Args:
        scene: as it is.
        low: upper left corner, 0 to 1.
        high: lower right corner.
        R_world_camera: of the viewer.
        position: of the viewer, world, metres.
        fov_rad: vertical.
        aspect: width over height.
    """
    half = np.tan(fov_rad / 2)
    ids = []
    for item in scene.objects:
        p = R_world_camera.T @ (item.pose.position - position)
        if item.hidden or p[2] <= 1e-3:
            continue
        x, y = 0.5 + p[0] / p[2] / (2 * half * aspect), 0.5 + p[1] / p[2] / (2 * half)
        if low[0] <= x <= high[0] and low[1] <= y <= high[1]:
            ids.append(item.id)
    return tuple(ids)
