"""Depth reliefs of the built-in shapes, whose orientation is known, computed once and cached."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Float32, UInt8

from diorama_core.io.derived import read_arrays, write_arrays
from diorama_core.library.catalogue import built_in_library, default_cache_dir
from diorama_core.library.ingest.relief import SIDE, relief
from diorama_core.library.record import Shape, ShapeLibrary

_FORMAT = 4
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


def load_known_shapes(
    cache_dir: Path | None = None,
    on_step: Callable[[float], None] = lambda _: None,
    library: ShapeLibrary | None = None,
) -> KnownShapes:
    """Reliefs of shapes: read from the cache, or taken now (half a minute for the built-in ones) and kept there.

    Only those that are missing are taken: after a change to one shape, that shape's.

    Args:
        cache_dir: Where they are kept; the user's cache by default.
        on_step: Told the share that is done.
        library: Whose shapes; the built-in ones by default.
    """
    library = library or built_in_library()
    shapes = _spread(library.shapes())
    path = _place(cache_dir)
    categories = tuple(s.category for s in shapes)
    sizes = np.log([s.size_m for s in shapes])
    reliefs_by_key = _read(path)
    missing = [s for s in shapes if _key(s) not in reliefs_by_key]
    if missing:
        for count, shape in enumerate(missing, start=1):
            reliefs_by_key[_key(shape)] = np.round(relief(library.mesh(shape.id)) * 255).astype(np.uint8)
            on_step(count / len(missing))
        reliefs_by_key = {_key(s): reliefs_by_key[_key(s)] for s in shapes}
        stored = {"keys": np.array(list(reliefs_by_key)), "reliefs": np.stack(list(reliefs_by_key.values()))}
        write_arrays(path, stored)
    reliefs = np.stack([reliefs_by_key[_key(s)] for s in shapes])
    return KnownShapes(categories, relief_features(reliefs.astype(np.float32) / 255.0), sizes)


def are_known() -> bool:
    """Whether the reliefs of the built-in shapes are in the cache."""
    return {_key(s) for s in _spread(built_in_library().shapes())} <= _read(_place(None)).keys()


def _place(cache_dir: Path | None) -> Path:
    return (cache_dir or default_cache_dir()) / "reliefs" / f"{_FORMAT}-{SIDE}.npz"


def _key(shape: Shape) -> str:
    return shape.content_hash or shape.id


def _spread(shapes: Sequence[Shape]) -> list[Shape]:
    """At most `EACH` of every category."""
    kinds: dict[str, list[Shape]] = {}
    for shape in shapes:
        kinds.setdefault(shape.category, []).append(shape)
    rows = (np.linspace(0, len(kind) - 1, min(len(kind), EACH)).round().astype(int) for kind in kinds.values())
    return [kind[row] for kind, some in zip(kinds.values(), rows, strict=True) for row in some]


def _read(path: Path) -> dict[str, UInt8[np.ndarray, "3 2 side side"]]:
    """Reliefs by the keys of their shapes; none where there is no such file, or a damaged one."""
    stored = read_arrays(path, "keys", "reliefs")
    if stored is None or len(stored[0]) != len(stored[1]):
        return {}
    return dict(zip(stored[0].tolist(), stored[1], strict=True))
