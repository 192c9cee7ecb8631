"""Rigid bodies of objects and the room for simulators, and the convex pieces of the room's planes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import manifold3d
import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import ConvexHull, QhullError

from diorama_core.export.gathering import ExportObject
from diorama_core.export.limbs import ExportLimb
from diorama_core.export.physics import Inertia
from diorama_core.geometry.planes import plane_axes
from diorama_core.geometry.unseen_walls import heights, open_edges, rectangle
from diorama_core.geometry.vectors import cross
from diorama_core.library import taxonomy
from diorama_core.scene.types import Architecture, Plane

MIN_SLAB_M = 0.05
GROUND_BEYOND_M, GROUND_DEPTH_M = 10.0, 0.5
"""How far the floor reaches beyond the room, and down: what falls for two seconds is not stopped by less."""
THIN_M = 1e-3
"""Pieces of slabs that are thinner than this are left out."""
CLEAR_M = 0.02
"""Between what stands over the floor's edge and the barrier beyond it."""
Points = Float[np.ndarray, "_ 3"]


@dataclass(frozen=True, eq=False)
class MovingPart:
    """What one joint of an object moves."""

    limb: ExportLimb
    parts: tuple[Points, ...]
    """Corners of convex bodies in the limb's frame, scale applied, metres."""
    inertia: Inertia
    """In the limb's frame."""
    friction: float
    """Friction of its joint, in newtons or newton metres."""


@dataclass(frozen=True, eq=False)
class RigidBody:
    """One object as a simulator sees it."""

    node: ExportObject
    parts: tuple[Points, ...]
    """Corners of convex bodies in the object's rigid frame, scale applied, metres."""
    inertia: Inertia
    """In the object's rigid frame."""
    friction: float
    free: bool
    """Whether it may move; otherwise it is welded to `carrier`, or to the room."""
    carrier: str | None = None
    """Id of the object it is welded to; None for the room and for free bodies."""
    moving: tuple[MovingPart, ...] = ()
    """What its joints move; `parts` and `inertia` are then those of the rest."""

    @property
    def mass_kg(self) -> float:
        """Mass without what its joints move."""
        return self.inertia.mass_kg

    @property
    def volume_m3(self) -> float:
        """Sum of the volumes of the parts that stay."""
        return sum(hull_volume(p) for p in self.parts)


@dataclass(frozen=True, eq=False)
class StaticSlab:
    """One plane of the room as convex pieces."""

    slug: str
    plane: Plane
    pieces: tuple[Points, ...]
    """In the world."""


@dataclass(frozen=True, eq=False)
class PhysicalScene:
    """Rigid bodies, supporters first, in a static room."""

    bodies: tuple[RigidBody, ...]
    slabs: tuple[StaticSlab, ...]
    notes: tuple[str, ...] = ()
    """What was decided that a reader of the file should know."""


def place(T: Float[np.ndarray, "4 4"], points: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    """Points in the frame that a rigid transform leads to."""
    return np.asarray(points @ T[:3, :3].T + T[:3, 3])


def is_soft(node: ExportObject) -> bool:
    """Whether an object gives way where it lies."""
    return taxonomy.resolve(node.item.category).category.soft


def hull_volume(points: Points) -> float:
    """Volume of the convex hull; 0 for flat sets."""
    try:
        return float(ConvexHull(points).volume)
    except (QhullError, ValueError):
        return 0.0


def hull_faces(points: Points) -> tuple[Points, Int[np.ndarray, "m 3"]]:
    """Vertices and outward triangles of a convex body.

    Which corners a triangle joins does not change when a body is moved or scaled along the axes, so bodies that are
    alike but for that (all boxes, and a shape's parts in each of its objects) share one hull.
    """
    low, size = points.min(axis=0), np.ptp(points, axis=0)
    form = np.round((points - low) / np.where(size > 0, size, 1.0), 7) + 0.0
    used, faces = _hull_of_form(form.tobytes())
    return points[used], faces


@lru_cache(maxsize=65536)
def _hull_of_form(form: bytes) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, "m 3"]]:
    """Rows that are corners of the hull of the points in these bytes, and its outward triangles among them."""
    points = np.frombuffer(form, dtype=np.float64).reshape(-1, 3)
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return np.arange(len(points)), np.array([[0, 1, 2]])
    faces = np.array(hull.simplices)
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    used = np.unique(faces)
    return used, np.searchsorted(used, faces)


def ground_piece(plane: Plane) -> tuple[Points, ...]:
    """The floor as one thick box that reaches beyond the room, so that nothing falls beside or through it."""
    axes = np.stack(plane_axes(plane.normal), axis=1)
    flat = plane.polygon @ axes
    low, high = flat.min(axis=0) - GROUND_BEYOND_M, flat.max(axis=0) + GROUND_BEYOND_M
    top = np.array([[u, v] for u in (low[0], high[0]) for v in (low[1], high[1])]) @ axes.T
    top = top + plane.normal * float(plane.polygon.mean(axis=0) @ plane.normal)
    return (np.vstack([top, top - plane.normal * GROUND_DEPTH_M]),)


def slab_pieces(plane: Plane) -> tuple[Points, ...]:
    """A plane with its thickness as convex prisms: one where its outline is convex, one a triangle otherwise."""
    depth = -plane.normal * max(plane.thickness, MIN_SLAB_M)
    flat = plane.polygon @ np.stack(plane_axes(plane.normal), axis=1)
    if _is_convex(flat):
        return (np.vstack([plane.polygon, plane.polygon + depth]),)
    triangles = np.asarray(manifold3d.triangulate([flat]), dtype=int)
    return tuple(
        np.vstack([plane.polygon[t], plane.polygon[t] + depth]) for t in triangles if _height(flat[t]) > THIN_M
    )


def barriers(architecture: Architecture, objects: Iterable[Points]) -> tuple[StaticSlab, ...]:
    """Walls that nobody sees where a room has none, beyond what stands over the floor's edge there: robots stay inside.

    Args:
        architecture: With the floor.
        objects: Corners of each object in the world.
    """
    found: list[StaticSlab] = []
    corners = list(objects)
    for a, b in open_edges(architecture):
        length = float(np.linalg.norm(b - a))
        along = (b - a) / length
        outward = np.array([along[1], -along[0]])
        away = CLEAR_M
        spans = [((c[:, :2] - a) @ along, (c[:, :2] - a) @ outward) for c in corners]
        for beside, beyond in sorted(spans, key=lambda span: float(span[1].min())):
            meets = beside.max() > -away - MIN_SLAB_M and beside.min() < length + away + MIN_SLAB_M
            if meets and beyond.max() > away - CLEAR_M and beyond.min() < away + MIN_SLAB_M + CLEAR_M:
                away = float(beyond.max()) + CLEAR_M
        start, end = (a + away * outward - away * along, b + away * outward + away * along)
        plane = Plane(f"barrier_{len(found) + 1}", "wall", rectangle(start, end, (0, 1), heights(architecture)))
        found.append(StaticSlab(plane.id, plane, slab_pieces(plane)))
    return tuple(found)


def _height(triangle: Float[np.ndarray, "3 2"]) -> float:
    """Least height of a triangle: slivers are no bodies for a simulator."""
    sides = np.roll(triangle, -1, axis=0) - triangle
    doubled_area = abs(float(sides[0, 0] * sides[1, 1] - sides[0, 1] * sides[1, 0]))
    return doubled_area / max(float(np.linalg.norm(sides, axis=1).max()), 1e-12)


def _is_convex(outline: Float[np.ndarray, "n 2"]) -> bool:
    edges = np.roll(outline, -1, axis=0) - outline
    after = np.roll(edges, -1, axis=0)
    turns = edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]
    return bool((turns >= -1e-9).all() or (turns <= 1e-9).all())
