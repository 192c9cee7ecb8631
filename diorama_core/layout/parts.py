"""Convex parts of library shapes, computed once per shape and kept."""

from __future__ import annotations

import threading

from diorama_core.geometry.convex import ConvexPart, convex_parts
from diorama_core.library.record import Shape, ShapeLibrary

_KNOWN: dict[str, tuple[ConvexPart, ...]] = {}
_LOCK = threading.Lock()


def parts_of_shape(library: ShapeLibrary, shape: Shape) -> tuple[ConvexPart, ...]:
    """Convex bodies that together contain the shape, in its canonical frame at scale 1.

    They follow from the geometry alone, so they are kept for the life of the process under its content hash; a
    shape without one is decomposed anew.
    """
    key = shape.content_hash
    with _LOCK:
        known = _KNOWN.get(key) if key else None
    if known is None:
        known = convex_parts(library.mesh(shape.id))
        if key:
            with _LOCK:
                _KNOWN[key] = known
    return known
