"""Outlines of objects on the floor, many at once: overlap, gaps, containment. Seen from above, in metres."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.geometry.planes import is_in_polygon
from diorama_core.scene.types import SceneObject

Points: TypeAlias = Float[np.ndarray, "n 2"]
Quads: TypeAlias = Float[np.ndarray, "n 4 2"]
Quad: TypeAlias = Float[np.ndarray, "4 2"]
Outline: TypeAlias = Float[np.ndarray, "k 2"]

_UNIT = 0.5 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def footprints(size_m: Float[np.ndarray, "_"], places: Points, yaws_rad: Float[np.ndarray, "n"]) -> Quads:
    """Outlines of a box at places and headings, counter-clockwise; `size_m` begins with its depth and width."""
    return put_at(_UNIT * np.asarray(size_m)[:2], places, yaws_rad)


def put_at(outline: Outline, places: Points, yaws_rad: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n k 2"]:
    """An outline around the origin, turned and put to places."""
    c, s = np.cos(yaws_rad), np.sin(yaws_rad)
    turns = np.stack([np.stack([c, s], axis=-1), np.stack([-s, c], axis=-1)], axis=-2)
    return outline @ turns + places[:, None]


def footprint_of(item: SceneObject) -> Quad:
    """The outline of an object's box, taken as upright."""
    return footprints(item.size_m, item.pose.position[None, :2], np.array([item.pose.yaw_rad]))[0]


def overlapping(quads: Quads, other: Outline, slack_m: float = 1e-4) -> Bool[np.ndarray, "n"]:
    """Which outlines share more than `slack_m` in every direction with another (separating axes)."""
    axes = _normals(other)
    near = np.flatnonzero(~_are_apart(quads @ axes.T, (other @ axes.T)[None], slack_m))
    edges = quads[near, 1:3] - quads[near, 0:2]
    normals = np.stack([edges[..., 1], -edges[..., 0]], axis=-1)
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)
    ours, theirs = np.einsum("nkd,nad->nka", quads[near], normals), np.einsum("kd,nad->nka", other, normals)
    overlap = np.zeros(len(quads), dtype=bool)
    overlap[near] = ~_are_apart(ours, theirs, slack_m)
    return overlap


def _are_apart(
    ours: Float[np.ndarray, "n k a"], theirs: Float[np.ndarray, "#n m a"], slack_m: float
) -> Bool[np.ndarray, "n"]:
    """Which corners, projected on axes, share at most the slack with others along one of them. The outlines come last
    in memory, where numpy is several times as fast.
    """
    a, b = (np.ascontiguousarray(corners.transpose(1, 2, 0)) for corners in (ours, theirs))
    return np.asarray(
        ((a.max(axis=0) <= b.min(axis=0) + slack_m) | (b.max(axis=0) <= a.min(axis=0) + slack_m)).any(axis=0)
    )


def gaps(quads: Quads, other: Outline) -> Float[np.ndarray, "n"]:
    """Free distance between each outline and another; 0 where they overlap."""
    near = np.minimum(
        _to_edges(quads, np.broadcast_to(other, (len(quads), *other.shape))),
        _to_edges(np.broadcast_to(other, (len(quads), *other.shape)), quads),
    )
    return np.where(overlapping(quads, other, 0.0), 0.0, near)


def gap_between(a: SceneObject, b: SceneObject) -> float:
    """Free distance between two objects, seen from above."""
    return float(gaps(footprint_of(a)[None], footprint_of(b))[0])


def lie_within(quads: Quads, outline: Outline, slack_m: float = 0.002) -> Bool[np.ndarray, "n"]:
    """True for outlines inside a room's, convex or not, up to a slack."""
    centre = quads.mean(axis=1, keepdims=True)
    drawn_in = quads + (centre - quads) * slack_m / np.maximum(
        np.linalg.norm(centre - quads, axis=-1, keepdims=True), slack_m
    )
    inside: Bool[np.ndarray, "n"] = np.array(np.asarray(is_in_polygon(drawn_in, outline)).all(axis=1))
    for corner in outline:  # a corner of the room that points into the outline
        inside &= ~_holds(drawn_in, corner)
    return inside


def to_outline(points: Points, outline: Outline) -> Float[np.ndarray, "n"]:
    """Distance of points from the nearest edge of an outline."""
    return _points_to_edges(points[:, None], np.broadcast_to(outline, (len(points), *outline.shape)))[:, 0]


def _holds(quads: Quads, point: Float[np.ndarray, "2"]) -> Bool[np.ndarray, "n"]:
    edges = np.roll(quads, -1, axis=1) - quads
    away = point - quads
    return np.asarray((edges[..., 0] * away[..., 1] - edges[..., 1] * away[..., 0] > 0).all(axis=1))


def _normals(outline: Outline) -> Float[np.ndarray, "k 2"]:
    edges = np.roll(outline, -1, axis=0) - outline
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


def _to_edges(a: Float[np.ndarray, "n p 2"], b: Float[np.ndarray, "n k 2"]) -> Float[np.ndarray, "n"]:
    return _points_to_edges(a, b).min(axis=1)


def _points_to_edges(
    points: Float[np.ndarray, "n p 2"], outline: Float[np.ndarray, "n k 2"]
) -> Float[np.ndarray, "n p"]:
    edge = np.roll(outline, -1, axis=1) - outline
    (x, y), (ex, ey) = np.moveaxis(points[:, :, None] - outline[:, None], -1, 0), np.moveaxis(edge[:, None], -1, 0)
    along = np.clip((x * ex + y * ey) / np.maximum(ex**2 + ey**2, 1e-12), 0.0, 1.0)
    return np.sqrt((x - along * ex) ** 2 + (y - along * ey) ** 2).min(axis=2)
