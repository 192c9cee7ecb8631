"""Use of rooms: their areas, where a wheelchair turns, how wide the ways between their doors are, which doors open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float

from diorama_core.editing.walking import free_floor
from diorama_core.export.door_swings import door_swings
from diorama_core.geometry.openings import DOOR, wall_of
from diorama_core.geometry.rooms import doorways, part_of_home
from diorama_core.library.furniture.articulation import articulation
from diorama_core.scene.types import HomeRoom, Scene

TURNING_M = 1.5
"""Diameter of the circle that a wheelchair turns in (DIN 18040-2)."""
WAYS_M = (1.2, 1.0, 0.9, 0.8, 0.7, 0.6, 0.5)
"""Widths that ways are told by."""


@dataclass(frozen=True)
class RoomUse:
    """Area of a room, room to turn in it, and ways through it."""

    room: HomeRoom
    area_m2: float
    turning_at: tuple[float, float] | None
    """Middle of a free turning circle (world, m); None where there is none."""
    way_m: float | None
    """Width of the way between all its doors, as wide as 1.2 m; 0 where there is none, None with fewer than two."""
    stuck: tuple[str, ...]
    """Ids of doors that do not open far enough to go through."""


def uses_of(scene: Scene) -> tuple[RoomUse, ...]:
    """The use of each room; a scene without rooms is one, called "room"."""
    floor = scene.architecture.floor
    rooms = scene.rooms or (() if floor is None else (HomeRoom("room", "room", floor.id),))
    swings = door_swings(scene.objects, articulation)
    entries = _entries(scene)
    found = []
    for room in rooms:
        part = part_of_home(scene, [room.id]) if scene.rooms else scene
        outline = shapely.make_valid(shapely.Polygon(scene.plane(room.floor).polygon[:, :2]))
        doors = [o.id for o in part.objects if o.category == DOOR]
        stuck = tuple(d for d in doors if d in swings and not swings[d].can_open)
        ways = entries.get(room.id, [])
        found.append(RoomUse(room, float(outline.area), _turning(part, outline), _way_m(part, outline, ways), stuck))
    return tuple(found)


def _entries(scene: Scene) -> dict[str, list[tuple[Float[np.ndarray, "2"], Float[np.ndarray, "2"]]]]:
    """Entries of each room: a point in each doorway, and the direction into the room."""
    found: dict[str, list[tuple[np.ndarray, np.ndarray]]] = {}
    inner = set()
    for way in doorways(scene):
        if way.opening.is_door:
            inner.add(way.opening.object_id)
            for room, wall in zip(way.rooms, way.walls, strict=True):
                found.setdefault(room, []).append((np.array(way.at), scene.plane(wall).normal[:2]))
    for room in [r.id for r in scene.rooms] or ["room"]:
        part = part_of_home(scene, [room]) if scene.rooms else scene
        walls = part.architecture.by_role("wall")
        for door in (o for o in part.objects if o.category == DOOR and o.id not in inner):
            face = wall_of(door, walls, part)
            if face is not None:
                found.setdefault(room, []).append((door.pose.position[:2], face.normal[:2]))
    return found


def _turning(part: Scene, outline: shapely.Geometry) -> tuple[float, float] | None:
    free = free_floor(part, TURNING_M / 2).intersection(outline)
    if free.is_empty:
        return None
    x, y = free.representative_point().coords[0]
    return float(x), float(y)


def _way_m(
    part: Scene, outline: shapely.Geometry, entries: Sequence[tuple[Float[np.ndarray, "2"], Float[np.ndarray, "2"]]]
) -> float | None:
    """The widest of `WAYS_M` that leads from each entry to every other."""
    if len(entries) < 2:
        return None
    for width in WAYS_M:
        free = free_floor(part, width / 2).intersection(outline)
        parts = [p for p in getattr(free, "geoms", [free]) if not p.is_empty]
        before = [shapely.Point(at + into * width) for at, into in entries]
        if any(all(p.distance(point) < width / 2 for point in before) for p in parts):
            return width
    return 0.0
