"""What the library knows of one shape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.scene.values import ArrayValue, frozen_array

SymmetryFold = Literal[1, 2, 4, 36]


@dataclass(frozen=True, eq=False)
class SupportSurface(ArrayValue):
    """A flat upward face of a shape on which things can stand, in the canonical frame at scale 1."""

    polygon: Float[np.ndarray, "n 3"]
    """Convex outline, counter-clockwise seen from above, metres."""
    clearance_m: float
    """Free height above it; `inf` when nothing of the shape is above."""
    interior: bool
    """Inside the shape (a shelf, a drawer) rather than on top of it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "polygon", frozen_array(self.polygon, (-1, 3)))

    @property
    def height_m(self) -> float:
        """z in the canonical (centred) frame."""
        return float(self.polygon[:, 2].mean())


@dataclass(frozen=True)
class Shape:
    """The record of one shape. Canonical frame: +X front, +Z up, centred on its bounding box, metres."""

    id: str
    category: str
    """Canonical category (`taxonomy`)."""
    caption: str
    """One line a person would say of it: 'walnut armchair with round arms'."""
    size_m: tuple[float, float, float]
    """Extents along x (front-back), y (left-right), z (height)."""
    style: str = ""
    source: str = "built in"
    licence: str = "MIT"
    symmetry: SymmetryFold = 1
    """Turns about up that leave it looking the same; 36 means round."""
    surfaces: tuple[SupportSurface, ...] = ()
    mass_kg: float = 1.0
    content_hash: str = ""
    """Hash of the geometry and materials: the key of everything derived from it."""


class ShapeLibrary(Protocol):
    """Where shapes come from. Read-only and safe to share between threads."""

    def shapes(self) -> tuple[Shape, ...]:
        """All records, in a stable order; cheap, so without support surfaces."""
        ...

    def shape(self, shape_id: str) -> Shape:
        """One record with its support surfaces; raises `LibraryError` when unknown."""
        ...

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """Records of one canonical category, in a stable order; without support surfaces."""
        ...

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        """Geometry only: one merged mesh in the canonical frame, for rays, collision and surfaces."""
        ...

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials and textures, in the canonical frame (+Z up), for display and export."""
        ...

    def glb(self, shape_id: str) -> bytes:
        """`parts` as GLB bytes, still +Z up and in metres (viewers rotate as their convention asks)."""
        ...
