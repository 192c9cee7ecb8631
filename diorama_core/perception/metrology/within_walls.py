"""Measures objects anew whose lower ends are not seen and that would reach through a wall of the room.

Boxes leave several readings of such an object open: farther and larger, turned by a quarter, nearer and smaller. The
walls, which are found after the objects, say which of them there is room for. So its readings compete once more, now
with the walls behind it, beside the other objects where they are; what it carries follows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from diorama_core.architecture.before_walls import MIN_CONFIDENCE, nearer_by
from diorama_core.architecture.mounting import ahead_of
from diorama_core.artefacts import ArchitectureEstimate, Cuboid, DetectedObject, Inputs, ObjectGeometry
from diorama_core.perception.metrology.arrangement import arrange
from diorama_core.perception.metrology.box_observations import BoxObservations, gather
from diorama_core.perception.metrology.carried_costs import CarriedCosts
from diorama_core.perception.metrology.floor import place_on_floor, solve_all
from diorama_core.perception.metrology.placement import FLOOR, Placement, readings_of
from diorama_core.perception.metrology.problem import Cuboids, Problems, View
from diorama_core.perception.metrology.reading import heading_and_size
from diorama_core.perception.metrology.supported_objects import place_on
from diorama_core.scene.types import Plane, yaw_rotation

_WALL_SIGMA_M = 0.1
"""How well the place of a wall that is seen is known."""
_ANYWHERE_M = 50.0
"""How far a room reaches where no wall is known."""
_SQUARE = 0.05
"""Sine up to which walls count as square or parallel to one another."""


@dataclass(frozen=True, eq=False)
class _Measured:
    """What is measured anew: everything about the camera's foot, as metrology has it."""

    observations: BoxObservations
    view: View
    height_m: float
    index_of: Mapping[str, int]


def measured_within_walls(
    geometry: ObjectGeometry, room: ArchitectureEstimate, objects: tuple[DetectedObject, ...], inputs: Inputs
) -> ObjectGeometry:
    """The same objects, those measured anew that stand behind a wall with their feet unseen, and what they carry.

    Args:
        geometry: Of all objects.
        room: Walls with their confidence, and supports whose parents are objects or planes.
        objects: Of the photo.
        inputs: With the photo.
    """
    walls = tuple(w for w in room.architecture.by_role("wall") if w.confidence >= MIN_CONFIDENCE)
    floors = {p.id for p in room.architecture.by_role("floor")}
    parents = {s.child: s.parent for s in room.supports}
    behind = [
        c
        for c in geometry.cuboids
        if not c.foot_seen and parents.get(c.object_id) in floors and nearer_by(c, walls, geometry.camera) < 1.0
    ]
    if not behind:
        return geometry
    foot = np.array([*geometry.camera.position[:2], 0.0])
    seen = _Measured(
        gather(objects, inputs.photo.width, inputs.photo.height),
        View(geometry.camera.intrinsics, geometry.camera.T_world_camera[:3, :3]),
        float(geometry.camera.position[2]),
        {o.id: k for k, o in enumerate(objects)},
    )
    known = {c.object_id: replace(c, centre=c.centre - foot) for c in geometry.cuboids}
    bounds = {
        c.object_id: _room_for(c, tuple(w for w in walls if ahead_of(c, w, geometry.camera.position)), foot)
        for c in behind
    }
    for placed in _placed(seen, bounds, known, parents):
        known[placed.object_id] = placed
        known |= _carried(placed.object_id, seen, known, parents)
    return replace(geometry, cuboids=tuple(replace(c, centre=c.centre + foot) for c in known.values()))


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
) -> list[Cuboid]:
    """The objects within their bounds, arranged beside the others on the floor, which stay."""
    rows: list[Problems] = []
    for name, bound in bounds.items():
        open_rows = place_on_floor(seen.observations, seen.index_of[name], seen.height_m)
        rows += [row.changed(footprint=bound, footprint_sigma_m=_WALL_SIGMA_M) for row in open_rows]
    readings = readings_of(solve_all(rows, seen.view), seen.observations, seen.view)
    own = {n: readings[seen.index_of[n]] for n in bounds}
    carried = CarriedCosts(seen.observations, seen.view, seen.height_m)
    loads = carried.of({seen.index_of[n]: r.boxes for n, r in own.items()})
    carrying = [r.costs + loads[seen.index_of[n]] for n, r in own.items()]
    beside = [n for n in known if n not in bounds and parents.get(n) == parents[next(iter(bounds))]]
    boxes = [r.boxes for r in own.values()] + [_batch(known[n]) for n in beside]
    costs = carrying + [np.zeros(1)] * len(beside)
    categories = [seen.observations.categories[seen.index_of[n]] for n in (*bounds, *beside)]
    chosen = arrange(boxes, costs, categories)
    return [
        _cuboid(known[name], found.placement(row, FLOOR), seen.observations)
        for (name, found), row in zip(own.items(), chosen, strict=False)
    ]


def _carried(
    parent: str, seen: _Measured, known: Mapping[str, Cuboid], parents: Mapping[str, str]
) -> dict[str, Cuboid]:
    """What an object carries, measured on it where it is now, and what that carries."""
    children = [name for name in known if parents.get(name) == parent]
    if not children:
        return {}
    index, below = seen.index_of[parent], _batch(known[parent])
    rows = [
        row
        for name in children
        for row in place_on(seen.observations, seen.index_of[name], index, below, seen.height_m, 0.0)
    ]
    readings = readings_of(solve_all(rows, seen.view), seen.observations, seen.view)
    found = {
        name: _cuboid(known[name], readings[seen.index_of[name]].placement(0, index), seen.observations)
        for name in children
    }
    lower = [_carried(name, seen, {**known, **found}, parents) for name in children]
    return {**found, **{name: cuboid for one in lower for name, cuboid in one.items()}}


def _batch(cuboid: Cuboid) -> Cuboids:
    """As a batch of one."""
    yaw = np.arctan2(cuboid.R_world_object[1, 0], cuboid.R_world_object[0, 0])
    return Cuboids(cuboid.centre[None], np.array([yaw]), cuboid.size_m[None])


def _cuboid(before: Cuboid, placement: Placement, observations: BoxObservations) -> Cuboid:
    yaw, size = heading_and_size(placement, observations.categories[placement.index])
    return replace(
        before, R_world_object=yaw_rotation(yaw), centre=placement.cuboid.centre[0], size_m=size, front_known=False
    )
