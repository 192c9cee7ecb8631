"""Convex parts of library shapes, computed once per shape and cached in memory and on disk: parts of many shapes as few
arrays, since an array costs more to open than to read.

Numbers are halved to four bytes: a micrometre in a hall.

Those of the built-in shapes come along (`assets/shapes`): to decompose all of them takes minutes.
"""

from __future__ import annotations

import hashlib
import logging
from collections.abc import Iterator, Mapping
from functools import cache, partial
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float, Int

from diorama_core.geometry.convex import ConvexPart, convex_parts
from diorama_core.io.assets import asset
from diorama_core.io.cache import LruCache
from diorama_core.io.derived import read_arrays, write_arrays
from diorama_core.layout.problem.clear_places import clear_of_places
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import carries_things

Parts = tuple[ConvexPart, ...]
NAMES = ("keys", "sizes", "counts", "vertices", "normals", "edges")
"""Names of the arrays, in the order in which `PackedParts` takes them."""


def pack(parts_by_key: Mapping[str, Parts]) -> dict[str, np.ndarray]:
    """The arrays: keys, parts per key (k), rows of each part in the three arrays (p 3), and these rows (n 3)."""
    parts = [part for group in parts_by_key.values() for part in group]
    columns = [[getattr(part, name) for part in parts] for name in NAMES[3:]]
    counts = np.array([[len(array) for array in column] for column in columns], dtype=np.int32).T
    sizes = np.array([len(group) for group in parts_by_key.values()], dtype=np.int32)
    rows = (np.concatenate(column).astype(np.float32) for column in columns)
    return dict(zip(NAMES, (np.array(list(parts_by_key)), sizes, counts, *rows), strict=True))


class PackedParts(Mapping[str, Parts]):
    """What `pack` made arrays of; parts are read when they are asked for.

    Args:
        arrays: In the order of `NAMES`.

    Raises:
        ValueError: when they do not belong together.
    """

    def __init__(self, *arrays: np.ndarray) -> None:
        keys, sizes, counts, *rows = arrays
        if len(keys) != len(sizes) or counts.shape != (int(sizes.sum()), 3):
            raise ValueError("the arrays of convex parts do not belong together")
        if counts.sum(axis=0).tolist() != [len(array) for array in rows]:
            raise ValueError("the arrays of convex parts do not belong together")
        last = np.cumsum(sizes)
        self._parts = dict(zip(keys.tolist(), zip((last - sizes).tolist(), last.tolist(), strict=True), strict=True))
        self._ends = np.cumsum(counts, axis=0)
        self._starts = self._ends - counts
        self._rows = rows

    def __getitem__(self, key: str) -> Parts:
        first, last = self._parts[key]
        return tuple(self._part(number) for number in range(first, last))

    def __iter__(self) -> Iterator[str]:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)

    def _part(self, number: int) -> ConvexPart:
        bounds = zip(self._starts[number].tolist(), self._ends[number].tolist(), strict=True)
        return ConvexPart(*(array[a:b].astype(np.float64) for array, (a, b) in zip(self._rows, bounds, strict=True)))


log = logging.getLogger(__name__)

VERSION = 9
"""Version of the decomposition and its files: raise it when `convex_parts` changes: older files are not read."""
BUILT_IN_PARTS = asset("shapes", f"convex-parts-{VERSION}.npz")
"""Written by `scripts/make_convex_parts.py`; an installation may leave it out."""

_CACHE: LruCache[str, Parts] = LruCache(4096)


def parts_of_shape(library: ShapeLibrary, shape: Shape) -> Parts:
    """Convex bodies that together contain the shape, in its canonical frame at scale 1.

    They follow from the geometry alone, so they are kept under its content hash; a shape without one is decomposed
    anew each time.
    """
    key = shape.content_hash
    mesh = partial(library.mesh, shape.id)
    carries = carries_things(shape.category)
    if not key:
        return clear_of_places(convex_parts(mesh()), shape.surfaces, mesh, carries=carries)
    return _CACHE.get(
        key, lambda: clear_of_places(_find_parts(key) or _decompose(key, mesh()), shape.surfaces, mesh, carries=carries)
    )


def parts_of_solids(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]) -> Parts:
    """Convex bodies that together contain a mesh that is no shape of a library, such as one moving part of it."""
    key = solids_key(vertices, faces)
    return _CACHE.get(key, lambda: _find_parts(key) or _decompose(key, trimesh.Trimesh(vertices, faces, process=False)))


def solids_key(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]) -> str:
    """Names a mesh that is no shape of a library by what it is."""
    return hashlib.sha256(np.round(vertices, 7).tobytes() + faces.astype(np.int64).tobytes()).hexdigest()[:24]


def is_built_in(shape: Shape) -> bool:
    """Whether the convex bodies of a shape come along."""
    return shape.content_hash in _read_built_in()


def are_cached(shape: Shape) -> bool:
    """Whether the convex bodies of a shape need not be computed."""
    return is_built_in(shape) or (bool(shape.content_hash) and _path(shape.content_hash).is_file())


@cache
def _read_built_in() -> Mapping[str, Parts]:
    return _read(BUILT_IN_PARTS)


def _path(key: str) -> Path:
    return default_cache_dir() / "parts" / f"{key}-{VERSION}.npz"


def _read(path: Path) -> Mapping[str, Parts]:
    arrays = read_arrays(path, *NAMES)
    try:
        return {} if arrays is None else PackedParts(*arrays)
    except ValueError as error:
        log.warning("%s is damaged (%s); it is made again", path, error)
        return {}


def _find_parts(key: str) -> Parts | None:
    return _read_built_in().get(key) or _read(_path(key)).get(key)


def _decompose(key: str, mesh: trimesh.Trimesh) -> Parts:
    """Decompose, and read back, so that a shape has the same parts whether they were computed or read."""
    arrays = pack({key: convex_parts(mesh)})
    write_arrays(_path(key), arrays)
    return PackedParts(*arrays.values())[key]
