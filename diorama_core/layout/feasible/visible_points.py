"""Points of every object that the camera sees of the observed layout: where they are in the picture should stay.

The bounds of an object in the picture say little where its ends are hidden, and the corners of its box are where
nothing was seen. The points of its surface that are seen, evenly spread over the picture, weigh an error as it does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import linear_sum_assignment

from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.settings import LAYOUT, LayoutSettings
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene.types import Camera, Scene, box_corners

VisiblePoints = Mapping[str, Float[np.ndarray, "_ 3"]]
"""By object id, points in the object's frame at scale 1."""


@dataclass(frozen=True, eq=False)
class TrackedPoints:
    """Points of one object and where the camera saw them.

    None where its middle is behind the camera, or it reaches there and nothing of its surface is seen.
    """

    points: Float[np.ndarray, "m 3"]
    """Object frame, scale 1."""
    pixels: Float[np.ndarray, "m 2"]
    depth_m: Float[np.ndarray, " m"]
    """Along the viewing axis."""
    seen: bool
    """Whether they are on the surface that was seen, rather than corners of the box."""


def visible_points(scene: Scene, library: ShapeLibrary, settings: LayoutSettings = LAYOUT) -> VisiblePoints:
    """Points that the scene's camera sees of each object; none of what is hidden or outside the picture."""
    from diorama_core.render.raycast import MeshCaster  # the editor opens without it

    items = [o for o in scene.objects if not o.hidden]
    if not items or scene.camera is None:
        return {}
    k = scene.camera.intrinsics
    shrink = min(1.0, settings.long_side_px / max(k.width, k.height))
    size = max(round(k.width * shrink), 1), max(round(k.height * shrink), 1)
    camera = Camera(k.resize(*size), scene.camera.T_world_camera)
    view = MeshCaster([(library.mesh(o.shape_id), o.pose.matrix) for o in items]).buffers(camera)
    points = {}
    for number, item in enumerate(items):
        rows, columns = np.nonzero(view.instance == number)
        step = max(len(rows) // settings.max_points, 1)
        rows, columns = rows[::step], columns[::step]
        rays = camera.rays(np.column_stack([columns + 0.5, rows + 0.5]))
        world = camera.position + view.depth_m[rows, columns, None].astype(np.float64) * rays
        points[item.id] = ((world - item.pose.position) @ item.pose.R_world_object) / item.pose.scale
    return points


def select_tracked_points(
    problem: Problem,
    camera: Camera,
    posed_px: Float[np.ndarray, "n 4"],
    bounds_px: Float[np.ndarray, "n 4"],
    visible: VisiblePoints,
) -> tuple[TrackedPoints, ...]:
    """The points of every object and where they were seen: as posed.

    Corners stand for objects of which little is seen, where they are in a picture stretched as their bounds are.

    Args:
        problem: the observed layout.
        camera: what looks at it.
        posed_px: bounds of the posed shapes in the picture; NaN for those that reach behind the camera.
        bounds_px: bounds of the objects there.
        visible: points that are seen.
    """
    tracked = []
    for i, name in enumerate(problem.ids):
        points = visible.get(name, np.zeros((0, 3)))
        before = float(camera.to_camera(problem.p[i : i + 1])[0, 2]) >= problem.settings.nearest_m
        seen = before and len(points) >= problem.settings.min_points
        points = points if seen else box_corners(problem.shape_size[i])
        world = problem.p[i] + (points * problem.scale[i]) @ problem.R[i].T
        depth = camera.to_camera(world)[:, 2]
        if depth.min() < problem.settings.nearest_m or not (seen or np.isfinite(posed_px[i]).all()):
            tracked.append(TrackedPoints(np.zeros((0, 3)), np.zeros((0, 2)), np.zeros(0), seen=False))
            continue
        pixels = camera.project(world)
        if not seen:
            stretch = (bounds_px[i, 2:] - bounds_px[i, :2]) / np.maximum(posed_px[i, 2:] - posed_px[i, :2], 1.0)
            pixels = bounds_px[i, :2] + (pixels - posed_px[i, :2]) * stretch
        tracked.append(TrackedPoints(points, pixels, depth, seen))
    return tuple(tracked)


def turn_points(
    points: Float[np.ndarray, "m 3"],
    size: Float[np.ndarray, "3"],
    R_from: Float[np.ndarray, "3 3"],
    R_to: Float[np.ndarray, "3 3"],
) -> Float[np.ndarray, "m 3"]:
    """The points of a turned box that are in the places of those of the box before the turn.

    A mirror that was seen with its back to the room is turned round; what is left in the picture remains left.

    Args:
        points: in the object's frame.
        size: extents of its box there.
        R_from: its rotation before.
        R_to: its rotation after.
    """
    nearest = R_from.T @ R_to
    rows, columns = linear_sum_assignment(-np.abs(nearest))
    share = points / size
    after = np.zeros_like(points)
    after[:, columns] = share[:, rows] * np.sign(nearest[rows, columns])
    return after * size
