"""Where cuboids and edges land in a picture, for many at once.

Edges are clipped to the view frustum, and the near plane's cut with them, so that a cuboid that is cut by the
picture's border, or that reaches behind the camera, has exactly the bounds that a person would draw around its
visible part.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from itertools import combinations

import numpy as np
from jaxtyping import Bool, Float, Int, Real

from diorama_core.scene.types import Camera, Intrinsics, Plane, box_corners

NEAR_M = 0.05
"""Depth of the near plane."""
_INSIDE_TOLERANCE = 1e-9
_AT_ONCE = 512
"""Cuboids that are clipped at once: so many stay in the processor's cache."""


def cuboid_corners(
    centres: Float[np.ndarray, "n 3"], yaws_rad: Float[np.ndarray, "n"], sizes_m: Float[np.ndarray, "n 3"]
) -> Float[np.ndarray, "n 8 3"]:
    """Corners of upright cuboids in the world, ordered as `scene.types.box_corners`."""
    local = box_corners((1.0, 1.0, 1.0)) * sizes_m[:, None, :]
    c, s = np.cos(yaws_rad)[:, None], np.sin(yaws_rad)[:, None]
    x, y = local[..., 0], local[..., 1]
    return np.stack([c * x - s * y, s * x + c * y, local[..., 2]], axis=-1) + centres[:, None, :]


def visible_bounds(
    corners_camera: Float[np.ndarray, "n 8 3"], intrinsics: Intrinsics
) -> tuple[Float[np.ndarray, "n 4"], Bool[np.ndarray, "n"]]:
    """Bounds in pixels (x1, y1, x2, y2) of the part of each cuboid that lies inside the picture.

    Returns:
        The bounds, and whether anything is visible. Where nothing is, the bounds are the point of the picture nearest
        to the cuboid's centre.
    """
    points = _stack_by_coordinate(corners_camera)
    slack = frustum_slack(points, intrinsics)
    inside = (slack >= 0).all(axis=(0, 1))
    u, v = _project(points, intrinsics)
    bounds = np.stack([u.min(axis=0), v.min(axis=0), u.max(axis=0), v.max(axis=0)], axis=-1)
    visible = np.ones(len(corners_camera), dtype=bool)
    every = np.flatnonzero(~inside)
    for cut in (every[at : at + _AT_ONCE] for at in range(0, len(every), _AT_ONCE)):
        bounds[cut], visible[cut] = _clip_bounds(corners_camera[cut], slack.take(cut, axis=-1), intrinsics)
    return bounds, visible


def box_iou(a: Real[np.ndarray, "*#n 4"], b: Real[np.ndarray, "*#n 4"]) -> Float[np.ndarray, "*_"]:
    """Intersection over union of boxes x1, y1, x2, y2, element by element (broadcasting)."""
    a, b = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    overlap = np.clip(np.minimum(a[..., 2:], b[..., 2:]) - np.maximum(a[..., :2], b[..., :2]), 0, None).prod(axis=-1)
    union = (a[..., 2:] - a[..., :2]).prod(axis=-1) + (b[..., 2:] - b[..., :2]).prod(axis=-1) - overlap
    return np.asarray(overlap / np.maximum(union, 1e-12))


def _stack_by_coordinate(points: Float[np.ndarray, "n p 3"]) -> Float[np.ndarray, "3 p n"]:
    """Stack points by coordinate, the cuboids side by side in memory: numpy is several times as fast along many."""
    return np.ascontiguousarray(points.transpose(2, 1, 0))


def _project(points: Float[np.ndarray, "3 *n"], k: Intrinsics) -> Float[np.ndarray, "2 *n"]:
    x, y, z = points
    z = np.maximum(z, 1e-9)
    return np.stack([k.fx * x / z + k.cx, k.fy * y / z + k.cy])


def frustum_slack(points: Float[np.ndarray, "3 *n"], k: Intrinsics) -> Float[np.ndarray, "5 *n"]:
    """How far camera-frame points are on the inner side of the near plane and the picture's four side planes.

    The near plane is in metres, the side planes are times the focal length; positive inside.
    """
    x, y, z = points
    return np.stack(
        [
            z - NEAR_M,
            k.fx * x + k.cx * z,
            (k.width - k.cx) * z - k.fx * x,
            k.fy * y + k.cy * z,
            (k.height - k.cy) * z - k.fy * y,
        ]
    )


def _clip_bounds(
    corners: Float[np.ndarray, "n 8 3"], slack: Float[np.ndarray, "5 8 n"], k: Intrinsics
) -> tuple[Float[np.ndarray, "n 4"], Bool[np.ndarray, "n"]]:
    """Bounds of the clipped edges, of the near plane's cut, and of the picture's corners that the cuboid covers."""
    points = _stack_by_coordinate(corners)
    a, b = edges_of_cuboid().T
    low, high = _segment_bounds(points[:, a], points[:, b], slack[:, a], slack[:, b], k)
    outside = slack < 0
    near = slack[0]
    left, right, top, bottom = np.any(outside[1:], axis=1)
    straddling = np.flatnonzero(outside[0].any(axis=0) & (near > 0).any(axis=0))
    if len(straddling):
        cut_low, cut_high = _near_cut_bounds(points.take(straddling, axis=-1), near.take(straddling, axis=-1), k)
        low[:, straddling] = np.minimum(low[:, straddling], cut_low)
        high[:, straddling] = np.maximum(high[:, straddling], cut_high)
    # A corner of the picture is covered only by what reaches beyond both of the sides that meet in it.
    reaching = np.flatnonzero((left | right) & (top | bottom))
    picture = np.array([[0.0, 0.0], [k.width, 0.0], [0.0, k.height], [k.width, k.height]])
    covered = _covers_rays(corners[reaching], (picture - [k.cx, k.cy]) / [k.fx, k.fy]).T
    for corner, at in zip(covered, picture, strict=True):
        over = reaching[corner]
        low[:, over] = np.minimum(low[:, over], at[:, None])
        high[:, over] = np.maximum(high[:, over], at[:, None])
    visible = np.isfinite(low).all(axis=0)
    size = np.array([k.width, k.height])
    nearest = np.clip(_project(corners.mean(axis=1).T, k), 0.0, size[:, None])
    bounds = np.where(visible, np.concatenate([low, high]), np.concatenate([nearest, nearest])).T
    return np.clip(bounds, 0.0, np.tile(size, 2)), visible


def _segment_bounds(
    start: Float[np.ndarray, "3 s n"],
    end: Float[np.ndarray, "3 s n"],
    start_slack: Float[np.ndarray, "5 s n"],
    end_slack: Float[np.ndarray, "5 s n"],
    k: Intrinsics,
) -> tuple[Float[np.ndarray, "2 n"], Float[np.ndarray, "2 n"]]:
    """Least and greatest pixels of the parts of segments inside the frustum; infinite where nothing is."""
    enters, leaves = clip_ends(start_slack, end_slack)
    enter, leave = enters.max(axis=0), leaves.min(axis=0)
    is_visible = np.concatenate([enter <= leave] * 2)
    way = end - start
    pixels = _project(np.concatenate([start + enter * way, start + leave * way], axis=1), k)
    return np.where(is_visible, pixels, np.inf).min(axis=1), np.where(is_visible, pixels, -np.inf).max(axis=1)


def clip_ends(
    start_slack: Float[np.ndarray, "5 s n"], end_slack: Float[np.ndarray, "5 s n"]
) -> tuple[Float[np.ndarray, "5 s n"], Float[np.ndarray, "5 s n"]]:
    """Where segments come in and go out at every plane, as shares of their lengths; entering after it left is out."""
    span = start_slack - end_slack
    crossing = start_slack / np.where(np.abs(span) < 1e-12, 1e-12, span)
    enter = np.where(start_slack < 0, np.where(end_slack < 0, 2.0, crossing), 0.0)
    return enter, np.where(end_slack < 0, np.where(start_slack < 0, -1.0, crossing), 1.0)


def _near_cut_bounds(
    points: Float[np.ndarray, "3 8 n"], near: Float[np.ndarray, "8 n"], k: Intrinsics
) -> tuple[Float[np.ndarray, "2 n"], Float[np.ndarray, "2 n"]]:
    """Bounds of the polygon in which the near plane cuts cuboids: its sides are no edges of the cuboids."""
    a, b = edges_of_cuboid().T
    cut = (near[a] < 0) != (near[b] < 0)
    share = near[a] / np.where(cut, near[a] - near[b], 1.0)
    ends = points[:, a] + share * (points[:, b] - points[:, a])
    slack = frustum_slack(ends, k)
    slack[0] = np.where(cut, 0.0, -1.0)
    first, second = _edge_pairs_of_faces().T
    return _segment_bounds(ends[:, first], ends[:, second], slack[:, first], slack[:, second], k)


def _covers_rays(corners: Float[np.ndarray, "n 8 3"], rays_xy: Float[np.ndarray, "r 2"]) -> Bool[np.ndarray, "n r"]:
    """Whether rays from the camera through (x, y, 1) meet the cuboids in front of the camera (slab test)."""
    axes = np.stack([corners[:, 1], corners[:, 2], corners[:, 4]], axis=1) - corners[:, :1]
    lengths = np.maximum(np.linalg.norm(axes, axis=-1), 1e-9)
    axes = axes / lengths[..., None]
    origin = -np.einsum("nac,nc->na", axes, corners[:, 0])
    directions = np.concatenate([rays_xy, np.ones((len(rays_xy), 1))], axis=1)
    along = np.einsum("nac,rc->nra", axes, directions)
    along = np.where(np.abs(along) < 1e-12, 1e-12, along)
    first = -origin[:, None] / along
    second = (lengths - origin)[:, None] / along
    enter = np.minimum(first, second).max(axis=-1)
    leave = np.maximum(first, second).min(axis=-1)
    return (enter <= leave + _INSIDE_TOLERANCE) & (leave > NEAR_M)


@cache
def edges_of_cuboid() -> Int[np.ndarray, "12 2"]:
    """Pairs of corner indices that differ in one axis."""
    return np.array([(i, i | (1 << axis)) for i in range(8) for axis in range(3) if not i & (1 << axis)])


@cache
def _edge_pairs_of_faces() -> Int[np.ndarray, "36 2"]:
    """Pairs of indices into `edges_of_cuboid`, of edges in one face; a plane's cut through a face joins such a pair."""
    edges = edges_of_cuboid()
    in_face = [((edges >> axis & 1) == side).all(axis=1) for axis in range(3) for side in (0, 1)]
    return np.array([pair for face in in_face for pair in combinations(np.flatnonzero(face), 2)])


def box_edges(corners_world: Float[np.ndarray, "8 3"]) -> Float[np.ndarray, "12 2 3"]:
    """Both ends of a box's edges, of corners in the order of `box_corners`."""
    return corners_world[edges_of_cuboid()]


def plane_edges(plane: Plane) -> Float[np.ndarray, "n 2 3"]:
    """Both ends of the edges of a plane's polygon."""
    return np.stack([plane.polygon, np.roll(plane.polygon, -1, axis=0)], axis=1)


def visible_segments(camera: Camera, edges_world: Iterable[Float[np.ndarray, "_ 2 3"]]) -> Float[np.ndarray, "k 2 2"]:
    """Segments in pixels, cut where they come too near the camera; those all behind it are left out."""
    ends = np.concatenate([np.empty((0, 2, 3)), *edges_world])
    depth = camera.to_camera(ends)[..., 2]
    kept = depth.max(axis=1) > NEAR_M
    ends, depth = ends[kept], depth[kept]
    rows, behind = np.arange(len(ends)), depth.argmin(axis=1)
    low, high = depth[rows, behind], depth[rows, 1 - behind]
    share = np.where(low < NEAR_M, (NEAR_M - low) / np.maximum(high - low, 1e-9), 0.0)
    ends[rows, behind] += share[:, None] * (ends[rows, 1 - behind] - ends[rows, behind])
    return camera.project(ends)
