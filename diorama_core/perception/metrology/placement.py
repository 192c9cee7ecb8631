"""Deciding what holds every object: all assumptions about an object compete by cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.geometry.projection import cuboid_corners
from diorama_core.library import taxonomy
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
from diorama_core.perception.metrology.settings import SETTINGS, MetrologySettings, PlacementSettings
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
        one = np.array([row])
        box = Cuboids(self.boxes.centre[one], self.boxes.yaw_rad[one], self.boxes.size_m[one])
        return Placement(int(self.problems.item[row]), supporter, self.problems.rows(one), box, float(self.costs[row]))


def place_all(
    observations: BoxObservations, view: View, height_m: float, settings: MetrologySettings = SETTINGS
) -> tuple[Placement, ...]:
    """Place every object: first on the floor, then on others, on walls and below the ceiling, the cheapest way each.

    Shelves that hang on walls come before the things that may lie on them.

    Args:
        observations: of all objects.
        view: intrinsics, and rotation from camera to world.
        height_m: of the camera above the floor.
        settings: of metrology.
    """
    floor = _not_through_tops(
        _place_on_floor(observations, view, height_m, settings), observations, view, height_m, settings
    )
    standing = [p for p in floor.values() if _tells_the_room(p, observations, settings.placement)]
    doors = [i for i, category in enumerate(observations.categories) if category.name == "door"]
    hung = [i for i, category in enumerate(observations.categories) if category.name in _HUNG_CARRIERS]
    others = [i for i in range(len(observations)) if i not in doors and i not in hung]
    best = dict(floor)
    best.update(
        _place_on_supporters(
            observations, view, height_m, floor, _room(standing, observations, settings.placement), doors, settings
        )
    )
    telling = standing + [best[i] for i in doors if best[i].cost < settings.placement.sure_cost]
    room = _room(telling, observations, settings.placement)
    best = _cheaper(best, _place_on_supporters(observations, view, height_m, floor, room, hung, settings))
    carriers = {**floor, **{i: best[i] for i in hung if i in best}}
    best = _cheaper(best, _place_on_supporters(observations, view, height_m, carriers, room, others, settings))
    needed = {p.supporter for p in best.values() if p.supporter >= 0}
    stacked = _stack(observations, view, height_m, {**best, **{i: carriers[i] for i in needed}}, settings)
    return tuple(stacked[i] for i in range(len(observations)))


def _not_through_tops(
    floor: Mapping[int, Placement],
    observations: BoxObservations,
    view: View,
    height_m: float,
    settings: MetrologySettings,
) -> dict[int, Placement]:
    """Places on the floor, dearer where what may stand on others would be seen on the floor through their tops."""
    placements = dict(floor)
    for index, placement in floor.items():
        category = observations.categories[index]
        if category is not UNKNOWN and category.name not in PORTABLE:
            continue
        carriers = [
            floor[j]
            for j in _possible_parents(observations, index, settings.placement)
            if j in floor and _has_top(observations, j)
        ]
        box = observations.box_px[index]
        shares = [
            share_seen_through_top(box, placement.cuboid, c.cuboid, height_m, view, settings.observed) for c in carriers
        ]
        placements[index] = replace(
            placement, cost=placement.cost + settings.placement.through_top_cost * max(shares, default=0.0)
        )
    return placements


def _has_top(observations: BoxObservations, index: int) -> bool:
    """Whether a thing is known to have a closed top on which others stand."""
    category = observations.categories[index]
    return category is not UNKNOWN and category.supports_objects


def _cheaper(best: Mapping[int, Placement], challengers: Mapping[int, Placement]) -> dict[int, Placement]:
    """For every object the cheaper of both."""
    better = {i: c for i, c in challengers.items() if i not in best or c.cost < best[i].cost}
    return {**best, **better}


def _place_on_floor(
    observations: BoxObservations, view: View, height_m: float, settings: MetrologySettings
) -> dict[int, Placement]:
    """Every object that may stand on the floor, arranged so that they fit together; sets are of one size."""
    rows: list[Problems] = []
    for index, category in enumerate(observations.categories):
        if category.mount != "ceiling" and category.name not in _FIXED_TO_WALLS:
            cost = _floor_cost(observations, index, settings.placement)
            rows += [
                p.with_columns(extra=p.extra + cost)
                for p in place_on_floor(observations, index, height_m, settings=settings)
            ]
    if not rows:
        return {}
    carried = CarriedCosts(observations, view, height_m, settings=settings)
    solved = solve_all(rows, view, settings)
    placed = _arrange_standing(solved, observations, view, carried, settings)
    sets = set_sizes(placed, observations, settings.placement)
    if sets:
        shared = [p for i, mode in sets.items() for p in place_on_floor(observations, i, height_m, (mode,), settings)]
        alone = np.isin(solved.problems.item, list(sets))
        solved = concatenate_solutions(
            solved.dearer(np.where(alone, settings.placement.odd_one_cost, 0.0)), solve_all(shared, view, settings)
        )
        placed = _arrange_standing(solved, observations, view, carried, settings)
    return placed


def _arrange_standing(
    solved: Solutions, observations: BoxObservations, view: View, carried: CarriedCosts, settings: MetrologySettings
) -> dict[int, Placement]:
    readings = readings_of(solved, observations, view, settings)
    standing = [i for i in readings if observations.categories[i].mount == "floor"]
    loads = carried.costs({i: readings[i].boxes for i in standing})
    costs = [readings[i].costs + loads[i] for i in standing]
    chosen = arrange(
        [readings[i].boxes for i in standing], costs, [observations.categories[i] for i in standing], settings.placement
    )
    picked = dict(zip(standing, chosen, strict=True))
    return {i: r.placement(picked.get(i, 0), FLOOR) for i, r in readings.items()}


def set_sizes(
    placed: Mapping[int, Placement], observations: BoxObservations, settings: PlacementSettings
) -> dict[int, SizeMode]:
    """For every member of a set the size that the well-seen members have, as a narrow mode.

    Of a member that is cut or hidden above or below nothing is taken of its height, nor of its sides' extents of one
    that is cut or hidden at a side; an extent that no member shows stays as open as it is.
    """
    modes: dict[int, SizeMode] = {}
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


def _place_on_supporters(
    observations: BoxObservations,
    view: View,
    height_m: float,
    carriers: Mapping[int, Placement],
    room: RoomExtent,
    indices: list[int],
    settings: MetrologySettings,
) -> dict[int, Placement]:
    """The cheapest way to hold some objects otherwise than by the floor."""
    best: dict[int, Placement] = {}
    groups: dict[int, list[Problems]] = {}
    for index in indices:
        for supporter, rows in _supporter_rows(observations, index, carriers, room, height_m, settings):
            groups.setdefault(supporter, []).extend(rows)
    if not groups:
        return best
    solved = solve_all([p for rows in groups.values() for p in rows], view, settings)
    under = np.repeat(list(groups), [sum(map(len, rows)) for rows in groups.values()])
    supporter_of = np.tile(under, len(solved.cost) // len(under))
    for supporter in groups:
        for index, readings in readings_of(
            solved.rows(supporter_of == supporter), observations, view, settings
        ).items():
            challenger = readings.placement(0, supporter)
            if index not in best or challenger.cost < best[index].cost:
                best[index] = challenger
    return best


def _stack(
    observations: BoxObservations,
    view: View,
    height_m: float,
    placed: Mapping[int, Placement],
    settings: MetrologySettings,
) -> dict[int, Placement]:
    """Places with small things on small things that lie on others, where that is cheaper: a cup on books."""
    placements, holding = dict(placed), {p.supporter for p in placed.values()}
    for index in np.argsort(-observations.box_px[:, 3], kind="stable").tolist():  # what is below first
        below = _small_carrier(observations, index, settings.placement)
        if below is None or placements[below].supporter < 0 or index in holding:
            continue
        rows = place_on(
            observations, index, below, placements[below].cuboid, height_m, settings.placement.stacked_cost, settings
        )
        on_it = readings_of(solve_all(rows, view, settings), observations, view, settings)[index].placement(0, below)
        if on_it.cost < placements[index].cost:
            placements[index] = on_it
    return placements


def _small_carrier(observations: BoxObservations, index: int, settings: PlacementSettings) -> int | None:
    """The small carrier of which the picture shows most just under a thing; None where that is little."""
    category = observations.categories[index]
    if not lies_on_furniture(category.name):
        return None
    carriers = [j for j, c in enumerate(observations.categories) if c.name in STACKED_ON]
    lower = [j for j in carriers if observations.box_px[j, 3] > observations.box_px[index, 3]]
    under = observations.beside[index, :, 3]
    below = max(supporters_of(observations, index, lower, settings), key=lambda j: float(under[j]), default=None)
    return below if below is not None and under[below] >= settings.seen_under else None


def _supporter_rows(
    observations: BoxObservations,
    index: int,
    carriers: Mapping[int, Placement],
    room: RoomExtent,
    height_m: float,
    settings: MetrologySettings,
) -> list[tuple[int, list[Problems]]]:
    """Rows for everything but the floor that may hold an object, by supporter."""
    category = observations.categories[index]
    options: list[tuple[int, list[Problems]]] = []
    on_top = _holding_cost(observations, index, "on top", settings.placement)
    parents = _possible_parents(observations, index, settings.placement)
    if np.isfinite(on_top) and category.name not in _NEVER_ON_OBJECTS:
        for parent in parents:
            cost = on_top + _unlikely_parent_cost(category, observations.categories[parent], settings.placement)
            if observations.categories[parent].name in RUGS:  # what lies on it is as good as on the floor
                cost += _floor_cost(observations, index, settings.placement)
            options.append(
                (parent, place_on(observations, index, parent, carriers[parent].cuboid, height_m, cost, settings))
            )
    on_wall = (
        settings.placement.screen_on_wall_cost
        if category.name in _SCREENS
        else _holding_cost(observations, index, "wall", settings.placement)
    )
    if category.mount == "surface" and (parents or _small_carrier(observations, index, settings.placement) is not None):
        on_wall += settings.placement.beside_its_supporter_cost
    if category.name not in _NEVER_ON_OBJECTS or category.name in _FIXED_TO_WALLS:
        options.append((WALL, place_on_wall(observations, index, height_m, room, on_wall, settings)))
    below = _holding_cost(observations, index, "ceiling", settings.placement)
    if np.isfinite(below):
        options.append((CEILING, place_below_ceiling(observations, index, height_m, room, below, settings)))
    return options


def readings_of(
    solved: Solutions, observations: BoxObservations, view: View, settings: MetrologySettings = SETTINGS
) -> dict[int, Readings]:
    """Distinct readings of every object in a batch, masks counted in.

    Args:
        solved: cuboids and their costs, several an object.
        observations: of all objects.
        view: intrinsics, and rotation from camera to world.
        settings: of metrology.
    """
    boxes = cuboids(solved.unknowns, solved.problems, view)
    names = tuple(c.name for c in observations.categories)
    masks = (observations.mask_reach, observations.corner_weight, observations.mask_exact)
    corners = corner_costs(solved.problems, boxes, view, *masks, names, settings=settings.observed)
    costs = solved.cost + corners + _side_view_costs(solved.problems, boxes, observations, settings.placement)
    readings = {}
    for index in np.unique(solved.problems.item).astype(int):
        mine = np.flatnonzero(solved.problems.item == index)
        own_cuboids = Cuboids(boxes.centre[mine], boxes.yaw_rad[mine], boxes.size_m[mine])
        distinct_rows = mine[distinct(own_cuboids, costs[mine], settings.placement)]
        remaining_boxes = Cuboids(
            boxes.centre[distinct_rows], boxes.yaw_rad[distinct_rows], boxes.size_m[distinct_rows]
        )
        readings[int(index)] = Readings(solved.problems.rows(distinct_rows), remaining_boxes, costs[distinct_rows])
    return readings


def _side_view_costs(
    problems: Problems, boxes: Cuboids, observations: BoxObservations, settings: PlacementSettings
) -> Float[np.ndarray, "n"]:
    """A little against things with a front that turn their side to the camera: people picture fronts."""
    fronted = np.array([c.name in AGAINST_WALLS for c in observations.categories])[problems.item.astype(int)]
    to_camera = boxes.centre[:, :2] / np.maximum(np.linalg.norm(boxes.centre[:, :2], axis=1, keepdims=True), 1e-6)
    facing = np.abs(np.cos(boxes.yaw_rad) * to_camera[:, 0] + np.sin(boxes.yaw_rad) * to_camera[:, 1])
    return np.where(fronted, settings.averted_cost * (1.0 - facing), 0.0)


def _floor_cost(observations: BoxObservations, index: int, settings: PlacementSettings) -> float:
    category = observations.categories[index]
    cost = _holding_cost(observations, index, "floor", settings)
    parents = _carriers(observations, index, settings)
    if category.mount == "surface" and parents:
        cost += settings.beside_its_supporter_cost
    if category.name in PORTABLE and any(_often_carries(observations, j, index) for j in parents):
        cost += settings.at_carrier_cost
    before = max((float(observations.before[index, j]) for j in parents), default=0.0)
    return cost + settings.before_cost * before


def _often_carries(observations: BoxObservations, parent: int, index: int) -> bool:
    carrier = observations.categories[parent]
    return carrier.supports_objects and often_carried(observations.categories[index].name, carrier.name) > 1.0


def _carriers(observations: BoxObservations, index: int, settings: PlacementSettings) -> list[int]:
    """What may hold a thing above the floor."""
    return [j for j in _possible_parents(observations, index, settings) if observations.categories[j].name not in RUGS]


def _possible_parents(observations: BoxObservations, index: int, settings: PlacementSettings) -> list[int]:
    carriers = [i for i, c in enumerate(observations.categories) if c.mount == "floor" or c.name in _HUNG_CARRIERS]
    return supporters_of(observations, index, carriers, settings)


def _holding_cost(observations: BoxObservations, index: int, where: str, settings: PlacementSettings) -> float:
    """What speaks against an object being held there; of one without a name the mean over all that it may be."""
    category, meanings, costs = observations.categories[index], observations.meanings[index], _COSTS[where]
    if category is not UNKNOWN:
        return costs[category.mount]
    likely = sum(share * float(np.exp(-costs[taxonomy.category(kind).mount] / 2)) for kind, share in meanings)
    return -2.0 * float(np.log(likely + settings.hardly))


def _unlikely_parent_cost(category: Category, parent: Category, settings: PlacementSettings) -> float:
    if parent is UNKNOWN:
        return 0.5
    carries = 0.0 if parent.supports_objects else 4.0
    if category is UNKNOWN:
        return carries
    return carries + 2.0 * settings.company_trust * float(
        np.log(max(settings.usual / often_carried(category.name, parent.name), 1.0))
    )


def _tells_the_room(placement: Placement, observations: BoxObservations, settings: PlacementSettings) -> bool:
    """Whether a thing surely stands on the floor where it was placed."""
    category = observations.categories[placement.index]
    if category.mount != "floor" or placement.cost >= settings.sure_cost:
        return False
    if category.name in PORTABLE and _possible_parents(observations, placement.index, settings):
        return False
    return not (category is UNKNOWN and bool(observations.is_hidden(placement.index)[3]))


def _room(telling: list[Placement], observations: BoxObservations, settings: PlacementSettings) -> RoomExtent:
    return extent_of(_corners(telling), tuple(observations.categories[p.index].name for p in telling), settings)


def _corners(placements: list[Placement]) -> Float[np.ndarray, "n 8 3"]:
    if not placements:
        return np.zeros((0, 8, 3))
    boxes = [p.cuboid for p in placements]
    return np.concatenate([cuboid_corners(b.centre, b.yaw_rad, b.size_m) for b in boxes])
