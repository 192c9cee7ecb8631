"""Which shapes are worth looking at for an object: its kinds', and near kinds' where those are few.

Things that hold other things up draw from their own pool: shapes with a surface to stand on and nothing on it yet
(paper, section 3.2: shapes with clutter baked in must not support anything).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from jaxtyping import Float

from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN, broad, category, column
from diorama_core.retrieval.settings import SETTINGS, PoolSettings
from diorama_core.scene.values import ArrayValue

RELATED: Mapping[str, tuple[str, ...]] = column("related")
"""Near kinds of each broad category, nearest first."""


def near_kinds(name: str, settings: PoolSettings = SETTINGS.pools) -> tuple[str, ...]:
    """Near kinds of a category, nearest first.

    A special kind has its broad category and that one's near kinds; a category without a row in `RELATED` those that
    are found in the same place and are most nearly as large.
    """
    kin = broad(name)
    if kin != name:
        return (kin, *(k for k in RELATED.get(kin, ()) if k != name))
    return RELATED.get(name) or _alike_in_size(name, settings)


@cache
def _alike_in_size(name: str, settings: PoolSettings) -> tuple[str, ...]:
    kind = category(name)
    others = [c for c in CATEGORIES if c.mount == kind.mount and c.name not in (name, UNKNOWN.name) and not c.kin]
    unlike = [float(np.abs(c.priors[0].log_median_xyz - kind.priors[0].log_median_xyz).sum()) for c in others]
    return tuple(others[i].name for i in np.argsort(unlike, kind="stable")[: settings.substitutes])


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
    senses: Mapping[str, float]
    """How likely its word means each kind, views apart."""
    named: bool = True
    """Whether a word says what it is: the category of a thing without one is a guess."""


def pool_for(library: ShapeLibrary, query: RetrievalQuery, settings: PoolSettings = SETTINGS.pools) -> Pool:
    """Shapes worth comparing with the picture, some dozens; nearest sizes where there are more."""

    def nearest(shapes: Sequence[Shape], most: int) -> list[Shape]:
        return _nearest(_usable(library, shapes, query), query.size_m, most, settings)

    senses, best = query.senses, max(query.senses.values())
    members: list[Pooled] = []
    least = 1 if query.named else settings.min_unnamed
    for rank, (kind, share) in enumerate(sorted(senses.items(), key=lambda row: (-row[1], row[0]))):
        if rank < least or (share >= settings.min_sense * best and len(members) < settings.max_pool):
            is_certain = len(senses) == 1 or kind == query.category
            most = settings.named_pool if is_certain else settings.other_pool if query.named else settings.unnamed_each
            factor = sense_factor(share / best, settings)
            members += [Pooled(shape, factor) for shape in nearest(library.in_category(kind), most)]
    is_known = bool(members)
    factor = settings.related_factor
    for near in near_kinds(query.category, settings):
        if len(members) >= settings.enough:
            break
        members += [Pooled(shape, factor) for shape in nearest(library.in_category(near), settings.named_pool)]
        factor *= settings.related_factor
    if is_known:
        return Pool(tuple(members))
    note = f"no {query.category} among the shapes; the nearest kinds were taken"
    if not members:
        members = [Pooled(shape, 1.0) for shape in nearest(library.shapes(), settings.named_pool)]
    return Pool(tuple(members), note)


def sense_factor(share: float, settings: PoolSettings = SETTINGS.pools) -> float:
    """What a score is multiplied by for a kind that is so many times as likely as the likeliest."""
    return float(share ** (1.0 / settings.views_say))


def _usable(library: ShapeLibrary, shapes: Sequence[Shape], query: RetrievalQuery) -> Sequence[Shape]:
    """The shapes that may hold things up, where that is asked; all of them where none may.

    Built-in shapes are empty by design; of others the measured support surfaces tell.
    """
    if not query.supports_objects:
        return shapes
    return [s for s in shapes if s.source == "built in" or library.shape(s.id).surfaces] or shapes


def _nearest(shapes: Sequence[Shape], size_m: np.ndarray, most: int, settings: PoolSettings) -> list[Shape]:
    """The shapes nearest in size, either way round, in a stable order."""
    ways = (size_m, size_m[[1, 0, 2]])
    costs = [min(size_cost(s.size_m, way, settings) for way in ways) for s in shapes]
    order = np.argsort(costs, kind="stable")[:most]
    return [shapes[i] for i in sorted(order)]


def size_cost(
    size_m: Sequence[float] | np.ndarray,
    wanted_m: Sequence[float] | np.ndarray,
    settings: PoolSettings = SETTINGS.pools,
) -> float:
    """How unlike two boxes are: mostly their proportions, gently their size (a shape may be scaled as a whole)."""
    ratio = np.log(np.maximum(wanted_m, settings.min_m)) - np.log(np.maximum(size_m, settings.min_m))
    overall = float(ratio.mean())
    return float(0.5 * (((ratio - overall) / 0.3) ** 2).sum() + 0.5 * (overall / 0.5) ** 2)
