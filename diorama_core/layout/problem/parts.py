"""Convex parts of library shapes, computed once per shape and cached in memory and on disk.

Those of the built-in shapes come along (`assets/shapes`): to decompose all of them takes minutes.
"""

from __future__ import annotations

import hashlib
import logging
from collections.abc import Mapping
from functools import cache, partial
from pathlib import Path

import numpy as np
import trimesh
from jaxtyping import Float, Int

from diorama_core.geometry.convex import convex_parts
from diorama_core.geometry.packed_parts import NAMES, PackedParts, Parts, packed
from diorama_core.io.assets import asset
from diorama_core.io.cache import LruCache
from diorama_core.io.derived import read_arrays, write_arrays
from diorama_core.layout.problem.clear_places import clear_of_places
from diorama_core.library import taxonomy
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary

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
    if not key:
        return clear_of_places(convex_parts(mesh()), shape.surfaces, mesh, carries=_carries(shape))
    return _CACHE.get(
        key, lambda: clear_of_places(_known(key) or _made(key, mesh()), shape.surfaces, mesh, carries=_carries(shape))
    )


def _carries(shape: Shape) -> bool:
    """Whether people put things on a shape of its kind, and nobody sits there."""
    kind = taxonomy.resolve(shape.category).category
    return kind.supports_objects and kind.seat_height_m is None


def parts_of_solids(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]) -> Parts:
    """Convex bodies that together contain a mesh that is no shape of a library, such as one moving part of it."""
    key = solids_key(vertices, faces)
    return _CACHE.get(key, lambda: _known(key) or _made(key, trimesh.Trimesh(vertices, faces, process=False)))


def solids_key(vertices: Float[np.ndarray, "v 3"], faces: Int[np.ndarray, "f 3"]) -> str:
    """Names a mesh that is no shape of a library by what it is."""
    return hashlib.sha256(np.round(vertices, 7).tobytes() + faces.astype(np.int64).tobytes()).hexdigest()[:24]


def is_built_in(shape: Shape) -> bool:
    """Whether the convex bodies of a shape come along."""
    return shape.content_hash in _built_in()


def are_cached(shape: Shape) -> bool:
    """Whether the convex bodies of a shape need not be computed."""
    return is_built_in(shape) or (bool(shape.content_hash) and _path(shape.content_hash).is_file())


@cache
def _built_in() -> Mapping[str, Parts]:
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


def _known(key: str) -> Parts | None:
    return _built_in().get(key) or _read(_path(key)).get(key)


def _made(key: str, mesh: trimesh.Trimesh) -> Parts:
    """Decomposed, and read back, so that a shape has the same parts whether they were computed or read."""
    arrays = packed({key: convex_parts(mesh)})
    write_arrays(_path(key), arrays)
    return PackedParts(*arrays.values())[key]
