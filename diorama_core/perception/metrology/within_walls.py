"""Measures objects anew that the walls of the room tell something of.

Boxes leave several readings of an object open: farther and larger, turned by a quarter, nearer and smaller. The walls,
which are found after the objects, say which of them there is room for where its lower end is not seen and it would
reach through one. Of a kind that stands at walls the one with its back there is the likelier, and the way in which its
edges run tells a case that is seen from the front from a long one that is seen along its length. So its readings
compete once more, beside the other objects where they are; what it carries follows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, UInt8

from diorama_core.architecture.before_walls import MIN_CONFIDENCE, nearer_by
from diorama_core.architecture.mounting import ahead_of
from diorama_core.artefacts import ArchitectureEstimate, Cuboid, DetectedObject, Inputs, ObjectGeometry
from diorama_core.library.taxonomy import AGAINST_WALLS, Category, category
from diorama_core.perception.metrology.arrangement import alike, arrange
from diorama_core.perception.metrology.backs import back_costs
from diorama_core.perception.metrology.box_observations import BoxObservations, gather
from diorama_core.perception.metrology.carried_costs import CarriedCosts
from diorama_core.perception.metrology.drawn_edges import DrawnEdges
from diorama_core.perception.metrology.floor import place_on_floor, solve_all
from diorama_core.perception.metrology.placement import FLOOR, Placement, readings_of
from diorama_core.perception.metrology.problem import Cuboids, Problems, View
from diorama_core.perception.metrology.reading import heading_and_size
from diorama_core.perception.metrology.settings import SETTINGS, HeightScanSettings, MetrologySettings
from diorama_core.perception.metrology.supported_objects import place_on
from diorama_core.scene.types import Plane, yaw_rotation

_WALL_SIGMA_M = 0.1
"""How well the place of a wall that is seen is known."""
_ANYWHERE_M = 50.0
"""How far a room reaches where no wall is known."""
_LONG = 0.2
"""Difference of the logarithms of depth and width."""
_SQUARE = 0.05
"""Sine up to which walls count as square or parallel to one another."""


@dataclass(frozen=True, eq=False)
class _Measured:
    """What is measured anew: everything about the camera's foot, as metrology has it."""

    observations: BoxObservations
    view: View
    height_m: float
    index_of: Mapping[str, int]
    rgb: UInt8[np.ndarray, "h w 3"]
    masks: tuple[Bool[np.ndarray, "h w"], ...]


def measured_within_walls(
    geometry: ObjectGeometry,
    room: ArchitectureEstimate,
    objects: tuple[DetectedObject, ...],
    inputs: Inputs,
    settings: MetrologySettings = SETTINGS,
) -> ObjectGeometry:
    """Objects with those measured anew that the walls tell something of, and what they carry.

    Args:
        geometry: Of all objects.
        room: Walls with their confidence, and supports whose parents are objects or planes.
        objects: Of the photo.
        inputs: With the photo.
    """
    if geometry.source.is_measured:
        return geometry
    walls = tuple(w for w in room.architecture.by_role("wall") if w.confidence >= MIN_CONFIDENCE)
    floors = {p.id for p in room.architecture.by_role("floor")}
    parents = {s.child: s.parent for s in room.supports}
    standing = [c for c in geometry.cuboids if parents.get(c.object_id) in floors]
    behind = [c for c in standing if not c.foot_seen and nearer_by(c, walls, geometry.camera) < 1.0]
    long = {o.id for o in objects if o.category in AGAINST_WALLS and _is_long(category(o.category))}
    backed = [c for c in standing if walls and c.object_id in long]
    if not behind and not backed:
        return geometry
    foot = np.array([*geometry.camera.position[:2], 0.0])
    seen = _Measured(
        gather(objects, inputs.photo.width, inputs.photo.height, settings),
        View(geometry.camera.intrinsics, geometry.camera.T_world_camera[:3, :3]),
        float(geometry.camera.position[2]),
        {o.id: k for k, o in enumerate(objects)},
        inputs.photo.rgb,
        tuple(o.mask for o in objects),
    )
    known = {c.object_id: replace(c, centre=c.centre - foot) for c in geometry.cuboids}
    bounds = {
        c.object_id: _room_for(c, tuple(w for w in walls if ahead_of(c, w, geometry.camera.position)), foot)
        for c in behind
    }
    for placed in _placed(seen, bounds, known, parents, settings) if bounds else ():
        known[placed.object_id] = placed
        known |= _carried(placed.object_id, seen, known, parents, settings)
    for name in [c.object_id for c in backed if c.object_id not in bounds]:
        turned = _with_back_at_wall(seen, name, known, parents, walls, foot, settings)
        if turned is not None:
            known[name] = turned
            known |= _carried(name, seen, known, parents, settings)
    return replace(geometry, cuboids=tuple(replace(c, centre=c.centre + foot) for c in known.values()))


def _is_long(kind: Category) -> bool:
    """Whether things of a kind are clearly of another depth than width: turned by a quarter, others are not another."""
    depth, width, _ = kind.priors[0].log_median_xyz
    return bool(abs(depth - width) > _LONG)


def _room_for(cuboid: Cuboid, walls: tuple[Plane, ...], foot: Float[np.ndarray, "3"]) -> Float[np.ndarray, "5"]:
    """The rectangle that the walls behind an object leave for it, as `Problems.footprint`.

    Its axes are those of the wall that the object reaches through most; walls aslant to that one are left out.
    """
    through = [float(((cuboid.corners_world + foot) @ w.normal).min()) - w.offset for w in walls]
    first = walls[int(np.argmin(through))].normal[:2]
    axes = np.stack([first, [-first[1], first[0]]])
    low, high = np.full(2, -_ANYWHERE_M), np.full(2, _ANYWHERE_M)
    for wall in walls:
        along = axes @ wall.normal[:2]
        axis = int(np.argmax(np.abs(along)))
        if abs(along[1 - axis]) > _SQUARE:
            continue
        at = wall.offset - float(wall.normal @ foot)
        if along[axis] > 0:
            low[axis] = max(low[axis], at)
        else:
            high[axis] = min(high[axis], -at)
    centre = 0.5 * (low + high) @ axes
    return np.array([*centre, np.arctan2(first[1], first[0]), *(0.5 * (high - low))])


def _placed(
    seen: _Measured,
    bounds: Mapping[str, Float[np.ndarray, "5"]],
    known: Mapping[str, Cuboid],
    parents: Mapping[str, str],
    settings: MetrologySettings,
) -> list[Cuboid]:
    """The objects within their bounds, arranged beside the others on the floor, which stay."""
    rows: list[Problems] = []
    for name, bound in bounds.items():
        open_rows = place_on_floor(seen.observations, seen.index_of[name], seen.height_m, settings=settings)
        rows += [row.changed(footprint=bound, footprint_sigma_m=_WALL_SIGMA_M) for row in open_rows]
    readings = readings_of(solve_all(rows, seen.view, settings), seen.observations, seen.view, settings)
    own = {n: readings[seen.index_of[n]] for n in bounds}
    carried = CarriedCosts(seen.observations, seen.view, seen.height_m, settings=settings)
    loads = carried.of({seen.index_of[n]: r.boxes for n, r in own.items()})
    carrying = [r.costs + loads[seen.index_of[n]] for n, r in own.items()]
    beside = [n for n in known if n not in bounds and parents.get(n) == parents[next(iter(bounds))]]
    boxes = [r.boxes for r in own.values()] + [_batch(known[n]) for n in beside]
    costs = carrying + [np.zeros(1)] * len(beside)
    categories = [seen.observations.categories[seen.index_of[n]] for n in (*bounds, *beside)]
    chosen = arrange(boxes, costs, categories, settings.placement)
    return [
        _cuboid(known[name], found.placement(row, FLOOR), seen.observations, settings.heights)
        for (name, found), row in zip(own.items(), chosen, strict=False)
    ]


def _with_back_at_wall(
    seen: _Measured,
    name: str,
    known: Mapping[str, Cuboid],
    parents: Mapping[str, str],
    walls: tuple[Plane, ...],
    foot: Float[np.ndarray, "3"],
    settings: MetrologySettings,
) -> Cuboid | None:
    """One object's best reading, walls and drawn edges counted in; None where it stays as it is.

    An object that was measured as no single reading of its box, as one of a set, stays, too.
    """
    index = seen.index_of[name]
    rows = place_on_floor(seen.observations, index, seen.height_m, settings=settings)
    readings = readings_of(solve_all(rows, seen.view, settings), seen.observations, seen.view, settings)[index]
    now = next(
        (k for k in range(len(readings.costs)) if alike(readings.boxes, k, _batch(known[name]), 0, settings.placement)),
        None,
    )
    if now is None:
        return None
    loads = CarriedCosts(seen.observations, seen.view, seen.height_m, settings=settings).of({index: readings.boxes})[
        index
    ]
    edges = DrawnEdges.of(seen.rgb, seen.masks[index], settings.observed).costs(
        readings.boxes, seen.height_m, seen.view
    )
    costs = readings.costs + loads + edges + back_costs(readings.boxes, walls, foot, settings.placement)
    kinds = {n: seen.observations.categories[seen.index_of[n]] for n in known}
    beside = [n for n in known if n != name and parents.get(n) == parents[name] and kinds[n].mount != "surface"]
    categories = [kinds[n] for n in (name, *beside)]
    boxes = [readings.boxes, *(_batch(known[n]) for n in beside)]
    chosen = arrange(boxes, [costs, *([np.zeros(1)] * len(beside))], categories, settings.placement)[0]
    return (
        None
        if chosen == now
        else _cuboid(known[name], readings.placement(chosen, FLOOR), seen.observations, settings.heights)
    )


def _carried(
    parent: str, seen: _Measured, known: Mapping[str, Cuboid], parents: Mapping[str, str], settings: MetrologySettings
) -> dict[str, Cuboid]:
    """What an object carries, measured on it where it is now, and what that carries."""
    children = [name for name in known if parents.get(name) == parent]
    if not children:
        return {}
    index, below = seen.index_of[parent], _batch(known[parent])
    rows = [
        row
        for name in children
        for row in place_on(seen.observations, seen.index_of[name], index, below, seen.height_m, 0.0, settings)
    ]
    readings = readings_of(solve_all(rows, seen.view, settings), seen.observations, seen.view, settings)
    found = {
        name: _cuboid(
            known[name], readings[seen.index_of[name]].placement(0, index), seen.observations, settings.heights
        )
        for name in children
    }
    lower = [_carried(name, seen, {**known, **found}, parents, settings) for name in children]
    return {**found, **{name: cuboid for one in lower for name, cuboid in one.items()}}


def _batch(cuboid: Cuboid) -> Cuboids:
    """As a batch of one."""
    yaw = np.arctan2(cuboid.R_world_object[1, 0], cuboid.R_world_object[0, 0])
    return Cuboids(cuboid.centre[None], np.array([yaw]), cuboid.size_m[None])


def _cuboid(
    before: Cuboid, placement: Placement, observations: BoxObservations, settings: HeightScanSettings
) -> Cuboid:
    yaw, size = heading_and_size(placement, observations.categories[placement.index], settings)
    return replace(
        before, R_world_object=yaw_rotation(yaw), centre=placement.cuboid.centre[0], size_m=size, front_known=False
    )
