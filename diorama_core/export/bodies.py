"""Rigid bodies of objects and the room for simulators."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from diorama_core.export.gathering import ExportObject
from diorama_core.export.limbs import ExportLimb
from diorama_core.export.physics import Inertia
from diorama_core.library import taxonomy
from diorama_core.scene.types import Plane

Points = Float[np.ndarray, "_ 3"]


@dataclass(frozen=True, eq=False)
class MovingPart:
    """What one joint of an object moves."""

    limb: ExportLimb
    parts: tuple[Points, ...]
    """Corners of convex bodies in the object's rigid frame, scale applied, metres."""
    inertia: Inertia
    """In the object's rigid frame."""


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
    without_contact: tuple[tuple[str, str], ...]
    """Pairs of object ids that may interpenetrate: rugs with what stands over their edge, and deep overlaps."""
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
