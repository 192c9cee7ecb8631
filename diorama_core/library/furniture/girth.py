"""Girth: bodies of revolution made wider and narrower along their height, as on a lathe.

A design that looks the same from all around is known by its profile, and a picture tells the profile of such a thing
whichever side it shows. The profile is changed by factors at equally spaced heights with a smooth curve through them, so
that walls, lips and feet stay what they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float, Int
from scipy.interpolate import PchipInterpolator

from diorama_core.library.furniture.model import Part, Parts, Size
from diorama_core.library.furniture.solids import Solid, unit

NAME = "girth"
"""Of the parameter in ids."""
KNOTS = 13
"""Heights at which the girth is told, from the foot to the top."""
MIN_PERCENT, MAX_PERCENT = 15, 400
_ON_PLANE_M = 1e-6


def girthed(size: Size, *, builder: Callable[..., Parts], girth: Sequence[int], **options: Any) -> Parts:
    """What another builder makes, wider and narrower along its height.

    Args:
        size: As for the other builder.
        builder: Of a body of revolution.
        girth: Percent at `KNOTS` heights.
        options: As for the other builder.
    """
    parts = builder(size, **options)
    points = np.concatenate([p.solid.vertices for p in parts])
    low, high = points.min(axis=0), points.max(axis=0)
    axis_xy, heights = (low + high)[:2] / 2, np.linspace(low[2], high[2], KNOTS)
    curve = PchipInterpolator(heights, np.asarray(girth, dtype=np.float64) / 100.0)
    return [_bent(part, curve, axis_xy, heights[1:-1]) for part in parts]


def _bent(
    part: Part, curve: PchipInterpolator, axis_xy: Float[np.ndarray, "2"], knots: Float[np.ndarray, " k"]
) -> Part:
    """A part with its distance from the axis multiplied by the curve; normals by the inverse transpose of that map.

    It is cut at the knots, so that there is something to bend between two corners of a profile.
    """
    solid = part.solid
    for height in knots:
        solid = cut(solid, float(height))
    z = solid.vertices[:, 2]
    factor, slope = curve(z), curve.derivative()(z)
    away = solid.vertices[:, :2] - axis_xy
    vertices = np.column_stack([axis_xy + away * factor[:, None], z])
    across = solid.normals[:, :2] / factor[:, None]
    normals = np.column_stack([across, solid.normals[:, 2] - slope * (away * across).sum(axis=1)])
    return replace(part, solid=replace(solid, vertices=vertices, normals=unit(normals)))


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
