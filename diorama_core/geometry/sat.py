"""Separating axes between many pairs of convex bodies at once, for bodies that only translate.

With fixed rotations, two convex bodies are apart exactly when some direction n out of finitely many separates them, and
what the separation along n becomes under translations is linear: gap + n . (move_a - move_b). So the axes are
computed once, and every later question costs one small product.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.geometry.convex import ConvexPart
from diorama_core.geometry.vectors import cross

_DEGENERATE = 1e-6
"""Cross products shorter than this (of unit vectors) give no axis."""
_AT_ONCE = 512
"""Pairs whose axes are found together: bodies of many faces pad only their own block, and memory is bounded."""


@dataclass(frozen=True, eq=False)
class PosedBodies:
    """Convex bodies in the world at their base positions, padded to common sizes."""

    vertices: Float[np.ndarray, "b v 3"]
    """Padded by repeating a vertex."""
    normals: Float[np.ndarray, "b f 3"]
    """Unit, zero where padded."""
    edges: Float[np.ndarray, "b e 3"]
    """Unit, zero where padded."""
    counts: Int[np.ndarray, "b 3"]
    """Counts of vertices, normals and edges, without the padding."""
    owner: Int[np.ndarray, " b"]
    low: Float[np.ndarray, "b 3"]
    high: Float[np.ndarray, "b 3"]


@dataclass(frozen=True, eq=False)
class PairAxes:
    """Signed separating directions of body pairs (a, b)."""

    a: Int[np.ndarray, " m"]
    b: Int[np.ndarray, " m"]
    normals: Float[np.ndarray, "m k 3"]
    gaps: Float[np.ndarray, "m k"]
    """Separation along each direction at the base positions; -inf where there is no axis."""

    def separations(self, move: Float[np.ndarray, "m 3"]) -> Float[np.ndarray, "m k"]:
        """Separations after body a moved by `move` relative to body b; positive somewhere means apart."""
        return self.gaps + np.einsum("mkc,mc->mk", self.normals, move)


@dataclass(frozen=True, eq=False)
class PaddedParts:
    """The parts of several objects in their own frames, padded to common sizes: what `place_bodies` poses."""

    vertices: Float[np.ndarray, "b v 3"]
    normals: Float[np.ndarray, "b f 3"]
    edges: Float[np.ndarray, "b e 3"]
    counts: Int[np.ndarray, "b 3"]
    """Counts of vertices, normals and edges, without the padding."""
    owner: Int[np.ndarray, " b"]

    @cached_property
    def reach(self) -> Float[np.ndarray, "n 3"]:
        """Half extents of a box around each object's centre that contains its parts, at scale 1, its own axes."""
        reach = np.zeros((int(self.owner.max(initial=-1)) + 1, 3))
        np.maximum.at(reach, self.owner, np.abs(self.vertices).max(axis=1, initial=0.0))
        return reach

    def select(self, objects: Bool[np.ndarray, " n"]) -> PaddedParts:
        """The parts of some of the objects."""
        rows = objects[self.owner]
        return PaddedParts(
            self.vertices[rows], self.normals[rows], self.edges[rows], self.counts[rows], self.owner[rows]
        )


def pack_parts(parts: Sequence[Sequence[ConvexPart]]) -> PaddedParts:
    """Pad the parts of objects (one sequence each, none empty) once, for many placements."""
    flat = [part for bodies_of_object in parts for part in bodies_of_object]
    return PaddedParts(
        vertices=_pad([part.vertices for part in flat], repeat=True),
        normals=_pad([part.normals for part in flat]),
        edges=_pad([part.edges for part in flat]),
        counts=np.array([(len(q.vertices), len(q.normals), len(q.edges)) for q in flat], dtype=int).reshape(-1, 3),
        owner=np.array([i for i, bodies_of_object in enumerate(parts) for _ in bodies_of_object], dtype=int),
    )


def place_bodies(
    packed: PaddedParts, R: Float[np.ndarray, "n 3 3"], p: Float[np.ndarray, "n 3"], scale: Float[np.ndarray, "n 3"]
) -> PosedBodies:
    """All parts of all objects, posed.

    Args:
        packed: convex parts in their objects' frames.
        R: rotations from the objects' frames to the world.
        p: centres in the world (m).
        scale: per axis of each object's frame.
    """
    to_world, S = R.transpose(0, 2, 1)[packed.owner], scale[packed.owner][:, None, :]
    world = np.matmul(packed.vertices * S, to_world) + p[packed.owner][:, None, :]
    return PosedBodies(
        vertices=world,
        normals=_unit(np.matmul(packed.normals / S, to_world)),
        edges=_unit(np.matmul(packed.edges * S, to_world)),
        counts=packed.counts,
        owner=packed.owner,
        low=world.min(axis=1),
        high=world.max(axis=1),
    )


def pair_axes(
    bodies: PosedBodies, a: Int[np.ndarray, " m"], b: Int[np.ndarray, " m"], *, faces_only: bool = False
) -> list[PairAxes]:
    """The separating directions of body pairs, in blocks of similar size: boxes first, what has most faces last.

    With `faces_only` those of two edges are left out: far fewer, and what they part is apart for certain, but bodies
    that pass corner to corner count as touching.

    Args:
        bodies: in the world.
        a, b: indices of the two bodies of every pair.
        faces_only: whether directions across two edges are left out.
    """
    most = np.maximum(bodies.counts[a], bodies.counts[b])
    order = np.lexsort((most[:, 0], most[:, 2], most[:, 1]))
    rows = np.split(order, range(_AT_ONCE, len(order), _AT_ONCE)) if len(order) else []
    return [
        _block(bodies, a[of_pair], b[of_pair], most[of_pair].max(axis=0), faces_only=faces_only) for of_pair in rows
    ]


def _block(
    bodies: PosedBodies,
    a: Int[np.ndarray, " m"],
    b: Int[np.ndarray, " m"],
    most: Int[np.ndarray, "3"],
    *,
    faces_only: bool,
) -> PairAxes:
    v, f, e = most
    Va, Vb = bodies.vertices[a, :v], bodies.vertices[b, :v]
    axes = np.concatenate([bodies.normals[a, :f], bodies.normals[b, :f]], axis=1)
    if not faces_only:
        ea, eb = bodies.edges[a, :e], bodies.edges[b, :e]
        crosses = cross(ea[:, :, None, :], eb[:, None, :, :]).reshape(len(a), -1, 3)
        axes = np.concatenate([axes, crosses], axis=1)
    lengths = np.sqrt((axes * axes).sum(axis=2))
    used = lengths > _DEGENERATE
    is_used = used.any(axis=0)
    axes, lengths, used = axes[:, is_used], lengths[:, is_used], used[:, is_used]
    axes = axes / np.where(used, lengths, 1.0)[..., None]
    on_a, on_b = np.matmul(Va, axes.transpose(0, 2, 1)), np.matmul(Vb, axes.transpose(0, 2, 1))
    ahead = np.where(used, on_a.min(axis=1) - on_b.max(axis=1), -np.inf)
    behind = np.where(used, on_b.min(axis=1) - on_a.max(axis=1), -np.inf)
    return PairAxes(a, b, np.concatenate([axes, -axes], axis=1), np.concatenate([ahead, behind], axis=1))


def _pad(arrays: Sequence[np.ndarray], *, repeat: bool = False) -> Float[np.ndarray, "b k 3"]:
    longest = max((len(x) for x in arrays), default=1)
    out = np.zeros((len(arrays), longest, 3))
    for k, x in enumerate(arrays):
        out[k, : len(x)] = x
        if repeat:
            out[k, len(x) :] = x[0]
    return out


def _unit(vectors: np.ndarray) -> np.ndarray:
    lengths = np.sqrt((vectors * vectors).sum(axis=-1, keepdims=True))
    return vectors / np.where(lengths > 1e-12, lengths, 1.0)
