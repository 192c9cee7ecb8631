"""Sizes at which colliding objects fit where they were seen.

A retrieved shape differs from the object: its arms do not pass under a desk, its frame is too wide for a gap. Moving it
out of the way can take it farther from where the photo shows it than a slightly smaller size does; both are costed
alike.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.sat import place_bodies
from diorama_core.layout.feasible.relocate import cheapest_spot
from diorama_core.layout.feasible.separate import Program, base, overlaps
from diorama_core.layout.feasible.structure import Structure

_AXES = np.array([[1, 1, 1], [1, 1, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0]], dtype=bool)
"""Which extents are reduced together: all, the footprint, the height, depth and width alone."""


def fitted_sizes(program: Program, outline_cost: Float[np.ndarray, " n"]) -> Structure:
    """The structure with colliding objects smaller where that costs less than the moves it saves.

    Objects that hold up others keep their sizes.

    Args:
        program: the moves that are possible, and what they cost.
        outline_cost: what a metre of outline counts, by object, in the unit of `Program.cost`.
    """
    problem = program.problem
    factors = np.ones((problem.count, 3))
    y = base(program)
    pairs = overlaps(program, y)[1]
    for pair in pairs if len(pairs) <= problem.settings.max_pairs else ():
        options = [
            (cost, k, factor)
            for k in pair
            if problem.free[k] and len(problem.rides(k)) == 1 and (factors[k] == 1.0).all()
            for cost, factor in _options(program, y, k, factors, float(outline_cost[k]))
        ]
        moved = min((cost for cost, _, factor in options if (factor == 1.0).all()), default=np.inf)
        cost, k, factor = min(options, key=lambda option: option[0], default=(np.inf, -1, np.ones(3)))
        if cost < problem.settings.worth * moved:
            factors[k] = factor
    scale, p = _resting(program, factors)
    smaller = np.flatnonzero((factors < 1.0).any(axis=1))
    reduced = tuple(sorted({*program.structure.reduced, *map(int, smaller)}))
    return replace(program.structure, scale=scale, p=p, reduced=reduced)


def _options(
    program: Program, y: Float[np.ndarray, " v"], k: int, factors: Float[np.ndarray, "n 3"], outline_cost: float
) -> list[tuple[float, Float[np.ndarray, "3"]]]:
    """What each size of one object costs, with the move that it still needs."""
    problem, structure = program.problem, program.structure
    extents = problem.shape_size[k] * structure.scale[k]
    options: list[tuple[float, Float[np.ndarray, "3"]]] = []
    steps = (*problem.settings.shrinks, problem.settings.smallest_shrink)
    for factor in np.vstack([np.ones(3), *(np.where(_AXES, step, 1.0) for step in steps)]):
        shrunk = 0.5 * float(np.linalg.norm((1.0 - factor) * extents)) * outline_cost
        if options and shrunk >= min(cost for cost, _ in options):
            continue
        # A smaller size that still has to go far away is no help, and looking far takes long.
        reaches_m = problem.settings.reaches_m if (factor == 1.0).all() else problem.settings.reaches_m[:1]
        spot = cheapest_spot(_resized(program, k, factors, factor), y, k, reaches_m)
        if spot is not None:
            options.append((float(np.hypot(spot.cost, shrunk)), factor))
    return options


def _resized(program: Program, k: int, factors: Float[np.ndarray, "n 3"], factor: Float[np.ndarray, "3"]) -> Program:
    """The program with some objects smaller, each resting where it rests."""
    sizes = factors.copy()
    sizes[k] = factor
    scale, p = _resting(program, sizes)
    return replace(program, bodies=place_bodies(program.problem.packed, program.structure.R, p, scale))


def _resting(
    program: Program, factors: Float[np.ndarray, "n 3"]
) -> tuple[Float[np.ndarray, "n 3"], Float[np.ndarray, "n 3"]]:
    """Scales and centres of objects in other sizes, their contact faces where they were."""
    problem, structure = program.problem, program.structure
    scale = structure.scale * factors
    toward = problem.contact * problem.shape_size / 2 * (structure.scale - scale)
    return scale, structure.p + np.matmul(structure.R, toward[..., None])[..., 0]
