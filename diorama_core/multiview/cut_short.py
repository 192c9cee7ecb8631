"""Which edges of boxes bound their objects from below only: where something nearer may hide the rest.

A detector's box ends where an object stops being seen. In one photo a table behind chairs is as wide as its box; where
other photos show more of it, its box must not make it smaller.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from diorama_core.artefacts import DetectedObject
from diorama_core.multiview.settings import SETTINGS, JoiningSettings


def edges_cut_short(
    objects: Sequence[DetectedObject],
    boxes_px: Float[np.ndarray, "n 4"],
    distances_m: Float[np.ndarray, "n"],
    settings: JoiningSettings = SETTINGS,
) -> Bool[np.ndarray, "n 4"]:
    """For every object and edge (left, top, right, bottom) whether it may go on behind something nearer.

    Args:
        objects: of one photo.
        boxes_px: their boxes.
        distances_m: how far their middles are from the camera.
        settings: numbers to work with.
    """
    found = np.zeros((len(objects), 4), dtype=bool)
    for i, box in enumerate(boxes_px):
        near = [o.mask for j, o in enumerate(objects) if j != i and distances_m[j] < settings.nearer * distances_m[i]]
        if not near:
            continue
        before = np.any(near, axis=0) & ~objects[i].mask
        for edge, rows, columns in _strips(box, before.shape, settings):
            strip = before[rows, columns]
            found[i, edge] = bool(strip.size) and strip.mean() >= settings.min_covered
    return found


def _strips(
    box: Float[np.ndarray, "4"], shape: tuple[int, ...], settings: JoiningSettings = SETTINGS
) -> list[tuple[int, slice, slice]]:
    """The strips outside a box's edges, as far as they are in the picture."""
    x1, y1, x2, y2 = (round(float(v)) for v in box)
    wide, high = (max(settings.min_strip_px, round(settings.strip * side)) for side in (x2 - x1, y2 - y1))
    beside, across = slice(max(y1, 0), y2), slice(max(x1, 0), x2)
    return [
        (0, beside, slice(max(x1 - wide, 0), max(x1, 0))),
        (1, slice(max(y1 - high, 0), max(y1, 0)), across),
        (2, beside, slice(min(x2, shape[1]), x2 + wide)),
        (3, slice(min(y2, shape[0]), y2 + high), across),
    ]
