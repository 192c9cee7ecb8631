"""Edits as plans make them: rooms are begun and drawn, corners dragged, walls split and given a length that was typed.

Whole walls move along their normals (`scene.room_edits.move_plane`), so that the room stays closed and what is fastened
to them follows. Parts of a split wall lie in one plane and share an edge; when one of them is moved, a wall closes the
gap.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import shapely
from jaxtyping import Float

from diorama_core.errors import EditRefused
from diorama_core.geometry.planes import clip_polygon
from diorama_core.geometry.wall_lines import DrawnWall, bare_wall
from diorama_core.scene.edits import fresh_id
from diorama_core.scene.room_edits import ceiling_height, floor_height, move_plane
from diorama_core.scene.types import Architecture, Plane, PlaneRole, Scene, SceneObject, Support, SurfaceFinish

MEET_M = 0.05
"""Ends of walls nearer than this are one corner."""
LONGEST_M = 50.0
SQUARE = 0.2
"""Least sine between a wall and the one that is moved to change its length."""

Point = Float[np.ndarray, "2"]


@dataclass(frozen=True)
class Corner:
    """Where two walls meet."""

    first: str
    """The wall that ends here, seen from inside the room from left to right."""
    second: str
    """The wall that starts here."""
    at: Point


def wall_feet(scene: Scene) -> tuple[DrawnWall, ...]:
    """Every wall without its openings."""
    return tuple(bare_wall(p) for p in scene.architecture.by_role("wall"))


def corners(scene: Scene) -> tuple[Corner, ...]:
    """Every corner of two walls."""
    feet = wall_feet(scene)
    return tuple(
        Corner(a.id, b.id, (a.end + b.start) / 2)
        for a in feet
        for b in feet
        if a.id != b.id and float(np.linalg.norm(a.end - b.start)) < MEET_M
    )


def move_corner(scene: Scene, first: str, second: str, shift: Point) -> Scene:
    """Move a corner by moving both of its walls: each stays parallel to what it was.

    Args:
        scene: as it is.
        first: id of a wall.
        second: id of the wall beside it.
        shift: of the corner, world x and y, metres.

    Raises:
        EditRefused: when the walls do not meet in a corner, or one would vanish.
    """
    if not any({c.first, c.second} == {first, second} for c in corners(scene)):
        raise EditRefused("these walls do not meet in a corner")
    shift = np.asarray(shift, dtype=np.float64)
    for wall in (first, second):
        outward = -scene.plane(wall).normal[:2]
        scene = move_plane(scene, wall, float(outward @ shift))
    return scene


def set_wall_length(scene: Scene, wall_id: str, length_m: float) -> Scene:
    """Give a wall a length by moving the wall at its right end, or else the one at its left.

    Raises:
        EditRefused: when the length is none, or no wall stands at its ends.
    """
    feet = {f.id: f for f in wall_feet(scene)}
    if wall_id not in feet:
        raise EditRefused("only walls have a length to set")
    if not 0.1 <= length_m <= LONGEST_M:
        raise EditRefused(f"a wall cannot be {length_m:g} m long; give 0.1 to {LONGEST_M:g} m")
    wall = feet[wall_id]
    after = [c.second for c in corners(scene) if c.first == wall_id]
    before = [c.first for c in corners(scene) if c.second == wall_id]
    for end, sign in [*((feet[i], 1.0) for i in after), *((feet[i], -1.0) for i in before)]:
        lever = sign * float(end.outward @ wall.direction)
        if abs(lever) > SQUARE:
            return move_plane(scene, end.id, (length_m - wall.length_m) * lever)
    raise EditRefused("no other wall stands at its ends; drag a wall instead")


SHORTEST_SIDE_M, LONGEST_SIDE_M = 1.0, 30.0
LOWEST_M, HIGHEST_M = 1.8, 10.0
FLOOR = SurfaceFinish("boards", (0.70, 0.54, 0.37))
WALLS = SurfaceFinish("paint", (0.93, 0.92, 0.89))
CEILING_COLOUR = (0.96, 0.96, 0.95)


def empty_room(width_m: float, depth_m: float, height_m: float) -> Scene:
    """A rectangular room on a boarded floor with painted walls; the origin is in the middle of the floor.

    Walls are numbered as one sees them from the middle: `wall_1` is far (+y), then right, near and left.

    Args:
        width_m: along x.
        depth_m: along y.
        height_m: of the ceiling above the floor.

    Raises:
        EditRefused: a length is no room's.
    """
    for name, length, low, high in (
        ("width", width_m, SHORTEST_SIDE_M, LONGEST_SIDE_M),
        ("depth", depth_m, SHORTEST_SIDE_M, LONGEST_SIDE_M),
        ("height", height_m, LOWEST_M, HIGHEST_M),
    ):
        if not low <= length <= high:
            raise EditRefused(f"a room cannot have a {name} of {length:g} m; give {low:g} to {high:g} m")
    x, y = width_m / 2, depth_m / 2
    return Scene(architecture=room_of_outline(np.array([[x, y], [-x, y], [-x, -y], [x, -y]]), height_m))


def room_of_outline(outline: Float[np.ndarray, "n 2"], height_m: float, floor_m: float = 0.0) -> Architecture:
    """A boarded floor, painted walls and a ceiling over an outline.

    Walls are numbered as one sees them from the middle, turning to the right from the outline's first side.

    Args:
        outline: Corners of the floor (world x and y), counter-clockwise seen from above.
        height_m: Of the ceiling above the floor.
        floor_m: z of the floor.
    """
    floor = np.column_stack([outline, np.full(len(outline), floor_m)])
    up = np.array([0.0, 0.0, height_m])
    sides = list(zip(floor, np.roll(floor, -1, axis=0), strict=True))
    walls = (
        _plane(f"wall_{n}", "wall", np.stack([b, a, a + up, b + up]), WALLS)
        for n, (a, b) in enumerate((sides[0], *sides[:0:-1]), start=1)
    )
    ceiling = Plane("ceiling", "ceiling", (floor + up)[::-1], colour=CEILING_COLOUR)
    return Architecture((_plane("floor", "floor", floor, FLOOR), *walls, ceiling))


def _plane(plane_id: str, role: PlaneRole, polygon: np.ndarray, finish: SurfaceFinish) -> Plane:
    return Plane(plane_id, role, polygon, colour=finish.colour, finish=finish, photo_colour=Plane.colour)


SHORTEST_PART_M = 0.2
USUAL_HEIGHT_M = 2.5
TOUCH_M = 0.01


def split_wall(scene: Scene, wall_id: str, at: Point) -> Scene:
    """Cut a wall in two where it is nearest to a point of the floor (world x and y).

    The left part, seen from inside the room, keeps the wall's id; what hangs on or stands against the right one
    follows it.

    Raises:
        EditRefused: when there is no such wall, or a part would be shorter than 20 cm.
    """
    foot = next((f for f in wall_feet(scene) if f.id == wall_id), None)
    if foot is None:
        raise EditRefused("only walls can be split; choose a wall of the plan")
    along = float((np.asarray(at, dtype=np.float64) - foot.start) @ foot.direction)
    if not SHORTEST_PART_M <= along <= foot.length_m - SHORTEST_PART_M:
        raise EditRefused(
            f"a wall's parts are at least {100 * SHORTEST_PART_M:g} cm long; split it farther from its ends"
        )
    wall, direction = scene.plane(wall_id), np.append(foot.direction, 0.0)
    level = float(foot.start @ foot.direction) + along
    left = replace(wall, polygon=clip_polygon(wall.polygon, -direction, -level))
    right = replace(wall, id=fresh_id(scene, "wall"), polygon=clip_polygon(wall.polygon, direction, level))
    ends = [c for c in left.polygon if abs(float(c @ direction) - level) < 1e-6]

    def parts(plane: Plane) -> tuple[Plane, ...]:
        if plane.id == wall_id:
            return left, right
        return (plane if plane.role == "wall" else replace(plane, polygon=_with_corners(plane.polygon, ends)),)

    planes = tuple(part for plane in scene.architecture.planes for part in parts(plane))
    beyond = {o.id for o in scene.objects if float(o.pose.position @ direction) > level}
    names = {wall_id: right.id}
    supports = tuple(_rename(s, names) if s.child in beyond else s for s in scene.supports)
    return replace(scene, architecture=replace(scene.architecture, planes=planes), supports=supports)


def draw_room(scene: Scene, outline: Float[np.ndarray, "n 2"]) -> Scene:
    """Put another room around the objects: its corners on the floor, in order (world x and y).

    It is as high as the one before. What hung on a wall or stood against one goes with the nearest new one.

    Raises:
        EditRefused: when the corners are no room: fewer than three, lines that cross, or lengths that no room has.
    """
    outline = _sound_outline(np.asarray(outline, dtype=np.float64))
    height = ceiling_height(scene) or USUAL_HEIGHT_M
    room = room_of_outline(outline, float(np.clip(height, LOWEST_M, HIGHEST_M)), floor_height(scene))
    supports = tuple(s for s in (_support(scene, s, room) for s in scene.supports) if s is not None)
    return replace(scene, architecture=room, supports=supports)


def _sound_outline(outline: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "n 2"]:
    """The corners counter-clockwise."""
    if len(outline) < 3:
        raise EditRefused("a room has at least three corners; click one after the other on the plan")
    sides = np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1)
    if not np.isfinite(outline).all() or sides.min() < SHORTEST_PART_M or sides.max() > LONGEST_M:
        raise EditRefused(f"walls are {SHORTEST_PART_M:g} to {LONGEST_M:g} m long; click the corners farther apart")
    room = shapely.Polygon(outline)
    if not room.is_valid:
        raise EditRefused("the walls cross one another; click the corners in order around the room")
    if room.area < SHORTEST_SIDE_M**2:
        raise EditRefused(f"a room covers at least {SHORTEST_SIDE_M**2:g} square metre")
    return outline if room.exterior.is_ccw else outline[::-1]


def _support(scene: Scene, edge: Support, room: Architecture) -> Support | None:
    """The edge with planes of the new room; None where the room has none of the kind that held it."""
    item = scene.object(edge.child)
    walls = {p.id for p in scene.architecture.by_role("wall")}
    near = _nearest_wall(item, room).id
    adheres = (near,) if walls & set(edge.adheres_to) else ()
    if not scene.has_plane(edge.parent):
        return replace(edge, adheres_to=adheres)
    role = scene.plane(edge.parent).role
    return replace(edge, parent=near if role == "wall" else role, adheres_to=adheres)


def _nearest_wall(item: SceneObject, room: Architecture) -> Plane:
    place = shapely.Point(item.pose.position[:2])
    return min(room.by_role("wall"), key=lambda wall: shapely.LineString(wall.polygon[:2, :2]).distance(place))


def _with_corners(polygon: Float[np.ndarray, "n 3"], points: Iterable[np.ndarray]) -> Float[np.ndarray, "m 3"]:
    """The polygon with corners at those of the points that lie on its rim."""
    for point in points:
        after = np.roll(polygon, -1, axis=0)
        edges = after - polygon
        share = np.einsum("ij,ij->i", point - polygon, edges) / np.maximum(np.einsum("ij,ij->i", edges, edges), 1e-12)
        away = np.linalg.norm(polygon + np.clip(share, 0.0, 1.0)[:, None] * edges - point, axis=1)
        k = int(away.argmin())
        if away[k] < TOUCH_M and np.linalg.norm(polygon - point, axis=1).min() >= TOUCH_M:
            polygon = np.insert(polygon, k + 1, point, axis=0)
    return polygon


def _rename(edge: Support, names: dict[str, str]) -> Support:
    adheres = tuple(names.get(i, i) for i in edge.adheres_to)
    return replace(edge, parent=names.get(edge.parent, edge.parent), adheres_to=adheres)
