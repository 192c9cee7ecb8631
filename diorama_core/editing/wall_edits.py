"""Walls are split, and rooms drawn, on the plan. Pure functions Scene -> Scene.

Parts of a split wall lie in one plane and share an edge; when one of them is moved, a wall closes the gap
(`scene.room_edits.move_plane`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import shapely
from jaxtyping import Float

from diorama_core.editing.new_room import HIGHEST_M, LOWEST_M, SHORTEST_M, room_of_outline
from diorama_core.editing.plan_edits import LONGEST_M, wall_feet
from diorama_core.errors import EditRefused
from diorama_core.geometry.planes import clip_polygon
from diorama_core.scene.edits import fresh_id
from diorama_core.scene.room_edits import ceiling_height, floor_height
from diorama_core.scene.types import Architecture, Plane, Scene, SceneObject, Support

SHORTEST_PART_M = 0.2
USUAL_HEIGHT_M = 2.5
TOUCH_M = 0.01

Point = Float[np.ndarray, "2"]


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
    along = float((np.asarray(at, dtype=np.float64) - foot.start) @ foot.along)
    if not SHORTEST_PART_M <= along <= foot.length_m - SHORTEST_PART_M:
        raise EditRefused(
            f"a wall's parts are at least {100 * SHORTEST_PART_M:g} cm long; split it farther from its ends"
        )
    wall, direction = scene.plane(wall_id), np.append(foot.along, 0.0)
    level = float(foot.start @ foot.along) + along
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
    supports = tuple(_renamed(s, names) if s.child in beyond else s for s in scene.supports)
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
    supports = tuple(s for s in (_held(scene, s, room) for s in scene.supports) if s is not None)
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
    if room.area < SHORTEST_M**2:
        raise EditRefused(f"a room covers at least {SHORTEST_M**2:g} square metre")
    return outline if room.exterior.is_ccw else outline[::-1]


def _held(scene: Scene, edge: Support, room: Architecture) -> Support | None:
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


def _renamed(edge: Support, names: dict[str, str]) -> Support:
    adheres = tuple(names.get(i, i) for i in edge.adheres_to)
    return replace(edge, parent=names.get(edge.parent, edge.parent), adheres_to=adheres)
