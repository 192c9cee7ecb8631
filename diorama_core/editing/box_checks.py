"""Boxes of a photo before anything is built of them: doubled ones are merged, absurd sizes are told."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diorama_core.artefacts import Box, LabelledBox
from diorama_core.geometry.openings import DOOR
from diorama_core.library.kinds import MAX_SIGMAS, OFF_ANYWAY, sizes_of_kind
from diorama_core.library.taxonomy import category, with_kin

SAME_SHARE = 0.7
"""Boxes that share so much of both together are of one object, whatever they are called."""
WITHIN_SHARE = 0.8
"""A box of a kindred kind that is within another by so much of itself is a piece of that object."""
PIECE_SHARE = 0.3
"""A piece of an object has at least so much of its area."""
HEIGHT = 2
"""Axis of the height among a kind's sizes."""


def merge_boxes(boxes: Sequence[LabelledBox]) -> tuple[LabelledBox, ...]:
    """The boxes, likeliest first, without those that show an object that a box before them shows."""
    kept: list[LabelledBox] = []
    for box in boxes:
        if not any(_is_same(box, other) for other in kept):
            kept.append(box)
    return tuple(kept)


def too_tall(boxes: Sequence[LabelledBox]) -> tuple[tuple[int, float], ...]:
    """Indices of boxes that are taller than their kind can be, with the least height they would have in metres.

    A box that ends higher in the picture than another one stands farther away, so it shows a metre no larger: what
    stands on the floor can be measured by everything that stands nearer, in its least usual height.
    """
    on_floor = [k for k, b in enumerate(boxes) if category(b.category).mount == "floor" or b.category == DOOR]
    excesses = []
    for k in on_floor:
        nearer = [j for j in on_floor if j != k and boxes[j].box[3] >= boxes[k].box[3] - 1.0]
        least = [_height_px(boxes[k].box) / _height_px(boxes[j].box) * _heights_m(boxes[j].category)[0] for j in nearer]
        tallest = _heights_m(boxes[k].category)[1]
        # One box that is cut off or misnamed would accuse all others: two must say so, or the only other one.
        agreed = sorted(least, reverse=True)[min(1, len(least) - 1)] if least else 0.0
        if agreed > tallest:
            excesses.append((k, agreed))
    return tuple(excesses)


def _heights_m(kind: str) -> tuple[float, float]:
    """A small height of a kind, which four of five things exceed, and the greatest that one has."""
    low, high = [], []
    for mode in sizes_of_kind(kind):
        sigma = float(np.sqrt(mode.covariance[HEIGHT, HEIGHT]))
        low.append(float(np.exp(mode.log_size[HEIGHT] - sigma)))
        high.append(float(np.exp(mode.log_size[HEIGHT] + MAX_SIGMAS * sigma + OFF_ANYWAY)))
    return min(low), max(high)


def _height_px(box: Box) -> float:
    return max(box[3] - box[1], 1.0)


def _is_same(box: LabelledBox, other: LabelledBox) -> bool:
    x1, y1, x2, y2 = (f(a, b) for f, a, b in zip((max, max, min, min), box.box, other.box, strict=True))
    shared = max(x2 - x1, 0.0) * max(y2 - y1, 0.0)
    area, others = _area(box.box), _area(other.box)
    if shared >= SAME_SHARE * (area + others - shared):
        return True
    kindred = box.category in with_kin(other.category) or other.category in with_kin(box.category)
    related = kindred or bool({box.category, other.category} & set(category(box.category).related or ()))
    alike = min(area, others) >= PIECE_SHARE * max(area, others)  # what is much smaller stands before it
    return related and alike and shared >= WITHIN_SHARE * min(area, others)


def _area(box: Box) -> float:
    return max(box[2] - box[0], 0.0) * max(box[3] - box[1], 0.0)
