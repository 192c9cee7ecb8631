"""What a reading of one object costs the others: things that rest in its box lie on it more or less well, and its top
is opaque, so that what is seen there does not stand on the floor behind it.

Things in a heap on a table are taken for larger ones on the floor far behind it where nothing but their sizes tells the
two apart. On the floor they would be seen through the top.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.floor import solve_all
from diorama_core.perception.metrology.problem import Cuboids, Problems, View
from diorama_core.perception.metrology.settings import SETTINGS, BoxObservationSettings
from diorama_core.perception.metrology.supported_objects import place_on, supporters_of


@dataclass(frozen=True, eq=False)
class CarriedCosts:
    """Costs of readings by what they would carry. Those that are known are not solved again."""

    observations: BoxObservations
    view: View
    height_m: float
    _known: dict[tuple[int, bytes], float] = field(default_factory=dict)
    """By carrier and cuboid."""

    def costs(self, readings: Mapping[int, Cuboids]) -> dict[int, Float[np.ndarray, "_"]]:
        """Cost of each reading of each object; 0 where there is nothing to choose, or nothing to carry."""
        children = {i: self._children(i) for i, boxes in readings.items() if len(boxes.yaw_rad) > 1}
        asked = {
            i: [readings[i].rows(np.array([k])) for k in range(len(readings[i].yaw_rad))]
            for i, loads in children.items()
            if loads
        }
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
            if category.mount == "surface" and supporters_of(self.observations, i, [parent])
        ]

    def _solve(self, carriers: list[tuple[int, Cuboids]], children: Mapping[int, list[int]]) -> None:
        """All at once: a row's solution does not depend on the others'."""
        rows: list[Problems] = []
        below: list[int] = []
        """The carrier that each row lies on."""
        for at, (parent, box) in enumerate(carriers):
            made = [
                p for i in children[parent] for p in place_on(self.observations, i, parent, box, self.height_m, 0.0)
            ]
            rows += made
            below += [at] * sum(map(len, made))
        solved = solve_all(rows, self.view, self.observations.settings)
        lowest = np.full((len(carriers), len(self.observations)), np.inf)
        item = solved.problems.item.astype(int)
        np.minimum.at(lowest, (np.tile(below, len(item) // len(below)), item), solved.cost)
        for at, (parent, box) in enumerate(carriers):
            self._known[_key(parent, box)] = sum(
                min(float(lowest[at, i]), self.observations.settings.placement.max_carried_cost)
                for i in children[parent]
            )


def _key(parent: int, box: Cuboids) -> tuple[int, bytes]:
    return parent, box.centre.tobytes() + box.yaw_rad.tobytes() + box.size_m.tobytes()


def share_seen_through_top(
    box_px: Float[np.ndarray, "4"],
    standing: Cuboids,
    carrier: Cuboids,
    height_m: float,
    view: View,
    settings: BoxObservationSettings = SETTINGS.observed,
) -> float:
    """Share of the lower end of a thing on the floor that would be seen through the top of another, 0 to 1.

    Args:
        box_px: Of the thing in the picture.
        standing: Where it would stand; one cuboid.
        carrier: What has the top; one cuboid.
        height_m: Of the camera above the floor.
        view: How the camera is held.
    """
    drop = float(carrier.top_m[0]) - height_m
    (x1, y1, x2, y2), k = box_px, view.intrinsics
    across = (x1 + x2) / 2 + 0.5 * settings.middle * (x2 - x1) * np.linspace(-1.0, 1.0, settings.samples)
    row = np.full(settings.samples, (y2 - settings.lower * (y2 - y1) - k.cy) / k.fy)
    rays = np.column_stack([(across - k.cx) / k.fx, row, np.ones(settings.samples)]) @ view.R_world_camera.T
    down = rays[:, 2] * np.sign(drop) > 1e-6
    met = (drop / np.where(down, rays[:, 2], 1.0))[:, None] * rays[:, :2]
    nearest = float(np.linalg.norm(standing.centre[0, :2])) - 0.5 * float(standing.size_m[0, :2].max())
    c, s = np.cos(carrier.yaw_rad[0]), np.sin(carrier.yaw_rad[0])
    off = (met - carrier.centre[0, :2]) @ np.array([[c, -s], [s, c]])
    on_top = (np.abs(off) <= carrier.size_m[0, :2] / 2).all(axis=1)
    return float((down & on_top & (drop < 0) & (np.linalg.norm(met, axis=1) < nearest)).mean())
