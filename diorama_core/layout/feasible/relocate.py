"""When no axis parts two things, look around: the nearest free spot on the same supporter."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.sat import PairAxes, pair_axes
from diorama_core.layout.feasible.separate import APART_M, Program, Separation, overlaps

_RADII_M = np.array([0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.27, 0.35, 0.45, 0.6])
_DIRECTIONS = 24
_REACHES_M = (0.1, 0.7)
"""Looked through in turn: most find a spot close by, and then only close neighbours were compared."""


def relocate(program: Program, found: Separation) -> Separation:
    """Move stuck objects, lightest first, to the nearest spot where they and what they hold up touch nothing.

    Those for which there is none within reach stay where the rounds left them.
    """
    y = found.y
    for pair in found.stuck:
        if _clear(program, y, pair):
            continue
        for i in sorted(pair, key=lambda k: (_load(program, k), k)):
            spot = _nearest_spot(program, y, i) if program.problem.free[i] else None
            if spot is not None:
                y = spot
                break
    depth, stuck = overlaps(program, y)
    return Separation(y, depth, stuck)


def _load(program: Program, i: int) -> float:
    """How much moves when an object does: the volume of its box and of what it holds up."""
    problem = program.problem
    sizes = problem.shape_size * program.structure.scale
    return float(sum(np.prod(sizes[k]) for k in problem.rides(i)))


def _clear(program: Program, y: np.ndarray, pair: tuple[int, int]) -> bool:
    return pair not in overlaps(program, y)[1]


def _nearest_spot(program: Program, y: Float[np.ndarray, " v"], i: int) -> Float[np.ndarray, " v"] | None:
    own = np.abs(program.J[i]).max(axis=0) > 1e-9
    above = program.problem.parent[i]
    if above >= 0:
        own &= np.abs(program.J[above]).max(axis=0) <= 1e-9
    columns = np.flatnonzero(own)
    if not len(columns):
        return None
    steps = _steps(program.J[i][:, columns])
    tried = y + np.zeros((len(steps), 1))
    tried[:, columns] += steps
    allowed = (
        (tried @ program.rows.T >= program.need - 1e-7).all(axis=1) if len(program.need) else steps[:, 0] > -np.inf
    )
    tried = tried[allowed]
    if not len(tried):
        return None
    moving = np.abs(program.J[:, :, columns]).max(axis=(1, 2)) > 1e-9
    far = np.abs(program.J[moving] @ (tried - y).T).max(axis=(0, 1))
    for reach in _REACHES_M:
        spot = _first_free(program, y, moving, tried[far <= reach], reach)
        if spot is not None:
            return spot
        tried, far = tried[far > reach], far[far > reach]
    return None


def _first_free(
    program: Program, y: np.ndarray, moving: np.ndarray, spots: Float[np.ndarray, "s v"], reach: float
) -> Float[np.ndarray, " v"] | None:
    owner = program.bodies.owner
    blocks = _pairs_around(program, y, moving, reach) if len(spots) else []
    levers = [program.J[owner[block.a]] - program.J[owner[block.b]] for block in blocks]
    for begin in range(0, len(spots), _DIRECTIONS):
        ring = spots[begin : begin + _DIRECTIONS]
        free = np.ones(len(ring), dtype=bool)
        for block, lever in zip(blocks, levers):
            apart = block.gaps[..., None] + block.normals @ (lever @ ring.T)
            free &= (apart.max(axis=1) >= 0.5 * APART_M).all(axis=0)
        if free.any():
            return np.asarray(ring[int(free.argmax())])
    return None


def _steps(lever: Float[np.ndarray, "3 c"]) -> Float[np.ndarray, "s c"]:
    """Steps in the object's coordinates, nearest first."""
    angles = np.arange(_DIRECTIONS) * (2 * np.pi / _DIRECTIONS)
    ring = np.column_stack([np.cos(angles), np.sin(angles)]) if lever.shape[1] == 2 else np.array([[1.0], [-1.0]])
    metric = np.linalg.cholesky(lever.T @ lever + 1e-12 * np.eye(lever.shape[1]))
    unit = np.linalg.solve(metric.T, ring.T).T
    return (_RADII_M[:, None, None] * unit).reshape(-1, lever.shape[1])


def _pairs_around(program: Program, y: Float[np.ndarray, " v"], moving: np.ndarray, reach: float) -> list[PairAxes]:
    bodies, problem = program.bodies, program.problem
    w = program.moves(y)[bodies.owner]
    low, high = bodies.low + w, bodies.high + w
    ours = np.flatnonzero(moving[bodies.owner])
    theirs = np.flatnonzero(~moving[bodies.owner])
    near = ((low[ours, None] - reach < high[None, theirs]) & (low[None, theirs] < high[ours, None] + reach)).all(axis=2)
    near &= ~problem.kin[bodies.owner[ours][:, None], bodies.owner[theirs][None]]
    a, b = np.nonzero(near)
    return pair_axes(bodies, ours[a], theirs[b])
