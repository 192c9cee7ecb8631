"""Choosing one reading of every thing on the floor so that they fit together.

Boxes leave several readings open: a near chair or a far table, a sofa along this axis or that. The chosen ones should
not stand in each other, and what lies on them should find its place there.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import Category, having
from diorama_core.perception.metrology.problem import Cuboids
from diorama_core.perception.metrology.settings import SETTINGS, PlacementSettings

_SEATS, _TABLES = having("under_tables"), having("legroom")


def distinct(
    boxes: Cuboids, costs: Float[np.ndarray, "n"], settings: PlacementSettings = SETTINGS.placement
) -> list[int]:
    """The cheapest rows that differ from each other in place, heading or size, cheapest first."""
    rows: list[int] = []
    for row in np.argsort(costs, kind="stable"):
        if len(rows) == settings.max_readings or (rows and costs[row] > costs[rows[0]] + settings.dearest):
            break
        if not any(_is_alike(boxes, int(row), other, settings) for other in rows):
            rows.append(int(row))
    return rows


def _is_alike(boxes: Cuboids, a: int, b: int, settings: PlacementSettings) -> bool:
    """Whether two readings hardly differ in place, heading and size."""
    return bool(
        np.linalg.norm(boxes.centre[a] - boxes.centre[b]) < settings.same_place_m
        and np.abs(np.log(_footprint_axes(boxes, a) / _footprint_axes(boxes, b))).max() < settings.same_size
    )


def _footprint_axes(boxes: Cuboids, row: int) -> Float[np.ndarray, "2"]:
    """Extents along the world's axes of the footprint."""
    c, s = np.abs(np.cos(boxes.yaw_rad[row])), np.abs(np.sin(boxes.yaw_rad[row]))
    depth, width = boxes.size_m[row, :2]
    return np.array([c * depth + s * width, s * depth + c * width])


def arrange(
    readings: list[Cuboids],
    costs: list[Float[np.ndarray, "_"]],
    categories: list[Category],
    settings: PlacementSettings = SETTINGS.placement,
) -> list[int]:
    """One reading per object: starting from the cheapest, objects change in turn while the whole becomes cheaper.

    Args:
        readings: Per object its readings, as a batch.
        costs: Per object the cost of each.
        categories: Per object.

    Returns:
        Per object the index of its reading.
    """
    chosen = [int(np.argmin(c)) for c in costs]
    pair = _pair_costs(readings, categories, settings)
    for _ in range(settings.rounds):
        before = list(chosen)
        for i in range(len(readings)):
            total = costs[i] + sum(pair[i][j][:, chosen[j]] for j in range(len(readings)) if j != i)
            if total[chosen[i]] > total.min() + 1e-9:
                chosen[i] = int(np.argmin(total))
        if chosen == before:
            break
    return chosen


def _pair_costs(
    readings: list[Cuboids], categories: list[Category], settings: PlacementSettings
) -> list[list[Float[np.ndarray, "_ _"]]]:
    count = len(readings)
    table = [[np.zeros((1, 1))] * count for _ in range(count)]
    for i in range(count):
        for j in range(i + 1, count):
            weight = settings.tucked_cost if _is_seat_at_table(categories[i], categories[j]) else settings.overlap_cost
            shared = weight * _footprint_overlap(readings[i], readings[j], settings)
            table[i][j], table[j][i] = shared, shared.T
    return table


def _is_seat_at_table(a: Category, b: Category) -> bool:
    return (a.name in _SEATS and b.name in _TABLES) or (b.name in _SEATS and a.name in _TABLES)


def _footprint_overlap(a: Cuboids, b: Cuboids, settings: PlacementSettings) -> Float[np.ndarray, "k l"]:
    """Share of the smaller footprint that lies in the other, for all pairs of readings; 0 for flat things."""
    a_in_b, b_in_a = _share_inside(a, b), _share_inside(b, a).T
    solid_a, solid_b = (boxes.size_m[:, 2] > settings.on_footprint_flat_m for boxes in (a, b))
    return np.where(solid_a[:, None] & solid_b, np.maximum(a_in_b, b_in_a), 0.0)


def _share_inside(a: Cuboids, b: Cuboids) -> Float[np.ndarray, "k l"]:
    """Share of a's footprint (a grid of points, shrunk by a tenth) inside b's footprint."""
    steps = np.linspace(-0.45, 0.45, 7)
    grid = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    points = _rotate(grid[None] * a.size_m[:, None, :2], a.yaw_rad[:, None]) + a.centre[:, None, :2]
    offset = points[:, None] - b.centre[None, :, None, :2]
    local = _rotate(offset, -b.yaw_rad[None, :, None])
    return (np.abs(local) <= b.size_m[None, :, None, :2] / 2).all(axis=-1).mean(axis=-1)


def _rotate(points: Float[np.ndarray, "*n 2"], yaw: Float[np.ndarray, "*m"]) -> Float[np.ndarray, "*n 2"]:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack([c * points[..., 0] - s * points[..., 1], s * points[..., 0] + c * points[..., 1]], axis=-1)
