"""The light of a room: its largest window if it has one, a broad soft light under the ceiling if it has none."""

from __future__ import annotations

import numpy as np

from diorama_core.render.lighting import Lighting
from diorama_core.scene.types import Scene, SceneObject


def room_light(scene: Scene) -> Lighting:
    """Daylight from the largest window with light from the ceiling all around, or lamp light alone."""
    corners = np.concatenate([p.polygon for p in scene.architecture.planes])
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = high - low
    windows = [o for o in scene.objects if o.category == "window"]
    if windows:
        return _daylight(max(windows, key=lambda o: (float(np.prod(o.size_m[1:])), o.id)), size)
    return Lighting(
        window_centre=np.array([*(low + high)[:2] / 2, high[2] - 0.25]),
        window_edges=np.array([[0.22 * size[0], 0.0, 0.0], [0.0, 0.22 * size[1], 0.0]]),
        window_irradiance=np.array([0.85, 0.77, 0.66]),
        reference_m=1.6,
        sky=np.array([0.62, 0.58, 0.52]),
        ground=np.array([0.42, 0.39, 0.35]),
        reach_m=0.5 * float(np.linalg.norm(size[:2])),
    )


def _daylight(window: SceneObject, size: np.ndarray) -> Lighting:
    R = window.pose.R_world_object
    return Lighting(
        window_centre=window.pose.position + R[:, 0] * 0.12,
        window_edges=np.stack([R[:, 1] * window.size_m[1] / 2, R[:, 2] * window.size_m[2] / 2]),
        window_irradiance=np.array([1.3, 1.27, 1.2]),
        reference_m=0.55 * float(np.linalg.norm(size[:2])),
        sky=np.array([0.6, 0.6, 0.59]),
        ground=np.array([0.38, 0.36, 0.34]),
        reach_m=0.55 * float(np.linalg.norm(size[:2])),
        inward=R[:, 0],
    )
