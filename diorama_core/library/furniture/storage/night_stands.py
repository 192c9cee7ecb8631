"""Night stands, empty."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *

DESIGNS: tuple[Design, ...] = (
    design("night stand", "oak-drawers", "oak night stand with two drawers", (0.42, 0.48, 0.55), "modern", case, body=m.OAK, bays=["2"], base="splay", base_h=0.16),
    design("night stand", "white-open", "white night stand with an open shelf", (0.40, 0.45, 0.58), "minimal", case, body=m.WHITE, bays=["open"], front=m.WHITE, base="legs", base_h=0.14, legs=m.BIRCH),
    design("night stand", "walnut-knob", "walnut bedside cabinet with three drawers", (0.44, 0.50, 0.64), "classic", case, body=m.WALNUT, bays=["3"], base="plinth", base_h=0.06, handle="knob", pull=m.BRASS, top=m.WALNUT),
    design("night stand", "door-sage", "sage bedside cabinet with a panelled door", (0.40, 0.44, 0.62), "rustic", case, body=m.SAGE, bays=["door"], panel="shaker", handle="knob", pull=m.BRASS, top=m.OAK),
    design("night stand", "steel", "steel-legged night stand", (0.40, 0.46, 0.52), "industrial", case, body=m.RECLAIMED, bays=["2"], base="steel", base_h=0.18, legs=m.BLACK_STEEL, handle="cup"),
    design("night stand", "cane", "night stand with a cane door", (0.42, 0.48, 0.60), "modern", case, body=m.LIGHT_OAK, bays=["door"], panel="shaker", infill=m.RATTAN, base="splay", base_h=0.18, handle="knob", pull=m.BRASS),
)  # fmt: skip
