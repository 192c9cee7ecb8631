"""Bounds of planar pieces as published: smallest rectangles, walls upright, corners joined (Diorama, supplement)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import cv2
import numpy as np
from jaxtyping import Float

from diorama_core.geometry.planes import ransac_plane

PLANE_M, TRIALS = 0.05, 1000
SNAP_M = 0.3
"""Corners of walls nearer to the floor than this are set on it."""
JOIN_M = 0.6
"""Walls are joined where each has two corners within this of their common line; the publication names no bound."""


@dataclass(frozen=True, eq=False)
class PlaneSheet:
    """A rectangle in space, later with moved corners."""

    normal: Float[np.ndarray, "3"]
    """Unit, into the room."""
    offset: float
    corners: Float[np.ndarray, "4 3"]


def fit_sheet(points: Float[np.ndarray, "n 3"], eye: Float[np.ndarray, "3"]) -> PlaneSheet:
    """The plane through most of the points, and the smallest rectangle on it that holds those (rotating calipers)."""
    normal, offset, agree = ransac_plane(points, PLANE_M, trials=TRIALS)
    if float(normal @ eye) < offset:
        normal, offset = -normal, -offset
    axes = _axes(normal)
    flat = (points[agree] @ axes).astype(np.float32)
    corners = cv2.boxPoints(cv2.minAreaRect(flat)).astype(np.float64)
    return PlaneSheet(normal, float(offset), corners @ axes.T + offset * normal)


def upright(wall: PlaneSheet, floor: PlaneSheet) -> PlaneSheet:
    """The wall turned about the line where it meets the floor until it is square to the floor."""
    line = np.cross(floor.normal, wall.normal)
    length = float(np.linalg.norm(line))
    if length < 1e-6:
        return wall
    normal = np.cross(line / length, floor.normal)
    normal = normal if normal @ wall.normal > 0 else -normal
    rows = np.stack([wall.normal, floor.normal, line / length])
    foot = np.linalg.solve(rows, np.array([wall.offset, floor.offset, 0.0]))
    offset = float(normal @ foot)
    return PlaneSheet(normal, offset, wall.corners - (wall.corners @ normal - offset)[:, None] * normal)


def join_walls(floor: PlaneSheet, walls: list[PlaneSheet]) -> list[PlaneSheet]:
    """Walls with feet on the floor and, where two come near their common line, with shared corners on it."""
    heights = [wall.corners @ floor.normal - floor.offset for wall in walls]
    drops = [np.where(np.abs(height) < SNAP_M, height, 0.0)[:, None] * floor.normal for height in heights]
    walls = [replace(wall, corners=wall.corners - drop) for wall, drop in zip(walls, drops, strict=True)]
    for i, j in combinations(range(len(walls)), 2):
        walls[i], walls[j] = _meeting(walls[i], walls[j])
    return walls


def _meeting(a: PlaneSheet, b: PlaneSheet) -> tuple[PlaneSheet, PlaneSheet]:
    """Two walls with their nearest corners on the line where they meet; unchanged when that is out of reach."""
    line = np.cross(a.normal, b.normal)
    length = float(np.linalg.norm(line))
    if length < 0.17:
        return a, b
    line /= length
    point = np.linalg.solve(np.stack([a.normal, b.normal, line]), np.array([a.offset, b.offset, 0.0]))
    first, second = (_nearest_two(s.corners, point, line) for s in (a, b))
    if first is None or second is None:
        return a, b
    corners_a, corners_b = a.corners.copy(), b.corners.copy()
    on_line = point + ((a.corners[first] - point) @ line)[:, None] * line
    along = on_line @ line
    wanted = b.corners[second] @ line
    corners_a[first] = on_line
    # Lower corner to lower corner, upper to upper.
    corners_b[second[np.argsort(wanted)]] = on_line[np.argsort(along)]
    return replace(a, corners=corners_a), replace(b, corners=corners_b)


def _nearest_two(
    corners: Float[np.ndarray, "4 3"], point: Float[np.ndarray, "3"], line: Float[np.ndarray, "3"]
) -> np.ndarray | None:
    offset = corners - point
    distance = np.linalg.norm(offset - (offset @ line)[:, None] * line, axis=1)
    two = np.argsort(distance, kind="stable")[:2]
    return two if distance[two].max() < JOIN_M else None


def counter_clockwise(corners: Float[np.ndarray, "n 3"], normal: Float[np.ndarray, "3"]) -> Float[np.ndarray, "n 3"]:
    """Corners of a polygon in the order in which they are counter-clockwise seen from where its normal points."""
    area = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    return corners if area @ normal > 0 else corners[::-1]


def _axes(normal: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 2"]:
    helper = np.eye(3)[int(np.abs(normal).argmin())]
    u = np.cross(helper, normal)
    u /= np.linalg.norm(u)
    return np.stack([u, np.cross(normal, u)], axis=1)
