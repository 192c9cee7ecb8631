"""What the library knows of one shape."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.errors import LibraryError
from diorama_core.io.bounded import parse_json, shorten
from diorama_core.scene.types import FaceName
from diorama_core.scene.values import ArrayValue, read_only_array

BUILT_IN = "built in"
"""Source of the shapes that come with Diorama."""
SymmetryFold = Literal[1, 2, 3, 4, 5, 6, 8, 36]
ROUND: SymmetryFold = 36


@dataclass(frozen=True, eq=False)
class SupportSurface(ArrayValue):
    """A flat upward face of a shape on which objects can stand, in the canonical frame at scale 1."""

    polygon: Float[np.ndarray, "n 3"]
    """Convex outline, counter-clockwise seen from above, metres."""
    clearance_m: float
    """Free height above it; `inf` when nothing of the shape is above."""
    interior: bool
    """Inside the shape (a shelf, a drawer) rather than on top of it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "polygon", read_only_array(self.polygon, (-1, 3)))

    @property
    def height_m(self) -> float:
        """z in the canonical (centred) frame."""
        return float(self.polygon[:, 2].mean())


@dataclass(frozen=True)
class Assumption:
    """One thing about a model that its file does not say for certain."""

    value: str
    """`+y` for an axis of the file, a number of metres for a unit, a category."""
    confidence: float
    """0 (a coin toss) to 1 (the user or the file said so)."""
    reason: str
    """Where it comes from, in a few plain words."""


@dataclass(frozen=True)
class Guess:
    """What was assumed about a model that was brought in, so that a person can see and correct it."""

    up: Assumption
    """Axis of the file that points up."""
    front: Assumption
    """Axis of the file that the front looks along."""
    unit: Assumption
    """Metres in one unit of the file."""
    category: Assumption


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
    source: str = BUILT_IN
    licence: str = "MIT"
    symmetry: SymmetryFold = 1
    """Turns about up that leave its geometry and colours the same; 36 means round."""
    surfaces: tuple[SupportSurface, ...] = ()
    mass_kg: float = 1.0
    content_hash: str = ""
    """Hash of the geometry and materials: the key of everything derived from it (thumbnail, pose templates, parts)."""
    synonyms: tuple[str, ...] = ()
    """What else a person may call this shape, beyond the names of its category: a data set's own words for it."""
    contact_faces: tuple[FaceName, ...] = ("bottom",)
    """Faces of the canonical box that may touch a supporter, the usual one first."""
    triangles: int = 0
    """0 when nobody counted."""
    guess: Guess | None = None
    """None when nothing had to be assumed (built-in shapes)."""


@runtime_checkable
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


class LibraryView:
    """Hands what is asked of a shape on to the library that has it. Implements `ShapeLibrary`."""

    _library: ShapeLibrary

    def __repr__(self) -> str:
        return repr(self._library)

    def _library_of(self, shape_id: str) -> ShapeLibrary:
        return self._library

    def shapes(self) -> tuple[Shape, ...]:
        """All records, in a stable order, without support surfaces."""
        return self._library.shapes()

    def in_category(self, category: str) -> tuple[Shape, ...]:
        """Records of one canonical category, without support surfaces."""
        return self._library.in_category(category)

    def shape(self, shape_id: str) -> Shape:
        """One record with its support surfaces; raises `LibraryError` when unknown."""
        return self._library_of(shape_id).shape(shape_id)

    def mesh(self, shape_id: str) -> trimesh.Trimesh:
        """Geometry only, one mesh in the canonical frame. Shared: do not change it."""
        return self._library_of(shape_id).mesh(shape_id)

    def parts(self, shape_id: str) -> trimesh.Scene:
        """Geometry with materials, in the canonical frame. Shared: do not change it."""
        return self._library_of(shape_id).parts(shape_id)

    def glb(self, shape_id: str) -> bytes:
        """`parts` as GLB, +Z up, metres."""
        return self._library_of(shape_id).glb(shape_id)


def picture_of(library: ShapeLibrary, shape_id: str) -> bytes | None:
    """The picture that came with a shape, where its library keeps one."""
    thumbnail = getattr(library, "thumbnail", None)
    return None if thumbnail is None else thumbnail(shape_id)


def usual_contact_faces(mount: str) -> tuple[FaceName, ...]:
    """Faces that touch a supporter, the usual one first, for where a category is found (`taxonomy.Mount`)."""
    if mount == "wall":
        return ("back", "bottom")  # a clock hangs, and also stands on a shelf
    return ("top",) if mount == "ceiling" else ("bottom",)


def shape_to_json(shape: Shape) -> str:
    """The whole record, surfaces included, as one line of JSON; `shape_from_json` gives it back unchanged."""
    row = {name: value for name, value in vars(shape).items() if name not in ("surfaces", "guess")}
    row["surfaces"] = [surface_row(s) for s in shape.surfaces]
    row["guess"] = None if shape.guess is None else asdict(shape.guess)
    return json.dumps(row, ensure_ascii=False, separators=(",", ":"), allow_nan=False)


_ADVICE = "add the shape to its library again"


def shape_from_json(text: str) -> Shape:
    """The record that `shape_to_json` wrote.

    Raises:
        LibraryError: when the text is not such a record.
    """
    try:
        row = parse_json(text, "a shape record", LibraryError, advice=_ADVICE)
        row |= {name: tuple(row[name]) for name in ("size_m", "synonyms", "contact_faces")}
        row["surfaces"] = tuple(map(surface_from, row["surfaces"]))
        if row["guess"] is not None:
            row["guess"] = Guess(**{name: Assumption(**value) for name, value in row["guess"].items()})
        return Shape(**row)
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise LibraryError(f"a shape record cannot be read ({shorten(str(error))}); {_ADVICE}") from error


def surface_row(surface: SupportSurface, decimals: int | None = None) -> dict[str, Any]:
    """A support surface as an object of JSON, its corners rounded where that is asked; `surface_from` reads it."""
    corners = surface.polygon if decimals is None else np.round(surface.polygon, decimals)
    clearance = surface.clearance_m if np.isfinite(surface.clearance_m) else None
    return {"polygon": corners.tolist(), "clearance_m": clearance, "interior": surface.interior}


def surface_from(row: Mapping[str, Any]) -> SupportSurface:
    """The support surface of such an object."""
    clearance = row["clearance_m"]
    return SupportSurface(np.array(row["polygon"]), np.inf if clearance is None else clearance, row["interior"])


def record_of(library: ShapeLibrary, shape_id: str) -> Shape:
    """The shape's record; from the list where it is, because `shape` may have to measure support surfaces first."""
    return next((s for s in library.shapes() if s.id == shape_id), None) or library.shape(shape_id)
