"""The room of a file by shape, whatever its nodes are called: slabs that are floor, walls and ceiling, and shells.

The lowest large level face is the floor, the large upright ones around everything else are the walls, a level one that
covers the floor from above is the ceiling. A shell is one mesh with several of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import trimesh
from jaxtyping import Float
from shapely.geometry import MultiPolygon, Polygon
from shapely.ops import unary_union

from diorama_core.importing.parts import Part
from diorama_core.scene.types import Plane, PlaneRole

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
    """What a part that nobody named is within the bounds of everything: floor, wall or ceiling; None for furniture."""
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
    """Floor, walls and ceiling of a mesh that is a room's shell, facing its middle; None where it is furniture."""
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
