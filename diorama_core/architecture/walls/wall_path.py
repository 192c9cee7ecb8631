"""Which wall leads in each heading: the cheapest path of walls across the view, by dynamic programming.

In plan, seen from the camera, headings run from left to right. A wall costs little in a heading where its points are
seen and much where farther objects are seen through it; going over to another wall costs little where the two meet and
more where one ends in the open. A doorway, below the part of its wall that is seen above it, does not count as seen
through.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.architecture.walls.surface import MeasuredSurface
from diorama_core.architecture.walls.wall_candidates import MIN_RISE_M, WallCandidate, crossings, same_wall, tolerance_m


@dataclass(frozen=True)
class WallPathSettings:
    """Costs of the path of walls."""

    heading_bins: int = 180
    full_evidence: float = 0.08
    """A wall is fully supported in a heading when this share of the picture's height shows it."""
    full_conflict: float = 0.05
    conflict_cost: float = 2.5
    unknown_cost: float = 0.9
    """Cost of a heading in which no wall is taken to lead; one in which a wall leads unseen costs 1."""
    corner_cost: float = 1.0
    open_end_cost: float = 4.0
    into_unknown_cost: float = 2.0
    corner_bins: float = 2.5
    """Two walls meet at a heading when their corner lies within this many headings of it."""
    meet_m: float = 0.06
    meet_per_m: float = 0.02
    min_doorway_depth_m: float = 0.6
    """What is seen below a lintel this far behind it or farther is another room, not a niche under a cupboard."""
    return_bins: int = 8
    return_points: int = 15
    nearest_wall_m: float = 0.3


SETTINGS = WallPathSettings()


@dataclass(frozen=True)
class Run:
    """A wall and the headings between which it leads."""

    wall: WallCandidate
    first: float
    last: float


@dataclass(frozen=True, eq=False)
class _Headings:
    """The view divided into equal headings, and the one of each measured point."""

    edges: Float[np.ndarray, "m1"]
    of_point: Int[np.ndarray, "n"]
    rows_px: float
    """Points that one heading holds in a picture measured everywhere."""

    @property
    def middles(self) -> Float[np.ndarray, "m"]:
        return 0.5 * (self.edges[1:] + self.edges[:-1])


def heading(point: Float[np.ndarray, "*n 2"], origin: Float[np.ndarray, "2"]) -> Float[np.ndarray, "*n"]:
    """Heading of points seen from `origin`, from +Y to the right, radians."""
    offset = np.asarray(point) - origin
    return np.asarray(np.arctan2(offset[..., 0], offset[..., 1]))


def wall_runs(
    surface: MeasuredSurface, walls: list[WallCandidate], view: tuple[float, float], top_m: float
) -> list[Run]:
    """The walls that lead, from left to right; headings in which none is known are left out.

    Args:
        surface: The measured points.
        walls: Candidates that may be walls.
        view: Headings of the picture's left and right side.
        top_m: Height at which walls end.
    """
    if not walls:
        return []
    headings = _bin_headings(surface, view)
    runs = _cheapest(surface, walls, headings, top_m)
    returns = _returns(surface, runs, headings, top_m)
    return _cheapest(surface, walls + returns, headings, top_m) if returns else runs


def _bin_headings(surface: MeasuredSurface, view: tuple[float, float]) -> _Headings:
    bins = SETTINGS.heading_bins
    edges = np.linspace(view[0], view[1], bins + 1)
    headings = heading(surface.points[:, :2], surface.camera_position[:2])
    of_point = ((headings - view[0]) / (edges[1] - edges[0])).astype(int).clip(0, bins - 1)
    return _Headings(edges, of_point, surface.grid_rows * surface.grid_columns / bins)


def _cheapest(surface: MeasuredSurface, walls: list[WallCandidate], headings: _Headings, top_m: float) -> list[Run]:
    """Viterbi over headings; the last label stands for no known wall."""
    costs = np.array(
        [_wall_costs(surface, w, headings, top_m) for w in walls]
        + [np.full(SETTINGS.heading_bins, SETTINGS.unknown_cost)]
    )
    origin = surface.camera_position[:2]
    leading, breaks, _ = cheapest_path(costs, lambda number: _going_over(walls, headings, number, origin))
    edges = headings.edges[breaks].tolist()
    spans = zip(leading, pairwise(edges), strict=True)
    return [Run(walls[label], first, last) for label, (first, last) in spans if label < len(walls)]


def cheapest_path(
    costs: Float[np.ndarray, "w m"], going_over: Callable[[int], Float[np.ndarray, "w w"]]
) -> tuple[Int[np.ndarray, "r"], Int[np.ndarray, "r1"], float]:
    """The cheapest labels of all headings (Viterbi): those of the runs, the runs' first headings and the end, the cost.

    Args:
        costs: of every label in every heading.
        going_over: cost of going from each label to each other at the border before a heading.
    """
    count = costs.shape[1]
    total, came_from = costs[:, 0].copy(), np.zeros((count, len(costs)), dtype=int)
    for number in range(1, count):
        step = total[:, None] + going_over(number)
        came_from[number] = step.argmin(axis=0)
        total = step[came_from[number], np.arange(len(costs))] + costs[:, number]
    labels = np.zeros(count, dtype=int)
    labels[-1] = int(total.argmin())
    for number in range(count - 1, 0, -1):
        labels[number - 1] = came_from[number, labels[number]]
    breaks = np.array([0, *(np.flatnonzero(np.diff(labels)) + 1).tolist(), count])
    return labels[breaks[:-1]], breaks, float(total.min())


def _wall_costs(
    surface: MeasuredSurface, wall: WallCandidate, headings: _Headings, top_m: float
) -> Float[np.ndarray, "m"]:
    """Cost of one wall in every heading, 0 to about 3."""
    on = lies_on(surface, wall)
    crossing, share = crossings(surface, wall.normal, wall.offset)
    rest = (1.0 - share) * np.linalg.norm(surface.points[:, :2] - surface.camera_position[:2], axis=1)
    margin = 0.10 + 2.0 * tolerance_m(surface.depth_m)
    beyond = (share > 0) & (rest > margin) & (crossing[:, 2] > 0.05) & (crossing[:, 2] < top_m - 0.05)
    lintel = _lintel_heights(surface, on, headings)
    below = beyond & (crossing[:, 2] < lintel[headings.of_point])
    deep = _count(below & (rest > SETTINGS.min_doorway_depth_m), headings) > 0.5 * _count(below, headings)
    doorway = below & deep[headings.of_point]
    cues = _count(on | doorway, headings) / (SETTINGS.full_evidence * headings.rows_px)
    conflict = _count(beyond & ~doorway, headings) / (SETTINGS.full_conflict * headings.rows_px)
    costs = 1.0 - np.minimum(cues, 1.0) + SETTINGS.conflict_cost * np.minimum(conflict, 1.0)
    reach = distance_along(wall, headings.middles, surface.camera_position[:2])
    return np.where(np.isfinite(reach) & (reach > SETTINGS.nearest_wall_m), costs, 1.0 + 2 * SETTINGS.conflict_cost)


def lies_on(surface: MeasuredSurface, wall: WallCandidate) -> Bool[np.ndarray, "n"]:
    """Points of the empty part of the picture that the wall explains."""
    near = np.abs(surface.points[:, :2] @ wall.normal - wall.offset) < tolerance_m(surface.depth_m)
    turned = surface.normals[:, :2] @ wall.normal
    agree = (turned > 0.7) | (surface.normals == 0).all(axis=1)
    return np.asarray(near & agree & ~surface.is_object & (surface.points[:, 2] > 0.03))


def _lintel_heights(surface: MeasuredSurface, on: Bool[np.ndarray, "n"], headings: _Headings) -> Float[np.ndarray, "m"]:
    """In every heading the height above which the wall is seen, where enough of it is; minus infinity elsewhere.

    Only a wall that is also seen lower down, beside the doorway, has a lintel; shelves and cupboards hang free.
    """
    high = on & (surface.points[:, 2] > 1.8)
    enough = _count(high, headings) > 0.02 * headings.rows_px
    if not (on & (surface.points[:, 2] < 1.5)).sum() > high.sum() * 0.5:
        return np.full(SETTINGS.heading_bins, -np.inf)
    lowest = np.full(SETTINGS.heading_bins, np.inf)
    np.minimum.at(lowest, headings.of_point[high], surface.points[high, 2])
    return np.where(enough, lowest, -np.inf)


def _count(chosen: Bool[np.ndarray, "n"], headings: _Headings) -> Float[np.ndarray, "m"]:
    return np.bincount(headings.of_point[chosen], minlength=SETTINGS.heading_bins).astype(np.float64)


def distance_along(
    wall: WallCandidate, toward: Float[np.ndarray, "m"], origin: Float[np.ndarray, "2"]
) -> Float[np.ndarray, "m"]:
    """How far away a wall's line is in headings; `inf` where it is not met in front."""
    slope = np.stack([np.sin(toward), np.cos(toward)], axis=-1) @ wall.normal
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (wall.offset - float(origin @ wall.normal)) / slope
    return np.where((slope < -0.01) & (distance > 0), distance, np.inf)


def _going_over(
    walls: list[WallCandidate], headings: _Headings, number: int, origin: Float[np.ndarray, "2"]
) -> Float[np.ndarray, "w1 w1"]:
    """Cost of going from each label to each other at the border before heading `number`."""
    count = len(walls)
    costs = np.full((count + 1, count + 1), SETTINGS.into_unknown_cost)
    at = headings.edges[number : number + 1]
    width = float(headings.edges[1] - headings.edges[0])
    reach = np.array([distance_along(w, at, origin)[0] for w in walls])
    with np.errstate(invalid="ignore"):
        apart = np.abs(reach[:, None] - reach[None, :])
        nearest = np.minimum(reach[:, None], reach[None, :])
        meet = apart < SETTINGS.meet_m + SETTINGS.meet_per_m * nearest
    corners = corner_headings(np.array([w.normal for w in walls]), np.array([w.offset for w in walls]), origin)
    meet |= np.abs(corners - float(at[0])) < SETTINGS.corner_bins * width
    costs[:count, :count] = np.where(meet, SETTINGS.corner_cost, SETTINGS.open_end_cost)
    np.fill_diagonal(costs, 0.0)
    return costs


def corner_headings(
    normals: Float[np.ndarray, "w 2"], offsets: Float[np.ndarray, "w"], origin: Float[np.ndarray, "2"]
) -> Float[np.ndarray, "w w"]:
    """Heading of the corner of every two walls, `nan` for nearly parallel ones."""
    offsets = offsets - normals @ origin
    a, b = normals[:, None], normals[None, :]
    determinant = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    safe = np.where(np.abs(determinant) < 0.17, np.nan, determinant)
    x = (offsets[:, None] * b[..., 1] - offsets[None, :] * a[..., 1]) / safe
    y = (a[..., 0] * offsets[None, :] - b[..., 0] * offsets[:, None]) / safe
    headings: Float[np.ndarray, "w w"] = np.arctan2(x, y)
    return headings


def _returns(surface: MeasuredSurface, runs: list[Run], headings: _Headings, top_m: float) -> list[WallCandidate]:
    """Walls between a nearer and a farther one, seen too aslant or too narrowly to be found by themselves."""
    origin = surface.camera_position[:2]
    width = float(headings.edges[1] - headings.edges[0])
    returns: list[WallCandidate] = []
    for left, right in pairwise(runs):
        at = np.array([0.5 * (left.last + right.first)])
        a, b = (float(distance_along(r.wall, at, origin)[0]) for r in (left, right))
        if not np.isfinite([a, b]).any() or abs(a - b) < 0.15:
            continue
        near, far = (left, right) if a < b else (right, left)
        middle = int((at[0] - headings.edges[0]) / width)
        close = np.abs(headings.of_point - middle) <= SETTINGS.return_bins
        close &= (surface.points[:, 2] > 0.1) & (surface.points[:, 2] < top_m - 0.05) & ~surface.is_object
        behind = surface.points[:, :2] @ near.wall.normal < near.wall.offset - 0.06
        before = surface.points[:, :2] @ far.wall.normal > far.wall.offset + 0.06
        between = close & behind & before
        for wall in (near.wall, far.wall):
            candidate = _square_to(surface, wall, between)
            known = [*(run.wall for run in runs), *returns]
            if candidate is not None and not any(same_wall(surface, candidate, w) for w in known):
                returns.append(candidate)
    return returns


def _square_to(surface: MeasuredSurface, wall: WallCandidate, between: Bool[np.ndarray, "n"]) -> WallCandidate | None:
    """The wall at a right angle to another through points, facing the camera; none where they do not agree on it."""
    if between.sum() < SETTINGS.return_points:
        return None
    normal = wall.direction
    offset = float(np.median(surface.points[between, :2] @ normal))
    if float(surface.camera_position[:2] @ normal) < offset:
        normal, offset = -normal, -offset
    inliers = between & (np.abs(surface.points[:, :2] @ normal - offset) < 0.5 * tolerance_m(surface.depth_m))
    tall = inliers.sum() >= SETTINGS.return_points and np.ptp(surface.points[inliers, 2]) > MIN_RISE_M
    if not tall or inliers.sum() < 0.5 * between.sum():
        return None
    offset = float(np.median(surface.points[inliers, :2] @ normal))
    return WallCandidate(normal, offset, inliers, 0.2, float(surface.area_m2[inliers].sum()))
