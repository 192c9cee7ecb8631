"""Night stands, empty."""

from __future__ import annotations

from functools import partial

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.cases import case
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = (
    Design(
        "night-stand-oak-drawers",
        "night stand",
        "oak night stand with two drawers",
        (0.42, 0.48, 0.55),
        "modern",
        partial(case, body=m.OAK, bays=["2"], base="splay", base_h=0.16),
    ),
    Design(
        "night-stand-white-open",
        "night stand",
        "white night stand with an open shelf",
        (0.40, 0.45, 0.58),
        "minimal",
        partial(case, body=m.WHITE, bays=["open"], front=m.WHITE, base="legs", base_h=0.14, legs=m.BIRCH),
    ),
    Design(
        "night-stand-walnut-knob",
        "night stand",
        "walnut bedside cabinet with three drawers",
        (0.44, 0.50, 0.64),
        "classic",
        partial(case, body=m.WALNUT, bays=["3"], base="plinth", base_h=0.06, handle="knob", pull=m.BRASS, top=m.WALNUT),
    ),
    Design(
        "night-stand-door-sage",
        "night stand",
        "sage bedside cabinet with a panelled door",
        (0.40, 0.44, 0.62),
        "rustic",
        partial(case, body=m.SAGE, bays=["door"], panel="shaker", handle="knob", pull=m.BRASS, top=m.OAK),
    ),
    Design(
        "night-stand-steel",
        "night stand",
        "steel-legged night stand",
        (0.40, 0.46, 0.52),
        "industrial",
        partial(case, body=m.RECLAIMED, bays=["2"], base="steel", base_h=0.18, legs=m.BLACK_STEEL, handle="cup"),
    ),
    Design(
        "night-stand-cane",
        "night stand",
        "night stand with a cane door",
        (0.42, 0.48, 0.60),
        "modern",
        partial(
            case,
            body=m.LIGHT_OAK,
            bays=["door"],
            panel="shaker",
            infill=m.RATTAN,
            base="splay",
            base_h=0.18,
            handle="knob",
            pull=m.BRASS,
        ),
    ),
)
