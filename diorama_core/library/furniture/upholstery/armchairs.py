"""Armchairs."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.upholstery.cushions import back_cushion, seat_cushion
from diorama_core.library.furniture.upholstery.sofas import sofa


def wing_chair(size: Size, cloth: Material, legs: Material) -> Parts:
    """A tall armchair with wings."""
    d, w, h = size
    parts = sofa((d, w, h * 0.80), cloth, legs, 1, "rolled", seat_h=0.46)
    back = box((0.14, w - 0.2, h - 0.46), 0.06, 3).turned("y", -7).moved(-d / 2 + 0.13, 0, 0.44)
    wing = cushion((0.34, 0.075, h - 0.62), 4.5, 4.0, 12).moved(-d / 2 + 0.22, w / 2 - 0.10, 0.6)
    pad = back_cushion(w - 0.26, h - 0.52, 0.15, 8).moved(-d / 2 + 0.14, 0, 0.46)
    return parts + of(cloth, back, *both_sides(wing), pad)


def barrel_chair(size: Size, cloth: Material, base: Material) -> Parts:
    """A round tub chair with a wrap-around back."""
    d, w, h = size
    t = np.linspace(-2.35, 2.35, 41)
    v = np.linspace(0, 1, 7)
    rise = 0.44 + (h - 0.44) * np.clip(np.cos(t / 2.35 * np.pi / 2), 0, 1) ** 0.7 * 0.85 + (h - 0.44) * 0.15
    a = np.pi - t
    r = 0.43
    x = (r * d * 1.03 * np.cos(a))[None, :] * (1 + 0.06 * v[:, None])
    y = (r * w * np.sin(a))[None, :] * (1 + 0.06 * v[:, None])
    z = 0.06 + (rise - 0.06)[None, :] * v[:, None]
    wall = slab(np.stack([x, y, z], axis=-1)[:, ::-1], 0.11)
    rolled = tube(np.stack([x[-1], y[-1], z[-1]], axis=1), 0.056, 10)
    ends = [ball(0.112).moved(x[-1, k], y[-1, k], z[-1, k] - 0.056) for k in (0, -1)]
    seat = [s.moved(0.05, 0, 0.3) for s in (cushion((d * 0.82, w * 0.80, 0.15), 2.6, 4, 14),)]
    drum = lathe([(r * 0.9 * d, 0.05), (r * 0.93 * d, 0.06), (r * 0.93 * d, 0.32), (r * 0.9 * d, 0.33)], 36)
    return of(cloth, wall, rolled, *ends, *seat, drum) + of(base, cylinder(0.36 * d, 0.055, 0.004, 36))


def lounge_chair(size: Size, cloth: Material, wood: Material) -> Parts:
    """An open wooden frame with a loose seat and back cushion."""
    d, w, h = size
    y = w / 2 - 0.03
    front, rear = d / 2 - 0.06, -d / 2 + 0.12
    legs = [
        taper((front + 0.03, y, 0), (front - 0.04, y, 0.56), 0.026, 0.042),
        taper((rear - 0.06, y, 0), (rear + 0.03, y, 0.58), 0.026, 0.042),
    ]
    rest = tube(
        bend([(rear - 0.06, y, 0.565), (0, y, 0.595), (front + 0.03, y, 0.57)], 6),
        [*np.linspace(0.016, 0.026, 7), *np.linspace(0.026, 0.016, 6)],
        10,
    )
    rails = [beam((front - 0.03, y, 0.33), (rear, y, 0.27), 0.024, 0.06)]
    cross = [
        beam((front - 0.04, -y, 0.32), (front - 0.04, y, 0.32), 0.03, 0.06),
        beam((rear + 0.02, -y, 0.27), (rear + 0.02, y, 0.27), 0.03, 0.05),
    ]
    slats = [
        rod((rear + 0.05, s, 0.34), (-d / 2 + 0.02, s, h - 0.02), 0.009, segments=8)
        for s in np.linspace(-0.6 * y, 0.6 * y, 5)
    ]
    top = beam((-d / 2 + 0.02, -0.72 * y, h - 0.03), (-d / 2 + 0.02, 0.72 * y, h - 0.03), 0.02, 0.05)
    post = both_sides(beam((rear + 0.06, 0.7 * y, 0.28), (-d / 2 + 0.02, 0.7 * y, h - 0.02), 0.03, 0.03))
    seat = turned(of(cloth, *seat_cushion(d * 0.76, 2 * y - 0.06, 0.13)), "y", -5)
    seat = [p.moved(0.06, 0, 0.33) for p in seat]
    back = back_cushion(2 * y - 0.09, h - 0.36, 0.14, 20).moved(-d / 2 + 0.18, 0, 0.39)
    return of(wood, *both_sides(*legs, rest, *rails), *cross, *slats, top, *post) + seat + of(cloth, back)


DESIGNS: tuple[Design, ...] = (
    design("armchair", "track-beige", "beige armchair with track arms", (0.86, 0.84, 0.84), "modern", sofa, cloth=m.BEIGE_FABRIC, legs=m.WALNUT, seats=1),
    design("armchair", "club-leather", "brown leather club chair", (0.88, 0.90, 0.80), "classic", sofa, cloth=m.BROWN_LEATHER, legs=m.DARK_WALNUT, seats=1, arms="rolled"),
    design("armchair", "wing-blue", "navy wing chair", (0.84, 0.78, 1.08), "classic", wing_chair, cloth=m.NAVY_FABRIC, legs=m.DARK_WALNUT),
    design("armchair", "tub-rose", "dusty rose tub chair", (0.76, 0.78, 0.74), "modern", barrel_chair, cloth=m.ROSE_FABRIC, base=m.DARK_WALNUT),
    design("armchair", "tub-cream", "cream tub chair", (0.80, 0.84, 0.78), "minimal", barrel_chair, cloth=m.LINEN, base=m.BLACK),
    design("armchair", "lounge-oak", "oak lounge chair with grey cushions", (0.80, 0.72, 0.84), "modern", lounge_chair, cloth=m.GREY_FABRIC, wood=m.OAK),
    design("armchair", "lounge-walnut", "walnut lounge chair with olive cushions", (0.82, 0.74, 0.86), "modern", lounge_chair, cloth=m.OLIVE_FABRIC, wood=m.WALNUT),
)  # fmt: skip
