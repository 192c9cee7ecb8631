"""Taking collisions away: a sequence of least-distance programs over convex parts.

Rotations are fixed by then, so "apart along this axis" is an exact linear inequality in the free coordinates. Each
round picks, for every pair of parts that touch, the axis along which the smallest move of anything that can move
parts them, and solves for the least total move under all rows chosen so far; pairs that turn out stuck try their
next axis.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.planes import in_polygon
from diorama_core.geometry.sat import Bodies, PairAxes, pair_axes, place_bodies
from diorama_core.layout.feasible.quadratic import HARD, SOFT, least_distance
from diorama_core.layout.feasible.structure import Structure
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.problem.supports import plane_surface

APART_M = 5e-4
"""Separation asked for once two parts touched."""
TOUCHING_M = 1e-4
"""Parts nearer than this (or overlapping) count as touching."""
_REACH_M = 0.02
"""Pairs of parts nearer than this are watched."""


@dataclass(eq=False)
class Program:
    """The moves that are possible and the rows that bound them, in whitened coordinates y."""

    problem: Problem
    structure: Structure
    bodies: Bodies
    J: Float[np.ndarray, "n 3 v"]
    """World move of object i: w_i = J_i @ y."""
    rows: Float[np.ndarray, "m v"]
    """Hard rows: rows @ y >= need."""
    need: Float[np.ndarray, " m"]
    watched: dict[tuple[int, int], int] = field(default_factory=dict)
    """Part pairs whose axes are known: (a, b) -> running number."""
    blocks: list[PairAxes] = field(default_factory=list)
    chosen: dict[tuple[int, int], tuple[np.ndarray, float]] = field(default_factory=dict)
    """Part pairs that are kept apart: axis and gap at the base positions."""
    tried: dict[tuple[int, int], list[np.ndarray]] = field(default_factory=dict)
    """Axes that turned out to be blocked."""

    def moves(self, y: Float[np.ndarray, " v"]) -> Float[np.ndarray, "n 3"]:
        """World move of every object."""
        return self.J @ y


@dataclass(frozen=True, eq=False)
class Separation:
    """Where the rounds ended."""

    y: Float[np.ndarray, " v"]
    depth_m: float
    """Deepest remaining overlap of parts."""
    stuck: tuple[tuple[int, int], ...]
    """Pairs of objects that still overlap."""


def build_program(problem: Problem, structure: Structure, weight: Float[np.ndarray, "n 2 2"]) -> Program:
    """Variables, hard rows and posed parts.

    Args:
        problem: who may collide with whom.
        structure: the base layout.
        weight: cost of each object's own two coordinates: r^T weight r.
    """
    n = problem.count
    moving = [i for i in range(n) if problem.free[i] and np.abs(structure.basis[i]).max() > 0]
    J, own = np.zeros((n, 3, 2 * len(moving))), np.zeros((n, 3, 2 * len(moving)))
    # r = L^-T y whitens the cost, so the least move is the least |y|.
    whiten = np.linalg.inv(np.linalg.cholesky(weight)).transpose(0, 2, 1)
    for column, i in enumerate(moving):
        lever = structure.basis[i] @ whiten[i]
        J[problem.rides(i), :, 2 * column : 2 * column + 2] = lever
        own[i, :, 2 * column : 2 * column + 2] = lever
    bodies = place_bodies(problem.packed, structure.R, structure.p, structure.scale)
    bound = -np.einsum("bc,bcv->bv", structure.bound_normal, own[structure.bound_owner])
    wall_rows, wall_need = _wall_rows(problem, structure, bodies, J)
    rows, need = np.vstack([bound, wall_rows]), np.concatenate([-structure.bound_slack, wall_need])
    alive = np.linalg.norm(rows, axis=1) > 1e-9
    return Program(problem, structure, bodies, J, rows[alive], need[alive])


def _wall_rows(problem: Problem, structure: Structure, bodies: Bodies, J: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Every object stays in front of the walls it could reach.

    Round the corner of a wall that stands into the room an object is behind that wall's plane and rightly so.
    """
    rows, need = [np.zeros((0, J.shape[2]))], [np.zeros(0)]
    fixed = {(i, w) for i, w, _ in problem.adheres}
    starts = np.searchsorted(bodies.owner, np.arange(problem.count))
    radius = 0.5 * np.linalg.norm(problem.shape_size * structure.scale, axis=1)
    in_room = in_polygon(structure.p[:, :2], problem.floor_outline)
    for w, wall in enumerate(problem.walls if problem.count else ()):
        surface = plane_surface(wall)
        ahead = structure.p @ wall.normal - wall.offset
        beside = (structure.p @ surface.outward.T - surface.offset).max(axis=1)
        reached = problem.free & (beside <= radius) & (ahead >= -radius - 0.5)
        reached &= ~(in_room & (beside > 0) & (ahead < 0))
        reached &= np.array([problem.on_plane[i] != wall.id and (i, w) not in fixed for i in range(problem.count)])
        nearest = np.minimum.reduceat((bodies.vertices @ wall.normal).min(axis=1), starts)
        rows.append(np.einsum("c,ncv->nv", wall.normal, J[reached]))
        need.append(wall.offset - nearest[reached])
    return np.vstack(rows), np.concatenate(need)


def separate(program: Program, *, rounds: int, check: Callable[[Float[np.ndarray, " v"], float], None]) -> Separation:
    """Rounds of choosing axes and solving, until nothing overlaps or the rounds are spent.

    Args:
        program: what may move and how.
        rounds: most rounds.
        check: called each round with the moves and the deepest overlap; may raise to cancel.
    """
    y = least_distance(program.rows, program.need, np.full(len(program.need), HARD))
    best: tuple[float, np.ndarray] = (np.inf, y)
    for _ in range(rounds):
        depth, touching = _touching(program, y)
        check(y, depth)
        if depth < best[0]:
            best = (depth, y)
        if not touching:
            return Separation(y, max(depth, 0.0), ())
        for pair, axes in touching.items():
            _choose_axis(program, pair, *axes)
        y = _solve(program)
    depth, _ = _touching(program, y)
    if depth > best[0]:
        depth, y = best
    return Separation(y, *overlaps(program, y))


def overlaps(program: Program, y: Float[np.ndarray, " v"]) -> tuple[float, tuple[tuple[int, int], ...]]:
    """Deepest overlap of parts in metres, and the pairs of objects that touch, after the moves y."""
    depth, touching = _touching(program, y)
    return max(depth, 0.0), tuple(sorted({_owners(program, pair) for pair in touching}))


def _owners(program: Program, pair: tuple[int, int]) -> tuple[int, int]:
    return int(program.bodies.owner[pair[0]]), int(program.bodies.owner[pair[1]])


def _solve(program: Program) -> Float[np.ndarray, " v"]:
    owner, J = program.bodies.owner, program.J
    pairs = np.array(list(program.chosen), dtype=int).reshape(-1, 2)
    axes = np.array([axis for axis, _ in program.chosen.values()])
    gaps = np.array([gap for _, gap in program.chosen.values()])
    rows = np.einsum("mc,mcv->mv", axes, J[owner[pairs[:, 0]]] - J[owner[pairs[:, 1]]])
    compliance = np.concatenate([np.full(len(program.need), HARD), np.full(len(gaps), SOFT)])
    return least_distance(np.vstack([program.rows, rows]), np.concatenate([program.need, APART_M - gaps]), compliance)


def _touching(
    program: Program, y: Float[np.ndarray, " v"]
) -> tuple[float, dict[tuple[int, int], tuple[np.ndarray, np.ndarray]]]:
    """Deepest overlap, and for every touching pair its axes and their gaps at the base positions."""
    w = program.moves(y)
    _watch(program, w)
    deepest, touching = -np.inf, {}
    owner = program.bodies.owner
    for block in program.blocks:
        apart = block.separations(w[owner[block.a]] - w[owner[block.b]]).max(axis=1)
        deepest = max(deepest, float(-apart.min()))
        for k in np.flatnonzero(apart < TOUCHING_M):
            touching[int(block.a[k]), int(block.b[k])] = (block.normals[k], block.gaps[k])
    return deepest, touching


def _watch(program: Program, w: Float[np.ndarray, "n 3"]) -> None:
    """Learn the axes of part pairs that have come near each other."""
    fresh = np.array([p for p in _near_parts(program, w) if p not in program.watched], dtype=int).reshape(-1, 2)
    if len(fresh):
        program.watched.update({(int(a), int(b)): len(program.watched) for a, b in fresh})
        program.blocks.extend(pair_axes(program.bodies, fresh[:, 0], fresh[:, 1]))


def _near_parts(program: Program, w: Float[np.ndarray, "n 3"]) -> list[tuple[int, int]]:
    bodies, problem = program.bodies, program.problem
    low, high = bodies.low + w[bodies.owner] - _REACH_M / 2, bodies.high + w[bodies.owner] + _REACH_M / 2
    starts = np.searchsorted(bodies.owner, np.arange(problem.count))
    if not problem.count:
        return []
    object_low, object_high = np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)
    near = ((object_low[:, None] <= object_high[None]) & (object_low[None] <= object_high[:, None])).all(axis=2)
    near &= ~problem.kin & (problem.free[:, None] | problem.free[None])
    ends = np.append(starts[1:], len(bodies.owner))
    found = []
    for i, j in zip(*np.nonzero(np.triu(near, 1))):
        a, b = slice(starts[i], ends[i]), slice(starts[j], ends[j])
        meet = ((low[a, None] <= high[None, b]) & (low[None, b] <= high[a, None])).all(axis=2)
        found += [(int(starts[i] + k), int(starts[j] + m)) for k, m in zip(*np.nonzero(meet))]
    return found


def _choose_axis(program: Program, pair: tuple[int, int], normals: np.ndarray, gaps: np.ndarray) -> None:
    """The axis along which the least move parts a pair, leaving out those that turned out blocked."""
    i, j = _owners(program, pair)
    lever = program.J[i] - program.J[j]
    mobility = np.linalg.norm(normals @ lever, axis=1)
    effort = np.where(mobility > 1e-3, (APART_M - gaps) / np.maximum(mobility, 1e-3), np.inf)
    previous = program.chosen.get(pair)
    if previous is not None:
        program.tried.setdefault(pair, []).append(previous[0])
    for axis in program.tried.get(pair, []):
        effort = np.where(normals @ axis > 0.99, effort + 10.0, effort)
    best = int(np.argmin(effort))
    if np.isfinite(effort[best]):
        program.chosen[pair] = (normals[best], float(gaps[best]))
