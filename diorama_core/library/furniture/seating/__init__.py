"""Chairs, stools and benches, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.seating import (
    bar_chairs,
    bar_stools,
    benches,
    bentwood_chairs,
    desk_chairs,
    metal_chairs,
    moulded_chairs,
    office_chairs,
    small_stools,
    stools,
    styled_benches,
    tub_chairs,
    upholstered_chairs,
    wooden_chairs,
)

KINDS = (
    *(wooden_chairs, moulded_chairs, metal_chairs, upholstered_chairs, bentwood_chairs, tub_chairs),
    *(stools, small_stools, bar_stools, bar_chairs, benches, styled_benches, office_chairs, desk_chairs),
)
DESIGNS: tuple[Design, ...] = tuple(design for kind in KINDS for design in kind.DESIGNS)
