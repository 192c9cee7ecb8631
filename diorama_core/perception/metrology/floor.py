"""Things on the floor, and with them the camera's height: one scan in which all objects vote."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import UNKNOWN, Category
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.priors import size_modes
from diorama_core.perception.metrology.problem import UNTOLD, Problems, View, stacked
from diorama_core.perception.metrology.rows import contact_start, row, size_start
from diorama_core.perception.metrology.solver import Solutions, solve

HEIGHT_PRIOR_M = 1.4
HEIGHT_LOG_SIGMA = 0.25
HEIGHTS_M: Float[np.ndarray, "13"] = np.geomspace(0.5, 2.3, 13)
_CAP = 25.0
"""No object counts more than this: it may be mislabelled."""
_DOUBTFUL_CAP = 9.0
"""The same for things that need not stand on the floor."""
_ODD_ANGLE_COST = 1.5
_ODD_ANGLES_DEG = (30.0, -30.0, 60.0, -60.0)
_SCAN_ITERATIONS = 10
_FARTHER = 1.6
_MAYBE_ELSEWHERE = frozenset({UNKNOWN.name, "box", "plant", "basket", "sink"})


@dataclass(frozen=True, eq=False)
class HeightScan:
    """How well every camera height explains the things on the floor."""

    height_m: float
    log_sigma: float
    """Of the height, from the curve's width at its minimum."""
    cost: float
    """At the minimum, the height's own prior included."""


def stands_on_floor(category: Category) -> bool:
    """Whether a category's objects tell the camera's height by standing on the floor (doors do)."""
    return category.mount == "floor" or category.name == "door"


def scan_heights(observations: BoxObservations, view: View) -> HeightScan:
    """Find the camera's height at which the objects on the floor have the most plausible sizes.

    Without any, the prior decides.
    """
    voters = [i for i in range(len(observations)) if stands_on_floor(observations.categories[i])]
    log_heights = np.log(HEIGHTS_M)
    total = ((log_heights - np.log(HEIGHT_PRIOR_M)) / HEIGHT_LOG_SIGMA) ** 2
    if voters:
        rows = stacked([p for i in voters for p in _scan_rows(observations, i)])
        total = total + _votes(rows, observations, view)
    log_height, log_sigma, cost = _minimum(log_heights, total)
    return HeightScan(float(np.exp(log_height)), log_sigma, cost)


def place_on_floor(observations: BoxObservations, index: int, height_m: float) -> list[Problems]:
    """Rows for an object on the floor, with odd headings where its category stands freely."""
    rows = []
    for mode in size_modes(observations.categories[index].name):
        for yaw, cost in _headings(observations.categories[index]):
            rows.append(row(observations, index, mode, camera_height_m=height_m, yaw_rad=yaw, extra=mode.cost + cost))
    return rows


def solve_all(rows: list[Problems], view: View) -> Solutions:
    """Solve rows from the contact with their base, from their expected size, and from farther away.

    The last matters for things cut by the picture's border, which fit from many distances.
    """
    batch = stacked(rows)
    starts = [contact_start(batch, view), size_start(batch, view), size_start(batch, view, _FARTHER)]
    return solve(stacked([batch] * len(starts)), np.concatenate(starts), view)


def _headings(category: Category) -> list[tuple[float, float]]:
    """Headings of the front (modulo half a turn) with their costs."""
    headings = [(0.0, 0.0), (np.pi / 2, 0.0)]
    if category.quarter_turns_free:
        headings += [(np.deg2rad(angle), _ODD_ANGLE_COST) for angle in _ODD_ANGLES_DEG]
    return headings


def _scan_rows(observations: BoxObservations, index: int) -> list[Problems]:
    """Rows for one object at every height; the cut is left out, it would draw the camera up and away."""
    category = observations.categories[index]
    return [
        row(observations, index, mode, camera_height_m=float(height), yaw_rad=yaw, cut_sigma=UNTOLD)
        for mode in size_modes(category.name)
        for yaw in ((0.0,) if mode.square else (0.0, np.pi / 2))
        for height in HEIGHTS_M
    ]


def _votes(rows: Problems, observations: BoxObservations, view: View) -> Float[np.ndarray, "13"]:
    """Sum over objects of their best cost at every height."""
    named = np.array([observations.categories[int(i)] is not UNKNOWN for i in rows.item])
    doubled = stacked([rows, rows.rows(named)])
    starts = np.concatenate([contact_start(rows, view), size_start(rows.rows(named), view)])
    solved = solve(doubled, starts, view, _SCAN_ITERATIONS)
    total = np.zeros(len(HEIGHTS_M))
    slots = np.searchsorted(HEIGHTS_M, doubled.camera_height_m - 1e-9)
    for index in np.unique(doubled.item).astype(int):
        mine = doubled.item == index
        best = np.full(len(HEIGHTS_M), np.inf)
        np.minimum.at(best, slots[mine], solved.cost[mine])
        doubtful = observations.categories[index].name in _MAYBE_ELSEWHERE
        total += np.minimum(best, _DOUBTFUL_CAP if doubtful else _CAP)
    return total


def _minimum(x: Float[np.ndarray, "n"], y: Float[np.ndarray, "n"]) -> tuple[float, float, float]:
    """The parabola through the lowest sample and its neighbours: place, sigma and value of its minimum."""
    i = int(np.clip(np.argmin(y), 1, len(x) - 2))
    a, b, c = np.polyfit(x[i - 1 : i + 2] - x[i], y[i - 1 : i + 2], 2)
    if a <= 1e-6:
        best = int(np.argmin(y))
        return float(x[best]), 1.0, float(y[best])
    place = float(np.clip(-b / (2 * a), x[i - 1] - x[i], x[i + 1] - x[i]))
    return float(x[i] + place), float(1 / np.sqrt(a)), float(a * place**2 + b * place + c)
