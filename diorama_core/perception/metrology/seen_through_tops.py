"""Tops of furniture are opaque: what is seen where a table's top is does not stand on the floor behind the table.

Things in a heap on a table are taken for larger ones on the floor far behind it where nothing but their sizes tells the
two apart. On the floor they would be seen through the top.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.perception.metrology.problem import Cuboids, View
from diorama_core.perception.metrology.settings import SETTINGS, BoxObservationSettings


def seen_through_top(
    box_px: Float[np.ndarray, "4"],
    standing: Cuboids,
    carrier: Cuboids,
    height_m: float,
    view: View,
    settings: BoxObservationSettings = SETTINGS.observed,
) -> float:
    """Share of the lower end of a thing on the floor that would be seen through the top of another, 0 to 1.

    Args:
        box_px: Of the thing in the picture.
        standing: Where it would stand; one cuboid.
        carrier: What has the top; one cuboid.
        height_m: Of the camera above the floor.
        view: How the camera is held.
    """
    drop = float(carrier.top_m[0]) - height_m
    x1, y1, x2, y2 = box_px
    k, across = (
        view.intrinsics,
        (x1 + x2) / 2 + 0.5 * settings.middle * (x2 - x1) * np.linspace(-1.0, 1.0, settings.samples),
    )
    pixels = np.stack(
        [(across - k.cx) / k.fx, np.full(settings.samples, (y2 - settings.lower * (y2 - y1) - k.cy) / k.fy)], axis=-1
    )
    rays = np.column_stack([pixels, np.ones(settings.samples)]) @ view.R_world_camera.T
    down = rays[:, 2] * np.sign(drop) > 1e-6
    met = (drop / np.where(down, rays[:, 2], 1.0))[:, None] * rays[:, :2]
    nearest = float(np.linalg.norm(standing.centre[0, :2])) - 0.5 * float(standing.size_m[0, :2].max())
    c, s = np.cos(carrier.yaw_rad[0]), np.sin(carrier.yaw_rad[0])
    off = (met - carrier.centre[0, :2]) @ np.array([[c, -s], [s, c]])
    on_top = (np.abs(off) <= carrier.size_m[0, :2] / 2).all(axis=1)
    return float((down & on_top & (drop < 0) & (np.linalg.norm(met, axis=1) < nearest)).mean())
