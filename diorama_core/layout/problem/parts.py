"""Convex parts of library shapes, computed once per shape and cached in memory and on disk."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float, Int

from diorama_core.geometry.convex import ConvexPart, convex_parts
from diorama_core.io.cache import LruCache
from diorama_core.io.derived import read_arrays, write_arrays
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary

VERSION = 7
"""Of the decomposition and its files: raise it when `convex_parts` changes, so that older files are not read."""
_ARRAYS = ("vertices", "normals", "edges")

_CACHE: LruCache[str, tuple[ConvexPart, ...]] = LruCache(4096)


def parts_of_shape(library: ShapeLibrary, shape: Shape) -> tuple[ConvexPart, ...]:
    """Convex bodies that together contain the shape, in its canonical frame at scale 1.

    They follow from the geometry alone, so they are kept under its content hash; a shape without one is decomposed
    anew each time.
    """
    key = shape.content_hash
    if not key:
        return convex_parts(library.mesh(shape.id))
    path = _path(key)
    return _CACHE.get(key, lambda: _read(path) or _made(path, library.mesh(shape.id)))


def parts_of_solids(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]) -> tuple[ConvexPart, ...]:
    """Convex bodies that together contain a mesh that is no shape of a library, such as one moving part of it."""
    key = hashlib.sha256(np.round(vertices, 7).tobytes() + faces.astype(np.int64).tobytes()).hexdigest()
    path = _path(key)
    return _CACHE.get(key, lambda: _read(path) or _made(path, trimesh.Trimesh(vertices, faces, process=False)))


def are_cached(shape: Shape) -> bool:
    """Whether the convex bodies of a shape are on disk."""
    return bool(shape.content_hash) and _path(shape.content_hash).is_file()


def _path(key: str) -> Path:
    return default_cache_dir() / "parts" / f"{key}-{VERSION}.npz"


def _read(path: Path) -> tuple[ConvexPart, ...] | None:
    """The parts in a file: their rows one after the other, since each array costs more to open than to read."""
    arrays = read_arrays(path, "counts", *_ARRAYS)
    if arrays is None or arrays[0].ndim != 2 or arrays[0].sum(axis=0).tolist() != [len(a) for a in arrays[1:]]:
        return None
    counts, *rows = arrays
    ends = np.cumsum(counts, axis=0)[:-1]
    parts = zip(*(np.split(array, ends[:, k]) for k, array in enumerate(rows)), strict=True)
    return tuple(ConvexPart(*part) for part in parts)


def _made(path: Path, mesh: trimesh.Trimesh) -> tuple[ConvexPart, ...]:
    parts = convex_parts(mesh)
    columns = {name: [getattr(part, name) for part in parts] for name in _ARRAYS}
    counts = np.array([[len(array) for array in column] for column in columns.values()]).T
    write_arrays(path, {"counts": counts, **{name: np.concatenate(column) for name, column in columns.items()}})
    return parts
