"""Which points of cuboids bound them in a picture, and how the bounds move with the cuboids.

While a cuboid moves a little, each of its four bounds goes with one point: a corner, or where an edge leaves the
picture. The derivative of the bound is that of the point's projection (the envelope theorem), so that nothing is
projected and clipped once more for every unknown.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.geometry.projection import clip_ends, edges_of_cuboid, frustum_normals, frustum_slack
from diorama_core.scene.types import Intrinsics, box_corners

_AT_BORDER_PX = 1e-6


@dataclass(frozen=True, eq=False)
class ExtremePoints:
    """For bounds x1, y1, x2, y2 of every cuboid the point that is seen there."""

    unit: Float[np.ndarray, "3 4 n"]
    """In the cuboid's own frame, its size being 1: -0.5 to 0.5."""
    camera: Float[np.ndarray, "3 4 n"]
    """In the camera frame, metres."""
    edge: Float[np.ndarray, "3 4 n"]
    """The edge along which the point slides as it stays at the picture's side; zero for corners."""
    side: Float[np.ndarray, "3 4 n"]
    """Normal of the frustum's side at which it stays."""
    told: Bool[np.ndarray, "n"]
    """False where nothing is visible, or where the near plane cuts the cuboid: there the points are of no use."""
    fixed: Bool[np.ndarray, "4 n"]
    """Whether the bound is the picture's border and stays there."""

    def slopes(self, moved: Float[np.ndarray, "u 3 4 n"], k: Intrinsics) -> Float[np.ndarray, "u 4 n"]:
        """Derivatives of the bounds in pixels.

        Args:
            moved: Derivatives of the points in the camera frame by every unknown, as if they were fixed to the cuboids.
            k: Of the camera.
        """
        against = (self.side * self.edge).sum(axis=0)
        slides = np.where(against == 0.0, 0.0, 1.0 / np.where(against == 0.0, 1.0, against))
        moved = moved - ((self.side * moved).sum(axis=1) * slides)[:, None] * self.edge
        x, y, z = self.camera
        along_x = k.fx * (moved[:, 0, 0::2] - (x / z)[0::2] * moved[:, 2, 0::2]) / z[0::2]
        along_y = k.fy * (moved[:, 1, 1::2] - (y / z)[1::2] * moved[:, 2, 1::2]) / z[1::2]
        slopes = np.stack([along_x[:, 0], along_y[:, 0], along_x[:, 1], along_y[:, 1]], axis=1)
        return np.where(self.fixed, 0.0, slopes)


def extreme_points(
    corners_camera: Float[np.ndarray, "n 8 3"],
    bounds_px: Float[np.ndarray, "n 4"],
    visible: Bool[np.ndarray, "n"],
    k: Intrinsics,
) -> ExtremePoints:
    """The points that bound cuboids in the picture.

    Args:
        corners_camera: Ordered as `scene.types.box_corners`.
        bounds_px: Their bounds, and
        visible: whether anything of them is seen, both as `projection.visible_bounds` tells.
        k: Of the camera.
    """
    count = len(corners_camera)
    points = np.ascontiguousarray(corners_camera.transpose(2, 1, 0))
    slack = frustum_slack(points, k)
    outside = slack < 0
    cut = np.flatnonzero(outside.any(axis=(0, 1)))
    is_free, fixed = np.ones(count, dtype=bool), np.zeros((4, count), dtype=bool)
    edge, side = np.zeros((3, 4, count)), np.zeros((3, 4, count))
    corner = _extremes(_pixels(points, k), np.ones((8, count), dtype=bool))
    unit = box_corners((1.0, 1.0, 1.0)).T[:, corner]
    camera = np.take_along_axis(points, corner[None], axis=1)
    if len(cut):
        is_free[cut] = visible[cut] & ~outside[0][:, cut].any(axis=0)
        fixed[:, cut] = (np.abs(bounds_px[cut] - [0.0, 0.0, k.width, k.height]) < _AT_BORDER_PX).T
        parts = _cut_points(points[:, :, cut], slack[:, :, cut], k)
        for of_all, of_cut in zip((unit, camera, edge, side), parts, strict=True):
            of_all[:, :, cut] = of_cut
    return ExtremePoints(unit, camera, edge, side, is_free, fixed)


def _cut_points(
    points: Float[np.ndarray, "3 8 m"], slack: Float[np.ndarray, "5 8 m"], k: Intrinsics
) -> tuple[Float[np.ndarray, "3 4 m"], ...]:
    """`unit`, `camera`, `edge` and `side` of cuboids that the picture's sides cut."""
    a, b = edges_of_cuboid().T
    start, way = points[:, a], points[:, b] - points[:, a]
    enter, leave = clip_ends(slack[:, a], slack[:, b])
    at = np.concatenate([enter.max(axis=0), leave.min(axis=0)])
    by = np.concatenate([enter.argmax(axis=0), leave.argmin(axis=0)])
    is_visible = np.tile(enter.max(axis=0) <= leave.min(axis=0), (2, 1))
    ends = np.concatenate([start, start], axis=1) + at * np.concatenate([way, way], axis=1)
    chosen = _extremes(_pixels(ends, k), is_visible)
    of_edge = chosen % len(a)
    share = np.take_along_axis(at, chosen, axis=0)
    box = box_corners((1.0, 1.0, 1.0)).T
    unit = box[:, a[of_edge]] + share * (box[:, b[of_edge]] - box[:, a[of_edge]])
    between = (share > 0.0) & (share < 1.0)
    edge = np.where(between, np.take_along_axis(way, of_edge[None], axis=1), 0.0)
    side = frustum_normals(k).T[:, np.take_along_axis(by, chosen, axis=0)]
    return unit, np.take_along_axis(ends, chosen[None], axis=1), edge, side


def _pixels(points: Float[np.ndarray, "3 p n"], k: Intrinsics) -> Float[np.ndarray, "2 p n"]:
    z = np.maximum(points[2], 1e-9)
    return np.stack([k.fx * points[0] / z, k.fy * points[1] / z])


def _extremes(pixels: Float[np.ndarray, "2 p n"], is_visible: Bool[np.ndarray, "p n"]) -> Int[np.ndarray, "4 n"]:
    """Index of the point at x1, y1, x2 and y2."""
    low = np.where(is_visible, pixels, np.inf).argmin(axis=1)
    high = np.where(is_visible, pixels, -np.inf).argmax(axis=1)
    return np.concatenate([low, high])
