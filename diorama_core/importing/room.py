"""The room of a foreign file: what is named floor, wall or ceiling and is flat, or has the shape of one.

By shape, whatever nodes are called, the lowest large level face is the floor, the large upright ones around everything
else are the walls, a level one that covers the floor from above is the ceiling. A shell is one mesh with several of
them. Where there is no floor, one is put under everything.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Float
from shapely.geometry import MultiPolygon, Point, Polygon
from shapely.geometry.polygon import orient
from shapely.ops import unary_union

from diorama_core.importing.parts import Part
from diorama_core.library.taxonomy import category
from diorama_core.scene.types import Plane, PlaneRole, Scene, SceneObject, Support

THIN_M = 0.5
"""Parts thicker than this are no wall, floor or ceiling, whatever they are called."""
LARGE_M = 1.0
"""Parts whose second-longest side is shorter are no wall, floor or ceiling either."""
ROUND_M = 0.3
"""Floor around the objects where a file has none."""
RESTS_M = 0.05
"""How far an object may hover over, or sink into, what it stands on."""
NEAR_WALL_M = 0.15
STRAIGHT_M = 1e-3
"""Corners of an outline that are off a straight line by less are none."""
PARALLEL = 0.9
"""Cosine between a wall's normal and the thinner side of what hangs on it, either way."""
_ROLES: dict[PlaneRole, str] = {"floor": r"floor|ground", "ceiling": r"ceiling|roof", "wall": r"walls?"}


@dataclass(frozen=True, eq=False)
class Room:
    """Planes, and the parts that are furniture."""

    planes: tuple[Plane, ...]
    objects: tuple[Part, ...]
    notes: tuple[str, ...]
    names: Mapping[str, str]
    """Of the rooms of a home, by the id of their floor."""


def room_of(parts: Sequence[Part]) -> Room:
    """Tell the room from what stands in it."""
    roles = _roles(parts)
    objects = tuple(p for p, role in roles if role is None)
    flat = [(p, role) for p, role in roles if role is not None]
    inside = objects or tuple(parts)
    middle = np.mean([p.whole.bounds.mean(axis=0) for p in inside], axis=0)
    planes: list[Plane] = []
    names: dict[str, str] = {}
    notes = []
    for part in objects:
        shell = shell_planes(part, _middle_within(part, objects))
        if shell is not None and not flat and not planes:
            planes += shell
            objects = tuple(p for p in objects if p is not part)
            notes.append(f"{part.name} was read as the room: {', '.join(p.id for p in shell)}")
    for part, role in flat:
        number = 1 + sum(p.role == role for p in planes)
        plane = _plane(part, role, role if number == 1 and role != "wall" else f"{role}-{number}", middle)
        if not any(_same(plane, other) for other in planes):
            planes.append(plane)
            names |= {} if part.room is None else {plane.id: part.room}
    if not any(p.role == "floor" for p in planes):
        planes.insert(0, _ground(parts))
        notes.append("the file has no floor: there is one under the lowest object")
    return Room(tuple(planes), objects, tuple(notes), names)


def _roles(parts: Sequence[Part]) -> list[tuple[Part, PlaneRole | None]]:
    """What each part is of the room: as it is named, and where nothing is named so, as it is shaped."""
    named = [_role(p) for p in parts]
    if not parts:
        return []
    everything = _bounds(parts)
    shaped = [slab_role(p, everything) if role is None else role for p, role in zip(parts, named, strict=True)]
    free = {role for role in _ROLES if role not in named}
    return [(p, n if n is not None else s if s in free else None) for p, n, s in zip(parts, named, shaped, strict=True)]


def _middle_within(shell: Part, parts: Sequence[Part]) -> Float[np.ndarray, "3"]:
    """The middle of what stands in a shell; of the shell itself where nothing does."""
    low, high = shell.whole.bounds
    middles = [p.whole.bounds.mean(axis=0) for p in parts if p is not shell]
    within = [m for m in middles if (low < m).all() and (m < high).all()]
    middle = np.mean(within, axis=0) if within else (low + high) / 2
    return np.append(middle[:2], (low[2] + high[2]) / 2)


def _role(part: Part) -> PlaneRole | None:
    words = re.sub(r"[^a-z]+", " ", part.name.lower())
    for role, pattern in _ROLES.items():
        if re.search(rf"\b({pattern})\b", words) and not re.search(
            r"\b(lamp|light|clock|shelf|art|mirror|mat)\b", words
        ):
            return role if _is_flat(part, role) else None
    return None


def _is_flat(part: Part, role: PlaneRole) -> bool:
    (_, sides, _), height = _rectangle(part), float(np.ptp(part.whole.bounds[:, 2]))
    if role == "wall":
        return min(sides) < THIN_M and max(sides) > LARGE_M / 2 and height > LARGE_M
    return height < THIN_M and min(sides) > LARGE_M


def _rectangle(part: Part) -> tuple[Float[np.ndarray, "2"], tuple[float, float], float]:
    """The smallest upright rectangle around a part: middle, sides, and the first side's angle."""
    import cv2  # only when a file is opened; the editor starts without it

    (x, y), (a, b), angle = cv2.minAreaRect(part.whole.vertices[:, :2].astype(np.float32))
    return np.array([x, y]), (float(a), float(b)), float(np.radians(angle))


def _plane(part: Part, role: PlaneRole, name: str, middle: Float[np.ndarray, "3"]) -> Plane:
    centre, (a, b), angle = _rectangle(part)
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    low, high = (float(v) for v in part.whole.bounds[:, 2])
    if role != "wall":
        corners = [centre + s * a / 2 * along + t * b / 2 * across for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        z = high if role == "floor" else low
        ring = corners if part.room is None else _floor_outline(part)
        polygon = np.array([[*c, z] for c in ring])
        return Plane(name, role, polygon if role == "floor" else polygon[::-1], max(high - low, 0.01))
    if a < b:
        a, b, along, across = b, a, across, along
    inward = across if (middle[:2] - centre) @ across > 0 else -across
    right = np.array([inward[1], -inward[0]])  # to the right as seen from inside
    face = centre + b / 2 * inward
    left_end, right_end = face - a / 2 * right, face + a / 2 * right
    polygon = np.array([[*left_end, low], [*right_end, low], [*right_end, high], [*left_end, high]])
    plane = Plane(name, "wall", polygon, max(b, 0.01))
    return plane if plane.normal[:2] @ inward > 0 else Plane(name, "wall", polygon[::-1], max(b, 0.01))


def _floor_outline(part: Part) -> Float[np.ndarray, "n 2"]:
    """Corners of the floor of a room, counter-clockwise seen from above."""
    upward = part.whole.triangles[part.whole.face_normals[:, 2] > PARALLEL]
    area = orient(unary_union([Polygon(t[:, :2]) for t in upward]).simplify(STRAIGHT_M))
    return np.asarray(max(getattr(area, "geoms", [area]), key=lambda a: a.area).exterior.coords)[:-1]


def _same(plane: Plane, other: Plane) -> bool:
    """Whether two planes are faces of one slab, which files keep apart by material."""
    if plane.role != other.role or plane.normal @ other.normal < 0.99:
        return False
    apart = [np.abs(end(plane.polygon, axis=0) - end(other.polygon, axis=0)).max() for end in (np.min, np.max)]
    return bool(max(apart) < THIN_M / 2)


def _bounds(parts: Sequence[Part]) -> Float[np.ndarray, "2 3"]:
    ends = np.array([p.whole.bounds for p in parts])
    return np.stack([ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)])


def _ground(parts: Sequence[Part]) -> Plane:
    low, high = _bounds(parts)
    (x0, y0), (x1, y1), z = low[:2] - ROUND_M, high[:2] + ROUND_M, low[2]
    return Plane("floor", "floor", np.array([[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]]))


def supports_of(scene: Scene) -> tuple[Support, ...]:
    """What stands on what, by touch: the highest surface right below, or the wall that a hung object touches."""
    boxes = {o.id: np.stack([o.corners_world.min(axis=0), o.corners_world.max(axis=0)]) for o in scene.objects}
    edges = []
    for item in scene.objects:
        wall = _wall(scene, item)
        below = _supporter_of(boxes, item.id)
        floor = _floor_under(scene, boxes[item.id])
        hangs = category(item.category).mount == "wall" or (below is None and floor is None)
        if wall is not None and hangs:
            edges.append(Support(item.id, wall, "mounted on", child_face="back"))
        elif below is not None:
            edges.append(Support(item.id, below))
        elif floor is not None:
            edges.append(Support(item.id, floor.id))
    return tuple(edges)


def _floor_under(scene: Scene, box: Float[np.ndarray, "2 3"]) -> Plane | None:
    """The floor at a box's foot; of several at one height the one it is over."""
    near = [p for p in scene.architecture.by_role("floor") if abs(box[0, 2] - p.centre[2]) < 2 * RESTS_M]
    over = [p for p in near if Polygon(p.polygon[:, :2]).buffer(RESTS_M).contains(Point(box.mean(axis=0)[:2]))]
    return next(iter(over or near), None)


def _supporter_of(boxes: dict[str, Float[np.ndarray, "2 3"]], object_id: str) -> str | None:
    mine = boxes[object_id]
    middle = mine.mean(axis=0)
    under = [
        (other[1, 2], name)
        for name, other in boxes.items()
        if name != object_id
        and abs(other[1, 2] - mine[0, 2]) < RESTS_M
        and other[0, 2] < mine[0, 2] - RESTS_M
        and (other[0, :2] <= middle[:2]).all()
        and (middle[:2] <= other[1, :2]).all()
    ]
    return max(under)[1] if under else None


def _wall(scene: Scene, item: SceneObject) -> str | None:
    corners, thin = item.corners_world, int(np.argmin(item.size_m[:2]))
    back = item.pose.R_world_object[:, thin]
    near = [
        (abs(float((corners @ w.normal).min()) - w.offset), w.id)
        for w in scene.architecture.by_role("wall")
        if abs(float(back @ w.normal)) > PARALLEL
    ]
    return min(near)[1] if near and min(near)[0] < NEAR_WALL_M else None


SHELL_M = 2.0
"""Both sides of a shell's plan are longer: no furniture is that large and holds a room's faces."""
FACE_M2 = 1.0
"""Smaller faces of a shell are skirting, sills and steps."""
MIN_WALL_HEIGHT_M, MIN_WALL_M = 1.8, 1.0
SLAB_M = 0.45
"""Walls and floors modelled as boxes are no thicker."""
LEVEL_COVERS = 0.35
"""Share of a shell's plan that its floor or ceiling has, wings of an L left out; tops of walls have less."""
JOINS_M = 1e-3
COVERS = 0.6
"""Share of everything's plan that a floor or a ceiling covers."""
BORDER_M = 0.3
"""So near to the plan's border an unnamed wall stands."""
DIRECTION_COS = float(np.cos(np.radians(5.0)))
SAME_M = 0.02
TWO_FACES_M = 0.5
"""Parallel faces that are nearer are the two sides of one wall."""
FLAT_SHARE = 0.8
"""Share of a slab's broad area on its two outer sides; shelves have boards between theirs."""


@dataclass(frozen=True, eq=False)
class Face:
    """A plane of a shell: what it covers from above, or of a wall its rectangle."""

    role: PlaneRole
    normal: Float[np.ndarray, "3"]
    """Outward of the material: into the room, or out of it."""
    corners: Float[np.ndarray, "n 3"]
    area: float

    @property
    def offset(self) -> float:
        """Along its normal from the origin."""
        return float(self.normal @ self.corners.mean(axis=0))


def slab_role(part: Part, everything: Float[np.ndarray, "2 3"]) -> PlaneRole | None:
    """What a part that nobody named is within the bounds of everything: floor, wall or ceiling; None for furniture.

    Args:
        part: in the world.
        everything: bounds of the whole file.
    """
    low, high = part.whole.bounds
    size, span = high - low, everything[1] - everything[0]
    if size[2] < SLAB_M and (size[:2] > MIN_WALL_M).all() and np.prod(size[:2]) > COVERS * np.prod(span[:2]):
        above_floor = low[2] - everything[0, 2]
        if above_floor < SLAB_M:
            return "floor"
        return "ceiling" if above_floor > MIN_WALL_HEIGHT_M and everything[1, 2] - high[2] < SLAB_M else None
    thin = int(size[:2].argmin())
    at_border = min(low[thin] - everything[0, thin], everything[1, thin] - high[thin]) < BORDER_M
    wide = size[1 - thin] > max(MIN_WALL_M, 0.4 * span[1 - thin])
    tall = size[2] > MIN_WALL_HEIGHT_M and size[2] > 0.6 * span[2]
    return "wall" if size[thin] < SLAB_M and at_border and wide and tall and _is_slab(part, thin) else None


def _is_slab(part: Part, axis: int) -> bool:
    """Whether a thin part's broad faces lie on its two outer sides only: a wall's do, a bookshelf's do not."""
    whole = part.whole
    broad = np.abs(whole.face_normals[:, axis]) > DIRECTION_COS
    at = whole.triangles_center[:, axis]
    outer = (at < whole.bounds[0, axis] + SAME_M) | (at > whole.bounds[1, axis] - SAME_M)
    areas = whole.area_faces
    return bool(broad.any() and areas[broad & outer].sum() > FLAT_SHARE * areas.sum())


def shell_planes(part: Part, middle: Float[np.ndarray, "3"]) -> tuple[Plane, ...] | None:
    """Floor, walls and ceiling of a mesh that is a room's shell, facing its middle; None where it is furniture.

    Args:
        part: in the world.
        middle: of the room; planes face it.
    """
    x, y, height = part.whole.extents
    if min(x, y) < SHELL_M or height < MIN_WALL_HEIGHT_M:
        return None
    faces = _faces(part.whole)
    levels = [f for f in faces if f.role == "floor"]
    walls = _inner([f for f in faces if f.role == "wall"], middle)
    plan = x * y
    floors = [f for f in levels if f.area > LEVEL_COVERS * plan and f.corners[0, 2] < middle[2]]
    ceilings = [f for f in levels if f.area > LEVEL_COVERS * plan and f.corners[0, 2] > middle[2]]
    covered = sum(f.area for f in (*walls, *floors[:1], *ceilings[:1]))
    if len(walls) + bool(floors) + bool(ceilings) < 3 or covered < 0.3 * part.whole.area:
        return None
    planes = [Plane("floor", "floor", _level(max(floors, key=_top), up=True))] if floors else []
    planes += [Plane(f"wall-{k}", "wall", _facing(w, middle)) for k, w in enumerate(walls, 1)]
    planes += [Plane("ceiling", "ceiling", _level(min(ceilings, key=_top), up=False))] if ceilings else []
    return tuple(planes)


def _top(face: Face) -> float:
    return float(face.corners[0, 2])


def _faces(mesh: trimesh.Trimesh) -> list[Face]:
    """Level and upright planes of a mesh that are large enough, as rectangles."""
    normals, centres, areas = mesh.face_normals, mesh.triangles_center, mesh.area_faces
    left = np.ones(len(normals), bool)
    faces: list[Face] = []
    for index in np.argsort(-areas, kind="stable"):
        normal = normals[index]
        level = bool(abs(normal[2]) > DIRECTION_COS)
        if not left[index] or not (level or abs(normal[2]) < 0.1):
            continue
        direction = np.array([0.0, 0.0, 1.0]) if level else np.append(normal[:2] / np.linalg.norm(normal[:2]), 0.0)
        same = left & (normals @ (direction if level and normal[2] > 0 else -direction if level else direction) > 0.99)
        same &= np.abs((centres - centres[index]) @ direction) < SAME_M
        left &= ~same
        if areas[same].sum() > FACE_M2:
            faces.append(_face(mesh, same, direction, level, float(areas[same].sum())))
        if areas[left].sum() < FACE_M2:
            break
    return [f for f in faces if f.role == "floor" or np.ptp(f.corners[:, 2]) > MIN_WALL_HEIGHT_M]


def _face(mesh: trimesh.Trimesh, chosen: np.ndarray, direction: np.ndarray, level: bool, area: float) -> Face:
    points = mesh.vertices[np.unique(mesh.faces[chosen])]
    if level:
        ring = _outline([Polygon(mesh.vertices[face, :2]) for face in mesh.faces[chosen]])
        return Face("floor", direction, np.column_stack([ring, np.full(len(ring), np.median(points[:, 2]))]), area)
    along, up = np.array([-direction[1], direction[0], 0.0]), np.array([0.0, 0.0, 1.0])
    a, b, at = points @ along, points[:, 2], float(np.median(points @ direction))
    ends = [(a.min(), b.min()), (a.max(), b.min()), (a.max(), b.max()), (a.min(), b.max())]
    return Face("wall", direction, np.array([direction * at + along * u + up * v for u, v in ends]), area)


def _outline(triangles: Sequence[Polygon]) -> Float[np.ndarray, "n 2"]:
    """Outline of the largest piece that the triangles cover."""
    whole = unary_union([t.buffer(JOINS_M, join_style="mitre") for t in triangles if t.area > 0])
    whole = whole.buffer(-JOINS_M, join_style="mitre")
    largest = max(whole.geoms, key=lambda p: p.area) if isinstance(whole, MultiPolygon) else whole
    return np.asarray(largest.simplify(SAME_M / 2).exterior.coords)[:-1]


def _inner(walls: Sequence[Face], middle: Float[np.ndarray, "3"]) -> list[Face]:
    """Select the side of each wall that is nearer to the middle."""
    kept: list[Face] = []
    for wall in sorted(walls, key=lambda f: abs(f.offset - float(f.normal @ middle))):
        side = np.sign(wall.offset - float(wall.normal @ middle))
        twin = any(
            abs(wall.normal @ other.normal) > DIRECTION_COS
            and abs(float(wall.normal @ (other.corners.mean(axis=0) - wall.corners.mean(axis=0)))) < TWO_FACES_M
            and side * np.sign(wall.normal @ other.normal) == np.sign(other.offset - float(other.normal @ middle))
            and _overlap(wall, other)
            for other in kept
        )
        if not twin:
            kept.append(wall)
    return kept


def _overlap(wall: Face, other: Face) -> bool:
    along = np.array([-other.normal[1], other.normal[0], 0.0])
    mine, theirs = wall.corners @ along, other.corners @ along
    return bool(min(mine.max(), theirs.max()) - max(mine.min(), theirs.min()) > 0.5 * np.ptp(mine))


def _level(face: Face, *, up: bool) -> Float[np.ndarray, "n 3"]:
    plane = Plane("level", "floor", face.corners)
    return face.corners if (plane.normal[2] > 0) == up else face.corners[::-1]


def _facing(face: Face, middle: Float[np.ndarray, "3"]) -> Float[np.ndarray, "n 3"]:
    plane = Plane("side", "wall", face.corners)
    return face.corners if plane.normal @ (middle - face.corners.mean(axis=0)) > 0 else face.corners[::-1]
