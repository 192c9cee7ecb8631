"""Console tables."""

from __future__ import annotations

from functools import partial

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.tables.coffee_tables import box_table
from diorama_core.library.furniture.tables.tops import frame_table, leg_table

DESIGNS: tuple[Design, ...] = (
    Design(
        "console-table-slim-oak",
        "console table",
        "slim oak console table",
        (0.34, 1.10, 0.80),
        "minimal",
        partial(leg_table, top=m.OAK, legs=m.OAK, shape="square", apron=0.07),
        2,
    ),
    Design(
        "console-table-steel",
        "console table",
        "steel console table with a shelf",
        (0.35, 1.20, 0.78),
        "industrial",
        partial(frame_table, top=m.RECLAIMED, frame=m.BLACK_STEEL, shelf=m.RECLAIMED),
        2,
    ),
    Design(
        "console-table-drawers",
        "console table",
        "painted console table with drawers",
        (0.38, 1.05, 0.79),
        "classic",
        partial(box_table, wood=m.SAGE, top=m.OAK, drawers=3, pull=m.BRASS),
    ),
    Design(
        "console-table-marble-brass",
        "console table",
        "marble console table on brass legs",
        (0.36, 1.15, 0.77),
        "modern",
        partial(frame_table, top=m.MARBLE, frame=m.BRASS),
        2,
    ),
)
