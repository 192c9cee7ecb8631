"""Reclining armchairs."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.upholstery.sofas import sofa

DESIGNS: tuple[Design, ...] = (
    design("recliner", "recliner", "black leather armchair with padded arms", (0.95, 0.98, 0.98), "modern", sofa, id="armchair-recliner", cloth=m.BLACK_LEATHER, legs=m.BLACK, seats=1, arms="pillow", plinth_base=True, seat_h=0.47),
)  # fmt: skip
