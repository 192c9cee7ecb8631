"""Reliefs of shapes whose orientation is known: the built-in ones, taken once and kept."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Float32

from diorama_core.io.derived import read_arrays, write_arrays
from diorama_core.library.catalogue import built_in_library, default_cache_dir
from diorama_core.library.ingest.relief import SIDE, relief
from diorama_core.library.record import Shape, ShapeLibrary

_FORMAT = 3
EACH = 6
"""Shapes of one category that are kept, evenly spread over it: more hardly tell more."""


@dataclass(frozen=True, eq=False)
class KnownShapes:
    """Upright shapes with their fronts along +X, to compare others with."""

    categories: tuple[str, ...]
    features: Float32[np.ndarray, "shapes f"]
    """`relief_features` of each."""
    log_extents: Float[np.ndarray, "shapes 3"]

    def rows_of(self, category: str) -> np.ndarray:
        """Rows of one category."""
        return np.flatnonzero(np.array(self.categories) == category)


def relief_features(pictures: np.ndarray) -> Float32[np.ndarray, "*n f"]:
    """A relief as a vector; roots, so that the low relief of handles and panels counts beside deep openings."""
    return np.sqrt(pictures).reshape(*pictures.shape[:-4], -1).astype(np.float32)


def known_shapes(
    cache_dir: Path | None = None,
    on_step: Callable[[float], None] = lambda _: None,
    library: ShapeLibrary | None = None,
) -> KnownShapes:
    """Reliefs of shapes: read from the cache, or taken now (half a minute for the built-in ones) and kept there.

    Args:
        cache_dir: Where they are kept; the user's cache by default.
        on_step: Told the share that is done.
        library: Whose shapes; the built-in ones by default.
    """
    library = library or built_in_library()
    shapes = _spread(library.shapes())
    path = _place(shapes, cache_dir)
    categories = tuple(s.category for s in shapes)
    sizes = np.log([s.size_m for s in shapes])
    retained = _read(path, len(shapes))
    if retained is None:
        retained = _taken(library, shapes, on_step)
        write_arrays(path, {"reliefs": retained})
    return KnownShapes(categories, relief_features(retained.astype(np.float32) / 255.0), sizes)


def are_known(cache_dir: Path | None = None) -> bool:
    """Whether the reliefs of the built-in shapes are in the cache."""
    return _place(_spread(built_in_library().shapes()), cache_dir).exists()


def _place(shapes: Sequence[Shape], cache_dir: Path | None) -> Path:
    state = hashlib.sha256(f"{_FORMAT} {SIDE} {[s.content_hash for s in shapes]}".encode()).hexdigest()[:24]
    return (cache_dir or default_cache_dir()) / "reliefs" / f"{state}.npz"


def _spread(shapes: Sequence[Shape]) -> list[Shape]:
    """At most `EACH` of every category."""
    kinds: dict[str, list[Shape]] = {}
    for shape in shapes:
        kinds.setdefault(shape.category, []).append(shape)
    rows = (np.linspace(0, len(kind) - 1, min(len(kind), EACH)).round().astype(int) for kind in kinds.values())
    return [kind[row] for kind, some in zip(kinds.values(), rows, strict=True) for row in some]


def _taken(library: ShapeLibrary, shapes: Sequence[Shape], on_step: Callable[[float], None]) -> np.ndarray:
    found = np.zeros((len(shapes), 3, 2, SIDE, SIDE), np.uint8)
    for row, shape in enumerate(shapes):
        found[row] = np.round(relief(library.mesh(shape.id)) * 255)
        on_step((row + 1) / len(shapes))
    return found


def _read(path: Path, count: int) -> np.ndarray | None:
    stored = read_arrays(path, "reliefs")
    return stored[0] if stored is not None and stored[0].shape == (count, 3, 2, SIDE, SIDE) else None
