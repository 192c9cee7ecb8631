"""Rooms of a home: which planes and objects are whose, and the openings that join them.

All of it follows from where things are, so that nothing can disagree: an object is in the room whose floor is under it,
a wall in the room that it faces, and an opening through two faces back to back joins the two rooms. A scene without
rooms is one room.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from jaxtyping import Float

from diorama_core.geometry.openings import HOME, faces_behind
from diorama_core.geometry.wall_lines import DrawnWall, Opening, wall_lines
from diorama_core.scene.types import Architecture, HomeRoom, Plane, Scene


@dataclass(frozen=True)
class Doorway:
    """A door, a window or a bare opening between two rooms, seen from the first."""

    rooms: tuple[str, str]
    """Ids of the rooms."""
    walls: tuple[str, str]
    """Ids of the two faces."""
    opening: Opening
    """In the first face."""
    at: tuple[float, float]
    """Middle of the opening between the faces, world x and y."""
    depth_m: float
    """From face to face."""


def floor_under(
    points: Float[np.ndarray, "n 3"], outlines: Sequence[Float[np.ndarray, "_ 2"]], heights_m: Sequence[float]
) -> list[int | None]:
    """Number of the floor that each point is over: of those under it or beside it the highest, then the nearest.

    Args:
        points: feet of things (world, m).
        outlines: of the floors; one with fewer than three corners is under nothing.
        heights_m: of the floors.
    """
    heights = np.asarray(heights_m, dtype=np.float64)
    nowhere = (True, len(heights), np.inf)
    chosen: list[tuple[tuple[bool, int, float], int | None]] = [(nowhere, None)] * len(points)
    at = shapely.points(points[:, :2])
    for number, outline in enumerate(outlines):
        away = shapely.distance(_area(outline), at) if len(outline) >= 3 else np.full(len(points), np.inf)
        higher = int((heights > heights[number] + HOME.sinks_m).sum())
        for k in np.flatnonzero(points[:, 2] > heights[number] - HOME.sinks_m):
            cost = bool(away[k] >= HOME.border_m), higher, float(away[k])
            chosen[k] = (cost, number) if cost < chosen[k][0] else chosen[k]
    return [number for _, number in chosen]


def rooms_of_objects(scene: Scene) -> Mapping[str, str]:
    """The room of each object, by their ids; nothing in a scene that is one room."""
    if not scene.rooms or not scene.objects:
        return {}
    ceilings = {p.id for p in scene.architecture.by_role("ceiling")}
    hanging = {s.child for s in scene.supports if s.parent in ceilings}
    feet = np.array([[*o.pose.position[:2], o.corners_world[:, 2].min()] for o in scene.objects])
    feet[[o.id in hanging for o in scene.objects], 2] -= HOME.under_ceiling_m
    return _rooms_of_feet(scene, [o.id for o in scene.objects], feet)


def rooms_of_planes(scene: Scene) -> Mapping[str, str]:
    """The room of each plane, by their ids: its own floor, the ceiling over it, the walls that face it."""
    if not scene.rooms:
        return {}
    planes = [p for p in scene.architecture.planes if p.role != "floor"]
    feet = np.array([_point_before_plane(p) for p in planes]).reshape(-1, 3)
    return {r.floor: r.id for r in scene.rooms} | _rooms_of_feet(scene, [p.id for p in planes], feet)


def part_of_home(scene: Scene, room_ids: Collection[str]) -> Scene:
    """Some rooms of a home as a scene: their planes, what is in them, and who holds up whom."""
    in_rooms = {**rooms_of_planes(scene), **rooms_of_objects(scene)}
    planes = tuple(p for p in scene.architecture.planes if in_rooms.get(p.id) in room_ids)
    objects = tuple(o for o in scene.objects if in_rooms.get(o.id) in room_ids)
    known = {p.id for p in planes} | {o.id for o in objects}
    supports = tuple(
        replace(s, adheres_to=tuple(w for w in s.adheres_to if w in known))
        for s in scene.supports
        if s.child in known and s.parent in known
    )
    rooms = tuple(r for r in scene.rooms if r.id in room_ids)
    return replace(scene, architecture=Architecture(planes), objects=objects, supports=supports, rooms=rooms)


def room_around(scene: Scene, point: Float[np.ndarray, "3"], among: Collection[str] = ()) -> Scene:
    """The room of a home that a point is in, or nearest to, as a scene; a scene without rooms as it is.

    Args:
        scene: a home, or one room.
        point: world, m.
        among: ids of the rooms to choose from; none: all.
    """
    rooms = [r for r in scene.rooms if r.id in among] or list(scene.rooms)
    if not rooms:
        return scene
    floors = [scene.plane(r.floor) for r in rooms]
    heights = [float(p.centre[2]) for p in floors]
    feet = np.array([[*point[:2], max(float(point[2]), min(heights))]])
    (number,) = floor_under(feet, [p.polygon[:, :2] for p in floors], heights)
    return part_of_home(scene, [rooms[number or 0].id])


def storeys_of(scene: Scene) -> Mapping[int, tuple[HomeRoom, ...]]:
    """The rooms of each storey, the lowest first."""
    return {n: tuple(r for r in scene.rooms if r.storey == n) for n in sorted({r.storey for r in scene.rooms})}


def doorways(scene: Scene) -> tuple[Doorway, ...]:
    """The openings between rooms, each once: through two faces back to back."""
    if len(scene.rooms) < 2:
        return ()
    in_rooms = rooms_of_planes(scene)
    walls = wall_lines(scene.architecture.planes, [o for o in scene.objects if not o.hidden], scene)
    lines, faces = {w.plane.id: w for w in walls}, [w.plane for w in walls]
    doorways_of_all: list[Doorway] = []
    for wall in walls:
        for opening in wall.openings:
            middle = wall.point_at((opening.from_m + opening.to_m) / 2)
            point = np.array([*middle, (opening.bottom_m + opening.top_m) / 2])
            for face in faces_behind(wall.plane, point, faces):
                pair = in_rooms.get(wall.plane.id), in_rooms.get(face.id)
                if pair[0] is None or pair[1] is None or not _is_open_at(lines[face.id], point):
                    continue
                depth = abs(wall.plane.offset - float(wall.plane.normal @ face.centre))
                at = middle + depth / 2 * wall.outward
                place = (float(at[0]), float(at[1]))
                if not any(_is_same(d, face.id, wall.plane.id, place, opening) for d in doorways_of_all):
                    doorways_of_all.append(Doorway((pair[0], pair[1]), (wall.plane.id, face.id), opening, place, depth))
    return tuple(doorways_of_all)


def _is_same(known: Doorway, first: str, second: str, at: tuple[float, float], opening: Opening) -> bool:
    """Whether a doorway is known from its other side."""
    apart = float(np.hypot(known.at[0] - at[0], known.at[1] - at[1]))
    return known.walls == (first, second) and apart < (opening.to_m - opening.from_m) / 2


def _is_open_at(wall: DrawnWall, point: Float[np.ndarray, "3"]) -> bool:
    along = float((point[:2] - wall.start) @ wall.direction)
    return any(o.from_m <= along <= o.to_m and o.bottom_m <= point[2] <= o.top_m for o in wall.openings)


def _rooms_of_feet(scene: Scene, ids: Sequence[str], feet: Float[np.ndarray, "n 3"]) -> dict[str, str]:
    floors = [scene.plane(r.floor) for r in scene.rooms]
    under = floor_under(feet, [p.polygon[:, :2] for p in floors], [float(p.centre[2]) for p in floors])
    return {name: scene.rooms[k].id for name, k in zip(ids, under, strict=True) if k is not None}


def _point_before_plane(plane: Plane) -> Float[np.ndarray, "3"]:
    """A point in the room that a wall or a ceiling is of, at the foot of a wall."""
    if plane.role == "ceiling":
        x, y = _area(plane.polygon[:, :2]).representative_point().coords[0]
        return np.array([x, y, float(plane.polygon[:, 2].min()) - HOME.under_ceiling_m])
    middle = (plane.polygon.min(axis=0) + plane.polygon.max(axis=0)) / 2 + HOME.before_m * plane.normal
    return np.array([*middle[:2], float(plane.polygon[:, 2].min())])


def _area(outline: Float[np.ndarray, "n 2"]) -> shapely.Geometry:
    return shapely.make_valid(shapely.Polygon(outline))
