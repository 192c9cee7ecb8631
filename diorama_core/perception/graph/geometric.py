"""The support graph without a language model, where every possible support of an object competes by cost, and a graph
applied to the objects' geometry.

Costs are negative logarithms of likelihoods. They weigh where the object ends and what is seen just below it in the
photo, the gap between its underside and what could carry it, whether it is above that, how near a wall it is, what
people put where, and (weakly) what the geometry stage believed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.artefacts import Cuboid, DetectedObject, Inputs, ObjectGeometry, SceneGraph
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.library.taxonomy import RUGS, STACKED_ON, UNKNOWN, WITH_BOARDS, Category, having
from diorama_core.perception.graph.object_observations import (
    SETTINGS,
    GeometricGraphSettings,
    ObjectSurroundings,
    observed,
)
from diorama_core.progress import Progress
from diorama_core.scene.types import Relation, Support, yaw_rotation

_PRIOR: dict[str, tuple[float, float, float, float]] = {
    #          on an object, floor, wall, ceiling
    "floor": (3.0, 0.0, 5.0, 12.0),
    "surface": (0.0, 2.5, 4.0, 9.0),
    "wall": (2.5, 2.5, 0.0, 6.0),
    "ceiling": (9.0, 9.0, 5.0, 0.0),
}
_NEVER_ON_OBJECTS = having("never_on_objects")


@dataclass(frozen=True)
class GeometricGraph:
    """One supporter for every object that has a cuboid, with a score; never a cycle."""

    settings: GeometricGraphSettings = SETTINGS

    def relate(
        self, inputs: Inputs, objects: tuple[DetectedObject, ...], geometry: ObjectGeometry, progress: Progress
    ) -> SceneGraph:
        """The graph that explains masks, cuboids and (where there is any) depth best.

        Args:
            inputs, objects, geometry, progress: as documented in `protocols.GraphStage`.
        """
        progress.report(0.0, "Working out what stands on what")
        items = observed(inputs, objects, geometry, self.settings)
        believed = {s.child: s for s in geometry.supports}
        options = {t.id: _options(t, items, believed.get(t.id), self.settings) for t in items}
        chosen = _without_cycles(options)
        edges, scores = [], []
        for obj in items:
            parent, cost = chosen[obj.id]
            relation: Relation = "mounted on" if parent in ("wall", "ceiling") else "placed on"
            edges.append(Support(obj.id, parent, relation))
            scores.append(_sureness(cost, options[obj.id], parent))
        return SceneGraph(tuple(edges), tuple(scores))


Options = tuple[tuple[str, float], ...]
"""(supporter, cost), cheapest first."""


def _options(
    obj: ObjectSurroundings,
    items: tuple[ObjectSurroundings, ...],
    believed: Support | None,
    settings: GeometricGraphSettings,
) -> Options:
    priors = _priors(obj.category, settings)
    costs = {
        "floor": priors[1] + _floor_cost(obj, settings),
        "wall": priors[2] + _wall_cost(obj, settings),
        "ceiling": priors[3] + _ceiling_cost(obj, settings),
    }
    if obj.category.name not in _NEVER_ON_OBJECTS:
        for other in items:
            if other.id != obj.id:
                costs[other.id] = priors[0] + _carried_cost(obj, other, settings)
    if believed is not None:
        for key in costs:
            costs[key] += 0.0 if key == believed.parent else settings.belief_cost
    return tuple(sorted(costs.items(), key=lambda item: (item[1], item[0])))


def _priors(category: Category, settings: GeometricGraphSettings) -> tuple[float, float, float, float]:
    if category is UNKNOWN:
        return settings.unnamed_prior
    prior = _PRIOR[category.mount]
    return (9.0, 9.0, 0.0, 9.0) if category.name in OPENING_CATEGORIES else prior


def _gap_cost(gap_m: float, usual_m: float, settings: GeometricGraphSettings) -> float:
    """Square for small gaps, bounded for large ones."""
    return float(settings.max_gap_cost * (1.0 - np.exp(-0.5 * (gap_m / usual_m) ** 2 / settings.max_gap_cost)))


def _floor_cost(obj: ObjectSurroundings, settings: GeometricGraphSettings) -> float:
    """High for an underside seen in the air, or an object seen below."""
    gap = max(obj.bottom_m, 0.0)
    seen = _gap_cost(gap, settings.floor_gap_m, settings)
    lenient = 1.0 - 0.7 * obj.hidden_below
    return lenient * seen + settings.below_weight * (1.0 - obj.below.get("floor", 0.0)) * lenient


def _wall_cost(obj: ObjectSurroundings, settings: GeometricGraphSettings) -> float:
    on_floor = 2.0 if obj.bottom_m < 0.1 and obj.category.mount != "wall" else 0.0
    return (
        on_floor
        + _gap_cost(max(obj.behind_m, 0.0), 0.25, settings)
        + 0.5 * settings.below_weight * obj.rim_share_on_objects
    )


def _ceiling_cost(obj: ObjectSurroundings, settings: GeometricGraphSettings) -> float:
    return _gap_cost(max(2.0 - obj.top_m, 0.0), 0.3, settings)


def _carried_cost(obj: ObjectSurroundings, other: ObjectSurroundings, settings: GeometricGraphSettings) -> float:
    """How badly an object would rest on another's top, seat or shelves."""
    if other.category.name in RUGS:
        return _rug_cost(obj, other, settings)
    above = obj.below.get(other.id, 0.0)
    carries = other.category.supports_objects or other.category is UNKNOWN
    stacked = above if other.category.name in STACKED_ON else 0.0
    cost = 0.0 if carries else settings.carries_nothing_cost * (1.0 - stacked)
    levels = [(other.top_m, settings.top_gap_m, 0.0)]
    seat = other.category.seat_height_m
    if seat is not None and seat < other.top_m:
        levels.append((seat, settings.inner_gap_m, 0.0))
    if other.category.name in WITH_BOARDS and other.bottom_m - 0.05 < obj.bottom_m < other.top_m - 0.05:
        levels.append((obj.bottom_m, settings.inner_gap_m, 0.8))
    gap = min(_gap_cost(abs(obj.bottom_m - z), usual, settings) + extra for z, usual, extra in levels)
    outside = _share_outside(obj.footprint, other.footprint)
    area, theirs = (float(np.prod(t.footprint[1] - t.footprint[0])) for t in (obj, other))
    larger = settings.larger_cost * min(max(np.log(max(area, 1e-4) / max(theirs, 1e-4)), 0.0), 1.0)
    return float(cost + gap + 5.0 * outside + larger + settings.below_weight * (1.0 - above))


def _rug_cost(obj: ObjectSurroundings, rug: ObjectSurroundings, settings: GeometricGraphSettings) -> float:
    """Cost of a rug below what stands within it, at the floor's height, where nothing else is seen just below."""
    outside = _share_outside(obj.footprint, rug.footprint)
    on_rug = obj.below.get(rug.id, 0.0)
    within = settings.within_rug * min(on_rug + obj.hidden_below, 1.0)
    return float(
        _gap_cost(max(obj.bottom_m, 0.0), settings.floor_gap_m, settings)
        - within
        + 8.0 * outside
        + settings.below_weight * (1 - on_rug)
    )


def _share_outside(child: Float[np.ndarray, "2 2"], parent: Float[np.ndarray, "2 2"]) -> float:
    """Share of the child's footprint that is not over the parent's, both along the world's axes."""
    shared = np.minimum(child[1], parent[1]) - np.maximum(child[0], parent[0])
    extent = np.maximum(child[1] - child[0], 0.02)
    return float(1.0 - np.prod(np.clip(shared / extent, 0.0, 1.0)))


def _without_cycles(options: dict[str, Options]) -> dict[str, tuple[str, float]]:
    """The cheapest supporter of each; where supporters lead in a circle, the least certain of them changes."""
    rank = dict.fromkeys(options, 0)
    while True:
        chosen = {key: options[key][rank[key]] for key in options}
        ring = _ring(chosen)
        if not ring:
            return chosen
        regret = {
            key: options[key][rank[key] + 1][1] - options[key][rank[key]][1]
            for key in ring
            if _has_next(options[key], rank[key])
        }
        rank[min(regret, key=lambda key: (regret[key], key))] += 1


def _has_next(options: Options, rank: int) -> bool:
    return rank + 1 < len(options)


def _ring(chosen: dict[str, tuple[str, float]]) -> list[str]:
    """Objects that hold one another up in a circle, if any do."""
    for start in sorted(chosen):
        path = [start]
        while path[-1] in chosen:
            following = chosen[path[-1]][0]
            if following in path:
                return path[path.index(following) :]
            path.append(following)
    return []


def _sureness(cost: float, options: Options, parent: str) -> float:
    """The chosen supporter's share of the likelihood of all."""
    costs = np.array([c for _, c in options])
    return float(np.exp(-cost) / np.maximum(np.exp(-costs).sum(), 1e-12)) if parent else 0.0


_TURNS: Mapping[str, float] = {
    "toward camera": np.pi,
    "away from camera": 0.0,
    "left": np.pi / 2,
    "right": -np.pi / 2,
}
"""Heading of a front relative to the line of sight, counter-clockwise seen from above."""


MAX_SETTLING_M = 0.35
"""A cuboid's underside moves no farther than this to its supporter; the layout optimiser does the rest."""
MIN_HEIGHT_M = 0.02


def with_graph(geometry: ObjectGeometry, graph: SceneGraph | None) -> ObjectGeometry:
    """The geometry with the graph's supports, and fronts turned as the graph says; unchanged without a graph."""
    if graph is None:
        return geometry
    facing = dict(graph.facing)
    turned = (_turned(c, facing.get(c.object_id), geometry) for c in geometry.cuboids)
    before, now = ({s.child: s.parent for s in edges} for edges in (geometry.supports, graph.supports))
    tops = {c.object_id: float(c.corners_world[:, 2].max()) for c in geometry.cuboids}
    cuboids = tuple(
        c if before.get(c.object_id) == now.get(c.object_id) else _stood(c, now.get(c.object_id, ""), tops)
        for c in turned
    )
    return replace(geometry, supports=graph.supports, cuboids=cuboids)


def _stood(cuboid: Cuboid, parent: str, tops_m: Mapping[str, float]) -> Cuboid:
    """The cuboid reaching down to a new supporter, its top where it was: the floor, or a top that is near."""
    low, high = (float(v) for v in (cuboid.corners_world[:, 2].min(), cuboid.corners_world[:, 2].max()))
    bottom = 0.0 if parent == "floor" else tops_m.get(parent, low)
    if abs(bottom - low) > MAX_SETTLING_M or high - bottom < MIN_HEIGHT_M:
        return cuboid
    size = cuboid.size_m.copy()
    size[2] = high - bottom
    centre = cuboid.centre.copy()
    centre[2] = (high + bottom) / 2
    return replace(cuboid, centre=centre, size_m=size)


def _turned(cuboid: Cuboid, direction: str | None, geometry: ObjectGeometry) -> Cuboid:
    """The cuboid with its front on the side that looks the named way; untouched where its front is known."""
    if direction is None or direction not in _TURNS or cuboid.front_known:
        return cuboid
    sight = cuboid.centre[:2] - geometry.camera.position[:2]
    heading = float(np.arctan2(sight[1], sight[0])) + _TURNS[direction]
    wanted = np.array([np.cos(heading), np.sin(heading)])
    quarter = max(range(4), key=lambda k: float((cuboid.R_world_object @ yaw_rotation(k * np.pi / 2))[:2, 0] @ wanted))
    size = cuboid.size_m if quarter % 2 == 0 else cuboid.size_m[[1, 0, 2]]
    R = cuboid.R_world_object @ yaw_rotation(quarter * np.pi / 2)
    return replace(cuboid, R_world_object=R, size_m=size, front_known=True)
