"""Solids cut at a height, so that there is something to bend there."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from diorama_core.library.furniture.solids import Solid, unit

_ON_PLANE_M = 1e-6


def cut(solid: Solid, height: float) -> Solid:
    """A solid whose triangles do not cross a height: those that did are split there, nothing else changes."""
    off = solid.vertices[:, 2] - height
    side = np.where(np.abs(off) < _ON_PLANE_M, 0, np.sign(off)).astype(int)[solid.faces]
    crossed = (side.min(axis=1) < 0) & (side.max(axis=1) > 0)
    if not crossed.any():
        return solid
    faces, side = solid.faces[crossed], side[crossed]
    touching = (side == 0).any(axis=1)
    alone = np.where(
        touching, np.argmax(side == 0, axis=1), np.argmax(side == -side.sum(axis=1, keepdims=True), axis=1)
    )
    a, b, c = (faces[np.arange(len(faces)), (alone + k) % 3] for k in range(3))
    split = [_Split(b[touching], c[touching]), _Split(a[~touching], b[~touching]), _Split(a[~touching], c[~touching])]
    starts = np.cumsum([len(solid.vertices), *(len(s.start) for s in split)])
    on_bc, on_ab, on_ac = (start + np.arange(len(s.start)) for start, s in zip(starts[:-1], split, strict=True))
    o, first, second = a[touching], b[touching], c[touching]
    a, b, c = a[~touching], b[~touching], c[~touching]
    pieces = [(o, first, on_bc), (o, on_bc, second), (a, on_ab, on_ac), (on_ab, b, c), (on_ab, c, on_ac)]
    made = np.concatenate([np.stack(piece, axis=1) for piece in pieces])
    return Solid(
        np.concatenate([solid.vertices, *(s.between(solid.vertices, off) for s in split)]),
        np.concatenate([solid.faces[~crossed], made]),
        unit(np.concatenate([solid.normals, *(s.between(solid.normals, off) for s in split)])),
        np.concatenate([solid.uv, *(s.between(solid.uv, off) for s in split)]),
    )


class _Split:
    """Edges that a height crosses."""

    def __init__(self, start: Int[np.ndarray, " e"], end: Int[np.ndarray, " e"]) -> None:
        self.start, self.end = start, end

    def between(self, values: Float[np.ndarray, "v k"], off_m: Float[np.ndarray, " v"]) -> Float[np.ndarray, "e k"]:
        """Values at the crossings, the same from both ends of an edge to the bit."""
        swapped = off_m[self.start] > off_m[self.end]
        low, high = np.where(swapped, self.end, self.start), np.where(swapped, self.start, self.end)
        share = (off_m[low] / (off_m[low] - off_m[high]))[:, None]
        return np.asarray(values[low] + share * (values[high] - values[low]))
