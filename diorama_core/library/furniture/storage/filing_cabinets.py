"""Filing cabinets."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def filing_cabinet(size: Size, steel: Material, drawers: int) -> Parts:
    """A steel filing cabinet with label holders."""
    d, w, h = size
    cavity = Cavity((d - 0.03, w, h - 0.02), (-0.012, 0, 0.02), wall=0.012)
    parts = cavity.body(steel, 0.006, 2) + of(steel, box((d - 0.08, w - 0.05, 0.03), 0.002))
    each = (h - 0.05) / drawers
    for k in range(drawers):
        z = 0.035 + each * k
        space = cavity.behind(0, z, w - 0.02, each - 0.008)
        front = drawer_front(d / 2 - 0.027, 0, z, w - 0.02, each - 0.008, steel, m.STEEL, "cup", space)
        label = of(m.WHITE, box((0.003, 0.07, 0.03), 0.001).moved(d / 2 - 0.008, 0, z + each * 0.72))
        parts += on_front(front, label)
    return parts


DESIGNS: tuple[Design, ...] = (
    design("filing cabinet", "filing", "grey steel filing cabinet", (0.60, 0.46, 1.02), "industrial", filing_cabinet, id="cabinet-filing", steel=m.LIGHT_GREY, drawers=3),
    design("filing cabinet", "low-filing", "white pedestal on castors' plinth", (0.55, 0.42, 0.60), "minimal", filing_cabinet, id="cabinet-low-filing", steel=m.WHITE, drawers=3),
)  # fmt: skip
