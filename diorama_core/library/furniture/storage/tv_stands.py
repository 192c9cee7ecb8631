"""Media units, empty."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *

DESIGNS: tuple[Design, ...] = (
    design("tv stand", "oak-open", "oak media unit with open bays", (0.42, 1.50, 0.50), "modern", case, body=m.OAK, bays=["door", "open", "door"], base="splay", base_h=0.14, handle="none"),
    design("tv stand", "white-low", "low white television stand", (0.40, 1.60, 0.40), "minimal", case, body=m.WHITE, bays=["1", "1", "1"], handle="none", base="plinth", base_h=0.05),
    design("tv stand", "industrial", "reclaimed-wood media console on steel", (0.42, 1.40, 0.52), "industrial", case, body=m.RECLAIMED, bays=["open", "2", "open"], base="steel", base_h=0.13, legs=m.BLACK_STEEL, handle="cup"),
    design("tv stand", "walnut-slats", "walnut media unit with slatted doors", (0.44, 1.80, 0.48), "modern", case, body=m.WALNUT, bays=["door", "door", "door", "door"], panel="slats", base="legs", base_h=0.1, handle="none"),
    design("tv stand", "classic", "cherry television cabinet", (0.46, 1.25, 0.60), "classic", case, body=m.CHERRY, bays=["door", "open", "door"], panel="shaker", handle="knob", pull=m.BRASS, base="plinth", base_h=0.07, top=m.CHERRY),
)  # fmt: skip
