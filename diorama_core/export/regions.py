"""Named places of a room where things can be put: every surface that holds something up, and what is free of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from diorama_core.arrangement.surfaces import RestingSurface, object_surfaces
from diorama_core.export.bodies import PhysicalScene, Points, RigidBody
from diorama_core.export.gathering import ExportScene, shift
from diorama_core.export.limbs import ExportLimb
from diorama_core.export.links import body_name
from diorama_core.export.navigation import BodyOutline, floor_area

MIN_SIDE_M = 0.05
"""Surfaces narrower than this hold nothing that a robot would put down: edges of books, rims."""
LEVEL = 0.99
"""Cosine to the vertical from which on a surface holds things up."""
ABOVE_M, HEADROOM_M = 0.005, 0.3
"""What reaches into this height above a surface takes its place; below, surfaces and things touch."""
NEAR_M = 0.03
"""A thing stands on a surface when its lowest point is this near to it."""


@dataclass(frozen=True, eq=False)
class Region:
    """One surface where things can be put."""

    name: str
    """Unique: that of its body and a number."""
    owner: str | None
    """Id of the object that it belongs to; None for the floor."""
    body: str | None
    """What the files call the body that carries it, the moving part where it is one; None for the room."""
    polygon: Float[np.ndarray, "n 3"]
    """Corners in the world."""
    T_body: Float[np.ndarray, "4 4"]
    """Middle of its box along the body's axes, in the body's frame."""
    size_m: tuple[float, float]
    """Sides of that box."""
    clearance_m: float
    """Height that is free above it; infinite where only the room ends it."""
    holds: tuple[str, ...]
    """Ids of what stands there."""
    free: BaseGeometry
    """What nothing covers, in the world's x and y."""


def regions_of(gathered: ExportScene, physical: PhysicalScene, bodies: Sequence[BodyOutline]) -> tuple[Region, ...]:
    """The floor first, then every level surface of the objects."""
    regions = [] if gathered.scene.architecture.floor is None else [_floor(gathered, bodies)]
    for body in physical.bodies:
        for number, (limb, surface) in enumerate(_surfaces(gathered, body)):
            regions.append(_region(body, limb, surface, number, bodies))
    return tuple(regions)


def _floor(gathered: ExportScene, bodies: Sequence[BodyOutline]) -> Region:
    area, level = floor_area(gathered), gathered.floor_m
    largest = max(getattr(area, "geoms", [area]), key=lambda part: part.area)
    flat = np.asarray(largest.exterior.coords)[:-1]
    polygon = np.column_stack([flat, np.full(len(flat), level)])
    free, holds = _rest(area, level, HEADROOM_M, bodies, None)
    middle, size = _box(polygon)
    return Region("floor_region", None, None, polygon, middle, size, np.inf, holds, free)


def _surfaces(gathered: ExportScene, body: RigidBody) -> Iterator[tuple[ExportLimb | None, RestingSurface]]:
    """Level surfaces of an object in its frame at its scale, wide enough, with the moving part that each lies on."""
    node = body.node
    shape = gathered.library.shape(node.item.shape_id)
    if not shape.surfaces and not gathered.children_of(node.id):
        return
    for surface in object_surfaces(shape, node.item):
        scaled = surface.transform(np.eye(3), np.zeros(3), node.scale)
        if min(np.ptp(scaled.polygon[:, :2], axis=0)) >= MIN_SIDE_M and node.T_world[2, 2] > LEVEL:
            below = scaled.polygon.mean(axis=0) - [0.0, 0.0, ABOVE_M]
            yield next((m.limb for m in body.moving if any(_holds(p, below) for p in m.parts)), None), scaled


def _holds(part: Points, point: Float[np.ndarray, "3"]) -> bool:
    low, high = part.min(axis=0), part.max(axis=0)
    return bool((low - ABOVE_M <= point).all() and (point <= high + ABOVE_M).all())


def _region(
    body: RigidBody, limb: ExportLimb | None, surface: RestingSurface, number: int, bodies: Sequence[BodyOutline]
) -> Region:
    """One surface of an object, given in its frame at its scale, in the world as its part stands."""
    node = body.node
    T = node.T_world if limb is None else node.T_world @ limb.T_object_limb
    polygon = surface.polygon @ T[:3, :3].T + T[:3, 3]
    high = min(surface.clearance_m, HEADROOM_M)
    free, holds = _rest(Polygon(polygon[:, :2]), float(polygon[:, 2].mean()), high, bodies, node.id)
    middle, size = _box(surface.polygon)
    name = body_name(node.slug, limb)
    return Region(
        f"{node.slug}_region_{number}", node.id, name, polygon, middle, size, surface.clearance_m, holds, free
    )


def _rest(
    area: BaseGeometry, level: float, headroom_m: float, bodies: Sequence[BodyOutline], owner: str | None
) -> tuple[BaseGeometry, tuple[str, ...]]:
    """What nothing but its owner covers of a surface, up to a headroom, and the ids of what stands on it."""
    lowest: dict[str, float] = {}
    covers = []
    for body in bodies:
        if body.owner is None or body.owner == owner:
            continue
        lowest[body.owner] = min(lowest.get(body.owner, np.inf), body.low)
        if body.low < level + headroom_m and body.high > level + ABOVE_M:
            covers.append((body.owner, body.section_between(level + ABOVE_M, level + headroom_m).intersection(area)))
    holds = (o for o, covered in covers if covered.area > 0 and abs(lowest[o] - level) < NEAR_M)
    return area.difference(shapely.unary_union([c for _, c in covers])), tuple(dict.fromkeys(holds))


def _box(polygon: Float[np.ndarray, "n 3"]) -> tuple[Float[np.ndarray, "4 4"], tuple[float, float]]:
    """Where the middle of a polygon's box along the axes lies, and its sides."""
    width, depth = np.ptp(polygon[:, :2], axis=0)
    return shift((polygon.min(axis=0) + polygon.max(axis=0)) / 2), (float(width), float(depth))
