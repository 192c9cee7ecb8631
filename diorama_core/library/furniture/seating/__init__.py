"""Chairs, stools and benches, one module a kind."""

from __future__ import annotations

from diorama_core.library.furniture.model import designs_of
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

DESIGNS = designs_of(
    wooden_chairs,
    moulded_chairs,
    metal_chairs,
    upholstered_chairs,
    bentwood_chairs,
    tub_chairs,
    stools,
    small_stools,
    bar_stools,
    bar_chairs,
    benches,
    styled_benches,
    office_chairs,
    desk_chairs,
)
