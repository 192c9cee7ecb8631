"""Masks of objects one over another as one map of numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Int32

from diorama_core.errors import InputError

MAX_STACKED = 500


@dataclass(frozen=True, eq=False)
class MaskMap:
    """A number for the object at each pixel, 0 for none, and what was understood."""

    values: Int32[np.ndarray, "h w"]
    notes: tuple[str, ...] = ()


def painted(masks: Sequence[Bool[np.ndarray, "_ _"]], name: str, what: str) -> MaskMap:
    """Overlapping masks as one map, smaller ones in front.

    Args:
        masks: of one size.
        name: of the file or folder.
        what: the masks are, for messages.

    Raises:
        InputError: they have different sizes, or are none or too many.
    """
    if not masks:
        raise InputError(f"{name}: holds no mask; give a PNG with one colour for each object, or one file for each")
    if len(masks) > MAX_STACKED:
        raise InputError(f"{name}: {len(masks)} masks are more than the {MAX_STACKED} accepted; keep the furniture")
    sizes = sorted({m.shape for m in masks})
    if len(sizes) > 1:
        shown = ", ".join(f"{w} x {h}" for h, w in sizes[:3])
        raise InputError(f"{name}: its {what} have different sizes ({shown}); give masks of this very photo")
    areas = [int(np.count_nonzero(m)) for m in masks]
    values = np.zeros(sizes[0], np.int32)
    for number in sorted(range(len(masks)), key=lambda k: -areas[k]):
        values[masks[number]] = number + 1
    overlap = sum(areas) - int(np.count_nonzero(values))
    over = "; where they overlap the smaller one is in front" if overlap > 0 else ""
    return MaskMap(values, (f"{name}: {len(masks)} {what}, one object each{over}",))
