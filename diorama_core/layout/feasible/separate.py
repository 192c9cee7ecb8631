"""Collision removal by a sequence of least-distance programs over convex parts.

Rotations are fixed by then, so "apart along this axis" is an exact linear inequality in the free coordinates. Which of
the many axes is chosen decides everything; so for two compounds that touch the cheapest way out is computed exactly
(`escape.exits`), and each pair of their parts gets the axis that parts it best there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.arrangement.surfaces import plane_surface
from diorama_core.geometry.planes import is_in_polygon
from diorama_core.geometry.sat import PairAxes, PosedBodies, pair_axes, place_bodies
from diorama_core.layout.escape import exits, ring
from diorama_core.layout.feasible.quadratic import HARD, SOFT, least_distance
from diorama_core.layout.feasible.structure import Structure
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.problem.volumes import may_meet

_SAME_WAY = float(np.cos(np.deg2rad(20.0)))
"""A way out within this of one that was blocked is not tried again."""


@dataclass(eq=False)
class Program:
    """The moves that are possible, what they cost, and the rows that bound them; y are the objects' own coordinates."""

    problem: Problem
    structure: Structure
    bodies: PosedBodies
    may_meet: Bool[np.ndarray, "b b"]
    """Which pairs of parts must not overlap."""
    J: Float[np.ndarray, "n 3 v"]
    """World move of object i: w_i = J_i @ y."""
    own: Bool[np.ndarray, "n v"]
    """Which variables are an object's own coordinates, not its supporters'."""
    rows: Float[np.ndarray, "m v"]
    """Hard rows: rows @ y >= need."""
    need: Float[np.ndarray, " m"]
    whiten: Float[np.ndarray, "v v"]
    """y = whiten @ z, where |z|^2 is what a move costs."""
    watched: dict[tuple[int, int], int] = field(default_factory=dict)
    """Part pairs whose axes are known: (a, b) -> running number."""
    blocks: list[PairAxes] = field(default_factory=list)
    chosen: dict[tuple[int, int], tuple[np.ndarray, float]] = field(default_factory=dict)
    """Part pairs with a separation constraint: axis and gap at the base positions."""
    tried: dict[tuple[int, int], list[np.ndarray]] = field(default_factory=dict)
    """Ways out, by pair of objects, that turned out to be blocked."""

    def moves(self, y: Float[np.ndarray, " v"]) -> Float[np.ndarray, "n 3"]:
        """World move of every object."""
        return self.J @ y

    def layout(self, y: Float[np.ndarray, " v"]) -> Problem:
        """The problem's objects after these moves."""
        return self.problem.with_poses(self.structure.R, self.structure.p + self.moves(y), self.structure.scale)

    def cost(self, y: Float[np.ndarray, "*s v"]) -> Float[np.ndarray, "*s"]:
        """What moves cost: metres, weighted."""
        return np.asarray(np.linalg.norm(np.linalg.solve(self.whiten, np.asarray(y).T), axis=0))


@dataclass(frozen=True, eq=False)
class Separation:
    """Where the rounds ended."""

    y: Float[np.ndarray, " v"]
    depth_m: float
    """Deepest remaining overlap of parts."""
    stuck: tuple[tuple[int, int], ...]
    """Pairs of objects that still overlap."""


def build_program(
    problem: Problem,
    structure: Structure,
    weight: Float[np.ndarray, "n 2 2"],
    seen: Float[np.ndarray, "n 3 3"] | None = None,
) -> Program:
    """Variables, their cost, hard rows and posed parts.

    Args:
        problem: who may collide with whom.
        structure: the base layout.
        weight: cost of each object's move relative to its supporter, in its own two coordinates: r^T weight r.
        seen: cost of each object's move in the world: w^T seen w.
    """
    n = problem.count
    moving = [i for i in range(n) if problem.free[i] and np.abs(structure.basis[i]).max() > 0]
    J, jacobian = np.zeros((n, 3, 2 * len(moving))), np.zeros((n, 3, 2 * len(moving)))
    cost = np.zeros((2 * len(moving), 2 * len(moving)))
    for column, i in enumerate(moving):
        mine = slice(2 * column, 2 * column + 2)
        J[problem.rides(i), :, mine] = structure.basis[i]
        jacobian[i, :, mine] = structure.basis[i]
        cost[mine, mine] = weight[i]
    if seen is not None:
        cost += np.tensordot(J, np.matmul(seen, J), axes=([0, 1], [0, 1]))
    bodies = place_bodies(problem.packed, structure.R, structure.p, structure.scale)
    bound = -np.einsum("bc,bcv->bv", structure.bound_normal, jacobian[structure.bound_owner])
    settled = problem.with_poses(structure.R, structure.p, structure.scale)
    wall_rows, wall_need = _wall_rows(settled, bodies, J)
    rows, need = np.vstack([bound, wall_rows]), np.concatenate([-structure.bound_slack, wall_need])
    alive = np.linalg.norm(rows, axis=1) > 1e-9
    return Program(
        problem,
        structure,
        bodies,
        may_meet(problem, bodies, [s and settled.to_world(i, s) for i, s in enumerate(structure.surface)]),
        J,
        np.abs(jacobian).max(axis=1, initial=0.0) > 1e-12,
        rows[alive],
        need[alive],
        np.linalg.inv(np.linalg.cholesky(cost)).T,
    )


def _wall_rows(problem: Problem, bodies: PosedBodies, J: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Every object stays in front of the walls it could reach, as far as those were seen.

    Round the corner of a wall that stands into the room an object is behind that wall's plane and rightly so: one whose
    middle is there, although it reaches behind the wall itself, and one that only passes the wall's end.
    """
    rows, need = [np.zeros((0, J.shape[2]))], [np.zeros(0)]
    fixed = {(i, w) for i, w, _ in problem.adheres}
    starts = np.searchsorted(bodies.owner, np.arange(problem.count))
    radius = 0.5 * np.linalg.norm(problem.shape_size * problem.scale, axis=1)
    in_room = is_in_polygon(problem.p[:, :2], problem.floor_outline)
    for w, wall in enumerate(problem.walls if problem.count else ()):
        if not wall.is_seen:
            continue
        surface = plane_surface(wall)
        ahead = problem.p @ wall.normal - wall.offset
        beside = (problem.p @ surface.outward.T - surface.offset).max(axis=1)
        reached = problem.free & (beside <= radius) & (ahead >= -radius - 0.5)
        reached &= ~(in_room & (beside > 0) & (ahead < 0))
        reached &= np.array([problem.on_plane[i] != wall.id and (i, w) not in fixed for i in range(problem.count)])
        reached[[i for i in np.flatnonzero(reached) if problem.passes(wall, int(i))]] = False
        nearest = np.minimum.reduceat((bodies.vertices @ wall.normal).min(axis=1), starts)
        rows.append(np.einsum("c,ncv->nv", wall.normal, J[reached]))
        need.append(wall.offset - nearest[reached])
    return np.vstack(rows), np.concatenate(need)


def separate(program: Program, *, rounds: int, check: Callable[[Float[np.ndarray, " v"], float], None]) -> Separation:
    """Alternate between choosing separating axes and solving, until nothing overlaps or the rounds are used up.

    `check` is called each round with the moves and the deepest overlap; it may raise to cancel.
    """
    y = base(program)
    best: tuple[float, np.ndarray] = (np.inf, y)
    for _ in range(rounds):
        depth, touching = _touching(program, y)
        check(y, depth)
        if depth < best[0]:
            best = (depth, y)
        if not touching:
            return Separation(y, max(depth, 0.0), ())
        for i, j in sorted({_owners(program, pair) for pair in touching}):
            _choose_way(program, y, i, j)
        y = _solve(program, SOFT)
    depth, _ = _touching(program, y)
    if depth > best[0]:
        depth, y = best
    return Separation(y, *overlaps(program, y))


def base(program: Program) -> Float[np.ndarray, " v"]:
    """The least move that respects the hard rows."""
    return program.whiten @ least_distance(
        program.rows @ program.whiten, program.need, np.full(len(program.need), HARD)
    )


def relax(program: Program, separation: Separation) -> Separation:
    """The least move in the neighbourhood of one that is free of overlap: as free of it, and never farther.

    Each pair of parts keeps the axis that parts it best where it was found; rows enter when they are violated.
    """
    for _ in range(program.problem.settings.relaxations):
        program.chosen.clear()
        y = separation.y
        while True:
            y = base(program) if not program.chosen else _solve(program, HARD)
            fresh = [pair for pair in _touching(program, y)[1] if pair not in program.chosen]
            if not fresh:
                break
            _keep_apart(program, fresh, separation.y)
        least = 1.0 - program.problem.settings.min_saving
        if _touching(program, y)[1] or program.cost(y) > least * program.cost(separation.y):
            break
        separation = Separation(y, separation.depth_m, separation.stuck)
    return separation


def overlaps(program: Program, y: Float[np.ndarray, " v"]) -> tuple[float, tuple[tuple[int, int], ...]]:
    """Deepest overlap of parts in metres, and the pairs of objects that touch, after the moves y."""
    depth, touching = _touching(program, y)
    return max(depth, 0.0), tuple(sorted({_owners(program, pair) for pair in touching}))


def _owners(program: Program, pair: tuple[int, int]) -> tuple[int, int]:
    return int(program.bodies.owner[pair[0]]), int(program.bodies.owner[pair[1]])


def _solve(program: Program, yielding: float) -> Float[np.ndarray, " v"]:
    owner, J = program.bodies.owner, program.J
    pairs = np.array(list(program.chosen), dtype=int).reshape(-1, 2)
    axes = np.array([axis for axis, _ in program.chosen.values()]).reshape(-1, 3)
    gaps = np.array([gap for _, gap in program.chosen.values()])
    rows = np.einsum("mc,mcv->mv", axes, J[owner[pairs[:, 0]]] - J[owner[pairs[:, 1]]])
    compliance = np.concatenate([np.full(len(program.need), HARD), np.full(len(gaps), yielding)])
    need = np.concatenate([program.need, program.problem.settings.apart_m - gaps])
    return program.whiten @ least_distance(np.vstack([program.rows, rows]) @ program.whiten, need, compliance)


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
        for k in np.flatnonzero(apart < program.problem.settings.touching_m):
            touching[int(block.a[k]), int(block.b[k])] = (block.normals[k], block.gaps[k])
    return deepest, touching


def _watch(program: Program, w: Float[np.ndarray, "n 3"]) -> None:
    """Learn the axes of part pairs that have come near each other."""
    fresh = np.array([p for p in _candidate_pairs(program, w) if p not in program.watched], dtype=int).reshape(-1, 2)
    if len(fresh):
        program.watched.update({(int(a), int(b)): len(program.watched) for a, b in fresh})
        program.blocks.extend(pair_axes(program.bodies, fresh[:, 0], fresh[:, 1]))


def _candidate_pairs(program: Program, w: Float[np.ndarray, "n 3"]) -> list[tuple[int, int]]:
    bodies, problem = program.bodies, program.problem
    reach = problem.settings.watched_m / 2
    low, high = bodies.low + w[bodies.owner] - reach, bodies.high + w[bodies.owner] + reach
    starts = np.searchsorted(bodies.owner, np.arange(problem.count))
    if not problem.count:
        return []
    object_low, object_high = np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)
    near = ((object_low[:, None] <= object_high[None]) & (object_low[None] <= object_high[:, None])).all(axis=2)
    near &= problem.free[:, None] | problem.free[None]
    np.fill_diagonal(near, val=False)
    ends = np.append(starts[1:], len(bodies.owner))
    pairs = []
    for i, j in zip(*np.nonzero(np.triu(near, 1))):
        a, b = slice(starts[i], ends[i]), slice(starts[j], ends[j])
        meet = ((low[a, None] <= high[None, b]) & (low[None, b] <= high[a, None])).all(axis=2)
        meet &= program.may_meet[a, b]
        pairs += [(int(starts[i] + k), int(starts[j] + m)) for k, m in zip(*np.nonzero(meet))]
    return pairs


def _pair_axes(
    program: Program, i: int, j: int, offset: Float[np.ndarray, "3"], directions: Float[np.ndarray, "d 3"]
) -> list[PairAxes]:
    """The watched pairs of parts of two objects, with the axes along which they are deepest apart or least deep, and
    those by which they part soonest in some of the directions.
    """
    owner, settings = program.bodies.owner, program.problem.settings
    axes = []
    for block in program.blocks:
        rows = np.flatnonzero((owner[block.a] == i) & (owner[block.b] == j))
        if len(rows):
            normals, gaps = block.normals[rows], block.gaps[rows]
            if gaps.shape[1] > settings.max_axes:
                apart = gaps + normals @ offset
                best = np.argpartition(-apart, settings.max_axes, axis=1)[:, : settings.max_axes]
                some = directions[:: max(len(directions) // settings.sides, 1)]
                best = np.hstack([best, _soonest(apart, normals, some, settings.apart_m)])
                normals = np.take_along_axis(normals, best[..., None], axis=1)
                gaps = np.take_along_axis(gaps, best, axis=1)
            axes.append(PairAxes(block.a[rows], block.b[rows], normals, gaps))
    return axes


def _soonest(
    apart: Float[np.ndarray, "m a"],
    normals: Float[np.ndarray, "m a 3"],
    directions: Float[np.ndarray, "d 3"],
    apart_m: float,
) -> Int[np.ndarray, "m d"]:
    """For every pair and direction, the axis by which the pair is apart after the shortest way."""
    slope = normals @ directions.T
    with np.errstate(divide="ignore", invalid="ignore"):
        way = np.where(slope > 1e-6, (apart_m - apart)[..., None] / slope, np.inf)
    return np.asarray(way.argmin(axis=1))


def _choose_way(program: Program, y: Float[np.ndarray, " v"], i: int, j: int) -> None:
    """Rows that part two objects along the direction in which that costs least, counted from where they began."""
    lever = program.J[i] - program.J[j]
    directions = ring(program.structure.R[i], lever)
    if not len(directions):
        return
    now = lever @ y
    blocks = _pair_axes(program, i, j, now, directions)
    offsets = [np.tile(now, (len(block.a), 1)) for block in blocks]
    ones = [np.ones(len(block.a)) for block in blocks]
    far = exits(blocks, offsets, ones, directions, program.problem.settings.apart_m)
    known = np.isfinite(far)
    target = now + np.where(known, far, 0.0)[:, None] * directions
    effort = np.linalg.norm(target @ np.linalg.pinv(lever @ program.whiten).T, axis=1)
    for way in program.tried.get((i, j), []):
        known &= directions @ way < _SAME_WAY
    if not known.any():
        return
    best = int(np.where(known, effort, np.inf).argmin())
    program.tried.setdefault((i, j), []).append(directions[best])
    for block in blocks:
        _set_axes(program, block, np.tile(target[best], (len(block.a), 1)))


def _set_axes(program: Program, block: PairAxes, offset: Float[np.ndarray, "m 3"]) -> None:
    """Each pair's row along the axis that parts it best once a has moved by `offset` relative to b."""
    axis = block.separations(offset).argmax(axis=1)
    for k, best in enumerate(axis):
        program.chosen[int(block.a[k]), int(block.b[k])] = (block.normals[k, best], float(block.gaps[k, best]))


def _keep_apart(program: Program, pairs: list[tuple[int, int]], y: Float[np.ndarray, " v"]) -> None:
    wanted, owner, w = set(pairs), program.bodies.owner, program.moves(y)
    for block in program.blocks:
        rows = np.array([k for k in range(len(block.a)) if (int(block.a[k]), int(block.b[k])) in wanted], dtype=int)
        if len(rows):
            axes = PairAxes(block.a[rows], block.b[rows], block.normals[rows], block.gaps[rows])
            _set_axes(program, axes, w[owner[axes.a]] - w[owner[axes.b]])
