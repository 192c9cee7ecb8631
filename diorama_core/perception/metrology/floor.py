"""Things on the floor, and with them the camera's height: one scan in which all objects vote."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.library.taxonomy import PORTABLE, UNKNOWN, Category, having
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.priors import SizeMode, standing_costs
from diorama_core.perception.metrology.problem import UNKNOWNS, UNTOLD, Problems, View, concatenate_problems
from diorama_core.perception.metrology.rows import contact_start, other_start, row, size_start
from diorama_core.perception.metrology.settings import SETTINGS, HeightScanSettings, MetrologySettings
from diorama_core.perception.metrology.solver import Solutions, solve

HEIGHTS_M: Float[np.ndarray, "13"] = np.geomspace(0.5, 2.3, 13)
TELL_LITTLE = PORTABLE | having("rug")
"""Things that vote on the camera's height only where nothing else does: they may stand on furniture, or be as large as
they like and half hidden by what stands on them."""
_MAYBE_ELSEWHERE = PORTABLE | {UNKNOWN.name, "sink"}


@dataclass(frozen=True, eq=False)
class HeightScan:
    """How well every camera height explains the things on the floor."""

    height_m: float
    log_sigma: float
    """Logarithmic deviation of the height, from the curve's width at its minimum."""
    cost: float
    """At the minimum, the height's own prior included."""


def stands_on_floor(category: Category) -> bool:
    """Whether a category's objects tell the camera's height by standing on the floor (doors do)."""
    return category.mount == "floor" or category.name == "door"


def scan_heights(observations: BoxObservations, view: View) -> HeightScan:
    """Find the camera's height at which the objects on the floor have the most plausible sizes.

    Without any, the prior decides.
    """
    return scan_heights_together([(observations, view, range(len(observations)))], settings=observations.settings)


def scan_heights_together(
    pictures: Sequence[tuple[BoxObservations, View, Collection[int]]],
    further_cost: Float[np.ndarray, "13"] | None = None,
    settings: MetrologySettings = SETTINGS,
) -> HeightScan:
    """Find the height of a camera that took several pictures from one place.

    Args:
        pictures: objects, camera, and which of the objects vote.
        further_cost: what else speaks against each of `HEIGHTS_M`, in squared sigmas.
        settings: of metrology.
    """
    standing = [
        [i for i in voting if stands_on_floor(observations.categories[i])] for observations, _, voting in pictures
    ]
    telling = [
        [i for i in rows if observations.categories[i].name not in TELL_LITTLE]
        for rows, (observations, _, _) in zip(standing, pictures, strict=True)
    ]
    log_heights = np.log(HEIGHTS_M)
    off = (log_heights - np.log(settings.heights.height_prior_m)) / settings.heights.height_log_sigma
    total = (settings.heights.height_tails + 1) * np.log1p(off**2 / settings.heights.height_tails)
    for observations, _, _ in pictures:
        if observations.depths is not None:
            off = (log_heights - observations.depths.log_height) / observations.depths.height_sigma
            total = total + off**2
    for voters, (observations, view, _) in zip(telling if any(telling) else standing, pictures, strict=True):
        if voters:
            rows = concatenate_problems([p for i in voters for p in _scan_rows(observations, i)])
            total = total + _votes(rows, observations, view)
    total = total if further_cost is None else total + further_cost
    log_height, log_sigma, cost = _parabola_minimum(log_heights, total)
    return HeightScan(float(np.exp(log_height)), log_sigma, cost)


def place_on_floor(
    observations: BoxObservations, index: int, height_m: float, modes: tuple[SizeMode, ...] | None = None
) -> list[Problems]:
    """Rows for an object on the floor, with odd headings where its category stands freely.

    Args:
        observations: of all objects.
        index: of the object.
        height_m: of the camera above the floor.
        modes: sizes that the object may have, those of its category by default.
    """
    category, rows = observations.categories[index], []
    for mode in modes or observations.size_modes(index):
        raised = standing_costs(category.name, mode, observations.settings.placement)[0]
        for yaw, cost in _headings(category, observations.settings.heights):
            extra = mode.cost + cost + raised
            rows.append(row(observations, index, mode, camera_height_m=height_m, yaw_rad=yaw, extra=extra))
    return rows


def solve_all(rows: list[Problems], view: View, settings: MetrologySettings = SETTINGS) -> Solutions:
    """Solve rows from the contact with their base, from their expected size, and from farther away.

    The last matters for things cut by the picture's border, which fit from many distances.
    """
    batch = concatenate_problems(rows)
    starts = [
        contact_start(batch, view, settings.fit),
        size_start(batch, view, settings=settings.fit),
        other_start(batch, view, settings.heights.farther, settings.fit),
    ]
    return solve(concatenate_problems([batch] * len(starts)), np.concatenate(starts), view, settings=settings.fit)


def _headings(category: Category, settings: HeightScanSettings) -> list[tuple[float, float]]:
    """Headings of the front (modulo half a turn) with their costs."""
    headings = [(0.0, 0.0), (np.pi / 2, 0.0)]
    if category.quarter_turns_free:
        headings += [(np.deg2rad(angle), settings.odd_angle_cost) for angle in settings.odd_angles_deg]
    return headings


def _scan_rows(observations: BoxObservations, index: int) -> list[Problems]:
    """Rows for one object at every height; the cut is left out, it would draw the camera up and away."""
    return [
        row(observations, index, mode, camera_height_m=float(height), yaw_rad=yaw, cut_sigma=UNTOLD)
        for mode in observations.size_modes(index)
        for yaw in ((0.0,) if mode.square else (0.0, np.pi / 2))
        for height in HEIGHTS_M
    ]


def _votes(rows: Problems, observations: BoxObservations, view: View) -> Float[np.ndarray, "13"]:
    """Sum over objects of how badly all their readings together fit at every height; those of a kind share votes."""
    total, settings = np.zeros(len(HEIGHTS_M)), observations.settings.heights
    costs = _costs_at_heights(rows, observations, view)
    names = [observations.categories[i].name for i in costs]
    for name, cost in zip(names, costs.values(), strict=True):
        most = settings.max_doubtful_vote if name in _MAYBE_ELSEWHERE else settings.max_vote
        total += np.minimum(cost, most) * (1 / (1 + (names.count(name) - 1) * settings.alike))
    return total


def _costs_at_heights(rows: Problems, observations: BoxObservations, view: View) -> dict[int, Float[np.ndarray, "13"]]:
    """For every object how badly all its readings together fit at every height of the camera.

    `rows` come in runs of one assumption at every height. A solution made larger with the camera's height projects
    alike, so every height starts once more from its neighbours' solutions: no vote hangs on an unlucky start.
    """
    settings = observations.settings
    named = np.array([observations.categories[int(i)] is not UNKNOWN for i in rows.item])
    again = rows.rows(named)
    starts = np.concatenate([contact_start(rows, view, settings.fit), other_start(again, view, settings=settings.fit)])
    first = solve(concatenate_problems([rows, again]), starts, view, settings.heights.scan_iterations, settings.fit)
    rows_of_costs = np.concatenate([np.arange(len(rows)), np.flatnonzero(named)])
    cost, unknowns = np.full(len(rows), np.inf), np.zeros((len(rows), UNKNOWNS))
    for k in np.argsort(-first.cost, kind="stable"):
        cost[rows_of_costs[k]], unknowns[rows_of_costs[k]] = first.cost[k], first.unknowns[k]
    for step in (1, -1):
        start = _from_neighbours(unknowns, step)
        again_solved = solve(rows, start, view, settings.heights.continued_iterations, settings.fit)
        better = again_solved.cost < cost
        cost = np.where(better, again_solved.cost, cost)
        unknowns = np.where(better[:, None], again_solved.unknowns, unknowns)
    costs = {}
    slots = np.searchsorted(HEIGHTS_M, rows.camera_height_m - 1e-9)
    for index in np.unique(rows.item).astype(int):
        mine = rows.item == index
        best = np.full(len(HEIGHTS_M), -np.inf)
        np.logaddexp.at(best, slots[mine], -0.5 * cost[mine])
        costs[int(index)] = -2.0 * best
    return costs


def _from_neighbours(unknowns: Float[np.ndarray, "n 6"], step: int) -> Float[np.ndarray, "n 6"]:
    """For every row the solution at the next height of its run, scaled to its own height."""
    by_run = unknowns.reshape(-1, len(HEIGHTS_M), UNKNOWNS)
    place = np.clip(np.arange(len(HEIGHTS_M)) + step, 0, len(HEIGHTS_M) - 1)
    start = by_run[:, place].reshape(-1, UNKNOWNS).copy()
    start[:, 1:5] += np.tile(np.log(HEIGHTS_M / HEIGHTS_M[place]), len(by_run))[:, None]
    return start


def _parabola_minimum(x: Float[np.ndarray, "n"], y: Float[np.ndarray, "n"]) -> tuple[float, float, float]:
    """The parabola through the lowest sample and its neighbours: place, sigma and value of its minimum."""
    i = int(np.clip(np.argmin(y), 1, len(x) - 2))
    a, b, c = np.polyfit(x[i - 1 : i + 2] - x[i], y[i - 1 : i + 2], 2)
    if a <= 1e-6:
        best = int(np.argmin(y))
        return float(x[best]), 1.0, float(y[best])
    place = float(np.clip(-b / (2 * a), x[i - 1] - x[i], x[i + 1] - x[i]))
    return float(x[i] + place), float(1 / np.sqrt(a)), float(a * place**2 + b * place + c)
