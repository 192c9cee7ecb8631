"""Media units, empty."""

from __future__ import annotations

from functools import partial

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.cases import case
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = (
    Design(
        "tv-stand-oak-open",
        "tv stand",
        "oak media unit with open bays",
        (0.42, 1.50, 0.50),
        "modern",
        partial(case, body=m.OAK, bays=["door", "open", "door"], base="splay", base_h=0.14, handle="none"),
    ),
    Design(
        "tv-stand-white-low",
        "tv stand",
        "low white television stand",
        (0.40, 1.60, 0.40),
        "minimal",
        partial(case, body=m.WHITE, bays=["1", "1", "1"], handle="none", base="plinth", base_h=0.05),
    ),
    Design(
        "tv-stand-industrial",
        "tv stand",
        "reclaimed-wood media console on steel",
        (0.42, 1.40, 0.52),
        "industrial",
        partial(
            case,
            body=m.RECLAIMED,
            bays=["open", "2", "open"],
            base="steel",
            base_h=0.13,
            legs=m.BLACK_STEEL,
            handle="cup",
        ),
    ),
    Design(
        "tv-stand-walnut-slats",
        "tv stand",
        "walnut media unit with slatted doors",
        (0.44, 1.80, 0.48),
        "modern",
        partial(
            case,
            body=m.WALNUT,
            bays=["door", "door", "door", "door"],
            panel="slats",
            base="legs",
            base_h=0.1,
            handle="none",
        ),
    ),
    Design(
        "tv-stand-classic",
        "tv stand",
        "cherry television cabinet",
        (0.46, 1.25, 0.60),
        "classic",
        partial(
            case,
            body=m.CHERRY,
            bays=["door", "open", "door"],
            panel="shaker",
            handle="knob",
            pull=m.BRASS,
            base="plinth",
            base_h=0.07,
            top=m.CHERRY,
        ),
    ),
)
