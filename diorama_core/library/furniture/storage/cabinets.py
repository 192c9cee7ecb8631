"""Cupboards and cabinets."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *

DESIGNS: tuple[Design, ...] = (
    design("cabinet", "two-door-white", "white two-door cabinet", (0.42, 0.82, 0.90), "minimal", case, body=m.WHITE, bays=["pair"], base="plinth", base_h=0.07),
    design("cabinet", "shaker-navy", "navy cabinet with panelled doors", (0.45, 0.95, 1.05), "classic", case, body=m.NAVY, bays=["pair"], panel="shaker", handle="knob", pull=m.BRASS, top=m.OAK, base="plinth", base_h=0.08),
    design("cabinet", "cane-oak", "oak cabinet with cane doors", (0.42, 0.90, 1.10), "modern", case, body=m.LIGHT_OAK, bays=["pair"], panel="shaker", infill=m.RATTAN, base="splay", base_h=0.18, handle="knob", pull=m.BRASS),
    design("cabinet", "slatted", "pine cupboard with louvred doors", (0.42, 0.80, 1.20), "rustic", case, body=m.PINE, bays=["pair"], panel="slats", base="plinth", base_h=0.07, handle="knob", pull=m.IRON),
)  # fmt: skip
