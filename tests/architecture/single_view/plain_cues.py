"""Room cues made by hand: a camera, and only those cues that a test states."""

from __future__ import annotations

import numpy as np

from diorama_core.architecture.single_view.room_cues import EDGE_THRESHOLD, RoomCues
from tests.synthetic_rooms import look

CAMERA = look(0.0, 10.0, 1.5, 70.0, (320, 240))


def cues(**given) -> RoomCues:
    """No lines, neutral edge maps, no objects, unless given."""
    neutral = {
        "camera": CAMERA,
        "directions": np.zeros((0, 3)),
        "ray_axes": np.zeros(0, dtype=int),
        "ray_weights": np.zeros(0),
        "edge_maps": np.full((3, 240, 320), EDGE_THRESHOLD, np.float32),
        "map_scale": 1.0,
        "segment_rays": np.zeros((0, 3)),
        "segment_axes": np.zeros(0, dtype=int),
        "object_low": np.zeros((0, 3)),
        "object_high": np.zeros((0, 3)),
        "object_weights": np.zeros(0),
        "backed_low": np.zeros((0, 3)),
        "backed_high": np.zeros((0, 3)),
        "backed_weights": np.zeros(0),
        "hung_top_m": 0.0,
    }
    neutral["object_portable"] = np.zeros(len(given.get("object_weights", ())), dtype=bool)
    return RoomCues(**(neutral | given))


def drawn_edges(camera, boundaries) -> np.ndarray:
    """Edge maps with a clear response along boundaries of the world: (axis, start, end)."""
    maps = np.zeros((3, camera.intrinsics.height, camera.intrinsics.width), np.float32)
    for axis, start, end in boundaries:
        points = np.array(start) + np.linspace(0.0, 1.0, 4000)[:, None] * (np.array(end) - np.array(start))
        points = points[camera.to_camera(points)[:, 2] > 0.1]
        columns, rows = np.floor(camera.project(points)).astype(int).T
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                x, y = columns + dx, rows + dy
                ok = (x >= 0) & (y >= 0) & (x < maps.shape[2]) & (y < maps.shape[1])
                maps[axis, y[ok], x[ok]] = 1.0
    return maps
