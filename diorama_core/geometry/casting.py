"""Intersections of rays with bounded planes and oriented boxes. Vectorised over rays."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from diorama_core.geometry.planes import is_in_plane_polygon
from diorama_core.scene.types import Camera, Plane

CONVEX_SLACK_M = 1e-6
"""A corner nearer than this to the line of an edge does not make a polygon concave."""


def pixel_centres(width: int, height: int, step: int = 1) -> Float[np.ndarray, "h w 2"]:
    """Pixel coordinates (x, y) of the centres of every `step`-th pixel, both ways."""
    xs = np.arange(step // 2, width, step) + 0.5
    ys = np.arange(step // 2, height, step) + 0.5
    return np.stack(np.meshgrid(xs, ys), axis=-1)


def convex_edges(plane: Plane) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m"]]:
    """The half-spaces `inward . p >= offset` that bound a convex plane's polygon within the plane."""
    start, end = plane.polygon, np.roll(plane.polygon, -1, axis=0)
    inward = np.cross(plane.normal, end - start)
    lengths = np.linalg.norm(inward, axis=1)
    inward = inward[lengths > 1e-9] / lengths[lengths > 1e-9, None]
    return inward, (inward * start[lengths > 1e-9]).sum(axis=1)


def cast_plane(
    origin: Float[np.ndarray, "3"], directions: Float[np.ndarray, "*n 3"], plane: Plane, slack_m: float = 1e-6
) -> Float[np.ndarray, "*n"]:
    """Distances, in units of each direction's length, at which rays meet a bounded plane; `inf` where they miss.

    Both sides count. `slack_m` widens a convex polygon, so that neighbouring planes leave no gap between them; other
    polygons (an L, a wall with a doorway) are taken as they are.

    Args:
        origin: of all rays, in the world (m).
        directions: of any length, in the world.
        plane: with its outline.
        slack_m: by which a convex outline is widened.
    """
    slope = directions @ plane.normal
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (plane.offset - origin @ plane.normal) / slope
    t = np.where((np.abs(slope) > 1e-9) & (t > 1e-6), t, np.inf)
    reach = np.where(np.isfinite(t), t, 0.0)
    inward, offsets = convex_edges(plane)
    if (plane.polygon @ inward.T >= offsets - CONVEX_SLACK_M).all():
        inside = np.ones(t.shape, dtype=bool)
        for normal, offset in zip(inward, offsets, strict=True):
            inside &= origin @ normal + reach * (directions @ normal) >= offset - slack_m
    else:
        inside = is_in_plane_polygon(origin + reach[..., None] * directions, plane)
    return np.where(inside, t, np.inf)


def cast_planes(
    origin: Float[np.ndarray, "3"],
    directions: Float[np.ndarray, "*n 3"],
    planes: tuple[Plane, ...],
    slack_m: float = 1e-3,
) -> tuple[Float[np.ndarray, "*n"], Int[np.ndarray, "*n"]]:
    """Nearest hit among bounded planes: distance (`inf` where none) and index of the plane (-1 where none).

    Args:
        origin: of all rays, in the world (m).
        directions: of any length, in the world.
        planes: with their outlines.
        slack_m: by which convex outlines are widened.
    """
    nearest = np.full(directions.shape[:-1], np.inf)
    which = np.full(directions.shape[:-1], -1)
    for index, plane in enumerate(planes):
        t = cast_plane(origin, directions, plane, slack_m)
        closer = t < nearest
        nearest = np.where(closer, t, nearest)
        which = np.where(closer, index, which)
    return nearest, which


def cast_box(
    origin: Float[np.ndarray, "3"],
    directions: Float[np.ndarray, "*n 3"],
    R_world_box: Float[np.ndarray, "3 3"],
    centre: Float[np.ndarray, "3"],
    size_m: Float[np.ndarray, "3"],
) -> tuple[Float[np.ndarray, "*n"], Float[np.ndarray, "*n 3"]]:
    """Where rays enter an oriented box (slab method).

    Args:
        origin: of all rays, in the world (m).
        directions: of any length, in the world.
        R_world_box: rotation from the box's axes to the world.
        centre: of the box, in the world (m).
        size_m: of the box, along its own axes.

    Returns:
        Distances in units of each direction's length, `inf` where they miss, and the outward world normals of the
        faces they enter by (zero where they miss). From inside, the exit counts, with its face turned inward.
    """
    o = (origin - centre) @ R_world_box
    d = directions @ R_world_box
    d = np.where(np.abs(d) < 1e-12, 1e-12, d)
    half = 0.5 * np.asarray(size_m)
    low, high = (-half - o) / d, (half - o) / d
    entries, exits = np.minimum(low, high), np.maximum(low, high)
    enter, leave = entries.max(axis=-1), exits.min(axis=-1)
    outside = enter > 1e-6
    hit = (enter <= leave) & (leave > 1e-6)
    axis = np.where(outside, entries.argmax(axis=-1), exits.argmin(axis=-1))
    facing = -np.sign(np.take_along_axis(d, axis[..., None], axis=-1))
    normals = R_world_box.T[axis] * facing
    return np.where(hit, np.where(outside, enter, leave), np.inf), np.where(hit[..., None], normals, 0.0)


def camera_rays(camera: Camera, step: int = 1) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "h w 3"]]:
    """Origin and world directions through the centres of every `step`-th pixel; distances along them are depths."""
    k = camera.intrinsics
    return camera.position, camera.rays(pixel_centres(k.width, k.height, step))
