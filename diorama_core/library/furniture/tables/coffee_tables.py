"""Coffee tables."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *
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
    design("coffee table", "oak-shelf", "oak coffee table with a lower shelf", (0.60, 1.10, 0.45), "classic", leg_table, 2, top=m.OAK, legs=m.OAK, shape="square", apron=0.06, shelf=m.OAK),
    design("coffee table", "walnut-oval", "oval walnut coffee table", (0.65, 1.20, 0.40), "modern", leg_table, 2, top=m.WALNUT, legs=m.WALNUT, outline="oval", shape="splay", apron=0.0),
    design("coffee table", "glass", "glass coffee table with a brass frame", (0.65, 1.10, 0.42), "modern", glass_table, 2, frame=m.BRASS),
    design("coffee table", "steel-reclaimed", "reclaimed-wood coffee table in a steel frame", (0.65, 1.15, 0.43), "industrial", frame_table, 2, top=m.RECLAIMED, frame=m.BLACK_STEEL, shelf=m.RECLAIMED),
    design("coffee table", "round-drum", "round oak drum coffee table", (0.80, 0.80, 0.36), "minimal", pedestal_table, 36, top=m.LIGHT_OAK, foot=m.LIGHT_OAK, kind="drum"),
    design("coffee table", "marble-round", "round marble coffee table on black legs", (0.85, 0.85, 0.42), "modern", hairpin_table, 4, top=m.MARBLE, steel=m.BLACK_STEEL, outline="round"),
    design("coffee table", "drawers", "walnut coffee table with two drawers", (0.62, 1.15, 0.46), "classic", box_table, wood=m.CHERRY, top=m.CHERRY, drawers=2, pull=m.BRASS),
    design("coffee table", "block", "low rounded wooden block table", (0.75, 0.95, 0.32), "minimal", block_table, 2, wood=m.DARK_WALNUT, groove=m.BLACK),
)  # fmt: skip
