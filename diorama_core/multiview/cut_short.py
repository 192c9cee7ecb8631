"""Which edges of boxes bound their objects from below only: where something nearer may hide the rest.

A detector's box ends where an object stops being seen. In one photo a table behind chairs is as wide as its box; where
other photos show more of it, its box must not make it smaller.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import DetectedObject

STRIP, MIN_STRIP_PX = 0.06, 4
"""Depth of the strip outside an edge, as a share of the box across it."""
MIN_COVERED = 0.2
"""Share of the strip that nearer objects must cover."""
NEARER = 1.02
"""Something is nearer when it is less than so many times as far away: what stands before and beside is taken for it."""


def edges_cut_short(
    objects: Sequence[DetectedObject], boxes_px: Float[np.ndarray, "n 4"], distances_m: Float[np.ndarray, "n"]
) -> Bool[np.ndarray, "n 4"]:
    """For every object and edge (left, top, right, bottom) whether it may go on behind something nearer.

    Args:
        objects: of one photo.
        boxes_px: their boxes.
        distances_m: how far their middles are from the camera.
    """
    found = np.zeros((len(objects), 4), dtype=bool)
    for i, box in enumerate(boxes_px):
        near = [o.mask for j, o in enumerate(objects) if j != i and distances_m[j] < NEARER * distances_m[i]]
        if not near:
            continue
        before = np.any(near, axis=0) & ~objects[i].mask
        for edge, rows, columns in _strips(box, before.shape):
            strip = before[rows, columns]
            found[i, edge] = bool(strip.size) and strip.mean() >= MIN_COVERED
    return found


def _strips(box: Float[np.ndarray, "4"], shape: tuple[int, ...]) -> list[tuple[int, slice, slice]]:
    """The strips outside a box's edges, as far as they are in the picture."""
    x1, y1, x2, y2 = (round(float(v)) for v in box)
    wide, high = max(MIN_STRIP_PX, round(STRIP * (x2 - x1))), max(MIN_STRIP_PX, round(STRIP * (y2 - y1)))
    beside, across = slice(max(y1, 0), y2), slice(max(x1, 0), x2)
    return [
        (0, beside, slice(max(x1 - wide, 0), max(x1, 0))),
        (1, slice(max(y1 - high, 0), max(y1, 0)), across),
        (2, beside, slice(min(x2, shape[1]), x2 + wide)),
        (3, slice(min(y2, shape[0]), y2 + high), across),
    ]
