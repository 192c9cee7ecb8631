"""Rooms of a home: joined at a door that both of them show, and drawn beside one another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import shapely
from jaxtyping import Float, UInt8

from diorama_core.editing.plan_edits import draw_room
from diorama_core.errors import EditRefused
from diorama_core.geometry.openings import DOOR, wall_of
from diorama_core.geometry.rooms import part_of_home, rooms_of_objects
from diorama_core.multiview.one_scene import move_to_room
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from diorama_core.scene.room_edits import floor_height
from diorama_core.scene.types import Architecture, HomeRoom, Plane, Scene, Support, rigid, yaw_rotation

USUAL_WALL_M = 0.12
"""Thickness of a wall between two rooms where nobody says another: brick and plaster."""

CUT_PX = 2.0
"""Boxes that come nearer to the picture's border are cut off by it: as far as people draw them."""

NARROWED = 0.1
"""Share of its width that a door seems to lose where each photo shows all of it: by the scales of two rooms."""

DRAWN_OVER = 0.1
"""Share of the smaller of two outlines that they have in common: less is a touch."""


@dataclass(frozen=True, eq=False)
class JoinedHome:
    """A home with a room more."""

    scene: Scene
    textures: Mapping[str, str]
    """What the pictures of the joined scene are called in the home, by what they were."""
    ids: Mapping[str, str]
    """What everything of the joined scene is called in the home, its door too, by what it was."""


def join(
    home: Scene,
    other: Scene,
    door: str,
    other_door: str,
    *,
    names: tuple[str, str] = ("room", "room"),
    wall_m: float = USUAL_WALL_M,
) -> JoinedHome:
    """The home with another scene beside it, so that the two sides of a door are one door in one wall.

    The other scene is moved as a whole; its door goes, and the home's is cut out of both faces. Its camera and what
    belongs to its photo stay behind.

    Args:
        home: a home, or one room.
        other: another room, or home.
        door: id of the door in the home.
        other_door: id of the same door in the other scene.
        names: of the home and of the other scene, for those that are one room.
        wall_m: thickness of the wall between them.

    Raises:
        EditRefused: one of the two is no door in a wall, or a scene has no floor.
    """
    if not 0.0 <= wall_m <= 1.0:
        raise EditRefused(f"a wall cannot be {wall_m:g} m thick; give 0 to 1 m")
    home, other = _as_home(home, names[0]), _as_home(other, names[1])
    home, other = as_one_door(home, other, door, other_door)
    T = place_at_door(home, other, door, other_door, wall_m=wall_m)
    wall, there = _wall_of_door(home, door), _wall_of_door(other, other_door)
    storeys = _storey(home, door) - _storey(other, other_door)
    moved = move_to_room(edits.remove(other, [other_door]), T)
    called = _new_names(home, moved)
    planes = tuple(_rename(p, called, wall_m if p.id == there.id else None) for p in moved.architecture.planes)
    textures = called.textures
    objects = tuple(
        replace(
            o,
            id=called.ids[o.id],
            mask_id=None,
            box_px=None,
            photo_materials=tuple(
                replace(m, texture=None if m.texture is None else textures[m.texture]) for m in o.photo_materials
            ),
        )
        for o in moved.objects
    )
    supports = tuple(_support(s, called.ids) for s in moved.supports)
    rooms = tuple(
        replace(r, id=called.ids[r.id], floor=called.ids[r.floor], storey=r.storey + storeys, name=called.rooms[r.id])
        for r in moved.rooms
    )
    thick = tuple(replace(p, thickness=wall_m / 2) if p is wall else p for p in home.architecture.planes)
    scene = replace(
        home,
        architecture=Architecture((*thick, *planes)),
        objects=(*home.objects, *objects),
        supports=(*home.supports, *supports),
        rooms=_renumber((*home.rooms, *rooms)),
    )
    return JoinedHome(scene, textures, {**called.ids, other_door: door})


def as_one_door(home: Scene, other: Scene, door: str, other_door: str) -> tuple[Scene, Scene]:
    """Both scenes with the door where their photos show its edges, as wide as the photo that shows more of it says.

    Args:
        home, other, door, other_door: as of `join`.
    """
    sides = ((home, door), (other, other_door))
    edges = [_box_edges(scene, name, _wall_of_door(scene, name)) for scene, name in sides]
    # What hides a door, and the border of the picture, make it narrower than it is.
    width = max(right - left for left, right, _ in edges)
    if not np.isfinite(width):
        return home, other
    first, second = (_with_edges(s, n, *seen, width=width) for (s, n), seen in zip(sides, edges, strict=True))
    return first, second


def place_at_door(
    home: Scene, other: Scene, door: str, other_door: str, *, wall_m: float = USUAL_WALL_M
) -> Float[np.ndarray, "4 4"]:
    """`T_home_other` that makes two doors one: back to back in a wall, feet at one height.

    Args:
        home, other, door, other_door, wall_m: as of `join`.
    """
    wall, there = _wall_of_door(home, door), _wall_of_door(other, other_door)
    yaw = np.arctan2(*-wall.normal[[1, 0]]) - np.arctan2(*there.normal[[1, 0]])
    R = yaw_rotation(float(yaw))
    return rigid(R, _foot(home, door, wall) - wall_m * wall.normal - R @ _foot(other, other_door, there))


def join_project(
    project: Project,
    scene: Scene,
    other: Project,
    door: str,
    other_door: str,
    *,
    wall_m: float = USUAL_WALL_M,
    name: str | None = None,
) -> tuple[JoinedHome, Mapping[str, UInt8[np.ndarray, "_ _ 3"]]]:
    """A project's scene with another project's beside it (`join`), and the pictures that came with it.

    Shapes that the other project brought itself are copied into the project.

    Args:
        project: of the home.
        scene: of the home, as it is now.
        other: the room that is added; it stays as it is.
        door: id of the door in the home.
        other_door: id of the same door in the other project.
        wall_m: thickness of the wall between them.
        name: of the scene where it is one room; the project's where None.

    Raises:
        EditRefused: as `join`, or the two use different libraries.
        ProjectError: a project cannot be read or written.
    """
    if project.shared_library_name != other.shared_library_name:
        raise EditRefused(
            f"{other.name} uses the library {other.shared_library_name}, {project.name} {project.shared_library_name}; "
            "build both with one library"
        )
    added = other.load_scene()
    made = join(scene, added, door, other_door, names=(name or project.name, other.name), wall_m=wall_m)
    if other.shapes_folder.is_dir():
        project.take_shapes(other)
    pictures = other.textures(added)  # those of its door went with it
    return made, {name: pictures[texture] for texture, name in made.textures.items() if texture in pictures}


def draw_room_of_home(scene: Scene, outline: Float[np.ndarray, "n 2"], storey: int = 0) -> Scene:
    """A room drawn in the plan: a new one beside the others, or another outline of the one that it is drawn over.

    A new room is as high as the others of its storey. A scene that is one room becomes a home when a room is drawn
    beside it.

    Args:
        scene: a home, or one room.
        outline: corners on the floor, in order (world x and y).
        storey: on which it is drawn.

    Raises:
        EditRefused: the corners are no room, it is drawn over several rooms, or the storey has no room.
    """
    if scene.architecture.floor is None:
        return draw_room(scene, outline)
    home = _as_home(scene, "room")
    beside = [r for r in home.rooms if r.storey == storey]
    if not beside:
        raise EditRefused(f"storey {storey} has no room; draw on a storey that has one")
    part = replace(part_of_home(home, {r.id for r in beside}), objects=(), supports=(), rooms=())
    drawn = draw_room(part, outline)
    over = [r for r in beside if _share(drawn.plane("floor"), home.plane(r.floor)) > DRAWN_OVER]
    if len(over) > 1:
        names = " and ".join(r.name for r in over)
        raise EditRefused(f"that would lie over {names}; draw beside the rooms, or over one of them")
    if over and not scene.rooms:
        return draw_room(scene, outline)
    if over:
        part = part_of_home(home, {over[0].id})
        drawn = draw_room(replace(part, rooms=()), outline)
    gone = {p.id for p in part.architecture.planes} if over else set()
    taken = set(_ids(home)) - gone
    ids = {p.id: _free(p.id, taken) for p in drawn.architecture.planes} | {o.id: o.id for o in drawn.objects}
    planes = (*home.architecture.planes, *(replace(p, id=ids[p.id]) for p in drawn.architecture.planes))
    kept = tuple(p for k, p in enumerate(planes) if k >= len(home.architecture.planes) or p.id not in gone)
    held = {s.child: _support(s, ids) for s in drawn.supports}
    room = (
        over[0]
        if over
        else HomeRoom(_free("room-2", taken), _free("room", {r.name for r in home.rooms}, " "), "", storey)
    )
    room = replace(room, floor=ids["floor"])
    return replace(
        home,
        architecture=Architecture(kept),
        supports=tuple(held.get(s.child, s) for s in home.supports),
        rooms=tuple(room if r.id == room.id else r for r in home.rooms) if over else (*home.rooms, room),
    )


def _share(drawn: Plane, floor: Plane) -> float:
    """Area that two floors have in common, of the smaller one."""
    first, second = (shapely.make_valid(shapely.Polygon(p.polygon[:, :2])) for p in (drawn, floor))
    return float(first.intersection(second).area / max(min(first.area, second.area), 1e-9))


@dataclass(frozen=True)
class _Names:
    """Ids, pictures and names of a scene's rooms as they are called in another."""

    ids: Mapping[str, str]
    textures: Mapping[str, str]
    rooms: Mapping[str, str]


def _new_names(home: Scene, moved: Scene) -> _Names:
    taken = set(_ids(home))
    ids = {i: _free(i, taken) for i in _ids(moved)}
    pictures = _pictures(home)
    textures = {name: _free(name, pictures) for name in sorted(_pictures(moved))}
    known = {r.name for r in home.rooms}
    return _Names(ids, textures, {r.id: _free(r.name, known, " ") for r in moved.rooms})


def _free(name: str, taken: set[str], between: str = "-") -> str:
    """A name that is not taken, and is from then on: the name itself, or with a number."""
    free = next(n for n in (name, *(f"{name}{between}{k}" for k in range(2, len(taken) + 3))) if n not in taken)
    taken.add(free)
    return free


def _ids(scene: Scene) -> list[str]:
    planes, objects = scene.architecture.planes, scene.objects
    return [*(p.id for p in planes), *(o.id for o in objects), *(r.id for r in scene.rooms)]


def _pictures(scene: Scene) -> set[str]:
    planes = scene.architecture.planes
    named = {t for p in planes for t in (p.texture, p.photo_texture)}
    named |= {m.texture for o in scene.objects for m in o.photo_materials}
    return {name for name in named if name is not None}


def _rename(plane: Plane, names: _Names, wall_m: float | None) -> Plane:
    pictures = {t: None if t is None else names.textures[t] for t in (plane.texture, plane.photo_texture)}
    return replace(
        plane,
        id=names.ids[plane.id],
        texture=pictures[plane.texture],
        photo_texture=pictures[plane.photo_texture],
        thickness=plane.thickness if wall_m is None else wall_m / 2,
    )


def _support(edge: Support, ids: Mapping[str, str]) -> Support:
    against = tuple(ids[w] for w in edge.adheres_to)
    return replace(edge, child=ids[edge.child], parent=ids[edge.parent], adheres_to=against)


def _as_home(scene: Scene, name: str) -> Scene:
    """A scene that is one room as a home of one."""
    floor = scene.architecture.floor
    if floor is None:
        raise EditRefused("a room without a floor has no place in a home; build it with one")
    if scene.rooms:
        return scene
    return replace(scene, rooms=(HomeRoom(_free("room-1", set(_ids(scene))), name, floor.id),))


def _wall_of_door(scene: Scene, door: str) -> Plane:
    if not scene.has_object(door) or scene.object(door).category != DOOR:
        doors = ", ".join(o.id for o in scene.objects if o.category == DOOR) or "none"
        raise EditRefused(f"there is no door {door!r}; choose one of: {doors}")
    wall = wall_of(scene.object(door), scene.architecture.by_role("wall"), scene)
    if wall is None:
        raise EditRefused(f"the door {door!r} is in no wall; move it to one first")
    return wall


def _with_edges(scene: Scene, door: str, left: float, right: float, cut: tuple[bool, bool], *, width: float) -> Scene:
    """The scene with a door of a width between the edges that its photo shows, or at the one that it does not cut off.

    Args:
        scene: of the door's room.
        door: its id.
        left, right: edges along its wall (m).
        cut: whether the picture cuts the edges off.
        width: of the door (m).
    """
    item, wall = scene.object(door), _wall_of_door(scene, door)
    if right - left > (1.0 - NARROWED) * width:
        middle = (left + right) / 2
    elif cut[0] != cut[1]:
        middle = right - width / 2 if cut[0] else left + width / 2
    else:
        return scene
    along = np.cross([0.0, 0.0, 1.0], wall.normal)
    moved = item.pose.move((middle - float(item.pose.position @ along)) * along)
    pose = replace(moved, scale=moved.scale * (1.0, width / float(item.size_m[1]), 1.0))
    return replace(scene, objects=tuple(replace(o, pose=pose) if o is item else o for o in scene.objects))


def _box_edges(scene: Scene, door: str, wall: Plane) -> tuple[float, float, tuple[bool, bool]]:
    """Where a door's left and right edge are along its wall (m) by its box, and whether the picture cuts them off.

    Infinitely wide where there is no photo, or somebody placed the door since.
    """
    camera, item = scene.camera, scene.object(door)
    box = item.box_px
    if camera is None or box is None or item.by_hand:
        return -np.inf, np.inf, (False, False)
    along, foot = np.cross([0.0, 0.0, 1.0], wall.normal), float(wall.polygon[:, 2].min())
    found = []
    # An upright edge is aslant in the picture: only one of its ends, or of what is seen of it, is at the box's side.
    for column, innermost in ((box[0], np.max), (box[2], np.min)):
        rays = camera.rays(np.array([[column, box[3]], [column, box[1]]]))
        facing = rays @ wall.normal
        away = (wall.offset - float(wall.normal @ camera.position)) / np.where(facing < 0.0, facing, np.nan)
        points = camera.position + away[:, None] * rays
        ends = np.interp([foot, foot + float(item.size_m[2])], points[:, 2], points @ along)
        found.append(float(innermost(ends)))
    cut = box[0] < CUT_PX, box[2] > camera.intrinsics.width - CUT_PX
    return (found[0], found[1], cut) if np.isfinite(found).all() else (-np.inf, np.inf, (False, False))


def _foot(scene: Scene, door: str, wall: Plane) -> Float[np.ndarray, "3"]:
    """The middle of a door on its wall's face, at the height of its room's floor."""
    position = scene.object(door).pose.position
    on_face = position - (float(wall.normal @ position) - wall.offset) * wall.normal
    room = _room_of(scene, door)
    return np.append(on_face[:2], floor_height(scene) if room is None else float(scene.plane(room.floor).centre[2]))


def _room_of(scene: Scene, door: str) -> HomeRoom | None:
    room = rooms_of_objects(scene).get(door)
    return next((r for r in scene.rooms if r.id == room), None)


def _storey(scene: Scene, door: str) -> int:
    room = _room_of(scene, door)
    return 0 if room is None else room.storey


def _renumber(rooms: tuple[HomeRoom, ...]) -> tuple[HomeRoom, ...]:
    lowest = min(r.storey for r in rooms)
    return tuple(replace(r, storey=r.storey - lowest) for r in rooms)
