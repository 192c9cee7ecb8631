"""Places to look at a room from that show all of it: pure geometry of a box and a field of view."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.scene.types import Scene

DEFAULT_FOV_RAD = np.radians(50.0)
NARROW_FOV_RAD = np.radians(7.0)
"""Field of view along an axis: from far away, lines that are parallel in the room nearly are on the screen."""
USUAL_ASPECT = 0.93
"""Aspect ratio of the 3D view between the panels in a window of 1280 x 720."""
MARGIN = 0.04
"""Share of the view that is left free on every side."""
COVERED = 0.2
"""Share of half the view's height that the tools cover at the top."""


def room_view(scene: Scene, aspect: float = USUAL_ASPECT) -> tuple[Float[np.ndarray, 3], Float[np.ndarray, 3]]:
    """A place above and behind the photo's camera, and the point to look at, that show the whole room."""
    points = _points(scene)
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    back = np.array([-0.45, -1.0, 0.62])
    if scene.camera is not None:
        flat = (scene.camera.position - centre) * (1.0, 1.0, 0.0)
        if np.linalg.norm(flat) > 0.3:
            flat /= np.linalg.norm(flat)
            back = flat + 0.35 * np.array([-flat[1], flat[0], 0.0]) + np.array([0.0, 0.0, 0.62])
    return _far_enough(points, centre, back / np.linalg.norm(back), aspect)


def side_view(
    scene: Scene, back: Float[np.ndarray, 3], aspect: float = USUAL_ASPECT
) -> tuple[Float[np.ndarray, 3], Float[np.ndarray, 3]]:
    """A far place in the direction `back` of the room from which all of it is in a narrow view, and its middle."""
    points = _points(scene)
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    return _far_enough(points, centre, back / np.linalg.norm(back), aspect, float(NARROW_FOV_RAD))


def _far_enough(
    points: Float[np.ndarray, "n 3"],
    centre: Float[np.ndarray, 3],
    back: Float[np.ndarray, 3],
    aspect: float,
    fov_rad: float = float(DEFAULT_FOV_RAD),
) -> tuple[Float[np.ndarray, 3], Float[np.ndarray, 3]]:
    """The nearest place in the direction `back` from which all points are in view, and the point to look at.

    The point is moved across the view until as much is left free on either side; the tools cover a strip at the top.
    """
    right = np.cross(-back, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, -back)
    half = np.tan(fov_rad / 2)
    across, down = half * max(aspect, 0.2) * (1 - MARGIN), half * (1 - MARGIN)
    local = points - centre
    x, y, near = local @ right, local @ up, local @ back
    # In view from the distance d: |x - x0| <= across (d - near), and likewise y.
    left, end = (x - across * near).min(), (x + across * near).max()
    low, high = (y - down * near).min(), (y + (down - COVERED * half) * near).max()
    distance = max((end - left) / (2 * across), (high - low) / (2 * down - COVERED * half), float(near.max()) + 0.3)
    x0 = (left + end) / 2
    y0 = (low + down * distance + high - (down - COVERED * half) * distance) / 2
    target = centre + x0 * right + y0 * up
    return target + back * distance, target


def _points(scene: Scene) -> Float[np.ndarray, "n 3"]:
    """Corners of everything in the room; of two metres of floor when there is nothing."""
    points = [o.corners_world for o in scene.objects] + [p.polygon for p in scene.architecture.planes]
    return np.concatenate(points) if points else np.array([[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]])


def bounds(scene: Scene) -> tuple[Float[np.ndarray, 3], Float[np.ndarray, 3]]:
    """Corners of the box around everything in the room; two metres on the floor when there is nothing."""
    points = _points(scene)
    return points.min(axis=0), points.max(axis=0)
