"""Shapes stretched by structure: legs, frames, boards and handles keep their thickness, only what lies between grows.

Along each axis the shape is cut at the planes between which solid matter is thin: slabs, found from the areas of faces
that face backward and forward along the axis, and narrow bodies such as round legs. Those intervals keep their
thickness, the stretches between them take up the rest (as in non-homogeneous resizing, Kraevoy et al. 2008). Bodies
that are small every way, such as handles and knobs, keep their form and follow what they sit on.

The result is a shape of the same bounding box, to be scaled as before: poses, collisions and files know one scale.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Float, Int
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from diorama_core.library.slots import placed_vertices, transform_of

Scale = tuple[float, float, float]
EVEN: Scale = (1.0, 1.0, 1.0)
STEP, MIN_UNEVEN = 0.1, 0.22
"""Scales are told apart in such steps of their logarithm, from such a difference on: nearly equal ones share."""
THIN = 0.14
"""An interval is thin below this share of the shape's extent."""
SMALL = 0.22
"""A body is small when it is below this share of the extent along every axis."""
MIN_FACE_SHARE = 0.004
"""Of the shape's cross-section: faces of less area together bound nothing."""
BINS = 400
FACING = 0.9
MOST_RIGID = 0.6
"""Of an extent; where more is thin, the thickest intervals are stretched like the rest."""
MIN_SLOPE, MAX_SLOPE = 0.25, 4.0
"""Of what lies between, against an even stretch."""
END = 0.02
"""Intervals that begin within this share of the extent from an end stay at that end."""


@dataclass(frozen=True, eq=False)
class AxisMap:
    """A piecewise linear map of one axis onto itself; both ends stay."""

    knots: Float[np.ndarray, "k"]
    values: Float[np.ndarray, "k"]

    def __call__(self, x: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
        """Where coordinates go."""
        return np.interp(x, self.knots, self.values)

    def slope(self, x: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n"]:
        """How much lengths grow there."""
        k = np.clip(np.searchsorted(self.knots, x, side="right") - 1, 0, len(self.knots) - 2)
        return np.asarray(np.diff(self.values)[k] / np.maximum(np.diff(self.knots)[k], 1e-12))


def relative_scale(scale: Float[np.ndarray, "3"]) -> Scale:
    """What of a scale is not even, in steps; `EVEN` where there is nothing to stretch by structure."""
    uneven = np.log(np.asarray(scale) / np.median(scale))
    if np.abs(uneven).max() < MIN_UNEVEN:
        return EVEN
    x, y, z = (round(float(v), 4) for v in np.exp(np.round(uneven / STEP) * STEP))
    return x, y, z


def stretched_parts(parts: trimesh.Scene, scale: Scale) -> trimesh.Scene:
    """The shape such that scaling it by `scale` keeps thin parts as thick as they were.

    Args:
        parts: The shape; unchanged.
        scale: Relative to an even one (`relative_scale`).
    """
    if scale == EVEN:
        return parts
    names = [str(n) for n, m in parts.geometry.items() if isinstance(m, trimesh.Trimesh) and len(m.faces)]
    whole = trimesh.util.concatenate([_placed(parts, n) for n in names])
    bodies = _bodies(whole)
    maps = [axis_map(whole, bodies, axis, scale[axis]) for axis in range(3)]
    moved = _moved(np.asarray(whole.vertices), bodies, maps, scale, np.ptp(whole.bounds, axis=0))
    scene, start = parts.copy(), 0
    for name in names:
        mesh = scene.geometry[name]
        end = start + len(mesh.vertices)
        placed = placed_vertices(parts, name)
        back = np.linalg.inv(transform_of(parts, name))
        slopes = np.stack([m.slope(placed[:, a]) for a, m in enumerate(maps)], axis=1)
        normals = np.asarray(parts.geometry[name].vertex_normals) / np.maximum(slopes, 1e-6)
        scene.geometry[name] = trimesh.Trimesh(
            trimesh.transform_points(moved[start:end], back),
            mesh.faces,
            vertex_normals=normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12),
            visual=mesh.visual,
            metadata=mesh.metadata,
            process=False,
        )
        start = end
    return scene


def axis_map(whole: trimesh.Trimesh, bodies: Int[np.ndarray, "n"], axis: int, factor: float) -> AxisMap:
    """The map of one axis that keeps thin intervals as thick as they are once it is scaled by `factor`.

    Args:
        whole: The shape.
        bodies: The connected body that each vertex belongs to.
        axis: 0, 1 or 2.
        factor: Scale of that axis.
    """
    low, high = (float(v) for v in whole.bounds[:, axis])
    extent = high - low
    ends = AxisMap(np.array([low, high]), np.array([low, high]))
    if abs(factor - 1.0) < 1e-6 or extent < 1e-6:
        return ends
    intervals = _merged([*_slabs(whole, axis), *_narrow_bodies(whole, bodies, axis)], extent)
    if not intervals:
        return ends
    for keep in (1.0, 0.75, 0.5, 0.25):
        found = _map(intervals, low, high, 1.0 + keep * (1.0 / factor - 1.0))
        if found is not None:
            return found
    return ends


def _map(intervals: list[tuple[float, float]], low: float, high: float, shrink: float) -> AxisMap | None:
    """Intervals made `shrink` times as thick about their outer edge or their middle; None where no room is left."""
    knots, values, near = [low], [low], END * (high - low)
    for left, right in intervals:
        at = low if left - low < near else high if high - right < near else (left + right) / 2
        knots += [left, right]
        values += [at + (left - at) * shrink, at + (right - at) * shrink]
    knots.append(high)
    values.append(high)
    x, y = np.array(knots), np.array(values)
    own = np.diff(x) > 1e-9
    slopes = np.diff(y)[own] / np.diff(x)[own]
    if (np.diff(y) < -1e-12).any() or slopes.min() < MIN_SLOPE or slopes.max() > MAX_SLOPE:
        return None
    retained = np.concatenate([[True], own])
    return AxisMap(x[retained], y[retained])


def _slabs(whole: trimesh.Trimesh, axis: int) -> list[tuple[float, float]]:
    """Thin solid matter between faces that face backward and the next ones that face forward."""
    low, high = whole.bounds[:, axis]
    extents = np.ptp(whole.bounds, axis=0)
    section = float(np.prod(np.delete(extents, axis)))
    normal = whole.face_normals[:, axis]
    at = whole.triangles_center[:, axis]
    bin_of = np.clip(((at - low) / (high - low) * BINS).astype(int), 0, BINS - 1)
    backward, forward = (
        np.bincount(bin_of[side], whole.area_faces[side], minlength=BINS)
        for side in (normal < -FACING, normal > FACING)
    )
    starts = np.flatnonzero(backward > MIN_FACE_SHARE * section)
    ends = np.flatnonzero(forward > MIN_FACE_SHARE * section)
    found = []
    for start in starts:
        after = ends[ends >= start]
        between = starts[(starts > start) & (starts < (after[0] if len(after) else 0))]
        if len(after) and not len(between) and after[0] - start < THIN * BINS:
            left = float(at[(bin_of == start) & (normal < -FACING)].min())
            right = float(at[(bin_of == after[0]) & (normal > FACING)].max())
            found.append((left, right))
    return [(left, right) for left, right in found if right > left]


def _narrow_bodies(whole: trimesh.Trimesh, bodies: Int[np.ndarray, "n"], axis: int) -> list[tuple[float, float]]:
    """Intervals of bodies that are narrow along the axis and long along another: legs, rails, posts."""
    extents = np.maximum(np.ptp(whole.bounds, axis=0), 1e-9)
    low, high = _bounds(np.asarray(whole.vertices), bodies)
    share = (high - low) / extents
    narrow = (share[:, axis] < THIN) & (np.delete(share, axis, axis=1).max(axis=1) >= SMALL)
    return [(float(a), float(b)) for a, b in zip(low[narrow, axis], high[narrow, axis], strict=True)]


def _merged(intervals: list[tuple[float, float]], extent: float) -> list[tuple[float, float]]:
    """Apart from one another, in order; where they would cover too much, thick ones are left out."""
    chosen = sorted(intervals, key=lambda i: i[1] - i[0])
    while chosen:
        joined: list[tuple[float, float]] = []
        for left, right in sorted(chosen):
            if joined and left <= joined[-1][1] + 1e-6:
                joined[-1] = (joined[-1][0], max(joined[-1][1], right))
            else:
                joined.append((left, right))
        thin = [i for i in joined if i[1] - i[0] < 2 * THIN * extent]
        if len(thin) == len(joined) and sum(b - a for a, b in joined) <= MOST_RIGID * extent:
            return joined
        chosen = chosen[:-1]
    return []


def _moved(
    vertices: Float[np.ndarray, "n 3"],
    bodies: Int[np.ndarray, "n"],
    maps: list[AxisMap],
    scale: Scale,
    extents: Float[np.ndarray, "3"],
) -> Float[np.ndarray, "n 3"]:
    moved = np.stack([m(vertices[:, a]) for a, m in enumerate(maps)], axis=1)
    low, high = _bounds(vertices, bodies)
    small = ((high - low) < SMALL * np.maximum(extents, 1e-9)).all(axis=1)
    # Feet carry the rest: they go where the rest goes, or there would be a gap.
    small &= low[:, 2] > vertices[:, 2].min() + END * extents[2]
    centre = (low + high) / 2
    placed = np.stack([m(centre[:, a]) for a, m in enumerate(maps)], axis=1)
    rigid = placed[bodies] + (vertices - centre[bodies]) / np.array(scale)
    inside = np.abs(rigid).max(axis=0) <= np.abs(vertices).max(axis=0) + 1e-9
    return np.where(small[bodies][:, None] & inside, rigid, moved)


def _bodies(whole: trimesh.Trimesh) -> Int[np.ndarray, "n"]:
    """The connected body of every vertex; vertices at one place are one, whatever mesh they belong to."""
    _, place = np.unique(np.round(whole.vertices, 5), axis=0, return_inverse=True)
    place = place.reshape(-1)
    corners = place[whole.faces]
    rows = np.concatenate([corners[:, 0], corners[:, 1]])
    columns = np.concatenate([corners[:, 1], corners[:, 2]])
    count = int(place.max()) + 1
    graph = coo_matrix((np.ones(len(rows), bool), (rows, columns)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1])[place]


def _bounds(
    vertices: Float[np.ndarray, "n 3"], bodies: Int[np.ndarray, "n"]
) -> tuple[Float[np.ndarray, "b 3"], Float[np.ndarray, "b 3"]]:
    count = int(bodies.max()) + 1
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, bodies, vertices)
    np.maximum.at(high, bodies, vertices)
    return low, high


def _placed(parts: trimesh.Scene, name: str) -> trimesh.Trimesh:
    mesh = parts.geometry[name]
    return trimesh.Trimesh(placed_vertices(parts, name), mesh.faces, process=False)
