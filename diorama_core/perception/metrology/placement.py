"""Deciding what holds every object: all assumptions about an object compete by cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.projection import cuboid_corners
from diorama_core.library.taxonomy import (
    AGAINST_WALLS,
    PORTABLE,
    RUGS,
    SETS,
    STACKED_ON,
    UNKNOWN,
    Category,
    Mount,
    column,
    having,
    lies_on_furniture,
    often_carried,
)
from diorama_core.library.taxonomy import category as find_category
from diorama_core.perception.metrology.arrangement import arrange, distinct
from diorama_core.perception.metrology.box_observations import BoxObservations
from diorama_core.perception.metrology.floor import place_on_floor, solve_all
from diorama_core.perception.metrology.mutual_costs import CarriedCosts, share_seen_through_top
from diorama_core.perception.metrology.priors import SizeMode, plain_mode
from diorama_core.perception.metrology.problem import Cuboids, Problems, View, cuboids
from diorama_core.perception.metrology.settings import PlacementSettings
from diorama_core.perception.metrology.silhouette import corner_costs
from diorama_core.perception.metrology.solver import Solutions, concatenate_solutions
from diorama_core.perception.metrology.supported_objects import (
    FLOOR_OBJECT_COST,
    RoomExtent,
    extent_of,
    place_below_ceiling,
    place_on,
    place_on_wall,
    supporters_of,
)

FLOOR, WALL, CEILING = -1, -2, -3
"""Supporters that are no objects."""

_NEVER = np.inf
_COSTS: Mapping[str, Mapping[Mount, float]] = {
    "on top": {"floor": FLOOR_OBJECT_COST, "surface": 0.0, "wall": 4.0, "ceiling": _NEVER},
    "floor": {"floor": 0.0, "surface": 6.0, "wall": 12.0, "ceiling": _NEVER},
    "wall": {"floor": 12.0, "surface": 8.0, "wall": 0.0, "ceiling": 6.0},
    "ceiling": {"floor": _NEVER, "surface": _NEVER, "wall": _NEVER, "ceiling": 0.0},
}
"""What speaks against a thing being held in a place, by how things of its kind are usually held."""
_SCREENS = having("screen")
_FIXED_TO_WALLS = having("fixed_to_wall")
_NEVER_ON_OBJECTS = having("never_on_objects")
"""Things that never stand on others."""
_HUNG_CARRIERS = frozenset(kind for kind in column("carries_as") if find_category(kind).mount == "wall")
"""What hangs on walls and carries things."""


@dataclass(frozen=True, eq=False)
class Placement:
    """What was decided about one object."""

    index: int
    supporter: int
    """Index of the supporting object, or FLOOR, WALL, CEILING."""
    problem: Problems
    """A batch of one."""
    cuboid: Cuboids
    """A batch of one."""
    cost: float
    """Everything that speaks against it, in squared sigmas."""


@dataclass(frozen=True, eq=False)
class Readings:
    """Solved rows of one object with their full costs, cheapest first."""

    problems: Problems
    boxes: Cuboids
    costs: Float[np.ndarray, "k"]

    def placement(self, row: int, supporter: int) -> Placement:
        """One of them, with what holds the object."""
        item, one = int(self.problems.item[row]), np.array([row])
        return Placement(item, supporter, self.problems.rows(one), self.boxes.rows(one), float(self.costs[row]))


def place_all(observations: BoxObservations, view: View, height_m: float) -> tuple[Placement, ...]:
    """Place every object: first on the floor, then on others, on walls and below the ceiling, the cheapest way each.

    Shelves that hang on walls come before the things that may lie on them.

    Args:
        observations: of all objects.
        view: intrinsics, and rotation from camera to world.
        height_m: of the camera above the floor.
    """
    search = _Search(observations, view, height_m)
    floor = search.not_through_tops(search.place_on_floor())
    standing = [p for p in floor.values() if search.tells_the_room(p)]
    doors = [i for i, category in enumerate(observations.categories) if category.name == "door"]
    hung = [i for i, category in enumerate(observations.categories) if category.name in _HUNG_CARRIERS]
    others = [i for i in range(len(observations)) if i not in doors and i not in hung]
    best = {**floor, **search.place_on_supporters(floor, search.room(standing), doors)}
    sure_cost = observations.settings.placement.sure_cost
    room = search.room(standing + [best[i] for i in doors if best[i].cost < sure_cost])
    best = _cheaper(best, search.place_on_supporters(floor, room, hung))
    carriers = {**floor, **{i: best[i] for i in hung if i in best}}
    best = _cheaper(best, search.place_on_supporters(carriers, room, others))
    needed = {p.supporter for p in best.values() if p.supporter >= 0}
    stacked = search.stack({**best, **{i: carriers[i] for i in needed}})
    return tuple(stacked[i] for i in range(len(observations)))


def _cheaper(best: Mapping[int, Placement], challengers: Mapping[int, Placement]) -> dict[int, Placement]:
    """For every object the cheaper of both."""
    better = {i: c for i, c in challengers.items() if i not in best or c.cost < best[i].cost}
    return {**best, **better}


@dataclass(frozen=True, eq=False)
class _Search:
    """Assumptions about the objects of one picture, seen from one height."""

    observations: BoxObservations
    view: View
    height_m: float

    @property
    def settings(self) -> PlacementSettings:
        return self.observations.settings.placement

    def not_through_tops(self, floor: Mapping[int, Placement]) -> dict[int, Placement]:
        """Places on the floor, dearer where what may stand on others would be seen on the floor through their tops."""
        placements, observed = dict(floor), self.observations.settings.observed
        for index, placement in floor.items():
            category = self.observations.categories[index]
            if category is not UNKNOWN and category.name not in PORTABLE:
                continue
            kinds = {j: self.observations.categories[j] for j in self._possible_parents(index) if j in floor}
            closed = [j for j, kind in kinds.items() if kind is not UNKNOWN and kind.supports_objects]
            box, cuboid = self.observations.box_px[index], placement.cuboid
            shares = [
                share_seen_through_top(box, cuboid, floor[j].cuboid, self.height_m, self.view, observed) for j in closed
            ]
            dearer = placement.cost + self.settings.through_top_cost * max(shares, default=0.0)
            placements[index] = replace(placement, cost=dearer)
        return placements

    def place_on_floor(self) -> dict[int, Placement]:
        """Every object that may stand on the floor, arranged so that they fit together; sets are of one size."""
        observations, height_m = self.observations, self.height_m
        rows: list[Problems] = []
        for index, category in enumerate(observations.categories):
            if category.mount != "ceiling" and category.name not in _FIXED_TO_WALLS:
                cost = self._floor_cost(index)
                rows += [p.with_columns(extra=p.extra + cost) for p in place_on_floor(observations, index, height_m)]
        if not rows:
            return {}
        carried = CarriedCosts(observations, self.view, height_m)
        solved = solve_all(rows, self.view, observations.settings)
        placed = self._arrange_standing(solved, carried)
        sets = set_sizes(placed, observations)
        if sets:
            shared = [p for i, mode in sets.items() for p in place_on_floor(observations, i, height_m, (mode,))]
            alone = np.isin(solved.problems.item, list(sets))
            dearer = solved.dearer(np.where(alone, self.settings.odd_one_cost, 0.0))
            solved = concatenate_solutions(dearer, solve_all(shared, self.view, observations.settings))
            placed = self._arrange_standing(solved, carried)
        return placed

    def _arrange_standing(self, solved: Solutions, carried: CarriedCosts) -> dict[int, Placement]:
        readings = readings_of(solved, self.observations, self.view)
        kinds = {
            i: self.observations.categories[i] for i in readings if self.observations.categories[i].mount == "floor"
        }
        boxes = {i: readings[i].boxes for i in kinds}
        loads = carried.costs(boxes)
        costs = [readings[i].costs + loads[i] for i in kinds]
        chosen = arrange(list(boxes.values()), costs, list(kinds.values()), self.settings)
        picked = dict(zip(kinds, chosen, strict=True))
        return {i: r.placement(picked.get(i, 0), FLOOR) for i, r in readings.items()}

    def place_on_supporters(
        self, carriers: Mapping[int, Placement], room: RoomExtent, indices: list[int]
    ) -> dict[int, Placement]:
        """The cheapest way to hold some objects otherwise than by the floor."""
        best: dict[int, Placement] = {}
        groups: dict[int, list[Problems]] = {}
        for index in indices:
            for supporter, rows in self._supporter_rows(index, carriers, room):
                groups.setdefault(supporter, []).extend(rows)
        if not groups:
            return best
        solved = solve_all([p for rows in groups.values() for p in rows], self.view, self.observations.settings)
        under = np.repeat(list(groups), [sum(map(len, rows)) for rows in groups.values()])
        supporter_of = np.tile(under, len(solved.cost) // len(under))
        for supporter in groups:
            readings = readings_of(solved.rows(supporter_of == supporter), self.observations, self.view)
            best = _cheaper(best, {i: r.placement(0, supporter) for i, r in readings.items()})
        return best

    def _supporter_rows(
        self, index: int, carriers: Mapping[int, Placement], room: RoomExtent
    ) -> list[tuple[int, list[Problems]]]:
        """Rows for everything but the floor that may hold an object, by supporter."""
        observations, height_m = self.observations, self.height_m
        category = observations.categories[index]
        options: list[tuple[int, list[Problems]]] = []
        on_top = self._holding_cost(index, "on top")
        parents = self._possible_parents(index)
        if np.isfinite(on_top) and category.name not in _NEVER_ON_OBJECTS:
            for parent in parents:
                cost = on_top + _unlikely_parent_cost(category, observations.categories[parent], self.settings)
                if observations.categories[parent].name in RUGS:  # what lies on it is as good as on the floor
                    cost += self._floor_cost(index)
                rows = place_on(observations, index, parent, carriers[parent].cuboid, height_m, cost)
                options.append((parent, rows))
        screen = category.name in _SCREENS
        on_wall = self.settings.screen_on_wall_cost if screen else self._holding_cost(index, "wall")
        if category.mount == "surface" and (parents or self._small_carrier(index) is not None):
            on_wall += self.settings.beside_its_supporter_cost
        if category.name not in _NEVER_ON_OBJECTS or category.name in _FIXED_TO_WALLS:
            options.append((WALL, place_on_wall(observations, index, height_m, room, on_wall)))
        below = self._holding_cost(index, "ceiling")
        if np.isfinite(below):
            options.append((CEILING, place_below_ceiling(observations, index, height_m, room, below)))
        return options

    def stack(self, placed: Mapping[int, Placement]) -> dict[int, Placement]:
        """Places with small things on small things that lie on others, where that is cheaper: a cup on books."""
        placements, holding = dict(placed), {p.supporter for p in placed.values()}
        for index in np.argsort(-self.observations.box_px[:, 3], kind="stable").tolist():  # what is below first
            below = self._small_carrier(index)
            if below is None or placements[below].supporter < 0 or index in holding:
                continue
            cuboid, cost = placements[below].cuboid, self.settings.stacked_cost
            rows = place_on(self.observations, index, below, cuboid, self.height_m, cost)
            solved = solve_all(rows, self.view, self.observations.settings)
            on_it = readings_of(solved, self.observations, self.view)[index].placement(0, below)
            if on_it.cost < placements[index].cost:
                placements[index] = on_it
        return placements

    def _small_carrier(self, index: int) -> int | None:
        """The small carrier of which the picture shows most just under a thing; None where that is little."""
        observations = self.observations
        if not lies_on_furniture(observations.categories[index].name):
            return None
        carriers = [j for j, c in enumerate(observations.categories) if c.name in STACKED_ON]
        lower = [j for j in carriers if observations.box_px[j, 3] > observations.box_px[index, 3]]
        under = observations.beside[index, :, 3]
        below = max(supporters_of(observations, index, lower), key=lambda j: float(under[j]), default=None)
        return below if below is not None and under[below] >= self.settings.seen_under else None

    def _floor_cost(self, index: int) -> float:
        observations, settings = self.observations, self.settings
        category = observations.categories[index]
        cost = self._holding_cost(index, "floor")
        carriers = {j: observations.categories[j] for j in self._possible_parents(index)}
        carriers = {j: kind for j, kind in carriers.items() if kind.name not in RUGS}
        if category.mount == "surface" and carriers:
            cost += settings.beside_its_supporter_cost
        if category.name in PORTABLE and any(
            kind.supports_objects and often_carried(category.name, kind.name) > 1.0 for kind in carriers.values()
        ):
            cost += settings.at_carrier_cost
        before = max((float(observations.before[index, j]) for j in carriers), default=0.0)
        return cost + settings.before_cost * before

    def _possible_parents(self, index: int) -> list[int]:
        kinds = enumerate(self.observations.categories)
        carriers = [i for i, c in kinds if c.mount == "floor" or c.name in _HUNG_CARRIERS]
        return supporters_of(self.observations, index, carriers)

    def _holding_cost(self, index: int, where: str) -> float:
        """What speaks against an object being held there; of one without a name the mean over all that it may be."""
        category, meanings = self.observations.categories[index], self.observations.meanings[index]
        if category is not UNKNOWN:
            return _COSTS[where][category.mount]
        likely = sum(share * float(np.exp(-_COSTS[where][find_category(k).mount] / 2)) for k, share in meanings)
        return -2.0 * float(np.log(likely + self.settings.hardly))

    def tells_the_room(self, placement: Placement) -> bool:
        """Whether a thing surely stands on the floor where it was placed."""
        category = self.observations.categories[placement.index]
        if category.mount != "floor" or placement.cost >= self.settings.sure_cost:
            return False
        if category.name in PORTABLE and self._possible_parents(placement.index):
            return False
        return not (category is UNKNOWN and bool(self.observations.is_hidden(placement.index)[3]))

    def room(self, telling: list[Placement]) -> RoomExtent:
        """How far the room reaches at least."""
        boxes = [p.cuboid for p in telling]
        corners = [cuboid_corners(b.centre, b.yaw_rad, b.size_m) for b in boxes]
        names = tuple(self.observations.categories[p.index].name for p in telling)
        return extent_of(np.concatenate([np.zeros((0, 8, 3)), *corners]), names, self.settings)


def _unlikely_parent_cost(category: Category, parent: Category, settings: PlacementSettings) -> float:
    if parent is UNKNOWN:
        return 0.5
    carries = 0.0 if parent.supports_objects else 4.0
    if category is UNKNOWN:
        return carries
    rarer = settings.usual / often_carried(category.name, parent.name)
    return carries + 2.0 * settings.company_trust * float(np.log(max(rarer, 1.0)))


def set_sizes(placed: Mapping[int, Placement], observations: BoxObservations) -> dict[int, SizeMode]:
    """For every member of a set the size that the well-seen members have, as a narrow mode.

    Of a member that is cut or hidden above or below nothing is taken of its height, nor of its sides' extents of one
    that is cut or hidden at a side; an extent that no member shows stays as open as it is.
    """
    modes: dict[int, SizeMode] = {}
    settings = observations.settings.placement
    for name in sorted({observations.categories[i].name for i in placed} & SETS):
        members = [i for i in placed if observations.categories[i].name == name]
        whole = np.array([~(observations.is_hidden(i) | observations.truncated[i]) for i in members])
        if len(members) < 2 or (~whole).sum(axis=1).min() > settings.max_unseen:
            continue
        upright, across = whole[:, 1] & whole[:, 3], whole[:, 0] & whole[:, 2]
        sizes = np.log([placed[i].cuboid.size_m[0] for i in members])
        usual = placed[members[0]].problem
        size, sigma = usual.log_size[0].copy(), usual.log_size_sigma[0].copy()
        for axes, seen in (([0, 1], across), ([2], upright)):
            if seen.any():
                size[axes], sigma[axes] = np.median(sizes[seen][:, axes], axis=0), settings.set_sigma
        modes |= dict.fromkeys(members, plain_mode(size, sigma, 0.0, name))
    return modes


def readings_of(solved: Solutions, observations: BoxObservations, view: View) -> dict[int, Readings]:
    """Distinct readings of every object in a batch of several an object, masks counted in.

    Args:
        solved: cuboids and their costs, several an object.
        observations: of all objects.
        view: intrinsics, and rotation from camera to world.
    """
    settings, problems = observations.settings, solved.problems
    boxes = cuboids(solved.unknowns, problems, view)
    names = tuple(c.name for c in observations.categories)
    masks = (observations.mask_reach, observations.corner_weight, observations.mask_exact)
    corners = corner_costs(problems, boxes, view, *masks, names, settings=settings.observed)
    costs = solved.cost + corners + _side_view_costs(problems, boxes, observations)
    readings = {}
    for index in np.unique(problems.item).astype(int):
        mine = np.flatnonzero(problems.item == index)
        rows = mine[distinct(boxes.rows(mine), costs[mine], settings.placement)]
        readings[int(index)] = Readings(problems.rows(rows), boxes.rows(rows), costs[rows])
    return readings


def _side_view_costs(problems: Problems, boxes: Cuboids, observations: BoxObservations) -> Float[np.ndarray, "n"]:
    """A little against things with a front that turn their side to the camera: people picture fronts."""
    fronted = np.array([c.name in AGAINST_WALLS for c in observations.categories])[problems.item.astype(int)]
    to_camera = boxes.centre[:, :2] / np.maximum(np.linalg.norm(boxes.centre[:, :2], axis=1, keepdims=True), 1e-6)
    facing = np.abs(np.cos(boxes.yaw_rad) * to_camera[:, 0] + np.sin(boxes.yaw_rad) * to_camera[:, 1])
    return np.where(fronted, observations.settings.placement.averted_cost * (1.0 - facing), 0.0)
