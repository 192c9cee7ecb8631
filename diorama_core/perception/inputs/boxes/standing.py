"""Which way up the photo is, by what its things usually do: rugs lie low, ceiling lamps hang high."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diorama_core.artefacts import LabelledBox, Photo
from diorama_core.library.taxonomy import UNKNOWN, broad, category

_USUAL = {"ceiling": (0.18, 0.14), "wall": (0.38, 0.15), "floor": (0.64, 0.14), "rug": (0.8, 0.12)}
"""Mean and deviation of the height in the picture (0 top, 1 bottom) of the middle of what is so held."""
CERTAIN = 6.0
"""Logarithm of the likelihoods' ratio from which a turned photo is said to be one: four hundred to one."""


def is_upside_down(boxes: Sequence[LabelledBox], height: int) -> bool:
    """Whether things lie in the picture as they do in one that was turned by 180 degrees.

    Args:
        boxes: with names; those without say nothing.
        height: of the photo, pixels.
    """
    ratio = 0.0
    for box in boxes:
        if box.category == UNKNOWN.name:
            continue
        mount = "rug" if broad(box.category) == "rug" else category(box.category).mount
        if mount not in _USUAL:
            continue
        mean, deviation = _USUAL[mount]
        at = (box.box[1] + box.box[3]) / 2 / height
        ratio += ((at - mean) ** 2 - (1.0 - at - mean) ** 2) / (2 * deviation**2)
    return ratio > CERTAIN


def turned_box(marked: LabelledBox, photo: Photo) -> LabelledBox:
    """A box of a photo after that was turned by 180 degrees."""
    x1, y1, x2, y2 = marked.box
    return replace(marked, box=(photo.width - x2, photo.height - y2, photo.width - x1, photo.height - y1))
