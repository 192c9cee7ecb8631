"""Floors, ceilings and the room's side of walls, of a measured room, flat or house."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from jaxtyping import Float
from shapely.geometry import MultiPoint, Point, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import polygonize, snap, unary_union

from diorama_core.geometry.openings import HOME
from diorama_core.geometry.rooms import floor_under
from diorama_core.importing.measured_types import MeasuredBox, MeasuredRoom, MeasuredWall
from diorama_core.scene.types import HomeRoom, Plane

CORNER_M = 0.25
"""Ends of walls that are so near meet in a corner, where the file has no floor."""
INSIDE_M = 0.3
"""So far from a wall one is in the room, on one side of it."""
LEVEL_M = 0.05
"""Walls whose tops differ by less carry a level ceiling."""
STOREY_M = 1.2
"""Floors that are farther apart in height are of two storeys: half of a low one."""
HALF_WALL_M = 0.4
"""Walls that end so far below the others carry no ceiling."""


@dataclass(frozen=True, eq=False)
class Storey:
    """One floor and what it covers."""

    outline: Polygon | None
    height_m: float
    name: str = ""


def largest_polygon(whole: BaseGeometry) -> Polygon | None:
    """The largest piece of a shape; None where there is none."""
    pieces = [p for p in getattr(whole, "geoms", [whole]) if isinstance(p, Polygon) and not p.is_empty]
    return max(pieces, key=lambda p: p.area, default=None)


def storeys_of(room: MeasuredRoom) -> tuple[Storey, ...]:
    """The floors of a room: as measured, or one that the walls enclose, or one around everything."""
    measured = [Storey(Polygon(f.outline), f.height_m, f.name) for f in room.floors]
    sound = tuple(s for s in measured if s.outline is not None and s.outline.is_valid and s.outline.area > 0)
    if sound:
        return sound
    heights = [float(f.height_m) for f in room.floors] or [float(w.polygon[:, 2].min()) for w in room.walls]
    heights = heights or [float(b.centre[2] - b.size_m[2] / 2) for b in room.boxes]
    return (Storey(_outline(room), min(heights, default=0.0)),)


def floor_planes(storeys: Sequence[Storey]) -> tuple[Plane, ...]:
    """A plane for each floor; none where nothing tells its outline."""
    return tuple(
        Plane(_number("floor", k), "floor", np.column_stack([ring, np.full(len(ring), s.height_m)]))
        for k, s in enumerate(storeys)
        if s.outline is not None
        for ring in (_ring(s.outline),)
    )


def rooms_of_floors(floors: Sequence[Plane], names: Mapping[str, str]) -> tuple[HomeRoom, ...]:
    """A room for each floor of a home; none where there is but one floor.

    Names are by the id of the floor; equal ones are numbered, and rooms without one, too.
    """
    if len(floors) < 2:
        return ()
    levels = sorted({float(f.centre[2]) for f in floors})
    steps = [high for low, high in pairwise(levels) if high - low > STOREY_M]
    taken: Counter[str] = Counter()
    rooms = []
    for number, floor in enumerate(floors, 1):
        name = names.get(floor.id) or "room"
        taken[name] += 1
        called = f"{name} {taken[name]}" if taken[name] > 1 or name == "room" else name
        storey = sum(float(floor.centre[2]) >= step for step in steps)
        rooms.append(HomeRoom(f"room-{number}", called, floor.id, storey))
    return tuple(rooms)


def ceiling_planes(storeys: Sequence[Storey], walls: Sequence[Plane]) -> tuple[tuple[Plane, ...], tuple[str, ...]]:
    """A level ceiling over each floor whose walls are equally high but for half walls; and what was left out."""
    planes, notes = [], []
    for number, storey in enumerate(storeys):
        walls_of_storey = [w for w in walls if _is_of(w, storey)] if len(storeys) > 1 else walls
        tops = np.array([float(w.polygon[:, 2].max()) for w in walls_of_storey])
        full = tops[tops > tops.max() - HALF_WALL_M] if len(tops) else tops
        if storey.outline is None or len(tops) < 3:
            continue
        if any(_has_slope(w) for w in walls_of_storey) or np.ptp(full) > LEVEL_M:
            notes.append("the ceiling slopes: its walls are read as they are, and it was left out")
            continue
        if len(full) < 3:
            continue
        ring = _ring(storey.outline)[::-1]
        polygon = np.column_stack([ring, np.full(len(ring), float(np.median(full)))])
        planes.append(Plane(_number("ceiling", number), "ceiling", polygon))
    return tuple(planes), tuple(dict.fromkeys(notes))


def inner_face(wall: MeasuredWall, storeys: Sequence[Storey]) -> Plane:
    """The wall's inner face, seen counter-clockwise from inside the room that it is a border of."""
    plane = Plane(wall.id, "wall", wall.polygon)
    normal, centre = plane.normal, plane.centre
    outline = _room_of(plane, storeys)
    if outline is not None:
        ahead, behind = (outline.contains(Point((centre + side * INSIDE_M * normal)[:2])) for side in (1, -1))
        middle = np.asarray(outline.representative_point().coords)[0]
        inward = ahead if ahead != behind else (middle - centre[:2]) @ normal[:2] > 0
        if not inward:
            plane, normal = replace(plane, polygon=wall.polygon[::-1]), -normal
    if wall.thickness_m == 0.0:
        return plane
    return replace(plane, polygon=plane.polygon + normal * wall.thickness_m / 2, thickness=wall.thickness_m)


def floors_below(boxes: Sequence[MeasuredBox], storeys: Sequence[Storey]) -> list[int | None]:
    """Number of the floor that each box is over."""
    feet = np.array([b.centre - [0.0, 0.0, b.size_m[2] / 2] for b in boxes]).reshape(-1, 3)
    outlines = [np.zeros((0, 2)) if s.outline is None else _ring(s.outline) for s in storeys]
    return floor_under(feet, outlines, [s.height_m for s in storeys])


def _number(word: str, index: int) -> str:
    return word if index == 0 else f"{word}-{index + 1}"


def _has_slope(wall: Plane) -> bool:
    """Whether a wall has a side that is neither level nor upright: a gable has two."""
    along = np.roll(wall.polygon, -1, axis=0) - wall.polygon
    rises, runs = np.abs(along[:, 2]), np.linalg.norm(along[:, :2], axis=1)
    return bool(((rises > LEVEL_M) & (runs > LEVEL_M)).any())


def _is_of(wall: Plane, storey: Storey) -> bool:
    """Whether a wall is at the border of a floor, or on it, and begins at about its height."""
    if storey.outline is None or abs(float(wall.polygon[:, 2].min()) - storey.height_m) > 2 * HOME.sinks_m:
        return False
    return bool(storey.outline.distance(Point(wall.centre[:2])) < HOME.border_m)


def _room_of(wall: Plane, storeys: Sequence[Storey]) -> Polygon | None:
    """The outline that a wall is the border of; of all together where it is none's."""
    outlines = [s.outline for s in storeys if s.outline is not None]
    if len(outlines) < 2:
        return outlines[0] if outlines else None
    at = Point(wall.centre[:2])
    near = [(s.outline.exterior.distance(at), k) for k, s in enumerate(storeys) if s.outline and _is_of(wall, s)]
    return storeys[min(near)[1]].outline if near else outlines[0]


def _ring(outline: Polygon) -> Float[np.ndarray, "n 2"]:
    """Corners counter-clockwise seen from above."""
    ring = np.asarray(outline.exterior.coords)[:-1, :2]
    return ring if outline.exterior.is_ccw else ring[::-1]


def _outline(room: MeasuredRoom) -> Polygon | None:
    """What the walls enclose, or what is around everything."""
    ends = [w.polygon[:, :2] for w in room.walls]
    if ends:
        segments = [MultiPoint(e).convex_hull for e in ends]
        for index in range(1, len(segments)):
            segments[index] = snap(segments[index], unary_union(segments[:index]), CORNER_M)
        rooms = list(polygonize(unary_union([s for s in segments if s.geom_type == "LineString"])))
        if rooms:
            return largest_polygon(unary_union(rooms))
    corners = [_corners(b)[:, :2] for b in room.boxes] + ends
    hull = MultiPoint(np.vstack(corners)).convex_hull if corners else None
    return hull if isinstance(hull, Polygon) else None


def _corners(box: MeasuredBox) -> Float[np.ndarray, "8 3"]:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return box.centre + (0.5 * signs * box.size_m) @ box.R_world_box.T
