"""The discrete search: which plane every cell of the picture shows (Stekovic et al. 2020), by what each plane costs in
each cell.

Costs are the publication's two: a layout's depth should be that which is measured where the room is seen and nowhere
in front of the objects, and its segments should be those of the picture.

A labelling is feasible when the planes of neighbouring cells meet at the line between them, or when the nearer of the
two ends there at its intersection with a third plane and hides the farther one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy import sparse
from scipy.optimize import Bounds, LinearConstraint, milp

from diorama_core.architecture.rac.arrangement import Arrangement, PlaneLine, arrangement, inverse_depths
from diorama_core.architecture.rac.proposals import Proposals
from diorama_core.architecture.walls.surface import MeasuredSurface
from diorama_core.scene.types import Camera

FULL_DISAGREEMENT = 0.2
"""Relative difference of depth that counts in full."""
SEGMENT_WEIGHT = 0.5
"""Cost of a pixel in another plane's segment, beside one with the wrong depth."""


@dataclass(frozen=True, eq=False)
class RoomLayout:
    """A plane for every cell of the picture."""

    cells: Arrangement
    chosen: tuple[int, ...]
    """The plane of each cell."""

    def planes_at(self, pixels: Float[np.ndarray, "n 2"]) -> Int[np.ndarray, "n"]:
        """The plane that each pixel shows; -1 for one in a piece too small to be a cell."""
        cell = self.cells.holds(pixels)
        return np.where(cell >= 0, np.array(self.chosen, dtype=int)[cell], -1)

    def depth_at(self, pixels: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n"]:
        """Rendered depth in metres; infinite where no cell is."""
        plane = self.planes_at(pixels)
        rows = self.cells.inverse[np.maximum(plane, 0)]
        inverse = (rows[:, :2] * pixels).sum(axis=1) + rows[:, 2]
        return np.where((plane >= 0) & (inverse > 0), 1.0 / np.maximum(inverse, 1e-9), np.inf)


def best_layout(
    surface: MeasuredSurface, proposals: Proposals, camera: Camera, hidden_ends: Sequence[PlaneLine] = ()
) -> RoomLayout | None:
    """The cheapest feasible layout of the proposed planes, with lines at which some of them may end besides.

    None where the search finds no labelling that fills the picture.

    Args:
        surface: measured points in the world, and which of them belong to objects.
        proposals: the proposed planes.
        camera: of the photo, in the world.
        hidden_ends: further lines at which planes may end, in the picture.
    """
    k = camera.intrinsics
    inverse = inverse_depths(proposals.normals, proposals.offsets, camera)
    cells = arrangement(inverse, (k.width, k.height), hidden_ends)
    chosen = label_cells(cell_costs(cells, surface, proposals, camera), borders_of(cells))
    return None if chosen is None else RoomLayout(cells, chosen)


def cell_costs(
    cells: Arrangement, surface: MeasuredSurface, proposals: Proposals, camera: Camera
) -> Float[np.ndarray, "c p"]:
    """Disagreement of each plane in each cell, in shares of the picture; infinite behind the camera.

    Args:
        cells: the c cells into which the planes' lines divide the picture.
        surface: measured points in the world, and which of them belong to objects.
        proposals: the p proposed planes.
        camera: of the photo, in the world.
    """
    pixels = camera.project(surface.points)
    cell = cells.holds(pixels)
    measured = 1.0 / np.maximum(surface.depth_m, 1e-6)
    costs = np.zeros((len(cells.cells), len(cells.inverse)))
    for p in range(len(cells.inverse)):
        q = cells.inverse_at(p, pixels)
        off = (q - measured) / measured
        # What hides the layout bounds it from one side only.
        wrong = np.where(surface.is_object, np.maximum(off, 0.0), np.abs(off))
        each = np.minimum(wrong / FULL_DISAGREEMENT, 1.0)
        each = each + SEGMENT_WEIGHT * ((proposals.segment >= 0) & (proposals.segment != p))
        inside = cell >= 0
        costs[:, p] = np.bincount(cell[inside], each[inside], minlength=len(cells.cells))
        behind = [float(cells.inverse_at(p, c.corners.mean(axis=0, keepdims=True))[0]) <= 0.0 for c in cells.cells]
        costs[np.array(behind, dtype=bool), p] = np.inf
    return costs / max(len(pixels), 1)


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
        middle, length = _common_edge(cells, a, b)
        depth = [float(cells.inverse_at(k, middle[None])[0]) for k in planes]
        ending = cells.lines[line].ending
        allowed = np.eye(len(planes), dtype=bool)
        for i, j in permutations(planes, 2):
            nearer = i if depth[i] > depth[j] else j
            allowed[i, j] = {i, j} == ending or nearer in ending
        borders[a].append(Border(b, allowed, EDGE_COST * length))
        borders[b].append(Border(a, allowed.T, EDGE_COST * length))
    return tuple(tuple(of_cell) for of_cell in borders)


def _common_edge(cells: Arrangement, a: int, b: int) -> tuple[Float[np.ndarray, "2"], float]:
    """Middle and length of the edge between two cells."""
    one, two = cells.cells[a].corners, cells.cells[b].corners
    common = [p for p in one if np.linalg.norm(two - p, axis=1).min() < 1e-6]
    if len(common) < 2:
        return (one.mean(axis=0) + two.mean(axis=0)) / 2, 0.0
    return (common[0] + common[-1]) / 2, float(np.linalg.norm(common[-1] - common[0]))


def label_cells(costs: Float[np.ndarray, "c p"], borders: Sequence[Sequence[Border]]) -> tuple[int, ...] | None:
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
