"""How well things that rest in another's box would lie on each of its readings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.floor import solve_all
from diorama_core.perception.metrology.problem import Cuboids, Problems, View
from diorama_core.perception.metrology.settings import SETTINGS, MetrologySettings
from diorama_core.perception.metrology.supported_objects import place_on, supporters_of


@dataclass(frozen=True, eq=False)
class CarriedCosts:
    """Costs of readings by what they would carry. Those that are known are not solved again."""

    observations: BoxObservations
    view: View
    height_m: float
    _known: dict[tuple[int, bytes], float] = field(default_factory=dict)
    """By carrier and cuboid."""
    settings: MetrologySettings = SETTINGS

    def of(self, readings: Mapping[int, Cuboids]) -> dict[int, Float[np.ndarray, "_"]]:
        """Per object the cost of each of its readings; 0 where there is nothing to choose, or nothing to carry.

        Args:
            readings: Cuboids that each object may be, by index.
        """
        children = {i: self._children(i) for i, boxes in readings.items() if len(boxes.yaw_rad) > 1}
        asked = {i: list(_singly(readings[i])) for i, loads in children.items() if loads}
        unknown = [(i, one) for i, boxes in asked.items() for one in boxes if _key(i, one) not in self._known]
        if unknown:
            self._solve(unknown, children)
        costs = {i: np.zeros(len(boxes.yaw_rad)) for i, boxes in readings.items()}
        return costs | {i: np.array([self._known[_key(i, one)] for one in boxes]) for i, boxes in asked.items()}

    def _children(self, parent: int) -> list[int]:
        """What rests in the parent's box."""
        return [
            i
            for i, category in enumerate(self.observations.categories)
            if category.mount == "surface"
            and parent in supporters_of(self.observations, i, [parent], self.settings.placement)
        ]

    def _solve(self, carriers: list[tuple[int, Cuboids]], children: Mapping[int, list[int]]) -> None:
        """All at once: a row's solution does not depend on the others'."""
        rows: list[Problems] = []
        below: list[int] = []
        """The carrier that each row lies on."""
        for at, (parent, box) in enumerate(carriers):
            loads = children[parent]
            made = [
                p for i in loads for p in place_on(self.observations, i, parent, box, self.height_m, 0.0, self.settings)
            ]
            rows += made
            below += [at] * sum(map(len, made))
        solved = solve_all(rows, self.view, self.settings)
        lowest = np.full((len(carriers), len(self.observations)), np.inf)
        item = solved.problems.item.astype(int)
        np.minimum.at(lowest, (np.tile(below, len(item) // len(below)), item), solved.cost)
        for at, (parent, box) in enumerate(carriers):
            self._known[_key(parent, box)] = sum(
                min(float(lowest[at, i]), self.settings.placement.max_carried_cost) for i in children[parent]
            )


def _singly(boxes: Cuboids) -> Iterator[Cuboids]:
    """Batches of one."""
    for k in range(len(boxes.yaw_rad)):
        yield Cuboids(boxes.centre[k : k + 1], boxes.yaw_rad[k : k + 1], boxes.size_m[k : k + 1])


def _key(parent: int, box: Cuboids) -> tuple[int, bytes]:
    return parent, box.centre.tobytes() + box.yaw_rad.tobytes() + box.size_m.tobytes()
