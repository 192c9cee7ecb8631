"""Chairs, stools and benches, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.seating import (
    bar_stools,
    benches,
    metal_chairs,
    moulded_chairs,
    office_chairs,
    stools,
    upholstered_chairs,
    wooden_chairs,
)

DESIGNS: tuple[Design, ...] = tuple(
    design
    for kind in (
        wooden_chairs,
        moulded_chairs,
        metal_chairs,
        upholstered_chairs,
        stools,
        benches,
        office_chairs,
        bar_stools,
    )
    for design in kind.DESIGNS
)
