"""Shapes stretched by structure: legs, frames, boards and handles keep their thickness, only what lies between grows.

Each axis is cut where matter is thin along it (`thin_matter`), whatever meshes and bodies the shape is made of. What is
thin keeps its thickness, the rest takes up the change in proportion (as in non-homogeneous resizing, Kraevoy et al.
2008). Bodies that are small every way, such as handles and knobs, keep their form and follow what they sit on. Sides
along which a part stretches according to the author of its model (`part_notes`) count instead of its thickness.

The result is a shape of the same bounding box, to be scaled as before: poses, collisions and files know one scale.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Float, Int
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.part_notes import notes_of
from diorama_core.library.slots import place_vertices, transform_of
from diorama_core.library.thin_matter import derive_thin_matter

Scale = tuple[float, float, float]
EVEN: Scale = (1.0, 1.0, 1.0)
Span = tuple[float, float, bool]
"""From where to where a part lies along an axis (m), and whether it stretches along it."""
STEP, MIN_UNEVEN = 0.02, 0.15
"""Scales are told apart in such steps of their logarithm, from such a difference on: nearly equal ones share."""
SMALL = 0.22
"""A body is small when it is below this share of the extent along every axis."""
PLIABLE = 0.005
"""How much of a change thin matter takes up against the rest: legs give a little where nothing else is left."""
RIGID = 100.0
"""What keeps its size by its author's word, where thin matter is 1: it gives where everything else does so too."""
MIN_SLOPE, MAX_SLOPE = 0.25, 4.0
"""Slopes of what lies between, against how large it was and against an even stretch."""
_ROUNDS = 60
END = 0.02
"""Bodies that begin within this share of the height from the bottom are feet."""


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


def stretch_parts(parts: trimesh.Scene, scale: Scale) -> trimesh.Scene:
    """The shape such that scaling it by `scale` keeps thin parts as thick as they were.

    Args:
        parts: The shape; unchanged.
        scale: Relative to an even one (`relative_scale`).
    """
    if scale == EVEN:
        return parts
    names = [str(n) for n, m in parts.geometry.items() if isinstance(m, trimesh.Trimesh) and len(m.faces)]
    whole = trimesh.util.concatenate([_place(parts, n) for n in names])
    bodies = _bodies(whole)
    vertices, faces = np.asarray(whole.vertices), np.asarray(whole.faces)
    maps = [axis_map(vertices, faces, axis, scale[axis], _note_spans(parts, names, axis)) for axis in range(3)]
    moved = _move(vertices, bodies, maps, scale, np.ptp(whole.bounds, axis=0))
    scene, start = parts.copy(), 0
    for name in names:
        mesh = scene.geometry[name]
        end = start + len(mesh.vertices)
        placed = place_vertices(parts, name)
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


def _note_spans(parts: trimesh.Scene, names: Sequence[str], axis: int) -> list[Span]:
    """Where bodies of parts with notes lie along an axis; those that keep their size last, since they prevail."""
    spans: list[Span] = []
    for name in names:
        notes = notes_of(parts.geometry[name])
        if notes is not None and notes.stretches is not None:
            mesh = _place(parts, name)
            low, high = _bounds(np.asarray(mesh.vertices), _bodies(mesh))
            spans += [(float(a), float(b), notes.stretches[axis]) for a, b in zip(low[:, axis], high[:, axis])]
    return sorted(spans, key=lambda span: not span[2])


def axis_map(
    vertices: Float[np.ndarray, "n 3"],
    faces: Int[np.ndarray, "m 3"],
    axis: int,
    factor: float,
    noted: Sequence[Span] = (),
) -> AxisMap:
    """The map of one axis that keeps what is thin as thick as it is once it is scaled by `factor`.

    Args:
        vertices: Of the shape.
        faces: Of the shape.
        axis: 0, 1 or 2.
        factor: Scale of that axis.
        noted: what the author says of parts; later ones prevail.
    """
    low, high = float(vertices[:, axis].min()), float(vertices[:, axis].max())
    if abs(factor - 1.0) < 1e-6 or high - low < 1e-6:
        return AxisMap(np.array([low, high]), np.array([low, high]))
    thin = derive_thin_matter(vertices, faces, axis, default_cache_dir() / "thin").copy()
    for start, end, stretches in noted:
        first, last = (np.array([start, end]) - low) / (high - low) * len(thin)
        thin[int(first + 0.5) : max(int(last + 0.5), int(first + 0.5) + 1)] = 0.0 if stretches else RIGID
    grown = local_growth(thin, factor)
    values = np.concatenate([[0.0], np.cumsum(grown)]) / float(grown.sum())
    changes = np.flatnonzero(np.abs(np.diff(grown)) > 1e-9) + 1
    knots = np.concatenate([[0], changes, [len(grown)]])
    return AxisMap(low + (high - low) * knots / len(grown), low + (high - low) * values[knots])


def local_growth(thin: Float[np.ndarray, " bins"], factor: float) -> Float[np.ndarray, " bins"]:
    """By how much each slice grows when the whole grows by `factor`: hardly where matter is thin, the more elsewhere.

    Args:
        thin: 0 to 1 by slice (`thin_matter`), `RIGID` by an author's word.
        factor: Positive.
    """
    least, most = min(1.0, factor) * MIN_SLOPE, max(1.0, factor) * MAX_SLOPE
    gives = 1.0 / (thin + PLIABLE)
    # The growth of the whole rises with what every slice is asked for, so bisection finds it.
    low, high = sorted((0.0, (most if factor > 1.0 else least - 1.0) / float(gives.min())))
    for _ in range(_ROUNDS):
        asked = (low + high) / 2
        whole = float(np.clip(1.0 + asked * gives, least, most).mean())
        low, high = (asked, high) if whole < factor else (low, asked)
    return np.clip(1.0 + (low + high) / 2 * gives, least, most)


def _move(
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


def _place(parts: trimesh.Scene, name: str) -> trimesh.Trimesh:
    mesh = parts.geometry[name]
    return trimesh.Trimesh(place_vertices(parts, name), mesh.faces, process=False)
