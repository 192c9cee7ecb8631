"""The published recipe: four stages of stochastic-gradient steps, batched and pruned.

Schedule as in the supplement: 200 steps a stage, learning rate 0.01 (0.001 for scale), momentum 0.9, decayed tenfold
every 50 steps; weights 3, 1 / 5, 1 / 1 / 5, 1. Rotations step on their manifold.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.geometry.vectors import cross
from diorama_core.layout import gradients
from diorama_core.layout.problem.problem import Problem
from diorama_core.layout.problem.volumes import Volumes, contact_templates
from diorama_core.layout.settings import AS_IT_IS, Weights


@dataclass(frozen=True)
class StageSchedule:
    """How steps are taken."""

    steps: int = 200
    """Per stage."""
    rate: float = 0.01
    scale_rate: float = 0.001
    momentum: float = 0.9
    decay: float = 0.1
    decay_every: int = 50

    def rates(self) -> Iterator[float]:
        """Factor on the learning rate, step by step."""
        for step in range(self.steps):
            yield self.decay ** (step // self.decay_every)


@dataclass(eq=False)
class State:
    """The layout while it is optimised, which the stages change, and how that is done."""

    problem: Problem
    """The layout as observed, with its supports."""
    schedule: StageSchedule
    report: Report
    weights: Weights = AS_IT_IS
    """Factors on what each cost counts."""

    def __post_init__(self) -> None:
        self.R, self.p, self.scale = self.problem.R.copy(), self.problem.p.copy(), self.problem.scale.copy()

    @property
    def layout(self) -> Problem:
        """The objects where they are now."""
        return self.problem.with_poses(self.R, self.p, self.scale)


Report = Callable[[str, int, State, Mapping[str, float]], None]
"""Called every step: stage, step, layout, and what each cost adds. May raise to cancel."""


@dataclass(frozen=True, eq=False)
class Edges:
    """Support edges and adherences, flattened: child faces against surfaces."""

    child: np.ndarray
    supporter: np.ndarray
    """Index of the supporting object; -1 for planes."""
    contact: Float[np.ndarray, "e 3"]
    """Outward normals of the touching faces, object frame."""
    point: Float[np.ndarray, "e 3"]
    """A point of the surface, in its owner's frame at scale 1."""
    normal: Float[np.ndarray, "e 3"]
    """In its owner's frame."""
    weight: Float[np.ndarray, " e"]
    """Weights of orientation: 1 for supports, 5 for adherence."""
    supports: int
    """The first so many are supports."""

    @classmethod
    def of(cls, problem: Problem) -> Edges:
        """All edges of a problem."""
        supported = [i for i, s in enumerate(problem.surface) if s is not None]
        surfaces = [problem.surface[i] for i in supported]
        walls = [problem.walls[w] for _, w, _ in problem.adheres]
        return cls(
            child=np.array(supported + [i for i, _, _ in problem.adheres], dtype=int),
            supporter=np.array([int(problem.parent[i]) for i in supported] + [-1] * len(walls), dtype=int),
            contact=np.array([problem.contact[i] for i in supported] + [f for _, _, f in problem.adheres]).reshape(
                -1, 3
            ),
            point=np.array(
                [s.polygon.mean(axis=0) for s in surfaces if s is not None] + [w.polygon[0] for w in walls]
            ).reshape(-1, 3),
            normal=np.array([s.normal for s in surfaces if s is not None] + [w.normal for w in walls]).reshape(-1, 3),
            weight=np.array([1.0] * len(supported) + [5.0] * len(walls)),
            supports=len(supported),
        )

    def owners(self, state: State) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rotation, centre and scale of each edge's owner; the identity for planes."""
        on_object = self.supporter >= 0
        R = np.where(on_object[:, None, None], state.R[self.supporter], np.eye(3))
        p = np.where(on_object[:, None], state.p[self.supporter], 0.0)
        scale = np.where(on_object[:, None], state.scale[self.supporter], 1.0)
        return R, p, scale

    def scatter(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Matrices that add edge gradients to children, and to supporting objects."""
        to_child, to_supporter = np.zeros((count, len(self.child))), np.zeros((count, len(self.child)))
        to_child[self.child, np.arange(len(self.child))] = 1.0
        on_object = np.flatnonzero(self.supporter >= 0)
        to_supporter[self.supporter[on_object], on_object] = 1.0
        return to_child, to_supporter


WATCHED_M = 0.1
"""Boxes with smaller gaps are watched."""


def orientation_stage(state: State) -> None:
    """Stage 1: turn objects until contact faces are parallel to their supports. 3 e_align + e_sem."""
    problem, schedule, weights = state.problem, state.schedule, state.weights
    edges = Edges.of(problem)
    to_child, to_supporter = edges.scatter(problem.count)
    front = state.R[:, :, 0].copy()
    velocity = np.zeros((problem.count, 3))
    free = problem.free.astype(np.float64)[:, None]
    on_object = edges.supporter >= 0
    inward = -edges.contact
    for step, rate in enumerate(schedule.rates()):
        face = np.einsum("eij,ej->ei", state.R[edges.child], inward)
        owner = np.where(on_object[:, None, None], state.R[edges.supporter], np.eye(3))
        normal = np.einsum("eij,ej->ei", owner, edges.normal)
        value, slope = gradients.align(face, normal)
        slope = 3.0 * weights.align * edges.weight[:, None] * slope
        cost, turn = gradients.semantic(state.R[:, :, 0], front)
        gradient = to_child @ cross(face, slope) - to_supporter @ cross(normal, slope)
        gradient += weights.heading * cross(state.R[:, :, 0], turn)
        velocity = schedule.momentum * velocity + gradient * free
        state.R = np.matmul(rotation_from_vector(-schedule.rate * rate * velocity), state.R)
        terms = {"align": 3.0 * weights.align * value, "heading": weights.heading * cost}
        state.report("orientation", step, state, terms)
    state.R = orthonormal(state.R)


def placement_stage(state: State) -> None:
    """Stage 2: move objects onto their supports, keeping their neighbours' relative positions. 5 e_place + e_rel."""
    problem, schedule, weights = state.problem, state.schedule, state.weights
    cost = PlacementCost.of(state)
    links = gradients.incidence(problem.relations, problem.count)
    velocity, start = np.zeros((problem.count, 3)), state.p.copy()
    free = problem.free.astype(np.float64)[:, None]
    for step, rate in enumerate(schedule.rates()):
        value, gradient = cost.value_and_gradient(state.p)
        distance, back = gradients.relative(state.p - start, problem.relations, links)
        slope = 5.0 * weights.place * gradient + weights.neighbours * back
        velocity = schedule.momentum * velocity + slope * free
        state.p = state.p - schedule.rate * rate * velocity
        terms = {"place": 5.0 * weights.place * value, "neighbours": weights.neighbours * distance}
        state.report("placement", step, state, terms)


def space_stage(state: State) -> None:
    """Stage 3: move and shrink objects until they are inside their supporting volumes. e_vol.

    A supporter's own pose bounds the volume but is not moved by it.
    """
    problem, schedule, weights = state.problem, state.schedule, state.weights
    volumes = Volumes.of(problem)
    supported = volumes.supported
    if not len(supported):
        return
    template, half = contact_templates(problem, supported)
    v_p, v_s = np.zeros((len(supported), 3)), np.zeros((len(supported), 3))
    free = problem.free[supported].astype(np.float64)[:, None]
    R = state.R[supported]
    nested = bool((problem.parent >= 0).any())
    for step, rate in enumerate(schedule.rates()):
        if step == 0 or nested:
            here = volumes.world_volumes(state.R, state.p, state.scale)
        p, scale = state.p[supported], state.scale[supported]
        tilt = np.abs(np.matmul(here.normal[:, None, :], R)[:, 0]) * half
        corners = p[:, None, :] + np.matmul(template * scale[:, None, :], R.transpose(0, 2, 1))
        top = (here.normal * p).sum(axis=1) - here.level + (tilt * scale).sum(axis=1)
        value, at_corners, at_top = gradients.volume(corners, top, here.outward, here.offset, here.clearance)
        to_scale = (np.matmul(at_corners, R) * template).sum(axis=1) + at_top[:, None] * tilt
        to_place = at_corners.sum(axis=1) + at_top[:, None] * here.normal
        v_p = schedule.momentum * v_p + weights.volume * to_place * free
        v_s = schedule.momentum * v_s + weights.volume * to_scale * free
        state.p[supported] = p - schedule.rate * rate * v_p
        state.scale[supported] = np.maximum(scale - schedule.scale_rate * rate * v_s, 0.05)
        state.report("space", step, state, {"volume": weights.volume * value})


def refinement_stage(state: State) -> None:
    """Stage 4: placement again, and no boxes overlapping. 5 e_place + e_col; walls are obstacles."""
    problem, schedule, weights = state.problem, state.schedule, state.weights
    cost = PlacementCost.of(state)
    R, centre, size, apart = with_walls(state)
    n = problem.count
    velocity = np.zeros((n, 3))
    free = problem.free.astype(np.float64)[:, None]
    seen = centre[:n] + np.inf
    for step, rate in enumerate(schedule.rates()):
        centre[:n] = state.p
        # Pairs further apart than WATCHED_M cannot touch before something has moved by half of that.
        if step % 10 == 0 and np.abs(state.p - seen).max(initial=0.0) > WATCHED_M / 4:
            pairs = gradients.candidate_pairs(R, centre, size, apart, WATCHED_M)
            boxes, links = gradients.BoxPairs.of(R, size, pairs, walls_from=n), gradients.incidence(pairs, len(centre))
            seen = state.p.copy()
        value, gradient = cost.value_and_gradient(state.p)
        overlap, away = boxes.collision(centre, links)
        slope = 5.0 * weights.place * gradient + weights.collision * away[:n]
        velocity = schedule.momentum * velocity + slope * free
        state.p = state.p - schedule.rate * rate * velocity
        terms = {"place": 5.0 * weights.place * value, "collision": weights.collision * overlap}
        state.report("refinement", step, state, terms)


@dataclass(frozen=True, eq=False)
class PlacementCost:
    """e_place as a function of positions only: everything else is fixed within a stage."""

    slope: Float[np.ndarray, "e 3"]
    level: Float[np.ndarray, " e"]
    weight: Float[np.ndarray, " e"]
    edges: Edges
    scatter: Float[np.ndarray, "n e"]

    @classmethod
    def of(cls, state: State) -> PlacementCost:
        """The cost at the present rotations and scales."""
        problem = state.problem
        edges = Edges.of(problem)
        R, _, scale = edges.owners(state)
        size = problem.shape_size[edges.child] * state.scale[edges.child]
        face = np.einsum("eij,ej->ei", state.R[edges.child], edges.contact * size / 2)
        point = np.einsum("eij,ej->ei", R, edges.point * scale)
        normal = np.einsum("eij,ej->ei", R, edges.normal)
        to_child, to_supporter = edges.scatter(problem.count)
        level = np.einsum("ec,ec->e", point - face, normal)
        return cls(normal, level, np.abs(normal).sum(axis=1), edges, to_child - to_supporter)

    def value_and_gradient(self, p: Float[np.ndarray, "n 3"]) -> tuple[float, Float[np.ndarray, "n 3"]]:
        """Value and gradient at these positions."""
        relative = self.scatter.T @ p
        distance = np.einsum("ec,ec->e", relative, self.slope) - self.level
        value = float(np.abs(distance) @ self.weight)
        return value, self.scatter @ ((np.sign(distance) * self.weight)[:, None] * self.slope)


def with_walls(state: State) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Boxes of objects and of walls, and which pairs may collide."""
    problem = state.problem
    n, walls = problem.count, problem.walls
    R = np.concatenate([state.R, np.array([_wall_frame(w.normal) for w in walls]).reshape(-1, 3, 3)])
    centres, sizes = [], []
    for k, wall in enumerate(walls):
        local = wall.polygon @ R[n + k]
        low, high = local.min(axis=0), local.max(axis=0)
        low[0] -= max(wall.thickness, 0.1)
        centres.append(R[n + k] @ ((low + high) / 2))
        sizes.append(high - low)
    centre = np.concatenate([state.p, np.array(centres).reshape(-1, 3)])
    size = np.concatenate([problem.shape_size * state.scale, np.array(sizes).reshape(-1, 3)])
    apart = np.zeros((n + len(walls), n + len(walls)), dtype=bool)
    apart[:n, :n] = ~problem.kin & (problem.free[:, None] | problem.free[None])
    for k, wall in enumerate(walls):
        hangs = np.array([problem.on_plane[i] == wall.id for i in range(n)], dtype=bool)
        apart[:n, n + k] = apart[n + k, :n] = problem.free & ~hangs
    return R, centre, size, apart


def _wall_frame(normal: np.ndarray) -> Float[np.ndarray, "3 3"]:
    """A rotation whose first column is the wall's normal."""
    helper = np.eye(3)[int(np.abs(normal).argmin())]
    second = np.cross(normal, helper)
    second /= np.linalg.norm(second)
    return np.column_stack([normal, second, np.cross(normal, second)])


def orthonormal(R: Float[np.ndarray, "n 3 3"]) -> Float[np.ndarray, "n 3 3"]:
    """The nearest rotations, against rounding."""
    u, _, vt = np.linalg.svd(R)
    return np.asarray(u @ vt)
