"""Which shapes are worth looking at for an object: its category's, near kinds where those are few, plain ones else.

Things that hold other things up draw from their own pool: shapes with a surface to stand on and nothing on it yet
(paper, section 3.2: shapes with clutter baked in must not support anything).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache

import numpy as np
from jaxtyping import Float

from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, broad, category, column
from diorama_core.scene.values import ArrayValue

_ENOUGH = 4
_RELATED_FACTOR = 0.6
_USUAL_FACTOR = 0.92
_RARE_FACTOR = 0.68
NAMED_POOL = 50
"""Of one kind; the paper's text query keeps as many."""
_OTHER_POOL = 14
"""Of every other kind that the word may mean."""
_UNNAMED_EACH = 5
"""Of every kind that a thing without a name may be."""
_MAX_POOL = 110
"""No more kinds are added to so many shapes."""
_MIN_SENSE = 0.04
"""Kinds less likely than this share of the likeliest are not looked at."""
_MIN_UNNAMED = 10
"""So many kinds are looked at whatever their share, where a thing has no name."""
_VIEWS_SAY = 10.0
"""How sharply views tell kinds apart: agreeing better by a factor f makes up for a kind less likely by f to this."""
_SUBSTITUTES = 3
_UNNAMED_POOL = 30
_EACH_KIND = 2
_SAME_SIZE_LOG = 0.4
_MIN_M = 0.01

RELATED: Mapping[str, tuple[str, ...]] = column("related")
"""Near kinds of each broad category, nearest first."""


def near_kinds(name: str) -> tuple[str, ...]:
    """Near kinds of a category, nearest first.

    A special kind has its broad category and that one's near kinds; a category without a row in `RELATED` those that
    are found in the same place and are most nearly as large.
    """
    kin = broad(name)
    if kin != name:
        return (kin, *(k for k in RELATED.get(kin, ()) if k != name))
    return RELATED.get(name) or _alike_in_size(name)


@cache
def _alike_in_size(name: str) -> tuple[str, ...]:
    own = category(name)
    others = [c for c in CATEGORIES if c.mount == own.mount and c.name not in (name, UNKNOWN.name) and not c.kin]
    unlike = [float(np.abs(c.priors[0].log_median_xyz - own.priors[0].log_median_xyz).sum()) for c in others]
    return tuple(others[i].name for i in np.argsort(unlike, kind="stable")[:_SUBSTITUTES])


USUAL = frozenset(c.name for c in CATEGORIES if c.usual)
"""What an unnamed thing in a room most likely is; the rest are found in kitchens, bathrooms and offices."""


@dataclass(frozen=True)
class Pooled:
    """A shape that may stand for an object, and how well its kind fits (1: the very category)."""

    shape: Shape
    kind_factor: float


@dataclass(frozen=True)
class Pool:
    """The shapes to rank for one object."""

    members: tuple[Pooled, ...]
    note: str = ""
    """For the user, where the object's own category has no shapes."""


@dataclass(frozen=True, eq=False)
class RetrievalQuery(ArrayValue):
    """What is known of an object before any shape is looked at."""

    category: str
    """Canonical, or "object"."""
    size_m: Float[np.ndarray, "3"]
    """Observed extents along x, y, z of the object frame."""
    supports_objects: bool
    """Whether something stands on it: then only shapes with a surface are taken, if any are."""
    supported_by: str
    """What holds it up: "floor", "wall", "ceiling" or an object's id."""
    senses: Mapping[str, float] = field(default_factory=dict)
    """How likely its word means each kind, views apart; by default its category alone."""
    named: bool = True
    """Whether a word says what it is: the category of a thing without one is a guess."""


def pool_for(library: ShapeLibrary, query: RetrievalQuery) -> Pool:
    """Shapes worth comparing with the picture, some dozens; nearest sizes where there are more."""
    if query.category == UNKNOWN.name and not query.senses:
        return Pool(_plausible(library, query))
    senses = dict(query.senses) or {query.category: 1.0}
    best = max(senses.values())
    members: list[Pooled] = []
    least = 1 if query.named else _MIN_UNNAMED
    for rank, (kind, share) in enumerate(sorted(senses.items(), key=lambda row: (-row[1], row[0]))):
        if rank < least or (share >= _MIN_SENSE * best and len(members) < _MAX_POOL):
            own = len(senses) == 1 or kind == query.category
            most = NAMED_POOL if own else _OTHER_POOL if query.named else _UNNAMED_EACH
            near_shapes = _nearest(_usable(library, library.in_category(kind), query), query.size_m, most)
            members += [Pooled(shape, sense_factor(share / best)) for shape in near_shapes]
    found = bool(members)
    factor = _RELATED_FACTOR
    for near in near_kinds(query.category):
        if len(members) >= _ENOUGH:
            break
        near_shapes = _nearest(_usable(library, library.in_category(near), query), query.size_m, NAMED_POOL)
        members += [Pooled(shape, factor) for shape in near_shapes]
        factor *= _RELATED_FACTOR
    if found:
        return Pool(tuple(members))
    note = f"no {query.category} among the shapes; the nearest kinds were taken"
    return Pool(tuple(members) or _plausible(library, query), note)


def sense_factor(share: float) -> float:
    """What a score is multiplied by for a kind that is so many times as likely as the likeliest."""
    return float(share ** (1.0 / _VIEWS_SAY))


def _usable(library: ShapeLibrary, shapes: Sequence[Shape], query: RetrievalQuery) -> Sequence[Shape]:
    """The shapes that may hold things up, where that is asked; all of them where none may.

    Built-in shapes are empty by design; of others the measured support surfaces tell.
    """
    if not query.supports_objects:
        return shapes
    return [s for s in shapes if s.source == "built in" or library.shape(s.id).surfaces] or shapes


def _nearest(shapes: Sequence[Shape], size_m: np.ndarray, most: int) -> list[Shape]:
    """The shapes nearest in size, either way round, in a stable order."""
    order = np.argsort([_fit_cost(s, size_m) for s in shapes], kind="stable")[:most]
    return [shapes[i] for i in sorted(order)]


def _plausible(library: ShapeLibrary, query: RetrievalQuery) -> tuple[Pooled, ...]:
    """For something unnamed: the two shapes nearest in size of every kind that is about as large.

    Kinds that hang or stand like it, the usual ones first in line; plain boxes always.
    """
    mounts = {"wall": ("wall",), "ceiling": ("ceiling",)}.get(query.supported_by, ("floor", "surface"))
    hung = [s for s in library.shapes() if category(s.category).mount in mounts] or list(library.shapes())
    wanted = np.log(np.maximum(query.size_m, _MIN_M))
    overall = [abs(float((np.log(np.maximum(s.size_m, _MIN_M)) - wanted).mean())) for s in hung]
    lifelike = [s for s, difference in zip(hung, overall, strict=True) if difference < _SAME_SIZE_LOG]
    usable = _usable(library, lifelike or hung, query)
    members: list[Pooled] = []
    for kind in dict.fromkeys(s.category for s in usable):
        factor = 1.0 if kind == "box" else _USUAL_FACTOR if kind in USUAL else _RARE_FACTOR
        same = [s for s in usable if s.category == kind]
        members += [Pooled(s, factor) for s in _nearest(same, query.size_m, _EACH_KIND)]
    order = np.argsort([_fit_cost(m.shape, query.size_m) for m in members], kind="stable")
    return tuple(members[i] for i in order[:_UNNAMED_POOL])


def _fit_cost(shape: Shape, size_m: np.ndarray) -> float:
    """How unlike in size, either way round."""
    return min(size_cost(shape.size_m, size_m), size_cost(shape.size_m, size_m[[1, 0, 2]]))


def size_cost(size_m: Sequence[float] | np.ndarray, wanted_m: Sequence[float] | np.ndarray) -> float:
    """How unlike two boxes are: mostly their proportions, gently their size (a shape may be scaled as a whole)."""
    ratio = np.log(np.maximum(wanted_m, _MIN_M)) - np.log(np.maximum(size_m, _MIN_M))
    overall = float(ratio.mean())
    return float(0.5 * (((ratio - overall) / 0.3) ** 2).sum() + 0.5 * (overall / 0.5) ** 2)
