"""The best chain of walls for a photo, by dynamic programming over the headings of the level view.

Candidates are upright planes of a few directions at many distances. In a heading each costs what it makes of the
column: floor-coloured wall, lines that stand out of their surface, missing edges at its foot and top, objects that
would stick through it. A transition between walls costs a corner, less at a visible vertical edge.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from weakref import WeakKeyDictionary

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.architecture.single_view.level_view import LevelView, project_directions, response
from diorama_core.architecture.single_view.room_cues import (
    EDGE_THRESHOLD,
    MAX_CEILING_M,
    PRIOR_LOG_SIGMA,
    PRIOR_MEDIAN_M,
    RoomCues,
)
from diorama_core.architecture.single_view.settings import SETTINGS, PhotoRoomSettings
from diorama_core.architecture.walls.wall_path import cheapest_path, corner_headings

FINE = np.linspace(-0.08, 0.08, 9)


@dataclass(frozen=True, eq=False)
class PhotoWalls:
    """Candidate walls: planes in plan `normal . p = offset`, normals toward the camera."""

    normals: Float[np.ndarray, "w 2"]
    offsets: Float[np.ndarray, "w"]
    directions: Int[np.ndarray, "w"]
    """Direction of the normal: 0 along x, 1 along y, 2 and more aslant."""

    def __len__(self) -> int:
        return len(self.offsets)

    def select(self, index: Int[np.ndarray, "v"]) -> PhotoWalls:
        """Some of them."""
        return PhotoWalls(self.normals[index], self.offsets[index], self.directions[index])


@dataclass(frozen=True, eq=False)
class Chain:
    """The walls that lead in the headings, from left to right."""

    walls: PhotoWalls
    """One a run, neighbours differ."""
    borders: Int[np.ndarray, "r1"]
    """Numbers of the headings' borders where runs begin and end."""
    ceiling_m: float
    cost: float


@dataclass(frozen=True, eq=False)
class _BelowCeiling:
    """Costs of walls in every heading that do not depend on the ceiling's height."""

    near: Float[np.ndarray, "w m"]
    """Level distance; 1 where a wall is not met."""
    met: Bool[np.ndarray, "w m"]
    floor: Float[np.ndarray, "w m"]
    """Cost of the floor before the wall."""
    upright: Float[np.ndarray, "w m"]
    """Cost of the wall as if it went on below the floor."""
    foot: Float[np.ndarray, "w m"]
    skirting: Float[np.ndarray, "w m"]
    others: Float[np.ndarray, "w m"]
    """Cost of objects and of unusual places."""


@dataclass(frozen=True, eq=False)
class ChainScorer:
    """Costs of walls in headings, of corners, and of ceilings."""

    cues: RoomCues
    view: LevelView
    settings: PhotoRoomSettings = SETTINGS
    _known: WeakKeyDictionary[PhotoWalls, _BelowCeiling] = field(default_factory=WeakKeyDictionary, init=False)

    def costs(self, walls: PhotoWalls, ceiling_m: float) -> Float[np.ndarray, "w m"]:
        """Cost of every wall in every heading."""
        low = self._costs_below_ceiling(walls)
        total = self._surfaces(walls, low, (ceiling_m - self.cues.camera.position[2]) / low.near)
        total -= self.settings.cues.edge_weight * (low.foot + self._edge(walls, low.near, ceiling_m)[0])
        total -= self.settings.cues.edge_weight * low.skirting
        total += low.others
        return np.where(low.met & (low.near > self.settings.search.nearest_m * 0.5), total, 1e3)

    def _costs_below_ceiling(self, walls: PhotoWalls) -> _BelowCeiling:
        """Costs that are the same below every ceiling: the same walls are tried below dozens."""
        if walls not in self._known:
            reach = self.reach(walls)
            met = np.isfinite(reach)
            near = np.where(met, reach, 1.0)
            rows = self.view.row_of(-self.cues.camera.position[2] / near)
            level, _, uprights = self._sums
            self._known[walls] = _BelowCeiling(
                near,
                met,
                _upto(level, rows),
                _upto_of(uprights, np.minimum(walls.directions, 2), rows),
                self._edge(walls, near, 0.0)[0],
                self._skirting(walls, near),
                self._objects(near) + self._backs(near) + self._usual(walls, near),
            )
        return self._known[walls]

    def reach(self, walls: PhotoWalls) -> Float[np.ndarray, "w m"]:
        """Level distance of walls in the headings' middles; `inf` where they are not met."""
        return self._reach_at(walls, self.view.middles_rad)

    def _reach_at(self, walls: PhotoWalls, headings: Float[np.ndarray, "m"]) -> Float[np.ndarray, "w m"]:
        across = np.stack([np.sin(headings), np.cos(headings)])
        slope = walls.normals @ across
        gap = walls.offsets - walls.normals @ self.cues.camera.position[:2]
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = gap[:, None] / slope
        s = self.settings.search
        return np.where((slope < -s.grazing) & (distance < s.reach_m), distance, np.inf)

    @cached_property
    def _sums(self) -> tuple[Float[np.ndarray, "m k1"], Float[np.ndarray, "m k1"], Float[np.ndarray, "3 m k1"]]:
        """Costs of floor, ceiling, and walls along x, along y and aslant, summed from the lowest row up."""
        v = self.view
        colour = self.settings.search.region_weight * v.floor_ratio * v.share
        level = self.settings.search.line_weight * v.lines[..., 2]
        along = (v.lines[..., 0], v.lines[..., 1], v.lines[..., 0] + v.lines[..., 1])
        uprights = [_cumulative_sum(0.5 * colour + self.settings.search.line_weight * lines) for lines in along]
        return _cumulative_sum(-0.5 * colour + level), _cumulative_sum(0.5 * colour + level), np.stack(uprights)

    def _surfaces(
        self, walls: PhotoWalls, low: _BelowCeiling, top: Float[np.ndarray, "w m"]
    ) -> Float[np.ndarray, "w m"]:
        """Floor, wall and ceiling, each where the candidate puts it, against colours and lines."""
        _, overhead, uprights = self._sums
        rows = self.view.row_of(top)
        total = low.floor + _upto_of(uprights, np.minimum(walls.directions, 2), rows) - low.upright
        return np.asarray(total + (overhead[:, -1] - _upto(overhead, rows)))

    def support(self, chain: Chain) -> Float[np.ndarray, "r"]:
        """How far each wall of a chain is seen, 0 to 1: foot and top as edges, and colours that change at the foot."""
        reach, s = self.reach(chain.walls), self.settings.search
        near = np.where(np.isfinite(reach), reach, s.farthest_m)
        sides = [self._edge(chain.walls, near, height) for height in (0.0, chain.ceiling_m)]
        skirting = self._skirting(chain.walls, near)
        sides.append((skirting, np.where(skirting > 0.0, sides[0][1], 0.0)))
        eye = float(self.cues.camera.position[2])
        weights = np.where(self.view.floor_ratio != 0, self.view.share, 0.0)
        colour, known = (_cumulative_sum(x) for x in (self.view.floor_ratio * self.view.share, weights))
        supports = []
        for run, (first, last) in enumerate(pairwise(chain.borders)):
            columns = slice(first, last)
            over, length = (sum(float(side[k][run, columns].sum()) for side in sides) for k in (0, 1))
            edge = (EDGE_THRESHOLD + over / max(length, 1e-9)) * min(1.0, length / s.enough_edge)
            foot = self.view.row_of(-eye / near[run : run + 1, columns])
            below, every = (_upto(x[columns], foot)[0] for x in (colour, known))
            apart = float((2.0 * below - colour[columns, -1]).sum()) / max(float(known[columns, -1].sum()), 1e-9)
            both = min(float(every.sum()), float((known[columns, -1] - every).sum())) > s.enough_colour
            supports.append(min(1.0, s.edge_trust * edge + s.colour_trust * max(apart, 0.0) * both))
        return np.array(supports)

    def _edge(
        self, walls: PhotoWalls, near: Float[np.ndarray, "w m"], height_m: float
    ) -> tuple[Float[np.ndarray, "w m"], Float[np.ndarray, "w m"]]:
        """How much of a wall's foot or top is an edge, over the threshold, and how much of it is free to be seen.

        Both in picture diagonals.
        """
        v, e = self.view, self.cues
        across = np.stack([np.sin(v.middles_rad), np.cos(v.middles_rad)], axis=-1)
        rise = height_m - e.camera.position[2]
        directions = np.concatenate([near[..., None] * across, np.full((*near.shape, 1), rise)], axis=-1)
        pixels, inside = project_directions(e.camera, directions)
        # The boundary's course from one heading to the next, as long as it is in the picture.
        step = np.linalg.norm(np.diff(pixels, axis=1, append=pixels[:, -1:]), axis=-1)
        step[:, -1] = step[:, -2] if step.shape[1] > 1 else 0.0
        k = e.camera.intrinsics
        step = np.minimum(step / np.hypot(k.width, k.height), 0.08)
        values = np.zeros(near.shape)
        for direction in np.unique(walls.directions):
            mine = walls.directions == direction
            # A wall across x runs along y.
            edge_map = e.edge_maps[1 - direction] if direction < 2 else e.slant_maps[direction - 2]
            values[mine] = response(edge_map, pixels[mine], inside[mine], e.map_scale) - EDGE_THRESHOLD
        free = inside & (np.abs(values) > 1e-6)
        return np.where(free, values * step, 0.0), np.where(free, step, 0.0)

    def _skirting(self, walls: PhotoWalls, near: Float[np.ndarray, "w m"]) -> Float[np.ndarray, "w m"]:
        """How much of the upper edge of a skirting board is an edge, over the threshold; 0 for walls without one.

        Without it the board's upper edge is taken for the foot of a wall that is farther away as readily as its lower.
        """
        edges = [self._edge(walls, near, height)[0] for height in self.settings.search.skirtings_m]
        return np.maximum(np.max(edges, axis=0), 0.0)

    def _objects(self, near: Float[np.ndarray, "w m"]) -> Float[np.ndarray, "w m"]:
        """Objects that would stick through a wall, in the headings of their corners."""
        e, s = self.cues, self.settings.search
        total = np.zeros(near.shape)
        if len(e.object_low) == 0:
            return total
        weights = e.object_weights / e.object_weights.sum()
        for low, high, weight in zip(e.object_low, e.object_high, weights, strict=True):
            of_corner = self.settings.cues.object_weight * weight / 4.0
            for x, y in corners_of(low, high) - e.camera.position[:2]:
                column = int(np.searchsorted(self.view.edges_rad, np.arctan2(x, y))) - 1
                if 0 <= column < near.shape[1]:
                    out = np.hypot(x, y) * (1.0 - s.unsure_share) - near[:, column]
                    total[:, column] += of_corner * np.clip(out / s.protrusion_m, 0.0, 2.0)
        return total

    def _backs(self, near: Float[np.ndarray, "w m"]) -> Float[np.ndarray, "w m"]:
        """Beds, storage and stoves stand at walls: a wall is where the sight through one leaves it."""
        e, v, s = self.cues, self.view, self.settings.search
        total = np.zeros(near.shape)
        across = np.stack([np.sin(v.middles_rad), np.cos(v.middles_rad)], axis=-1)
        for low, high, weight in zip(e.backed_low, e.backed_high, e.backed_weights, strict=True):
            left = leaves(e.camera.position[:2], across, low[:2], high[:2])
            behind = np.flatnonzero(np.isfinite(left))
            if len(behind):
                apart = np.log(near[:, behind] / left[behind]) / s.back_log_sigma
                total[:, behind] += s.back_weight * weight / len(behind) * np.minimum(apart**2, s.back_cap)
        return total

    def _usual(self, walls: PhotoWalls, near: Float[np.ndarray, "w m"]) -> Float[np.ndarray, "w m"]:
        """Walls of rooms are so far away, and rarely led to their ends much farther."""
        gap = np.abs(walls.offsets - walls.normals @ self.cues.camera.position[:2])
        sideways = np.abs(walls.normals[:, 0]) > np.abs(walls.normals[:, 1])
        usual = np.where(sideways, 0.5 * PRIOR_MEDIAN_M[0], PRIOR_MEDIAN_M[1])
        odd = 0.5 * np.minimum((np.log(gap / usual) / 0.5) ** 2, 9.0)
        beyond = np.log(np.maximum(near / self.settings.search.far_m, 1.0)) / self.settings.search.far_log_sigma
        return self.settings.cues.prior_weight / near.shape[1] * (odd[:, None] + 0.5 * np.minimum(beyond**2, 9.0))

    def ceiling_prior(self, ceiling_m: float) -> float:
        """Cost of a height, and of objects that hang from above it."""
        odd = float(0.5 * min((np.log(ceiling_m / PRIOR_MEDIAN_M[2]) / PRIOR_LOG_SIGMA[2]) ** 2, 9.0))
        e = self.cues
        highest = max(float(e.object_high[:, 2].max()) if len(e.object_high) else 0.0, e.hung_top_m)
        through = np.clip((highest - ceiling_m) / self.settings.search.protrusion_m, 0.0, 2.0)
        return self.settings.cues.prior_weight * odd + 0.5 * float(through)

    def going_over(self, walls: PhotoWalls, ceiling_m: float) -> Float[np.ndarray, "b w w"]:
        """Cost of going from each wall to each other at the inner borders of the headings."""
        v, s = self.view, self.settings.search
        borders = v.edges_rad[1:-1]
        reach = self._reach_at(walls, borders).T
        nearest = np.where(np.isfinite(reach), reach, 50.0)
        eye = float(self.cues.camera.position[2])
        summed = _cumulative_sum(v.upright[1:-1])
        seen = _upto_rows(summed, v.row_of((ceiling_m - eye) / nearest)) - _upto_rows(summed, v.row_of(-eye / nearest))
        seen = s.upright_weight * np.maximum(seen, 0.0)
        width = float(v.edges_rad[1] - v.edges_rad[0])
        corner = corner_headings(walls.normals, walls.offsets, self.cues.camera.position[:2])
        a, b = walls.normals[:, None], walls.normals[None]
        folds_in = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0] < 0
        folded = np.where(folds_in, s.corner_cost, s.protruding_cost)
        cost = np.empty((len(borders), *corner.shape))
        for k, border in enumerate(borders):  # one at a time stays in the processor's cache
            edge = np.where(nearest[k, :, None] <= nearest[k], seen[k, :, None], seen[k])
            usual = np.where(np.abs(corner - border) < s.corner_bins * width, folded, s.jump_cost)
            np.maximum(usual - edge, s.min_share * usual, out=cost[k])
        same = np.arange(len(walls))
        cost[:, same, same] = 0.0
        return np.asarray(cost)


def corners_of(low: Float[np.ndarray, "3"], high: Float[np.ndarray, "3"]) -> Float[np.ndarray, "4 2"]:
    """Corners in plan of a box along the axes."""
    return np.array([[x, y] for x in (low[0], high[0]) for y in (low[1], high[1])])


def best_chain(scorer: ChainScorer, walls: PhotoWalls, ceiling_m: float) -> Chain:
    """The cheapest path of walls over the headings."""
    over = scorer.going_over(walls, ceiling_m)
    leading, breaks, cost = cheapest_path(scorer.costs(walls, ceiling_m), lambda number: over[number - 1])
    return Chain(walls.select(leading), breaks, ceiling_m, cost + scorer.ceiling_prior(ceiling_m))


def refine_chain(scorer: ChainScorer, chain: Chain, heights_m: Float[np.ndarray, "c"]) -> Chain:
    """The chain with its ceiling and its walls' places set more finely, in turns."""
    for share in (1.0, 0.4, 0.15):
        chain = best_chain(scorer, nearby_walls(scorer, chain.walls, share), best_ceiling(scorer, chain, heights_m))
        heights_m = chain.ceiling_m * (1.0 + share * FINE)
    return chain


def nearby_walls(scorer: ChainScorer, walls: PhotoWalls, share: float) -> PhotoWalls:
    """Walls a little nearer and farther than the given ones."""
    eye = walls.normals @ scorer.cues.camera.position[:2]
    offsets = eye[:, None] + (walls.offsets - eye)[:, None] * (1.0 + share * FINE)
    repeat = np.repeat(np.arange(len(walls)), len(FINE))
    _, first = np.unique(np.stack([repeat, offsets.ravel().round(5)], axis=1), axis=0, return_index=True)
    return PhotoWalls(walls.normals[repeat], offsets.ravel(), walls.directions[repeat]).select(first)


def best_ceiling(scorer: ChainScorer, chain: Chain, heights_m: Float[np.ndarray, "c"]) -> float:
    """The height at which the chain costs least."""
    columns = np.concatenate([np.arange(a, b) for a, b in pairwise(chain.borders)])
    runs = np.repeat(np.arange(len(chain.walls)), np.diff(chain.borders))
    eye = float(scorer.cues.camera.position[2])
    possible = heights_m[(heights_m > eye + 0.15) & (heights_m < MAX_CEILING_M + 1e-9)]
    if len(possible) == 0:
        return chain.ceiling_m

    def cost(height: float) -> float:
        return float(scorer.costs(chain.walls, height)[runs, columns].sum()) + scorer.ceiling_prior(height)

    return float(min(possible, key=cost))


def leaves(
    eye: Float[np.ndarray, "2"],
    across: Float[np.ndarray, "m 2"],
    low: Float[np.ndarray, "2"],
    high: Float[np.ndarray, "2"],
) -> Float[np.ndarray, "m"]:
    """Distance at which sights along the unit directions `across` leave a footprint; `inf` for those that miss it.

    Args:
        eye: where sights begin, x and y in the world (m).
        across: unit directions in the plan.
        low, high: corners of the footprint with the smallest and largest x and y (m).
    """
    safe = np.where(np.abs(across) < 1e-9, 1e-9, across)
    ends = np.stack([(low - eye) / safe, (high - eye) / safe])
    first, last = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
    return np.where((last > np.maximum(first, 0.0)), last, np.inf)


def _cumulative_sum(cells: Float[np.ndarray, "m k"]) -> Float[np.ndarray, "m k1"]:
    return np.concatenate([np.zeros((len(cells), 1)), np.cumsum(cells, axis=1)], axis=1)


def _upto_of(
    summed: Float[np.ndarray, "d m k1"], which: Int[np.ndarray, "w"], rows: Float[np.ndarray, "w m"]
) -> Float[np.ndarray, "w m"]:
    """Sums below fractional rows, for each wall of its own table."""
    below = np.minimum(rows.astype(int), summed.shape[2] - 2)
    part, table, column = rows - below, which[:, None], np.arange(rows.shape[1])
    return np.asarray(summed[table, column, below] * (1.0 - part) + summed[table, column, below + 1] * part)


def _upto(summed: Float[np.ndarray, "m k1"], rows: Float[np.ndarray, "w m"]) -> Float[np.ndarray, "w m"]:
    """Sums below fractional rows."""
    return _upto_rows(summed, rows.T).T


def _upto_rows(summed: Float[np.ndarray, "m k1"], rows: Float[np.ndarray, "m w"]) -> Float[np.ndarray, "m w"]:
    below = np.minimum(rows.astype(int), summed.shape[1] - 2)
    part = rows - below
    return np.asarray(
        np.take_along_axis(summed, below, axis=1) * (1.0 - part) + np.take_along_axis(summed, below + 1, axis=1) * part
    )
