"""Reclining armchairs."""

from __future__ import annotations

from functools import partial

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.model import Design
from diorama_core.library.furniture.upholstery.sofas import sofa

DESIGNS: tuple[Design, ...] = (
    Design(
        "armchair-recliner",
        "recliner",
        "black leather armchair with padded arms",
        (0.95, 0.98, 0.98),
        "modern",
        partial(sofa, cloth=m.BLACK_LEATHER, legs=m.BLACK, seats=1, arms="pillow", plinth_base=True, seat_h=0.47),
    ),
)
