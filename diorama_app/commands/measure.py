"""Measure between two clicked points, and rescale everything by a length that is known."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_app.reconstruction.camera_correction import rescale_room
from diorama_app.session.client import Client, Measuring
from diorama_app.session.units import format_length
from diorama_core.errors import EditRefused
from diorama_core.geometry.casting import cast_box, cast_planes
from diorama_core.scene.types import Scene


def point_under(
    scene: Scene, origin: Float[np.ndarray, "3"], direction: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "3"] | None:
    """The nearest point of the room or of an object's box on a ray; planes seen from behind are passed through."""
    facing = tuple(p for p in scene.architecture.planes if float(p.normal @ direction) < 0)
    distances = [float(cast_planes(origin, direction[None], facing)[0][0])] if facing else []
    for item in scene.objects:
        if not item.hidden:
            pose = item.pose
            distance, _ = cast_box(origin, direction[None], pose.R_world_object, pose.position, item.size_m)
            distances.append(float(distance[0]))
    nearest = min(distances, default=np.inf)
    return origin + nearest * direction if np.isfinite(nearest) else None


def start_measuring(client: Client) -> None:
    """The next two clicks in the view are the ends of a length."""
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
    length = measured_m(client.doing)
    client.view.show_measure(points, "" if length is None else format_length(length, client.preferences.unit))
    client.refresh()


def measured_m(doing: object) -> float | None:
    """The length between the two clicked points; None before there are two."""
    if not isinstance(doing, Measuring) or len(doing.points) < 2:
        return None
    return float(np.linalg.norm(np.subtract(doing.points[1], doing.points[0])))


def rescale_measured(client: Client, length_true_m: float) -> None:
    """Scale everything so that what was measured has this length."""
    now = measured_m(client.doing)
    if now is None:
        raise EditRefused("click two points in the view first, then type the distance between them")
    shown = format_length(length_true_m, client.preferences.unit)
    rescale_room(client, f"rescale: {format_length(now, client.preferences.unit)} is {shown}", now, length_true_m)
    stop_measuring(client)
    client.session.view.show_whole_room()
    client.session.refresh()


def stop_measuring(client: Client) -> None:
    """End measuring."""
    if isinstance(client.doing, Measuring):
        client.doing = None
    client.view.show_measure((), "")
