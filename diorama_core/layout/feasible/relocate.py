"""Sequential relocation: each overlapping object moves to the cheapest collision-free place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.geometry.sat import PairAxes, pair_axes
from diorama_core.layout.escape import exits, ring
from diorama_core.layout.feasible.separate import Program, Separation, overlaps


def relocate(program: Program, y: Float[np.ndarray, " v"]) -> Separation:
    """Remove overlaps by moving the cheaper object of each pair.

    What an object supports goes with it, and so may its own supporters instead of it. Pairs for which nothing within
    reach is free stay as they are.
    """
    depth, pairs = overlaps(program, y)
    refused: set[tuple[int, int]] = set()
    while left := [pair for pair in pairs if pair not in refused]:
        spots = (cheapest_spot(program, y, k, program.problem.settings.reaches_m) for k in _movable(program, left[0]))
        placed = [spot for spot in spots if spot is not None]
        if not placed:
            refused.add(left[0])
            continue
        best = min(placed, key=lambda spot: spot.cost)
        y = best.y
        pairs = tuple(pair for pair in pairs if not (best.moving[pair[0]] or best.moving[pair[1]]))
    return Separation(y, *overlaps(program, y)) if depth > 0 else Separation(y, 0.0, ())


@dataclass(frozen=True, eq=False)
class FreeSpot:
    """A place that is free."""

    cost: float
    y: Float[np.ndarray, " v"]
    moving: Bool[np.ndarray, " n"]


def _movable(program: Program, pair: tuple[int, int]) -> list[int]:
    """Objects whose move changes how a pair stands to one another: the two and what supports only one of them."""
    first, second = (program.problem.chain(k) for k in pair)
    return [k for k in (*first, *second) if (k in first) != (k in second) and program.problem.free[k]]


def cheapest_spot(program: Program, y: Float[np.ndarray, " v"], i: int, reaches_m: Sequence[float]) -> FreeSpot | None:
    """The cheapest place without overlap for an object and what it supports; None where none is within reach.

    Args:
        program: the moves that are possible, and what they cost.
        y: the moves so far.
        i: index of the object.
        reaches_m: looked through in turn until a place is found.
    """
    columns = np.flatnonzero(program.own[i])
    if not len(columns):
        return None
    lever = program.J[i][:, columns]
    directions = ring(program.structure.R[i], lever)
    steps = directions @ np.linalg.pinv(lever).T
    moving = np.abs(program.J[:, :, columns]).max(axis=(1, 2)) > 1e-9
    limit = _limits(program, y, columns, steps)
    farthest = float(limit.max())
    for looked, reach in pairwise((-np.inf, *reaches_m)):
        if looked >= farthest:
            break
        far = _free_distances(program, y, moving, directions, min(reach, farthest))
        tried = y + np.zeros((len(far), 1))
        tried[:, columns] += np.where(np.isfinite(far), far, 0.0)[:, None] * steps
        cost = np.where(far <= np.minimum(limit, reach), program.cost(tried), np.inf)
        best = int(cost.argmin())
        if np.isfinite(cost[best]):
            return FreeSpot(float(cost[best]), tried[best], moving)
    return None


def _limits(program: Program, y: np.ndarray, columns: np.ndarray, steps: Float[np.ndarray, "d c"]) -> np.ndarray:
    """How far each direction can be followed within the hard rows, metres."""
    if not len(program.need):
        return np.full(len(steps), np.inf)
    slack = np.maximum(program.rows @ y - program.need, 0.0)
    closing = -(program.rows[:, columns] @ steps.T)
    return np.asarray(np.where(closing > 1e-9, slack[:, None] / np.maximum(closing, 1e-9), np.inf).min(axis=0) + 1e-7)


def _free_distances(
    program: Program, y: Float[np.ndarray, " v"], moving: np.ndarray, directions: np.ndarray, reach: float
) -> Float[np.ndarray, " d"]:
    """Distances to the first free place along each direction; what is farther than `reach` was not looked at."""
    w = program.moves(y)[program.bodies.owner]
    blocks = _pairs_around(program, w, moving, reach)
    ones, apart_m = [np.ones(len(block.a)) for block in blocks], program.problem.settings.apart_m
    return exits(blocks, [w[block.a] - w[block.b] for block in blocks], ones, directions, apart_m)


def _pairs_around(program: Program, w: Float[np.ndarray, "b 3"], moving: np.ndarray, reach: float) -> list[PairAxes]:
    bodies = program.bodies
    low, high = bodies.low + w, bodies.high + w
    ours = np.flatnonzero(moving[bodies.owner])
    theirs = np.flatnonzero(~moving[bodies.owner])
    near = ((low[ours, None] - reach < high[None, theirs]) & (low[None, theirs] < high[ours, None] + reach)).all(axis=2)
    near &= program.may_meet[np.ix_(ours, theirs)]
    a, b = np.nonzero(near)
    return pair_axes(bodies, ours[a], theirs[b], faces_only=True)
