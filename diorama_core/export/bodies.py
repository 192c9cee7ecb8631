"""Rigid bodies of objects and the room for simulators."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import ConvexHull, QhullError

from diorama_core.export.gathering import ExportObject
from diorama_core.export.limbs import ExportLimb
from diorama_core.export.physics import Inertia
from diorama_core.geometry.vectors import cross
from diorama_core.library import taxonomy
from diorama_core.scene.types import Plane

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
