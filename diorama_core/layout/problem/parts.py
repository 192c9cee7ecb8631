"""Convex parts of library shapes: computed once per shape, kept in memory and on disk."""

from __future__ import annotations

import os
import tempfile
import threading
from pathlib import Path

import numpy as np

from diorama_core.geometry.convex import ConvexPart, convex_parts
from diorama_core.library.catalogue import default_cache_dir
from diorama_core.library.record import Shape, ShapeLibrary

VERSION = 6
"""Of the decomposition: raise it when `convex_parts` changes, so that files of older versions are not read."""

_KNOWN: dict[str, tuple[ConvexPart, ...]] = {}
_LOCK = threading.Lock()


def parts_of_shape(library: ShapeLibrary, shape: Shape) -> tuple[ConvexPart, ...]:
    """Convex bodies that together contain the shape, in its canonical frame at scale 1.

    They follow from the geometry alone, so they are kept under its content hash; a shape without one is decomposed
    anew each time.
    """
    key = shape.content_hash
    if not key:
        return convex_parts(library.mesh(shape.id))
    with _LOCK:
        known = _KNOWN.get(key)
    if known is None:
        path = default_cache_dir() / "parts" / f"{key}-{VERSION}.npz"
        known = _read(path)
        if known is None:
            known = convex_parts(library.mesh(shape.id))
            _write(path, known)
        with _LOCK:
            _KNOWN[key] = known
    return known


def _read(path: Path) -> tuple[ConvexPart, ...] | None:
    try:
        with np.load(path) as stored:
            count = int(stored["count"])
            return tuple(
                ConvexPart(stored[f"vertices_{k}"], stored[f"normals_{k}"], stored[f"edges_{k}"]) for k in range(count)
            )
    except (OSError, ValueError, KeyError, EOFError):
        return None


def _write(path: Path, parts: tuple[ConvexPart, ...]) -> None:
    """Keep parts for the next start; where the cache cannot be written they are only kept in memory."""
    arrays = {f"{name}_{k}": getattr(q, name) for k, q in enumerate(parts) for name in ("vertices", "normals", "edges")}
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".tmp", delete=False) as file:
            np.savez(file, count=len(parts), **arrays)
        os.replace(file.name, path)
    except OSError:
        return
