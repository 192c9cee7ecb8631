"""Which shapes are worth looking at for an object: its category's, near kinds where those are few, plain ones else.

Things that hold other things up draw from their own pool: shapes with a surface to stand on and nothing on it yet
(paper, section 3.2: shapes with clutter baked in must not support anything).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import UNKNOWN

_ENOUGH = 4
_RELATED_FACTOR = 0.6
_PLAIN_FACTOR = 0.75
_UNKNOWN_POOL = 24
_LEAST_M = 0.01

RELATED: dict[str, tuple[str, ...]] = {
    "chair": ("office chair", "armchair", "stool"),
    "office chair": ("chair", "armchair"),
    "armchair": ("sofa", "chair"),
    "stool": ("ottoman", "chair", "side table"),
    "bench": ("ottoman", "coffee table", "sofa"),
    "sofa": ("armchair", "bench"),
    "ottoman": ("stool", "box", "bench"),
    "table": ("desk", "coffee table", "console table"),
    "coffee table": ("side table", "table", "bench"),
    "side table": ("night stand", "coffee table", "stool"),
    "desk": ("table", "console table"),
    "bed": ("sofa",),
    "night stand": ("side table", "cabinet", "dresser"),
    "dresser": ("cabinet", "sideboard", "night stand"),
    "cabinet": ("dresser", "sideboard", "wardrobe", "bookshelf"),
    "sideboard": ("cabinet", "dresser", "tv stand"),
    "console table": ("table", "desk", "sideboard"),
    "tv stand": ("sideboard", "cabinet", "console table"),
    "bookshelf": ("cabinet", "wardrobe", "shelves"),
    "wardrobe": ("cabinet", "bookshelf", "refrigerator"),
    "refrigerator": ("wardrobe", "cabinet"),
    "stove": ("washing machine", "kitchen counter", "cabinet"),
    "washing machine": ("stove", "cabinet", "box"),
    "kitchen counter": ("sideboard", "cabinet", "table"),
    "sink": ("kitchen counter", "cabinet", "bowl"),
    "toilet": ("stool", "ottoman"),
    "bathtub": ("sink", "box"),
    "floor lamp": ("lamp", "plant"),
    "lamp": ("floor lamp", "vase"),
    "ceiling lamp": ("lamp",),
    "television": ("monitor", "picture"),
    "monitor": ("television", "laptop"),
    "laptop": ("monitor", "books"),
    "computer": ("box", "microwave"),
    "keyboard": ("books", "laptop"),
    "microwave": ("box", "computer", "stove"),
    "pillow": ("ottoman", "box"),
    "books": ("box", "laptop"),
    "plant": ("vase", "floor lamp"),
    "vase": ("bottle", "cup", "plant"),
    "bowl": ("cup", "basket"),
    "cup": ("vase", "bowl", "bottle"),
    "bottle": ("vase", "cup"),
    "clock": ("picture", "mirror"),
    "box": ("basket", "ottoman"),
    "basket": ("trash can", "box"),
    "trash can": ("basket", "box"),
    "picture": ("mirror", "window"),
    "mirror": ("picture", "window"),
    "shelves": ("bookshelf", "console table"),
    "curtain": ("window", "picture"),
    "window": ("picture", "mirror"),
    "door": ("wardrobe", "picture"),
    "radiator": ("cabinet", "box"),
    "rug": ("books", "picture"),
    "piano": ("desk", "sideboard", "console table"),
    "toy": ("box", "vase"),
}
"""Near kinds of each category, nearest first."""


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


def pool_for(library: ShapeLibrary, category: str, size_m: Float[np.ndarray, "3"], holds_things: bool) -> Pool:
    """Shapes for an object of a category and an observed size.

    Args:
        library: Where shapes come from.
        category: Canonical category, or "object".
        size_m: Observed extents along x, y, z of the object frame.
        holds_things: Whether something stands on the object: then only shapes with a surface are taken, if any are.
    """
    if category == UNKNOWN.name:
        return Pool(_plausible(library, size_m, holds_things))
    own = _usable(library, library.in_category(category), holds_things)
    members = [Pooled(shape, 1.0) for shape in own]
    factor = _RELATED_FACTOR
    for near in RELATED.get(category, ()):
        if len(members) >= _ENOUGH:
            break
        members += [Pooled(shape, factor) for shape in _usable(library, library.in_category(near), holds_things)]
        factor *= _RELATED_FACTOR
    if own:
        return Pool(tuple(members))
    note = f"no {category} among the shapes; the nearest kinds were taken"
    return Pool(tuple(members) or _plausible(library, size_m, holds_things), note)


def _usable(library: ShapeLibrary, shapes: tuple[Shape, ...], holds_things: bool) -> tuple[Shape, ...]:
    """The shapes that may hold things up, where that is asked; all of them where none may.

    Built-in shapes are empty by design; of others the measured support surfaces tell.
    """
    if not holds_things:
        return shapes
    return tuple(s for s in shapes if s.source == "built in" or library.shape(s.id).surfaces) or shapes


def _plausible(library: ShapeLibrary, size_m: Float[np.ndarray, "3"], holds_things: bool) -> tuple[Pooled, ...]:
    """Shapes of any kind nearest in size to something unnamed; plain boxes first."""
    shapes = _usable(library, library.shapes(), holds_things)
    cost = [size_cost(shape.size_m, size_m) for shape in shapes]
    order = np.argsort(np.array(cost) - 2.0 * np.array([s.category == "box" for s in shapes]), kind="stable")
    return tuple(
        Pooled(shapes[i], 1.0 if shapes[i].category == "box" else _PLAIN_FACTOR) for i in order[:_UNKNOWN_POOL]
    )


def size_cost(size_m: Sequence[float] | np.ndarray, wanted_m: Sequence[float] | np.ndarray) -> float:
    """How unlike two boxes are: mostly their proportions, gently their size (a shape may be scaled as a whole)."""
    ratio = np.log(np.maximum(wanted_m, _LEAST_M)) - np.log(np.maximum(size_m, _LEAST_M))
    overall = float(ratio.mean())
    return float(0.5 * (((ratio - overall) / 0.3) ** 2).sum() + 0.5 * (overall / 0.5) ** 2)
