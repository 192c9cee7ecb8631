"""Sofas that turn a corner."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.upholstery.cushions import seat_cushion
from diorama_core.library.furniture.upholstery.sofas import sofa


def corner_sofa(size: Size, cloth: Material, legs: Material) -> Parts:
    """An L-shaped sofa: a chaise at its left."""
    d, w, h = size
    body = 0.95
    chaise = 0.85
    main = sofa((body, w, h), cloth, legs, 3, "slim")
    parts = [p.moved(-d / 2 + body / 2) for p in main]
    y = w / 2 - chaise / 2
    length = d - body + 0.12
    pad = [s.moved(d / 2 - length / 2, y - 0.02, 0.29) for s in seat_cushion(length, chaise - 0.05, 0.15)]
    base = box((length + 0.04, chaise, 0.17), 0.02, 2).moved(d / 2 - length / 2 - 0.02, y, 0.13)
    feet = [
        taper(
            (d / 2 - 0.07, y + s * (chaise / 2 - 0.07), 0),
            (d / 2 - 0.07, y + s * (chaise / 2 - 0.07), 0.14),
            0.026,
            0.044,
        )
        for s in (1, -1)
    ]
    return parts + of(cloth, *pad, base) + of(legs, *feet)


DESIGNS: tuple[Design, ...] = (
    design("sectional sofa", "corner", "light grey corner sofa with a chaise", (1.60, 2.50, 0.82), "modern", corner_sofa, id="sofa-corner", cloth=m.LIGHT_FABRIC, legs=m.BLACK),
)  # fmt: skip
