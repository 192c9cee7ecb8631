"""Console tables."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.tables.coffee_tables import box_table
from diorama_core.library.furniture.tables.tops import frame_table, leg_table

DESIGNS: tuple[Design, ...] = (
    design("console table", "slim-oak", "slim oak console table", (0.34, 1.10, 0.80), "minimal", leg_table, 2, top=m.OAK, legs=m.OAK, shape="square", apron=0.07),
    design("console table", "steel", "steel console table with a shelf", (0.35, 1.20, 0.78), "industrial", frame_table, 2, top=m.RECLAIMED, frame=m.BLACK_STEEL, shelf=m.RECLAIMED),
    design("console table", "drawers", "painted console table with drawers", (0.38, 1.05, 0.79), "classic", box_table, wood=m.SAGE, top=m.OAK, drawers=3, pull=m.BRASS),
    design("console table", "marble-brass", "marble console table on brass legs", (0.36, 1.15, 0.77), "modern", frame_table, 2, top=m.MARBLE, frame=m.BRASS),
)  # fmt: skip
