"""Deciding what holds every object: all assumptions about an object compete by cost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diorama_core.geometry.projection import cuboid_corners
from diorama_core.library.taxonomy import UNKNOWN, Category
from diorama_core.perception.metrology.evidence import Evidence
from diorama_core.perception.metrology.floor import place_on_floor, solve_from_both_starts
from diorama_core.perception.metrology.held import (
    Extent,
    extent_of,
    place_below_ceiling,
    place_on,
    place_on_wall,
    supporters_of,
)
from diorama_core.perception.metrology.problem import Cuboids, Problems, View, cuboids
from diorama_core.perception.metrology.solver import Solutions

FLOOR, WALL, CEILING = -1, -2, -3
"""Supporters that are no objects."""

_FREE, _NEVER = 0.0, np.inf
_ON_TOP_COST = {"floor": 4.0, "surface": 0.0, "wall": 4.0, "ceiling": _NEVER}
_FLOOR_COST = {"floor": 0.0, "surface": 6.0, "wall": 12.0, "ceiling": _NEVER}
_WALL_COST = {"floor": 12.0, "surface": 6.0, "wall": 0.0, "ceiling": 6.0}
_CEILING_COST = {"floor": _NEVER, "surface": 14.0, "wall": _NEVER, "ceiling": 0.0}
_UNNAMED_COSTS = {"on top": 2.0, "floor": 0.0, "wall": 3.0, "ceiling": 4.0}
_LARGE = frozenset(
    ("sofa", "bed", "wardrobe", "table", "desk", "bathtub", "piano", "dresser", "bookshelf", "refrigerator", "rug")
)
"""Things on the floor that never stand on others."""


@dataclass(frozen=True, eq=False)
class Placement:
    """What was decided about one object."""

    index: int
    supporter: int
    """Index of the supporting object, or FLOOR, WALL, CEILING."""
    solution: Solutions
    """A batch of one."""
    cuboid: Cuboids
    """A batch of one."""

    @property
    def cost(self) -> float:
        """Everything that speaks against it, in squared sigmas."""
        return float(self.solution.cost[0])


def place_all(evidence: Evidence, view: View, height_m: float) -> tuple[Placement, ...]:
    """Place every object, first on the floor, then on others, on walls and below the ceiling, the cheapest way each."""
    count = len(evidence)
    floor = _on_floor(evidence, view, height_m)
    room = extent_of(_corners([p for i, p in floor.items() if _likely_on_floor(evidence.categories[i])]))
    rows: list[Problems] = []
    supporters: list[int] = []
    for index in range(count):
        for supporter, part in _held_rows(evidence, index, floor, room, height_m):
            rows += part
            supporters += [supporter] * len(part)
    best = dict(floor)
    if rows:
        solved = solve_from_both_starts(rows, view)
        for index in range(count):
            mine = np.flatnonzero(solved.problems.item == index)
            if len(mine):
                chosen = mine[np.argmin(solved.cost[mine])]
                challenger = _placement(index, supporters[chosen % len(rows)], solved, int(chosen), view)
                if index not in best or challenger.cost < best[index].cost:
                    best[index] = challenger
    return tuple(_without_cycles(best, floor)[i] for i in range(count))


def _on_floor(evidence: Evidence, view: View, height_m: float) -> dict[int, Placement]:
    rows: list[Problems] = []
    for index, category in enumerate(evidence.categories):
        cost = _cost(category, "floor", _FLOOR_COST)
        if np.isfinite(cost):
            rows += [p.changed(extra=p.extra + cost) for p in place_on_floor(evidence, index, height_m)]
    if not rows:
        return {}
    solved = solve_from_both_starts(rows, view)
    found = {}
    for index in np.unique(solved.problems.item).astype(int):
        mine = np.flatnonzero(solved.problems.item == index)
        found[int(index)] = _placement(int(index), FLOOR, solved, int(mine[np.argmin(solved.cost[mine])]), view)
    return found


def _held_rows(
    evidence: Evidence, index: int, floor: dict[int, Placement], room: Extent, height_m: float
) -> list[tuple[int, list[Problems]]]:
    """Rows for everything but the floor that may hold an object, by supporter."""
    category = evidence.categories[index]
    options: list[tuple[int, list[Problems]]] = []
    on_top = _cost(category, "on top", _ON_TOP_COST)
    if np.isfinite(on_top) and category.name not in _LARGE:
        candidates = [i for i in floor if _likely_on_floor(evidence.categories[i])]
        for parent in supporters_of(evidence, index, candidates):
            cost = on_top + _unlikely_parent_cost(evidence.categories[parent])
            options.append((parent, place_on(evidence, index, parent, floor[parent].cuboid, height_m, cost)))
    on_wall = _cost(category, "wall", _WALL_COST)
    if np.isfinite(on_wall) and category.name not in _LARGE:
        options.append((WALL, place_on_wall(evidence, index, height_m, room, on_wall)))
    below = _cost(category, "ceiling", _CEILING_COST)
    if np.isfinite(below):
        options.append((CEILING, place_below_ceiling(evidence, index, height_m, room, below)))
    return options


def _cost(category: Category, where: str, table: dict[str, float]) -> float:
    return _UNNAMED_COSTS[where] if category is UNKNOWN else table[category.mount]


def _unlikely_parent_cost(category: Category) -> float:
    if category is UNKNOWN:
        return 0.5
    return 0.0 if category.supports_things else 4.0


def _likely_on_floor(category: Category) -> bool:
    return category.mount == "floor"


def _corners(placements: list[Placement]) -> np.ndarray:
    if not placements:
        return np.zeros((0, 8, 3))
    boxes = [p.cuboid for p in placements]
    return np.concatenate([cuboid_corners(b.centre, b.yaw_rad, b.size_m) for b in boxes])


def _placement(index: int, supporter: int, solved: Solutions, row: int, view: View) -> Placement:
    solution = solved.rows(np.array([row]))
    return Placement(index, supporter, solution, cuboids(solution.unknowns, solution.problems, view))


def _without_cycles(best: dict[int, Placement], floor: dict[int, Placement]) -> dict[int, Placement]:
    """A supporter must itself have stayed on the floor; where it did not, it is put back there."""
    needed = {p.supporter for p in best.values() if p.supporter >= 0}
    return {i: floor[i] if i in needed else p for i, p in best.items()}
