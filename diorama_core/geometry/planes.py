"""Planes: their own axes and texture coordinates, polygons cut by half-spaces, robust fits, grid normals."""

from __future__ import annotations

from math import hypot, sqrt

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.scene.types import Plane


def plane_axes(normal: Float[np.ndarray, "3"]) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """Unit axes (u, v) within a plane of a unit normal, with `u x v = normal`.

    Walls: u runs horizontally to the right as seen from inside the room, v runs up. Floor: u = world +X,
    v = world +Y. Ceiling: u = world +X, v = world -Y (for flat ones; tilted ones are as near to that as can be).
    """
    x, y, z = normal.tolist()  # numbers, not arrays: this is in the layout's inner loop
    steepness = hypot(x, y)
    if steepness >= 0.5:
        u0, u1, u2 = -y / steepness, x / steepness, 0.0
    else:
        length = sqrt(max(1.0 - x * x, 0.5))
        u0, u1, u2 = (1.0 - x * x) / length, 0.0 - x * y / length, 0.0 - x * z / length
    return np.array([u0, u1, u2]), np.array([y * u2 - z * u1, z * u0 - x * u2, x * u1 - y * u0])


def plane_rectangle(plane: Plane) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3 2"], Float[np.ndarray, "2"]]:
    """The rectangle around a plane's polygon, aligned with `plane_axes`.

    Returns:
        Its corner of least u and v (world), the axes as columns (u, v), and its extents along them in metres.
    """
    u, v = plane_axes(plane.normal)
    axes = np.stack([u, v], axis=1)
    flat = plane.polygon @ axes
    low, high = flat.min(axis=0), flat.max(axis=0)
    origin = axes @ low + plane.offset * plane.normal
    return origin, axes, np.maximum(high - low, 1e-9)


def plane_uv(plane: Plane) -> Float[np.ndarray, "n 2"]:
    """Texture coordinates of a plane's corners, 0 to 1 across `plane_rectangle`.

    This is the one definition that renderer, exporter and viewer share. The origin is the picture's bottom-left:
    (0, 0) is least u, least v; row 0 of the picture is v = 1 (OpenGL and trimesh; glTF files flip v when written).
    """
    origin, axes, extents = plane_rectangle(plane)
    return (plane.polygon - origin) @ axes / extents


def clip_polygon(
    polygon: Float[np.ndarray, "n d"], normal: Float[np.ndarray, "d"], offset: float
) -> Float[np.ndarray, "m d"]:
    """The part of a convex polygon where `normal . p >= offset` (Sutherland-Hodgman); empty when none is."""
    side = polygon @ normal - offset
    corners: list[np.ndarray] = []
    for i in range(len(polygon)):
        j = (i + 1) % len(polygon)
        if side[i] >= 0:
            corners.append(polygon[i])
        if (side[i] >= 0) != (side[j] >= 0):
            share = side[i] / (side[i] - side[j])
            corners.append(polygon[i] + share * (polygon[j] - polygon[i]))
    return np.array(corners).reshape(-1, polygon.shape[1])


def fit_plane(points: Float[np.ndarray, "n 3"]) -> tuple[Float[np.ndarray, "3"], float]:
    """Least-squares plane `normal . p = offset` through at least three points; the normal's sign is arbitrary."""
    centre = points.mean(axis=0)
    _, vectors = np.linalg.eigh(np.cov((points - centre).T))
    normal = vectors[:, 0]
    return normal, float(normal @ centre)


def ransac_plane(
    points: Float[np.ndarray, "n 3"], tolerance_m: float, seed: int = 0, trials: int = 256
) -> tuple[Float[np.ndarray, "3"], float, Bool[np.ndarray, "n"]]:
    """The plane that most points agree with, refined on them; all trials are scored at once.

    Args:
        points: At least three.
        tolerance_m: Distance within which a point agrees.
        seed: Of the trials' choice of points.
        trials: How many planes through three points are tried.

    Returns:
        Unit normal (sign arbitrary), offset of `normal . p = offset`, and which points agree.
    """
    rng = np.random.default_rng(seed)
    sample = points if len(points) <= 2000 else points[rng.choice(len(points), 2000, replace=False)]
    picks = sample[rng.integers(0, len(sample), (trials, 3))]
    normals = np.cross(picks[:, 1] - picks[:, 0], picks[:, 2] - picks[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    sound = lengths > 1e-9
    normals = normals[sound] / lengths[sound, None]
    if len(normals) == 0:
        normal, offset = fit_plane(points)
        return normal, offset, np.abs(points @ normal - offset) < tolerance_m
    distances = np.abs(sample @ normals.T - (normals * picks[sound, 0]).sum(axis=1))
    best = int((distances < tolerance_m).sum(axis=0).argmax())
    normal, offset = normals[best], float(normals[best] @ picks[sound][best, 0])
    for _ in range(2):
        inliers = np.abs(points @ normal - offset) < tolerance_m
        if inliers.sum() < 3:
            break
        normal, offset = fit_plane(points[inliers])
    return normal, offset, np.abs(points @ normal - offset) < tolerance_m


def grid_normals(points_camera: Float[np.ndarray, "h w 3"], step: int = 2) -> Float[np.ndarray, "h w 3"]:
    """Normals of a depth map's points, by differences on the image grid; zero where they cannot be told.

    Args:
        points_camera: Points in the camera frame, z = 0 where missing.
        step: Half the span of the differences, pixels.

    Returns:
        Unit normals in the same frame, toward the camera. Differences across a jump in depth give none.
    """
    z = points_camera[..., 2]
    normals = np.zeros_like(points_camera)
    inner = (slice(step, -step), slice(step, -step))
    right, left = points_camera[step:-step, 2 * step :], points_camera[step:-step, : -2 * step]
    below, above = points_camera[2 * step :, step:-step], points_camera[: -2 * step, step:-step]
    cross = np.cross(below - above, right - left)
    lengths = np.linalg.norm(cross, axis=-1, keepdims=True)
    centre = z[inner]
    jump = 0.03 * step * centre
    known = (centre > 0) & (lengths[..., 0] > 1e-12)
    for side in (right, left, below, above):
        known &= (side[..., 2] > 0) & (np.abs(side[..., 2] - centre) < jump)
    unit = cross / np.maximum(lengths, 1e-12)
    away = (unit * points_camera[inner]).sum(axis=-1, keepdims=True) > 0
    normals[inner] = np.where(known[..., None], np.where(away, -unit, unit), 0.0)
    return normals


def is_in_polygon(points: Float[np.ndarray, "*n 2"], outline: Float[np.ndarray, "k 2"]) -> Bool[np.ndarray, "*n"]:
    """True for points within a polygon, convex or not, by the even-odd rule; never within an empty one."""
    x, y = np.moveaxis(points, -1, 0)
    inside = np.zeros(x.shape, dtype=bool)
    for (ax, ay), (bx, by) in zip(outline.tolist(), np.roll(outline, -1, axis=0).tolist(), strict=True):
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) * (bx - ax) / (by - ay))
    return inside


def signed_area(polygon: Float[np.ndarray, "k 2"]) -> float:
    """Area of a polygon, positive for a counter-clockwise one; 0 for fewer than three corners."""
    x, y = polygon[:, 0], polygon[:, 1]
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def is_in_plane_polygon(points: Float[np.ndarray, "*n 3"], plane: Plane) -> Bool[np.ndarray, "*n"]:
    """True for points of a plane in its polygon, convex or not."""
    axes = np.stack(plane_axes(plane.normal), axis=1)
    return is_in_polygon(points @ axes, plane.polygon @ axes)
