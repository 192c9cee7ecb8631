"""Lamps that stand, sit, hang and cling, and candles."""

from __future__ import annotations

from diorama_core.library.furniture.lighting import (
    candles,
    ceiling_lamps,
    chandeliers,
    desk_lamps,
    floor_lamps,
    table_lamps,
    wall_lamps,
)
from diorama_core.library.furniture.model import designs_of

DESIGNS = designs_of(table_lamps, desk_lamps, floor_lamps, ceiling_lamps, chandeliers, wall_lamps, candles)
