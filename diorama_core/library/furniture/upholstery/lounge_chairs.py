"""Armchairs of wood, steel, cane and cloth, in every style."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.upholstery.cushions import back_cushion, seat_cushion
from diorama_core.library.furniture.upholstery.sofas import sofa


def bergere(size: Size, cloth: Material, wood: Material) -> Parts:
    """A salon armchair: padded back and closed sides in a carved frame, bowed legs."""
    d, w, h = size
    xb, xf = -d / 2 + 0.13, d / 2 - 0.07
    legs = [
        *both_sides(leg("cabriole", xf - 0.03, 0.42 * w, 0.31, 0.055)),
        *both_sides(rod((xb - 0.09, 0.36 * w, 0), (xb, 0.36 * w, 0.3), 0.014, 0.022)),
    ]
    rail = [
        *both_sides(beam((xb, 0.40 * w, 0.31), (xf, 0.43 * w, 0.31), 0.036, 0.07)),
        beam((xf, -0.43 * w, 0.31), (xf, 0.43 * w, 0.31), 0.036, 0.075),
        beam((xb, -0.4 * w, 0.31), (xb, 0.4 * w, 0.31), 0.036, 0.07),
    ]
    post = both_sides(
        tube(
            bend(
                [
                    (xb, 0.40 * w, 0.3),
                    (xb - 0.02, 0.42 * w, 0.6),
                    (xb - 0.08, 0.40 * w, h - 0.13),
                    (xb - 0.095, 0.30 * w, h - 0.035),
                ],
                5,
            ),
            0.018,
            8,
        )
    )
    crest = tube(
        bend(
            [
                (xb - 0.095, 0.30 * w, h - 0.035),
                (xb - 0.10, 0.14 * w, h - 0.02),
                (xb - 0.102, 0, h - 0.016),
                (xb - 0.10, -0.14 * w, h - 0.02),
                (xb - 0.095, -0.30 * w, h - 0.035),
            ],
            5,
        ),
        0.018,
        8,
    )
    arm = both_sides(
        tube(
            bend(
                [
                    (xb - 0.02, 0.425 * w, 0.65),
                    (0, 0.46 * w, 0.66),
                    (xf - 0.12, 0.47 * w, 0.63),
                    (xf - 0.07, 0.465 * w, 0.58),
                    (xf - 0.1, 0.44 * w, 0.33),
                ],
                5,
            ),
            0.017,
            8,
        )
    )
    scroll = both_sides(ball(0.05, 6).moved(xf - 0.085, 0.467 * w, 0.59))
    back = cushion((h - 0.42, 0.78 * w, 0.1), 5, 2.8, 12).turned("y", -99).moved(xb - 0.03, 0, 0.36 + (h - 0.36) / 2)
    side = both_sides(box((xf - xb - 0.12, 0.05, 0.3), 0.02, 2).moved(0.0, 0.425 * w, 0.33))
    pads = both_sides(cushion((0.2, 0.055, 0.045), 3, 2.4, 6).moved(0.02, 0.462 * w, 0.66))
    seat = [q.moved((xf + xb) / 2 + 0.03, 0, 0.33) for q in seat_cushion(xf - xb + 0.03, 0.8 * w, 0.14)]
    return of(wood, *legs, *rail, *post, crest, *arm, *scroll) + of(cloth, back, *side, *pads, *seat)


def sling_chair(size: Size, hide: Material, steel: Material) -> Parts:
    """Thick leather slung in a frame of square steel, leather straps for arms."""
    d, w, h = size
    y, seat_z = w / 2 - 0.015, 0.42
    xf, xb = d / 2 - 0.015, -d / 2 + 0.12
    side = [
        box((0.03, 0.03, 0.6), 0.004).moved(xf, y),
        box((0.03, 0.03, 0.6), 0.004).moved(xb, y),
        box((xf - xb + 0.03, 0.03, 0.03), 0.004).moved((xf + xb) / 2, y),
        box((xf - xb + 0.03, 0.03, 0.03), 0.004).moved((xf + xb) / 2, y, 0.57),
    ]
    cross = [
        beam((x, -y, z), (x, y, z), 0.026, 0.026)
        for x, z in ((xf, seat_z - 0.02), (xb, 0.22), (-d / 2 + 0.02, h - 0.02))
    ]
    rear = both_sides(
        beam((xb + 0.02, y - 0.04, 0.3), (-d / 2 + 0.02, y - 0.04, h - 0.005), 0.026, 0.026),
        beam((xb + 0.02, y - 0.04, 0.3), (xb + 0.02, y, 0.3), 0.026, 0.026),
    )
    path = bend(
        [
            (xf - 0.005, 0, seat_z),
            (0.12, 0, seat_z - 0.07),
            (xb + 0.07, 0, seat_z - 0.10),
            (xb + 0.03, 0, seat_z - 0.02),
            (-d / 2 + 0.07, 0, h - 0.2),
            (-d / 2 + 0.035, 0, h - 0.005),
        ],
        6,
    )
    u = np.linspace(-1, 1, 7)[None, :]
    sag = -0.012 * (1 - u**2)
    sheet = np.stack(
        [
            np.broadcast_to(path[:, :1], (len(path), 7)) - sag * 0.3,
            np.broadcast_to((y - 0.06) * u, (len(path), 7)),
            path[:, 2:] + sag,
        ],
        axis=-1,
    )
    straps = both_sides(box((xf - xb - 0.06, 0.06, 0.01), 0.004).moved((xf + xb) / 2, y, 0.597))
    pad = [q.moved(0.06, 0, seat_z - 0.085) for q in (cushion((0.5, 2 * y - 0.14, 0.12), 7, 3, 12),)]
    lean = (
        cushion((h - seat_z - 0.06, 2 * y - 0.16, 0.1), 6, 2.8, 12)
        .turned("y", -106)
        .moved(-d / 2 + 0.15, 0, (h + seat_z) / 2 + 0.01)
    )
    return of(steel, *both_sides(*side), *cross, *rear) + of(hide, slab(sheet[:, ::-1], 0.008), *straps, *pad, lean)


def mission_chair(size: Size, cloth: Material, wood: Material) -> Parts:
    """A settler's armchair: thick square posts, broad flat arms, slats under them, loose cushions."""
    d, w, h = size
    y, x = w / 2 - 0.03, d / 2 - 0.035
    front = both_sides(box((0.06, 0.06, 0.58), 0.008, 2).moved(x, y))
    rear = both_sides(beam((-x + 0.05, y, 0), (-x - 0.005, y, h - 0.01), 0.05, 0.05, 0.008))
    arms = both_sides(box((d - 0.02, 0.11, 0.028), 0.01, 2).moved(0.01, y + 0.01, 0.575))
    rails = [
        *both_sides(*(beam((-x + 0.04, y, z), (x, y, z), 0.026, 0.07) for z in (0.2, 0.34))),
        beam((x, -y, 0.31), (x, y, 0.31), 0.028, 0.1),
        beam((-x + 0.03, -y, 0.28), (-x + 0.03, y, 0.28), 0.028, 0.08),
    ]
    slats = both_sides(
        *(box((0.035, 0.014, 0.24), 0.003).moved(px, y, 0.34) for px in np.linspace(-x + 0.14, x - 0.1, 5))
    )
    back = [
        beam((-x + 0.05 - 0.055 * z / h, -y + 0.02, z), (-x + 0.05 - 0.055 * z / h, y - 0.02, z), 0.02, 0.06)
        for z in np.linspace(0.5, h - 0.05, 4)
    ]
    seat = [q.moved(0.03, 0, 0.33) for q in seat_cushion(d - 0.16, 2 * y - 0.07, 0.13)]
    return of(wood, *front, *rear, *arms, *rails, *slats, *back) + of(
        cloth, *seat, back_cushion(2 * y - 0.1, h - 0.44, 0.15, 9).moved(-x + 0.07, 0, 0.44)
    )


def wicker_chair(size: Size, weave: Material, frame: Material, cloth: Material) -> Parts:
    """A woven tub with a rolled rim and a seat cushion."""
    d, w, h = size
    a = np.linspace(-2.3, 2.3, 41)
    v = np.linspace(0, 1, 9)[:, None]
    top = 0.56 + (h - 0.56) * np.clip(np.cos(a * 0.68), 0, 1) ** 1.2
    flare = 0.80 + 0.2 * v**1.4
    x = -0.46 * d * np.cos(a) * flare + 0.02
    y = -0.47 * w * np.sin(a) * flare
    z = 0.1 + (top - 0.1) * v
    wall = slab(np.stack(np.broadcast_arrays(x, y, z), axis=-1)[:, ::-1], 0.03)
    rim = tube(np.stack([x[-1], y[-1], z[-1]], axis=1), 0.026, 8)
    ends = [tube(np.stack([x[:, k], y[:, k], z[:, k]], axis=1), 0.02, 8) for k in (0, -1)]
    skirt = cylinder(0.40 * min(d, w), 0.28, 0.01, 36).scaled(x=d / min(d, w), y=w / min(d, w)).moved(0.015, 0, 0.08)
    feet = four(rod((0.3 * d, 0.3 * w, 0), (0.28 * d, 0.28 * w, 0.12), 0.016, 0.02))
    seat = cushion((0.72 * d, 0.74 * w, 0.13), 3.0, 3.2, 12).moved(0.06, 0, 0.33)
    pillow = back_cushion(0.56 * w, 0.36, 0.13, 16).moved(-0.29 * d, 0, 0.44)
    return of(weave, wall, rim, *ends, skirt) + of(frame, *feet) + of(cloth, seat, pillow)


def block_chair(size: Size, cloth: Material, base: Material) -> Parts:
    """Cushions as blocks on a recessed plinth, low and square."""
    d, w, h = size
    t = 0.19
    parts = of(base, box((d - 0.12, w - 0.12, 0.05), 0.004))
    low = box((d - 0.01, w - 2 * t + 0.04, 0.2), 0.045, 3).moved(0, 0, 0.045)
    sides = both_sides(box((d, t, h * 0.74), 0.06, 3).moved(0, w / 2 - t / 2, 0.045))
    back = box((0.2, w - 2 * t + 0.02, h - 0.05), 0.06, 3).moved(-d / 2 + 0.1, 0, 0.045)
    seat = cushion((d - 0.2, w - 2 * t, 0.19), 9, 4.2, 12).moved(0.1, 0, 0.235)
    return parts + of(cloth, low, *sides, back, seat)


def round_chair(size: Size, cloth: Material, base: Material) -> Parts:
    """A cocoon: one fat rounded roll for the back and arms round a thick seat."""
    d, w, h = size
    t = np.linspace(-2.2, 2.2, 41)
    height = 0.3 + (h - 0.48) * np.clip(np.cos(t * 0.62), 0, 1) ** 0.6
    a = 0.13 + 0.02 * np.cos(t)
    path = np.stack([-0.345 * d * np.cos(t), -0.36 * w * np.sin(t), height], axis=1)
    roll = tube(path, a, 16)
    v = np.linspace(0, 1, 5)[:, None]
    wall = slab(
        np.stack(np.broadcast_arrays(path[:, 0], path[:, 1], 0.07 + (height - 0.07) * v), axis=-1)[:, ::-1], 0.25
    )
    ends = [
        solid.moved(path[k, 0], path[k, 1])
        for k in (0, -1)
        for solid in (
            ball(2 * float(a[k]), 8).moved(z=height[k] - float(a[k])),
            cylinder(0.125, height[k] - 0.07, 0.02).moved(z=0.07),
        )
    ]
    seat = cushion((0.86 * d, 0.66 * w, 0.24), 2.8, 3.4, 14).moved(0.075 * d, 0, 0.22)
    drum = cushion((0.8 * d, 0.72 * w, 0.26), 2.4, 7, 10).moved(0.04 * d, 0, 0.05)
    return of(cloth, roll, wall, *ends, seat, drum) + of(base, cylinder(0.34 * d, 0.07, 0.004, 36))


def slipper_chair(size: Size, cloth: Material, wood: Material, profile: Leg, buttons: bool = True) -> Parts:
    """A low armless chair with a buttoned back."""
    d, w, h = size
    feet = four(leg(profile, 0.38 * d, 0.38 * w, 0.22, 0.045))
    box_seat = box((d * 0.86, w * 0.94, 0.12), 0.03, 2).moved(0.04, 0, 0.2)
    pad = cushion((d * 0.9, w, 0.17), 6, 3.2, 12).moved(0.05, 0, 0.285)
    tall = h - 0.3
    back = cushion((tall, w * 0.97, 0.16), 5, 3.0, 14).turned("y", -102).moved(-d * 0.36, 0, 0.3 + tall / 2)
    parts = of(wood, *feet) + of(cloth, box_seat, pad, back)
    if buttons:
        lean = np.tan(np.deg2rad(12))
        studs = []
        for z, ys in ((0.56, (-0.16, 0, 0.16)), (0.67, (-0.08, 0.08))):
            studs += [
                ball(0.022, 4).moved(-d * 0.36 + 0.076 - lean * (z - 0.3 - tall / 2), y, z - 0.011)
                for y in ys
                if z < h - 0.1
            ]
        parts += of(cloth, *studs)
    return parts


def cane_chair(size: Size, cloth: Material, wood: Material, cane: Material) -> Parts:
    """A wooden box frame with cane sides and back, loose cushions."""
    d, w, h = size
    y, x = w / 2 - 0.02, d / 2 - 0.025
    posts = both_sides(
        box((0.04, 0.036, 0.6), 0.008, 2).moved(x, y), beam((-x + 0.07, y, 0), (-x, y, h), 0.036, 0.04, 0.008)
    )
    bars = both_sides(*(beam((-x + 0.07 - 0.07 * z / h, y, z), (x, y, z), 0.03, 0.04, 0.008) for z in (0.22, 0.585)))
    cross = [
        beam((px, -y, z), (px, y, z), 0.03, 0.045, 0.008)
        for px, z in ((x, 0.24), (-x + 0.05, 0.24), (-x + 0.004, h - 0.025))
    ]
    sides = both_sides(box((d - 0.12, 0.008, 0.35), 0.002).moved(0.01, y, 0.23))
    back = box((0.008, 2 * y - 0.02, h - 0.28), 0.002).turned("y", -5).moved(-x + 0.05, 0, 0.25)
    seat = [q.moved(0.03, 0, 0.25) for q in seat_cushion(d - 0.14, 2 * y - 0.05, 0.18)]
    return (
        of(wood, *posts, *bars, *cross)
        + of(cane, *sides, back)
        + of(cloth, *seat, back_cushion(2 * y - 0.08, h - 0.42, 0.16, 8).moved(-x + 0.08, 0, 0.43))
    )


DESIGNS: tuple[Design, ...] = (
    design("armchair", "bergere-linen", "linen bergère with a whitewashed frame", (0.78, 0.72, 1.00), "classic", bergere, cloth=m.LINEN, wood=m.WHITEWASH),
    design("armchair", "bergere-plum", "plum velvet bergère in mahogany", (0.80, 0.74, 1.02), "classic", bergere, cloth=s.PLUM_VELVET, wood=m.MAHOGANY),
    design("armchair", "sling-cognac", "cognac leather sling chair on black steel", (0.82, 0.72, 0.80), "industrial", sling_chair, hide=s.COGNAC_LEATHER, steel=m.BLACK_STEEL),
    design("armchair", "sling-black", "black leather sling chair on chrome", (0.80, 0.70, 0.78), "industrial", sling_chair, hide=m.BLACK_LEATHER, steel=m.CHROME),
    design("armchair", "mission-oak", "oak mission chair with rust cushions", (0.86, 0.78, 0.96), "rustic", mission_chair, cloth=m.RUST_FABRIC, wood=m.OAK),
    design("armchair", "mission-dark", "dark mission chair with a leather seat", (0.88, 0.80, 1.00), "rustic", mission_chair, cloth=m.BROWN_LEATHER, wood=m.DARK_WALNUT),
    design("armchair", "wicker", "wicker armchair with a linen cushion", (0.78, 0.76, 0.84), "rustic", wicker_chair, weave=m.WICKER, frame=m.WALNUT, cloth=m.LINEN),
    design("armchair", "block-grey", "square light grey armchair on a plinth", (0.86, 0.88, 0.70), "minimal", block_chair, cloth=m.LIGHT_FABRIC, base=m.BLACK),
    design("armchair", "block-cream", "square cream leather armchair", (0.84, 0.84, 0.68), "minimal", block_chair, cloth=m.CREAM_LEATHER, base=m.STEEL),
    design("armchair", "round-boucle", "round ivory bouclé armchair", (0.86, 0.88, 0.72), "modern", round_chair, cloth=s.IVORY_BOUCLE, base=m.BLACK),
    design("armchair", "slipper-gold", "gold velvet slipper chair", (0.76, 0.64, 0.82), "classic", slipper_chair, cloth=s.GOLD_VELVET, wood=m.DARK_WALNUT, profile="turned"),
    design("armchair", "slipper-teal", "teal velvet slipper chair on brass", (0.74, 0.62, 0.78), "modern", slipper_chair, cloth=s.TEAL_VELVET, wood=m.BRASS, profile="taper", buttons=False),
    design("armchair", "cane-walnut", "walnut armchair with cane sides", (0.80, 0.70, 0.80), "modern", cane_chair, cloth=s.SAND_BOUCLE, wood=m.WALNUT, cane=m.RATTAN),
    design("armchair", "loveseat-olive", "wide olive armchair with slim arms", (0.88, 1.02, 0.82), "modern", sofa, cloth=m.OLIVE_FABRIC, legs=m.OAK, seats=1, arms="slim"),
)  # fmt: skip
