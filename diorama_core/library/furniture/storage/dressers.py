"""Dressers and chests of drawers."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *

DESIGNS: tuple[Design, ...] = (
    design("dresser", "oak-six", "oak dresser with six drawers", (0.48, 1.40, 0.80), "modern", case, body=m.OAK, bays=["3", "3"], base="splay", base_h=0.16),
    design("dresser", "white-four", "white chest of four drawers", (0.46, 0.80, 1.00), "minimal", case, body=m.WHITE, bays=["4"], base="plinth", base_h=0.06, handle="none"),
    design("dresser", "mahogany", "mahogany chest of five drawers", (0.50, 0.92, 1.15), "classic", case, body=m.MAHOGANY, bays=["5"], handle="knob", pull=m.BRASS, base="legs", base_h=0.1, top=m.MAHOGANY),
    design("dresser", "tallboy", "tall narrow chest of drawers", (0.42, 0.56, 1.28), "modern", case, body=m.WALNUT, bays=["6"], base="legs", base_h=0.12),
    design("dresser", "cream-rustic", "cream painted dresser with an oak top", (0.48, 1.15, 0.86), "rustic", case, body=m.CREAM, bays=["3", "3"], handle="cup", pull=m.IRON, base="plinth", base_h=0.07, top=m.OAK),
    design("dresser", "industrial", "reclaimed-wood dresser on steel", (0.45, 1.20, 0.82), "industrial", case, body=m.RECLAIMED, bays=["2", "2", "2"], base="steel", base_h=0.14, legs=m.BLACK_STEEL, handle="cup"),
)  # fmt: skip
