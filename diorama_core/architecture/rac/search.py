"""The discrete search: which plane every cell of the picture shows (Stekovic et al. 2020, section 3).

A labelling is feasible when the planes of neighbouring cells meet at the line between them, or when the nearer of the
two ends there at its intersection with a third plane and hides the farther one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from jaxtyping import Bool, Float
from scipy import sparse
from scipy.optimize import Bounds, LinearConstraint, milp

from diorama_core.architecture.rac.arrangement import Arrangement

MAX_NODES = 2000
"""Branches that the solver looks at; the best labelling found by then is taken."""
EDGE_COST = 2e-5
"""Cost of a pixel of edge between two planes, beside a picture in which everything disagrees: of layouts that agree as
well, which differ behind furniture only, the one with the shortest edges is taken."""


@dataclass(frozen=True, eq=False)
class Border:
    """Two cells that touch."""

    other: int
    allowed: Bool[np.ndarray, "p p"]
    """Own plane by the other's: whether they may meet here."""
    length: float
    """Relative cost of an edge here."""


def borders_of(cells: Arrangement) -> tuple[tuple[Border, ...], ...]:
    """For every cell, its neighbours and which planes may meet at each."""
    borders: list[list[Border]] = [[] for _ in cells.cells]
    planes = range(len(cells.inverse))
    for a, b, line in cells.neighbours():
        middle, length = _shared(cells, a, b)
        depth = [float(cells.inverse_at(k, middle[None])[0]) for k in planes]
        ending = cells.lines[line].ending
        allowed = np.eye(len(planes), dtype=bool)
        for i, j in permutations(planes, 2):
            nearer = i if depth[i] > depth[j] else j
            allowed[i, j] = {i, j} == ending or nearer in ending
        borders[a].append(Border(b, allowed, EDGE_COST * length))
        borders[b].append(Border(a, allowed.T, EDGE_COST * length))
    return tuple(tuple(of_cell) for of_cell in borders)


def _shared(cells: Arrangement, a: int, b: int) -> tuple[Float[np.ndarray, "2"], float]:
    """Middle and length of the edge between two cells."""
    one, two = cells.cells[a].corners, cells.cells[b].corners
    common = [p for p in one if np.linalg.norm(two - p, axis=1).min() < 1e-6]
    if len(common) < 2:
        return (one.mean(axis=0) + two.mean(axis=0)) / 2, 0.0
    return (common[0] + common[-1]) / 2, float(np.linalg.norm(common[-1] - common[0]))


def labelled(costs: Float[np.ndarray, "c p"], borders: Sequence[Sequence[Border]]) -> tuple[int, ...] | None:
    """The cheapest feasible plane of every cell; None where there is none.

    The publication's problem in whole numbers: one of `c p` switches is on for every cell, a plane is shown only beside
    planes that may meet it there, and every border between two planes costs its length.

    Args:
        costs: of every plane in every cell, infinite where it cannot be seen.
        borders: as `borders_of` gives them.
    """
    if not costs.size or not np.isfinite(costs.min(axis=1)).all():
        return None
    cells, planes = costs.shape
    pairs = [(a, b) for a, of_cell in enumerate(borders) for b in of_cell]
    switches, between = cells * planes, len(pairs)
    one_each = sparse.hstack([sparse.kron(sparse.eye(cells), np.ones((1, planes))), sparse.csr_array((cells, between))])
    visible = np.isfinite(costs).ravel()
    constraints = [LinearConstraint(one_each, 1.0, 1.0)]
    if pairs:
        constraints.append(LinearConstraint(_neighbouring(pairs, cells, planes), -np.inf, 0.0))
    solved = milp(
        np.concatenate([np.where(visible, costs.ravel(), 0.0), [0.5 * border.length for _, border in pairs]]),
        integrality=np.concatenate([np.ones(switches), np.zeros(between)]),
        bounds=Bounds(0.0, np.concatenate([visible.astype(float), np.ones(between)])),
        constraints=constraints,
        options={"node_limit": MAX_NODES},
    )
    if solved.x is None:
        return None
    return tuple(int(p) for p in solved.x[:switches].reshape(cells, planes).argmax(axis=1))


def _neighbouring(pairs: Sequence[tuple[int, Border]], cells: int, planes: int) -> sparse.csr_array:
    """Rows, each at most 0, for every border and plane.

    First own plane less those of the other cell that may meet it; then own plane less the other's less the edge.
    """
    here = np.array([cell for cell, _ in pairs])[:, None]
    neighbours = np.array([border.other for _, border in pairs])[:, None]
    number, plane = np.arange(len(pairs))[:, None], np.arange(planes)
    may_meet, of_edge = 2 * planes * number + plane, 2 * planes * number + planes + plane
    nodes, other = here * planes + plane, neighbours * planes + plane
    edge = np.broadcast_to(cells * planes + number, nodes.shape)
    at, mine, theirs = np.nonzero([border.allowed for _, border in pairs])
    rows = [may_meet, may_meet[at, mine], of_edge, of_edge, of_edge]
    columns = [nodes, other[at, theirs], nodes, other, edge]
    values = [np.full(c.shape, sign) for c, sign in zip(columns, (1.0, -1.0, 1.0, -1.0, -1.0), strict=True)]
    row, column, value = (np.concatenate([x.ravel() for x in part]) for part in (rows, columns, values))
    return sparse.csr_array((value, (row, column)), shape=(2 * planes * len(pairs), cells * planes + len(pairs)))
