"""The form of a shape in the words that people annotate: its top, its base, arms, back, upholstery, doors and drawers.

Read off the geometry at the size at which the shape stands, so that a round table stretched to twice its width is oval.
Doors and drawers are counted by the joints of built-in shapes; of other shapes nobody knows them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import cv2
import numpy as np
import trimesh
from jaxtyping import Bool, Float, Int8

from diorama_core.library.furniture.articulation import articulation
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.slots import Slot, slots_of
from diorama_core.library.taxonomy import broad, having

MEASURED = ("top", "base", "arms", "doors", "drawers", "upholstered", "open back")
"""Attributes that a shape's design can tell; others of an annotation are not compared."""
VALUES: Mapping[str, tuple[str | int, ...]] = {
    "top": ("rectangular", "square", "round", "oval"),
    "base": ("four legs", "pedestal", "plinth", "panel", "sled", "five-star"),
    "arms": ("no", "yes"),
    "doors": (0, 1, 2, 3, 4),
    "drawers": (0, 1, 2, 3, 4, 5, 6),
    "upholstered": ("no", "yes"),
    "open back": ("no", "yes"),
}
"""What each may be; the last count stands for more, too."""
_TABLES, _SEATS = having("table_form"), having("seat") - having("table_form")
_BACKED, _HARD_OR_SOFT = having("back_varies"), having("drawn_up")
"""Kinds of seats some of which have open backs, and some of which are upholstered: hardly an easy seat is without."""
_SAMPLES = 6000
_TOP_SLAB = 0.06
"""Share of the height that counts as the top."""
_SQUARE_RATIO = 1.15
FULL_RECTANGLE = 0.92
"""Share of its bounding rectangle that a rectangular top fills; a round one fills 0.785."""
_FOOT, _SLABS = (0.0, 0.06), ((0.03, 0.1), (0.1, 0.2), (0.2, 0.3), (0.3, 0.42))
"""Slabs of the height in which bases are told apart: a shelf or a stretcher between legs is in one of them only."""
_BODY = 2
"""So many of the uppermost slabs closed all around are a body on low feet, where the shape is a table."""
_DIRECTIONS = 24
_CENTRAL, _WIDE_FOOT = 0.45, 0.6
"""Radius, as a share of the footprint's: a pedestal is within the one, a star's foot beyond the other."""
_CLOSED, _TWO_SIDES, _ON_RUNNERS = 0.9, 0.55, 0.25
"""Shares of directions in which a plinth, a panel base, and how many more in which runners meet the floor."""
_SIDE, _MIDDLE = 0.7, 0.35
"""Shares of half the width: armrests are beyond the one, the seat is within the other."""
_BEFORE = (0.05, 0.3)
"""Shares of the depth from the middle: before the back, and behind the front edge."""
_ARM_RISE = 0.1
"""Share of the height by which armrests are higher than the seat."""
_SOFT, _KNOWN = 0.3, 0.5
"""Shares of the surface: fabric and leather of what is upholstered (a pad on wood is less), and known ones."""
_BACK_RISE, _MIN_BACK = 0.1, 0.12
"""Shares of the height: above the seat, where nothing but the back is left, and how high a back is at least."""
_OPEN_BACK = 0.8
"""A back that fills less of the outline around it, seen from the front, is seen through."""
_DRAWN_PX = 128


def form_of(
    shape_id: str, category: str, mesh: trimesh.Trimesh, size_m: Float[np.ndarray, "3"], slots: Sequence[Slot]
) -> dict[str, str | int]:
    """What the design of a shape tells of its form; attributes that its kind does not have are left out.

    Args:
        shape_id: for the joints of built-in shapes.
        category: its kind.
        mesh: in the canonical frame at scale 1 (+X front, +Z up, centred).
        size_m: at which it stands.
        slots: its materials (`library.slots.slots_of`).
    """
    form: dict[str, str | int] = {}
    points = _surface_points(mesh) * (np.asarray(size_m) / np.maximum(mesh.extents, 1e-6))
    if broad(category) in _TABLES or category in _TABLES:
        form["top"] = _top(points, size_m)
    if category in _TABLES | _SEATS:
        form["base"] = _base(points, size_m, seat=category in _SEATS)
    if category in _SEATS:
        form["arms"] = _arms(points, size_m)
    if category in _BACKED and (back := _back_fill(mesh)) is not None:
        form["open back"] = "yes" if back < _OPEN_BACK else "no"
    if category in _HARD_OR_SOFT and (soft := _soft_share(slots)) is not None:
        form["upholstered"] = "yes" if soft >= _SOFT else "no"
    moving = articulation(shape_id)
    if category not in _SEATS:
        names = [] if moving is None else [joint.name for joint in moving.joints]
        form["doors"] = sum(name.startswith("door") for name in names)
        form["drawers"] = sum(name.startswith("drawer") for name in names)
    return form


def form_at(library: ShapeLibrary, shape: Shape, size_m: Float[np.ndarray, "3"]) -> dict[str, str | int]:
    """The form (`form_of`) of a shape of a library at the size at which it stands."""
    slots = slots_of(library.parts(shape.id))
    return form_of(shape.id, shape.category, library.mesh(shape.id), np.asarray(size_m), slots)


def value_indices(form: Mapping[str, str | int]) -> Int8[np.ndarray, "7"]:
    """Place of each attribute's value in `VALUES`, in the order of `MEASURED`; -1 where it has none."""
    indices = np.full(len(MEASURED), -1, np.int8)
    for k, name in enumerate(MEASURED):
        value, values = form.get(name), VALUES[name]
        if isinstance(value, int):
            value = min(value, len(values) - 1)
        if value in values:
            indices[k] = values.index(value)
    return indices


def agrees(stated: str | int, design: str | int) -> bool:
    """Whether an annotated value is that of the design; "yes" is any number, "no" none; a square is a rectangle."""
    if stated == design:
        return True
    if isinstance(design, int):
        return {"yes": design > 0, "no": design == 0}.get(str(stated), str(stated) == str(design))
    return {stated, design} == {"square", "rectangular"}


def compare(stated: Mapping[str, str | int], design: Mapping[str, str | int]) -> dict[str, bool]:
    """For every attribute that both state, whether they agree."""
    return {name: agrees(stated[name], design[name]) for name in MEASURED if name in stated and name in design}


def _surface_points(mesh: trimesh.Trimesh) -> Float[np.ndarray, "n 3"]:
    """Spread evenly over the surface, always the same ones."""
    return np.asarray(trimesh.sample.sample_surface(mesh, _SAMPLES, seed=0)[0], dtype=np.float64)


def _slab(points: Float[np.ndarray, "n 3"], heights: tuple[float, float]) -> Float[np.ndarray, "m 2"]:
    """Points between two shares of the height, seen from above."""
    z = (points[:, 2] - points[:, 2].min()) / max(float(np.ptp(points[:, 2])), 1e-9)
    inside: Bool[np.ndarray, "n"] = (z >= heights[0]) & (z <= heights[1])
    return points[inside, :2]


def _top(points: Float[np.ndarray, "n 3"], size_m: Float[np.ndarray, "3"]) -> str:
    outline = cv2.convexHull(_slab(points, (1.0 - _TOP_SLAB, 1.0)).astype(np.float32))
    filled = cv2.contourArea(outline) / max(float(np.prod(np.ptp(outline[:, 0], axis=0))), 1e-9)
    even = max(size_m[:2]) / max(min(size_m[:2]), 1e-9) < _SQUARE_RATIO
    if filled >= FULL_RECTANGLE:
        return "square" if even else "rectangular"
    return "round" if even else "oval"


def _base(points: Float[np.ndarray, "n 3"], size_m: Float[np.ndarray, "3"], seat: bool) -> str:
    half = np.maximum(np.asarray(size_m[:2]) / 2, 1e-9)
    foot = _slab(points, _FOOT) / half
    slabs = [slab / half for slab in (_slab(points, heights) for heights in _SLABS) if len(slab)]
    if not len(foot) or not slabs:
        return "none"
    if min(float(np.quantile(np.linalg.norm(slab, axis=1), 0.9)) for slab in slabs) < _CENTRAL:
        wide = np.quantile(np.linalg.norm(foot, axis=1), 0.9) > _WIDE_FOOT
        return "five-star" if seat and wide and _arms_of_star(foot) else "pedestal"
    filled, below = [_directions_filled(slab) for slab in slabs], _directions_filled(foot)
    around = min(filled)
    if around >= _CLOSED or (not seat and min(filled[-_BODY:]) >= _CLOSED):
        return "plinth"
    if around >= _TWO_SIDES:
        return "panel"
    return "sled" if below - around > _ON_RUNNERS else "four legs"


def _arms_of_star(foot: Float[np.ndarray, "n 2"]) -> bool:
    """Whether the foot stands on single points around it, as castors do, rather than on a disc."""
    return _directions_filled(foot[np.linalg.norm(foot, axis=1) > _WIDE_FOOT]) < _CLOSED


def _directions_filled(points: Float[np.ndarray, "n 2"]) -> float:
    """Share of the directions from the middle in which there is a point."""
    angle = np.arctan2(points[:, 1], points[:, 0])
    return len(np.unique(np.floor(angle / (2 * np.pi) * _DIRECTIONS))) / _DIRECTIONS


def _arms(points: Float[np.ndarray, "n 3"], size_m: Float[np.ndarray, "3"]) -> str:
    """Whether something beside the sitter is higher than the seat, before the back."""
    aside = np.abs(points[:, 1]) / max(size_m[1] / 2, 1e-9)
    before = (points[:, 0] > _BEFORE[0] * size_m[0]) & (points[:, 0] < _BEFORE[1] * size_m[0])
    side, seat = points[before & (aside > _SIDE), 2], points[before & (aside < _MIDDLE), 2]
    if not len(side) or not len(seat):
        return "no"
    return "yes" if np.quantile(side, 0.98) - np.quantile(seat, 0.98) > _ARM_RISE * size_m[2] else "no"


def _soft_share(slots: Sequence[Slot]) -> float | None:
    """Fabric and leather's share of the surface; None where it is not known what most of it is made of."""
    whole = sum(slot.area_m2 for slot in slots)
    if not sum(slot.area_m2 for slot in slots if slot.role != "material") > _KNOWN * whole:
        return None
    return sum(slot.area_m2 for slot in slots if slot.role in ("fabric", "leather")) / whole


def _back_fill(mesh: trimesh.Trimesh) -> float | None:
    """Share of the outline around a seat's back that is not seen through from the front; None where it has none."""
    points, low, size = _surface_points(mesh), mesh.bounds[0], np.maximum(mesh.extents, 1e-9)
    depth, aside = (points[:, 0] - low[0]) / size[0] - 0.5, np.abs((points[:, 1] - low[1]) / size[1] - 0.5) * 2
    seat = points[(depth > _BEFORE[0]) & (depth < _BEFORE[1]) & (aside < _MIDDLE), 2]
    above = float(np.quantile(seat, 0.98)) + _BACK_RISE * size[2] if len(seat) else np.inf
    if mesh.bounds[1, 2] - above < _MIN_BACK * size[2]:
        return None
    triangles = mesh.triangles
    behind = (triangles[:, :, 0].mean(axis=1) - low[0]) / size[0] - 0.5 < _BEFORE[0]
    flat = triangles[behind & (triangles[:, :, 2].max(axis=1) > above)][:, :, 1:]
    at = (flat - [low[1], above]) / [size[1], mesh.bounds[1, 2] - above] * (_DRAWN_PX - 1)
    drawn = np.zeros((_DRAWN_PX, _DRAWN_PX), np.uint8)
    for triangle in np.rint(at).astype(np.int32):
        cv2.fillConvexPoly(drawn, triangle, 1)
    around = cv2.contourArea(cv2.convexHull(np.argwhere(drawn).astype(np.int32))) if drawn.any() else 0.0
    return float(drawn.sum()) / around if around > 0 else None
