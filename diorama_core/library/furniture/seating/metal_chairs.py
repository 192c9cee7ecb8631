"""Chairs of steel: pressed café chairs and cantilevers."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.seating.wooden_chairs import curved_back


def metal_cafe_chair(size: Size, colour: Material, seat: Material | None) -> Parts:
    """A pressed-steel café chair with a bent tube back."""
    d, w, h = size
    seat_z = 0.45
    parts = of(colour, prism(superellipse(d * 0.74, w * 0.82, 6, 32), 0.022, 0.008).moved(0.04, 0, seat_z - 0.022))
    if seat is not None:
        parts += of(seat, prism(superellipse(d * 0.74, w * 0.84, 6, 32), 0.02, 0.007).moved(0.04, 0, seat_z))
    parts += of(colour, *both_sides(taper((d * 0.47, w * 0.46, 0), (d * 0.36, w * 0.34, seat_z - 0.01), 0.022, 0.044)))
    parts += of(
        colour, *both_sides(taper((-d * 0.44, w * 0.46, 0), (-d * 0.27, w * 0.34, seat_z - 0.01), 0.022, 0.044))
    )
    hoop = bend(
        [
            (-0.26 * d, 0.36 * w, seat_z - 0.02),
            (-0.36 * d, 0.41 * w, seat_z + 0.22),
            (-0.42 * d, 0.36 * w, h - 0.07),
            (-0.44 * d, 0.2 * w, h - 0.012),
            (-0.44 * d, 0, h - 0.01),
            (-0.44 * d, -0.2 * w, h - 0.012),
            (-0.42 * d, -0.36 * w, h - 0.07),
            (-0.36 * d, -0.41 * w, seat_z + 0.22),
            (-0.26 * d, -0.36 * w, seat_z - 0.02),
        ],
        5,
    )
    splat = curved_back(0.13, h - seat_z - 0.02, 0.0, 0.006, 0.17 * d).moved(-0.27 * d, 0, seat_z - 0.005)
    rails = both_sides(rod((0.4 * d, 0.40 * w, 0.2), (-0.36 * d, 0.40 * w, 0.2), 0.007))
    return parts + of(colour, tube(hoop, 0.012), splat, *rails)


def cantilever_chair(size: Size, frame: Material, web: Material) -> Parts:
    """Bent steel tube with a cane or leather seat and back."""
    d, w, h = size
    half, seat_z = w / 2 - 0.014, 0.445
    path = [
        (-0.46 * d, half, 0.013),
        (0.38 * d, half, 0.013),
        (0.475 * d, half, 0.06),
        (0.475 * d, half, seat_z - 0.06),
        (0.40 * d, half, seat_z),
        (-0.28 * d, half, seat_z - 0.012),
        (-0.36 * d, half, seat_z + 0.06),
        (-0.47 * d, half, h - 0.01),
    ]
    dense = np.concatenate([np.linspace(a, b, 5, endpoint=False) for a, b in pairwise(path)] + [np.array([path[-1]])])
    seat = box((0.62 * d, w - 0.05, 0.026), 0.011, 2).moved(0.04 * d, 0, seat_z - 0.014)
    back = curved_back(w - 0.02, 0.24, 0.0, 0.024, 0.05).moved(-0.41 * d, 0, h - 0.245)
    base = rod((-0.46 * d, half, 0.013), (-0.46 * d, -half, 0.013), 0.012)
    return of(frame, *both_sides(tube(bend(dense, 2), 0.0125)), base) + of(web, seat, back)


DESIGNS: tuple[Design, ...] = (
    design("chair", "cafe-steel", "pressed-steel café chair", (0.49, 0.45, 0.85), "industrial", metal_cafe_chair, colour=m.BLACK_STEEL, seat=None),
    design("chair", "cafe-wood-seat", "steel café chair with an oak seat", (0.50, 0.46, 0.84), "industrial", metal_cafe_chair, colour=m.IRON, seat=m.OAK),
    design("chair", "cantilever-cane", "chrome cantilever chair with cane seat and back", (0.57, 0.47, 0.82), "modern", cantilever_chair, frame=m.CHROME, web=m.RATTAN),
    design("chair", "cantilever-black", "cantilever chair in black leather", (0.58, 0.50, 0.86), "modern", cantilever_chair, frame=m.CHROME, web=m.BLACK_LEATHER),
)  # fmt: skip
