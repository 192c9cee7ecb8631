"""Flat parts of a scene file that are pieces of the thing they lie on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from diorama_core.importing.part import Part

FLAT_M = 1e-3
FLUSH_M = 0.03
"""So near to a face a flat part lies on it."""
MIN_SHARE = 0.3
"""Smallest covered share of a face; a mat on a table covers less and is an object of its own."""


def joined_flat_parts(parts: Sequence[Part]) -> tuple[Part, ...]:
    """The parts, those without thickness that cover a face of another one (not its foot) joined to it."""
    bounds = [p.whole.bounds for p in parts]
    owners = {k: owner for k in range(len(parts)) if (owner := _owner(k, bounds)) is not None}
    joined = []
    for index, part in enumerate(parts):
        pieces = [parts[k] for k, owner in owners.items() if owner == index]
        if index not in owners:
            joined.append(_with_pieces(part, pieces) if pieces else part)
    return tuple(joined)


def _owner(index: int, bounds: Sequence[Float[np.ndarray, "2 3"]]) -> int | None:
    """The part whose face a flat part covers most of."""
    low, high = bounds[index]
    axis = int((high - low).argmin())
    if (high - low)[axis] > FLAT_M:
        return None
    across = [k for k in range(3) if k != axis]
    found = []
    for other, (below, above) in enumerate(bounds):
        if other == index or (above - below)[axis] <= FLAT_M:
            continue
        faces = [above[axis]] if axis == 2 else [below[axis], above[axis]]
        flush = any(abs(low[axis] - face) < FLUSH_M for face in faces)
        inside = (low[across] > below[across] - FLUSH_M).all() and (high[across] < above[across] + FLUSH_M).all()
        share = float(np.prod((high - low)[across]) / max(np.prod((above - below)[across]), 1e-12))
        if flush and inside and share > MIN_SHARE:
            found.append((share, other))
    return max(found)[1] if found else None


def _with_pieces(part: Part, pieces: Sequence[Part]) -> Part:
    scene = part.scene.copy()
    for piece in pieces:
        for node in piece.scene.graph.nodes_geometry:
            T, name = piece.scene.graph[node]
            scene.add_geometry(piece.scene.geometry[name], node_name=str(node), geom_name=str(name), transform=T)
    key = None if part.key is None else " ".join([part.key, *(str(p.key) for p in pieces)])
    return replace(part, scene=scene, key=key)
