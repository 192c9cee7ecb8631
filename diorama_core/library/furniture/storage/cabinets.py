"""Cupboards and cabinets."""

from __future__ import annotations

from functools import partial

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.cases import case
from diorama_core.library.furniture.model import Design

DESIGNS: tuple[Design, ...] = (
    Design(
        "cabinet-two-door-white",
        "cabinet",
        "white two-door cabinet",
        (0.42, 0.82, 0.90),
        "minimal",
        partial(case, body=m.WHITE, bays=["pair"], base="plinth", base_h=0.07),
    ),
    Design(
        "cabinet-shaker-navy",
        "cabinet",
        "navy cabinet with panelled doors",
        (0.45, 0.95, 1.05),
        "classic",
        partial(
            case,
            body=m.NAVY,
            bays=["pair"],
            panel="shaker",
            handle="knob",
            pull=m.BRASS,
            top=m.OAK,
            base="plinth",
            base_h=0.08,
        ),
    ),
    Design(
        "cabinet-cane-oak",
        "cabinet",
        "oak cabinet with cane doors",
        (0.42, 0.90, 1.10),
        "modern",
        partial(
            case,
            body=m.LIGHT_OAK,
            bays=["pair"],
            panel="shaker",
            infill=m.RATTAN,
            base="splay",
            base_h=0.18,
            handle="knob",
            pull=m.BRASS,
        ),
    ),
    Design(
        "cabinet-slatted",
        "cabinet",
        "pine cupboard with louvred doors",
        (0.42, 0.80, 1.20),
        "rustic",
        partial(
            case, body=m.PINE, bays=["pair"], panel="slats", base="plinth", base_h=0.07, handle="knob", pull=m.IRON
        ),
    ),
)
