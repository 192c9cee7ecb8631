"""Measure between two clicked points, and rescale everything by a length that is known."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_app.reconstruction.camera_correction import rescale_room
from diorama_app.session.client import Client, Measuring
from diorama_app.session.units import format_length
from diorama_app.strings import _
from diorama_core.errors import EditRefused
from diorama_core.geometry.casting import cast_box, cast_planes
from diorama_core.geometry.vectors import unit
from diorama_core.scene.types import Scene

SNAP_RAD = 0.018
"""A click snaps to a corner within this angle of its ray: about twelve pixels of a view."""
HIDDEN_M = 0.1
"""A corner so far behind what is clicked is hidden by it."""


def point_under(
    scene: Scene, origin: Float[np.ndarray, 3], direction: Float[np.ndarray, 3]
) -> Float[np.ndarray, 3] | None:
    """The corner that a ray nearly meets, or else the nearest point of the room or of an object's box on it.

    Planes seen from behind are passed through.
    """
    ahead = unit(direction)
    facing = tuple(p for p in scene.architecture.planes if float(p.normal @ ahead) < 0)
    distances = [float(cast_planes(origin, ahead[None], facing)[0][0])] if facing else []
    corners = [p.polygon for p in facing]
    for item in scene.objects:
        if not item.hidden:
            pose = item.pose
            distance = cast_box(origin, ahead[None], pose.R_world_object, pose.position, item.size_m)[0]
            distances.append(float(distance[0]))
            corners.append(item.corners_world)
    nearest = min(distances, default=np.inf)
    corner = _corner_near(origin, ahead, np.concatenate(corners), nearest) if corners else None
    if corner is None and np.isfinite(nearest):
        return np.asarray(origin + nearest * ahead)
    return corner


def _corner_near(
    origin: Float[np.ndarray, 3], ahead: Float[np.ndarray, 3], corners: Float[np.ndarray, "n 3"], nearest_m: float
) -> Float[np.ndarray, 3] | None:
    """The corner that a ray (of unit length) passes closest by, unless what the ray meets hides it."""
    offsets = corners - origin
    away = np.linalg.norm(offsets, axis=1)
    angles = np.arccos(np.clip(offsets @ ahead / np.maximum(away, 1e-9), -1.0, 1.0))
    angles[away > nearest_m + HIDDEN_M] = np.inf
    closest = int(np.argmin(angles))
    return corners[closest] if angles[closest] < SNAP_RAD else None


def start_measuring(client: Client) -> None:
    """The next two clicks in the view are the ends of a length; near a corner they take the corner."""
    client.doing = Measuring()
    client.view.show_measure((), "")
    client.refresh()


def measure_at(client: Client, doing: Measuring, origin: np.ndarray, direction: np.ndarray) -> None:
    """Take the next end of the length.

    Args:
        client: the browser that asked.
        doing: the ends so far.
        origin: of the ray, world, metres.
        direction: of the ray.
    """
    point = point_under(client.session.scene, origin, direction)
    if point is None:
        raise EditRefused("nothing to measure there; click the room or an object")
    points = (*doing.points, (float(point[0]), float(point[1]), float(point[2])))
    points = points[-1:] if len(points) > 2 else points
    client.doing = Measuring(points)
    length = length_m(client.doing)
    client.view.show_measure(points, "" if length is None else format_length(length, client.preferences.unit))
    client.refresh()


def length_m(doing: object) -> float | None:
    """The length between the two clicked points; None before there are two."""
    if not isinstance(doing, Measuring) or len(doing.points) < 2:
        return None
    return float(np.linalg.norm(np.subtract(doing.points[1], doing.points[0])))


def rescale_measured(client: Client, length_true_m: float) -> None:
    """Scale everything so that what was measured has this length."""
    now = length_m(client.doing)
    if now is None:
        raise EditRefused("click two points in the view first, then type the distance between them")
    measured, shown = (format_length(length, client.preferences.unit) for length in (now, length_true_m))
    rescale_room(client, _("rescale {old} to {new}").format(old=measured, new=shown), now, length_true_m)
    stop_measuring(client)
    client.session.view.show_whole_room()
    client.session.refresh()


def stop_measuring(client: Client) -> None:
    """End measuring."""
    if isinstance(client.doing, Measuring):
        client.doing = None
    client.view.show_measure((), "")
