"""Boxes, baskets, bins and luggage."""

from __future__ import annotations

from diorama_core.library.furniture.containers import baskets, bins, boxes, luggage
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        boxes,
        baskets,
        bins,
        luggage,
    )
    for design in kind.DESIGNS
)
