"""How far two compounds of convex parts must go to be apart, exactly, along any one direction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.sat import PairAxes
from diorama_core.geometry.vectors import cross


def ring(R: Float[np.ndarray, "3 3"], span: Float[np.ndarray, "3 c"], count: int = 24) -> Float[np.ndarray, "d 3"]:
    """Unit directions in which an object may move, evenly spread from its own axes on.

    They turn with the object, so that a layout does not depend on how the world is turned.

    Args:
        R: rotation of the object.
        span: world directions of its coordinates; one or two of them are independent.
        count: of the directions, where two are independent.
    """
    left, size, _ = np.linalg.svd(span, full_matrices=False)
    plane = left[:, size > 1e-6 * max(float(size[0]), 1e-12)]
    if plane.shape[1] == 0:
        return np.zeros((0, 3))
    if plane.shape[1] == 1:
        return np.stack([plane[:, 0], -plane[:, 0]])
    flat = plane @ (plane.T @ R)
    first = flat[:, int(np.linalg.norm(flat, axis=0).argmax() if np.linalg.norm(flat[:, 0]) < 0.5 else 0)]
    first = first / np.linalg.norm(first)
    second = cross(cross(plane[:, 0], plane[:, 1]), first)
    angles = np.arange(count) * (2 * np.pi / count)
    return np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second)


def exits(
    blocks: Sequence[PairAxes],
    offsets: Sequence[Float[np.ndarray, "_ 3"]],
    signs: Sequence[Float[np.ndarray, " _"]],
    directions: Float[np.ndarray, "d 3"],
    apart_m: float,
) -> Float[np.ndarray, " d"]:
    """Least distance to go along each direction until every pair of parts is apart.

    A convex pair overlaps for one interval of the distance; what is sought is the end of the intervals that follow on
    one another from 0.

    Args:
        blocks: the pairs' separating axes, each block with a number of pairs of its own.
        offsets: for every block, how far a has already moved relative to b in each of its pairs.
        signs: for every block, 1 where a is what goes, -1 where b is.
        directions: unit.
        apart_m: separation asked for.
    """
    lows, highs = [np.zeros((0, len(directions)))], [np.zeros((0, len(directions)))]
    for block, offset, sign in zip(blocks, offsets, signs, strict=True):
        missing = apart_m - block.separations(offset)
        slope = (block.normals @ directions.T) * sign[:, None, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            meets = missing[..., None] / slope
        steep = np.abs(slope) > 1e-9
        always = ~steep & (missing <= 0)[..., None]
        highs.append(np.where(steep & (slope > 0), meets, np.inf).min(axis=1))
        low = np.where(steep & (slope < 0), meets, -np.inf).max(axis=1)
        lows.append(np.where(always.any(axis=1), np.inf, low))
    low, high = np.concatenate(lows), np.concatenate(highs)
    return _first_gaps(low, high)


def _first_gaps(low: Float[np.ndarray, "m d"], high: Float[np.ndarray, "m d"]) -> Float[np.ndarray, " d"]:
    """For every direction the least t >= 0 that is inside none of its open intervals."""
    ahead = (low < high) & (high > 0)
    low, high = np.where(ahead, low, np.inf), np.where(ahead, high, -np.inf)
    order = np.argsort(low, axis=0)
    begins, ends = (np.take_along_axis(side, order, axis=0) for side in (low, high))
    # How far the intervals that begin before the next one reach from 0 on, as long as they follow on one another.
    reached = np.maximum.accumulate(np.concatenate([np.zeros((1, low.shape[1])), ends]), axis=0)
    gaps = np.concatenate([begins >= reached[:-1], np.ones((1, low.shape[1]), bool)])
    return reached[gaps.argmax(axis=0), np.arange(low.shape[1])]
