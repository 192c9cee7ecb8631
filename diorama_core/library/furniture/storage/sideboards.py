"""Sideboards."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *

DESIGNS: tuple[Design, ...] = (
    design("sideboard", "walnut-long", "long walnut sideboard", (0.45, 1.75, 0.72), "modern", case, body=m.WALNUT, bays=["door", "3", "door"], base="splay", base_h=0.18, handle="knob", pull=m.BRASS),
    design("sideboard", "oak-classic", "oak sideboard with panelled doors", (0.48, 1.50, 0.88), "classic", case, body=m.OAK, bays=["door", "2", "2", "door"], panel="shaker", handle="knob", pull=m.BRASS, base="legs", base_h=0.12, top=m.OAK),
    design("sideboard", "white-minimal", "white sideboard without handles", (0.42, 1.60, 0.74), "minimal", case, body=m.WHITE, bays=["door", "door", "door"], handle="none", base="plinth", base_h=0.06),
    design("sideboard", "rustic", "reclaimed-wood sideboard", (0.46, 1.40, 0.82), "rustic", case, body=m.RECLAIMED, bays=["pair", "3"], panel="shaker", handle="cup", pull=m.IRON, base="plinth", base_h=0.07),
    design("sideboard", "cane", "black sideboard with cane doors", (0.44, 1.55, 0.78), "modern", case, body=m.BLACK_WOOD, bays=["door", "door", "door"], panel="shaker", infill=m.RATTAN, base="steel", base_h=0.16, legs=m.BLACK_STEEL, handle="knob", pull=m.BRASS),
)  # fmt: skip
