"""Colliding objects that end before one another, where that changes the picture less than moving them does.

A retrieved shape is longer than the object, or its far end was a guess: a counter reaches into the refrigerator at its
end. To move one of the two shifts all of its outline, and what stands beside it gives way in turn; with one side nearer
only that side changes. What the object holds up stays where it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.sat import place_bodies
from diorama_core.layout.feasible.hidden_extents import MIN_SHARE, covers_box, free_m, is_hidden, reaching_in_m
from diorama_core.layout.feasible.photo_observations import PhotoObservations
from diorama_core.layout.feasible.relocate import cheapest_spot
from diorama_core.layout.feasible.resize import MAX_PAIRS, WORTH
from diorama_core.layout.feasible.separate import Program, base, overlaps
from diorama_core.layout.feasible.settle import SMALLEST_SHRINK
from diorama_core.layout.feasible.structure import Structure, with_sizes
from diorama_core.layout.problem.problem import Problem

ONE_SIDE = 0.5
"""What a metre of one visible side costs against moving the object by a metre, which shifts two sides."""
HIDDEN_SIDE = 0.1
"""The same for a side that was not seen."""
LEVEL = 0.3
"""A direction whose cosine to a support's normal is smaller lies in the support."""


@dataclass(frozen=True, eq=False)
class _Cut:
    """One side of an object nearer."""

    cost: float
    k: int
    """Index of the object."""
    p: Float[np.ndarray, "3"]
    """Its centre then."""
    scale: Float[np.ndarray, "3"]


def ending_apart(program: Program, observations: PhotoObservations, outline_cost: Float[np.ndarray, " n"]) -> Structure:
    """The structure with colliding objects cut on one side where that costs less than the moves it saves.

    What would have to move as far nevertheless keeps its size.

    Args:
        program: the moves that are possible, and what they cost.
        observations: what the camera saw.
        outline_cost: what a metre of outline counts, by object, in the unit of `Program.cost`.
    """
    structure, y = program.structure, base(program)
    pairs = overlaps(program, y)[1]
    settled = replace(program.problem, R=structure.R, p=structure.p + program.moves(y), scale=structure.scale)
    start, spent = settled, np.zeros(program.problem.count)
    for pair in pairs if len(pairs) <= MAX_PAIRS else ():
        options = [
            cut
            for k, other in (pair, pair[::-1])
            for cut in _cuts(settled, start, observations, k, other, float(outline_cost[k]))
        ]
        best = min(options, key=lambda cut: (cut.cost, cut.k), default=None)
        if best is not None and best.cost < WORTH * _move_cost(program, y, pair):
            spent[best.k] += best.cost
            centres, scales = settled.p.copy(), settled.scale.copy()
            centres[best.k], scales[best.k] = best.p, best.scale
            settled = replace(settled, p=centres, scale=scales)
    shorter = _resized(program, structure.p + (settled.p - start.p), settled.scale)
    left = sorted({k for pair in overlaps(shorter, y)[1] for k in pair})
    in_vain = [k for k in left if _move_cost(shorter, y, [k]) + spent[k] >= _move_cost(program, y, [k])]
    p, scale = shorter.structure.p.copy(), shorter.structure.scale.copy()
    p[in_vain], scale[in_vain] = structure.p[in_vain], structure.scale[in_vain]
    cut = np.flatnonzero((scale != structure.scale).any(axis=1))
    return replace(with_sizes(program.problem, structure, p, scale), reduced=tuple(map(int, cut)))


def _resized(program: Program, p: Float[np.ndarray, "n 3"], scale: Float[np.ndarray, "n 3"]) -> Program:
    """The program with objects in other sizes and places."""
    structure = replace(program.structure, p=p, scale=scale)
    bodies = place_bodies(program.problem.packed, structure.R, p, scale)
    return replace(program, structure=structure, bodies=bodies, watched={}, blocks=[], chosen={}, tried={})


def _move_cost(program: Program, y: Float[np.ndarray, " v"], objects: Sequence[int]) -> float:
    """What the cheapest move of one of some objects to a free place costs."""
    spots = (cheapest_spot(program, y, k) for k in objects if program.problem.free[k])
    return min((spot.cost for spot in spots if spot is not None), default=np.inf)


def _cuts(
    settled: Problem,
    start: Problem,
    observations: PhotoObservations,
    k: int,
    other: int,
    outline_cost: float,
) -> Iterator[_Cut]:
    """The sides on which an object can end before another."""
    place = settled.surface[k]
    if not settled.free[k] or place is None:
        return
    against = [face for i, _, face in settled.adheres if i == k]
    for axis in range(3):
        for sign in (-1.0, 1.0):
            side = sign * np.eye(3)[axis]
            touches = abs(float(side @ settled.contact[k])) > LEVEL or any(
                float(side @ face) > LEVEL for face in against
            )
            outward = settled.R[k] @ side
            if touches or (settled.parent[k] < 0 and abs(float(outward @ place.normal)) > LEVEL):
                continue
            extent = float(settled.shape_size[k, axis] * settled.scale[k, axis])
            face = settled.p[k] + 0.5 * extent * outward
            cut = reaching_in_m(settled, k, [other], settled.p, settled.scale, axis, outward)
            least = MIN_SHARE * float(start.shape_size[k, axis] * start.scale[k, axis])
            if not 0.0 < cut <= min(free_m(settled, k, float(face @ outward), outward), extent - least):
                continue
            shorter = settled.scale[k] * np.where(np.arange(3) == axis, 1.0 - cut / extent, 1.0)
            nearer = settled.p[k] - 0.5 * cut * outward
            hidden = is_hidden(observations, k, settled.p[k], face)
            hidden = hidden and covers_box(start, observations, k, nearer, shorter)
            if not hidden and extent - cut < SMALLEST_SHRINK * float(start.shape_size[k, axis] * start.scale[k, axis]):
                continue
            yield _Cut((HIDDEN_SIDE if hidden else ONE_SIDE) * cut * outline_cost, k, nearer, shorter)
