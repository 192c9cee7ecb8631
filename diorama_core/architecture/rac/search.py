"""The discrete search: which plane every cell of the picture shows (Stekovic et al. 2020, section 3).

A labelling is feasible when the planes of neighbouring cells meet at the line between them, or when the nearer of the
two ends there at its intersection with a third plane and hides the farther one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.architecture.rac.arrangement import Arrangement

MAX_STEPS = 30000
"""Partial labellings that are looked at; without a feasible one among them there is no layout."""
EDGE_COST = 2e-5
"""Of a pixel of edge between two planes, beside a picture in which everything disagrees: of layouts that agree as well,
which differ behind furniture only, the one with the shortest edges is taken."""


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
    found: list[list[Border]] = [[] for _ in cells.cells]
    planes = range(len(cells.inverse))
    for a, b, line in cells.neighbours():
        middle, length = _shared(cells, a, b)
        depth = [float(cells.inverse_at(k, middle[None])[0]) for k in planes]
        meeting = set(cells.lines[line]) if cells.lines[line][0] != cells.lines[line][1] else set()
        allowed = np.eye(len(planes), dtype=bool)
        for i in planes:
            for j in planes:
                if i != j and meeting:
                    nearer = i if depth[i] > depth[j] else j
                    allowed[i, j] = {i, j} == meeting or nearer in meeting
        found[a].append(Border(b, allowed, EDGE_COST * length))
        found[b].append(Border(a, allowed.T, EDGE_COST * length))
    return tuple(tuple(of_cell) for of_cell in found)


def _shared(cells: Arrangement, a: int, b: int) -> tuple[Float[np.ndarray, "2"], float]:
    """Middle and length of the edge between two cells."""
    one, two = cells.cells[a].corners, cells.cells[b].corners
    common = [p for p in one if np.linalg.norm(two - p, axis=1).min() < 1e-6]
    if len(common) < 2:
        return (one.mean(axis=0) + two.mean(axis=0)) / 2, 0.0
    return (common[0] + common[-1]) / 2, float(np.linalg.norm(common[-1] - common[0]))


@dataclass
class _Search:
    """Depth first, the cheapest plane of a cell first, cut off by the best labelling so far."""

    costs: Float[np.ndarray, "c p"]
    borders: Sequence[Sequence[Border]]
    order: Sequence[int]
    rest: Float[np.ndarray, "_"]
    best: float = np.inf
    found: Mapping[int, int] = field(default_factory=dict)
    steps: int = 0

    def go(self, depth: int, chosen: dict[int, int], spent: float) -> None:
        if self.steps >= MAX_STEPS or spent + self.rest[depth] >= self.best:
            return
        self.steps += 1
        if depth == len(self.order):
            self.best, self.found = spent, dict(chosen)
            return
        cell = self.order[depth]
        own = self.costs[cell].copy()
        for border in self.borders[cell]:
            if border.other in chosen:
                other = chosen[border.other]
                own[~border.allowed[:, other]] = np.inf
                own[np.arange(len(own)) != other] += border.length
        for plane in np.argsort(own, kind="stable"):
            if not np.isfinite(own[plane]):
                break
            chosen[cell] = int(plane)
            self.go(depth + 1, chosen, spent + float(own[plane]))
            del chosen[cell]


def labelled(costs: Float[np.ndarray, "c p"], borders: Sequence[Sequence[Border]]) -> tuple[int, ...] | None:
    """The cheapest feasible plane of every cell; None where the search finds none.

    Args:
        costs: of every plane in every cell, infinite where it cannot be seen.
        borders: as `borders_of` gives them.
    """
    if not costs.size or not np.isfinite(costs.min(axis=1)).all():
        return None
    order = _order(costs, borders)
    least = np.array([costs[k].min() for k in order])
    rest = np.concatenate([np.cumsum(least[::-1])[::-1], [0.0]])
    search = _Search(costs, borders, order, rest)
    search.go(0, {}, 0.0)
    return tuple(search.found[k] for k in range(len(costs))) if search.found else None


def _order(costs: Float[np.ndarray, "c p"], borders: Sequence[Sequence[Border]]) -> list[int]:
    """The surest cell first, then always the surest that touches what is decided."""
    finite = np.where(np.isfinite(costs), costs, 1.0)
    two = np.sort(finite, axis=1)[:, :2]
    regret = two[:, 1] - two[:, 0] if two.shape[1] > 1 else np.ones(len(costs))
    left, order = set(range(len(costs))), []
    touching: set[int] = set()
    while left:
        pick = max(touching or left, key=lambda k: (regret[k], -k))
        order.append(pick)
        left.discard(pick)
        touching = (touching | {b.other for b in borders[pick]}) & left
    return order
