"""Coffee tables."""

from __future__ import annotations

from functools import partial

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.carcass import drawer_front
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Design, Parts, Size, four, of
from diorama_core.library.furniture.solids import box, taper
from diorama_core.library.furniture.tables.side_tables import block_table
from diorama_core.library.furniture.tables.tops import (
    frame_table,
    glass_table,
    hairpin_table,
    leg_table,
    pedestal_table,
)


def box_table(size: Size, wood: Material, top: Material, drawers: int, pull: Material) -> Parts:
    """A coffee or console table with drawers in a box on short legs."""
    d, w, h = size
    case = 0.15
    parts = of(
        wood,
        box((d - 0.02, w - 0.02, case), 0.005).moved(z=h - case - 0.022),
        *four(taper((d / 2 - 0.045, w / 2 - 0.045, 0), (d / 2 - 0.045, w / 2 - 0.045, h - case), 0.03, 0.05)),
    )
    parts += of(top, box((d, w, 0.024), 0.006, 2).moved(z=h - 0.024))
    each = (w - 0.05) / drawers
    for k in range(drawers):
        y = -w / 2 + 0.025 + each * (k + 0.5)
        parts += drawer_front(d / 2 - 0.012, y, h - case - 0.012, each - 0.008, case - 0.02, wood, pull, "knob")
    return parts


DESIGNS: tuple[Design, ...] = (
    Design(
        "coffee-table-oak-shelf",
        "coffee table",
        "oak coffee table with a lower shelf",
        (0.60, 1.10, 0.45),
        "classic",
        partial(leg_table, top=m.OAK, legs=m.OAK, shape="square", apron=0.06, shelf=m.OAK),
        2,
    ),
    Design(
        "coffee-table-walnut-oval",
        "coffee table",
        "oval walnut coffee table",
        (0.65, 1.20, 0.40),
        "modern",
        partial(leg_table, top=m.WALNUT, legs=m.WALNUT, outline="oval", shape="splay", apron=0.0),
        2,
    ),
    Design(
        "coffee-table-glass",
        "coffee table",
        "glass coffee table with a brass frame",
        (0.65, 1.10, 0.42),
        "modern",
        partial(glass_table, frame=m.BRASS),
        2,
    ),
    Design(
        "coffee-table-steel-reclaimed",
        "coffee table",
        "reclaimed-wood coffee table in a steel frame",
        (0.65, 1.15, 0.43),
        "industrial",
        partial(frame_table, top=m.RECLAIMED, frame=m.BLACK_STEEL, shelf=m.RECLAIMED),
        2,
    ),
    Design(
        "coffee-table-round-drum",
        "coffee table",
        "round oak drum coffee table",
        (0.80, 0.80, 0.36),
        "minimal",
        partial(pedestal_table, top=m.LIGHT_OAK, foot=m.LIGHT_OAK, kind="drum"),
        36,
    ),
    Design(
        "coffee-table-marble-round",
        "coffee table",
        "round marble coffee table on black legs",
        (0.85, 0.85, 0.42),
        "modern",
        partial(hairpin_table, top=m.MARBLE, steel=m.BLACK_STEEL, outline="round"),
        4,
    ),
    Design(
        "coffee-table-drawers",
        "coffee table",
        "walnut coffee table with two drawers",
        (0.62, 1.15, 0.46),
        "classic",
        partial(box_table, wood=m.CHERRY, top=m.CHERRY, drawers=2, pull=m.BRASS),
    ),
    Design(
        "coffee-table-block",
        "coffee table",
        "low rounded wooden block table",
        (0.75, 0.95, 0.32),
        "minimal",
        partial(block_table, wood=m.DARK_WALNUT, groove=m.BLACK),
        2,
    ),
)
