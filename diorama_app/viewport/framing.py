"""Places to look at a room from that show all of it: pure geometry of a box and a field of view."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.scene.types import Scene, box_corners

DEFAULT_FOV_RAD = np.radians(50.0)
NARROW_FOV_RAD = np.radians(7.0)
"""Of views along an axis: from far away, lines that are parallel in the room nearly are on the screen."""
USUAL_ASPECT = 0.93
"""Of the 3D view between the panels in a window of 1280 x 720."""
AROUND_M = np.array([0.5, 0.5, 0.3])
"""Margin of the room view around the furniture."""


def room_view(scene: Scene, aspect: float = USUAL_ASPECT) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """A place above and behind the photo's camera, and the point to look at, that show all the furniture."""
    low, high = _furnished_bounds(scene)
    centre = (low + high) / 2
    back = np.array([-0.45, -1.0, 0.62])
    if scene.camera is not None:
        flat = (scene.camera.position - centre) * (1.0, 1.0, 0.0)
        if np.linalg.norm(flat) > 0.3:
            flat /= np.linalg.norm(flat)
            back = flat + 0.35 * np.array([-flat[1], flat[0], 0.0]) + np.array([0.0, 0.0, 0.62])
    return _far_enough(low, high, back / np.linalg.norm(back), aspect), centre


def side_view(
    scene: Scene, back: Float[np.ndarray, "3"], aspect: float = USUAL_ASPECT
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """A far place in the direction `back` of the room from which all of it is in a narrow view, and its middle."""
    low, high = bounds(scene)
    return _far_enough(low, high, back / np.linalg.norm(back), aspect, float(NARROW_FOV_RAD)), (low + high) / 2


def _far_enough(
    low: Float[np.ndarray, "3"],
    high: Float[np.ndarray, "3"],
    back: Float[np.ndarray, "3"],
    aspect: float,
    fov_rad: float = float(DEFAULT_FOV_RAD),
) -> Float[np.ndarray, "3"]:
    """The nearest place in the direction `back` of a box's centre from which all of the box is in view."""
    centre = (low + high) / 2
    corners = box_corners(np.maximum(high - low, 0.5))
    right = np.cross(-back, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, -back)
    half = np.tan(fov_rad / 2)
    needed = np.maximum(np.abs(corners @ right) / (half * max(aspect, 0.2)), np.abs(corners @ up) / half)
    return centre + back * float((needed + corners @ back).max()) * 1.04


def _furnished_bounds(scene: Scene) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """The box around what stands in the room and the wall behind it; around the whole room when it is empty."""
    low, high = bounds(scene)
    if not scene.objects:
        return low, high
    corners = np.concatenate([o.corners_world for o in scene.objects])
    inner_low, inner_high = corners.min(axis=0) - AROUND_M, corners.max(axis=0) + AROUND_M
    return np.maximum(low, inner_low), np.minimum(high, inner_high)


def bounds(scene: Scene) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """Corners of the box around everything in the room; two metres on the floor when there is nothing."""
    points = [o.corners_world for o in scene.objects] + [p.polygon for p in scene.architecture.planes]
    if not points:
        return np.array([-1.0, -1.0, 0.0]), np.array([1.0, 1.0, 1.0])
    cloud = np.concatenate(points)
    return cloud.min(axis=0), cloud.max(axis=0)
