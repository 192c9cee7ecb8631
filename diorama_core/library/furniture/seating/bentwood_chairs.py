"""Chairs of bent wood: bistro hoops, wishbones and oval backs."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def bistro_chair(size: Size, wood: Material, seat: Material) -> Parts:
    """A café chair: round seat in a bent ring, hooped back within a hoop."""
    d, _, h = size
    seat_z, r = 0.455, 0.215
    x0 = d / 2 - r - 0.02
    ring = tube(ring_path(superellipse(2 * r, 2 * r, 2.2, 36), seat_z - 0.015), 0.017, 8, closed=True).moved(x0)
    pad = prism(superellipse(2 * r - 0.02, 2 * r - 0.02, 2.2, 32), 0.016, 0.006).moved(x0, 0, seat_z - 0.016)
    brace = tube(ring_path(superellipse(1.62 * r, 1.62 * r, 2, 28), 0.22), 0.009, 6, closed=True).moved(x0 - 0.005)
    front = both_sides(rod((x0 + 0.18, 0.17, 0), (x0 + 0.13, 0.145, seat_z - 0.02), 0.012, 0.017))
    parts = of(wood, ring, brace, *front) + of(seat, pad)
    for inner, foot in ((0.0, 0.0), (0.055, 0.30)):
        z0 = foot if foot == 0.0 else seat_z - 0.01
        half = 0.19 - inner
        top = h - inner * 1.5
        hoop = bend(
            [
                (x0 - 0.2 + (0.03 if inner else 0.0), half - (0.03 if inner else -0.01), z0),
                (x0 - 0.19, half - 0.02, seat_z),
                (x0 - 0.225, half, seat_z + 0.2),
                (-d / 2 + 0.03, half * 0.86, top - 0.08),
                (-d / 2 + 0.014, half * 0.45, top - 0.02),
                (-d / 2 + 0.014, 0, top - 0.012),
            ],
            5,
        )
        whole = np.concatenate([hoop, (hoop * [1, -1, 1])[-2::-1]])
        parts += of(wood, tube(whole, 0.0145 if not inner else 0.011, 8))
    return parts


def wishbone_chair(size: Size, wood: Material, cord: Material) -> Parts:
    """A Y-backed chair: steam-bent top rail, tapered posts, woven seat."""
    d, w, h = size
    seat_z, xf, xb = 0.445, d / 2 - 0.04, -d / 2 + 0.14
    legs = both_sides(
        rod((xf, 0.44 * w, 0), (xf - 0.015, 0.42 * w, seat_z), 0.013, 0.018),
        tube(
            bend(
                [
                    (xb - 0.05, 0.36 * w, 0),
                    (xb, 0.34 * w, seat_z * 0.7),
                    (xb + 0.03, 0.36 * w, seat_z + 0.1),
                    (xb + 0.0, 0.43 * w, h - 0.06),
                ],
                5,
            ),
            np.interp(np.linspace(0, 1, 16), [0, 0.5, 1], [0.012, 0.019, 0.013]),
            8,
        ),
    )
    t = np.linspace(-1, 1, 25)
    rail = np.stack(
        [
            xb + 0.14 - 0.24 * np.cos(t * np.pi / 2) ** 0.8,
            0.485 * w * np.sin(t * np.pi / 2),
            h - 0.03 + 0.012 * np.cos(t * np.pi),
        ],
        axis=1,
    )
    back = tube(rail, np.interp(np.abs(t), [0, 0.7, 1], [0.019, 0.017, 0.012]), 8)
    stem = slab(
        np.stack(np.broadcast_arrays(*_wishbone(xb, seat_z, h)), axis=-1),
        0.01,
    )
    arms = both_sides(
        beam((xb - 0.035, 0.012, seat_z + 0.2), (xb - 0.085, 0.085, h - 0.035), 0.03, 0.01),
    )
    rails = [
        *both_sides(rod((xf, 0.42 * w, 0.26), (xb - 0.02, 0.35 * w, 0.26), 0.011)),
        rod((xf - 0.005, 0.42 * w, 0.31), (xf - 0.005, -0.42 * w, 0.31), 0.011),
        rod((xb, 0.34 * w, 0.33), (xb, -0.34 * w, 0.33), 0.011),
    ]
    seat = prism([(xf, -0.43 * w), (xf, 0.43 * w), (xb + 0.01, 0.35 * w), (xb + 0.01, -0.35 * w)], 0.035, 0.014).moved(
        0, 0, seat_z - 0.03
    )
    return of(wood, *legs, back, stem, *arms, *rails) + of(cord, seat)


def _wishbone(xb: float, seat_z: float, h: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    v, u = np.meshgrid(np.linspace(0, 1, 6), np.linspace(-1, 1, 5), indexing="ij")
    return xb + 0.01 - 0.05 * v, -u * 0.03, seat_z - 0.02 + v * 0.24


def oval_back_chair(size: Size, wood: Material, cloth: Material, arms: bool = False) -> Parts:
    """A salon chair: padded oval back in a carved frame, bowed legs."""
    d, w, h = size
    seat_z, lean = 0.48, 12.0
    xf, xb = d / 2 - 0.07, -d / 2 + 0.12
    legs = [*both_sides(leg("cabriole", xf - 0.02, 0.38 * w, seat_z - 0.08, 0.05))]
    legs += both_sides(rod((xb - 0.07, 0.36 * w, 0), (xb + 0.01, 0.33 * w, seat_z - 0.06), 0.013, 0.02))
    outline = superellipse(xf - xb + 0.09, w * 0.92, 3.4, 32)
    middle = (xf + xb) / 2
    rail = prism(outline, 0.06, 0.014).moved(middle, 0, seat_z - 0.1)
    pad = cushion((xf - xb + 0.05, w * 0.86, 0.11), 3.4, 2.6, 10).moved(middle, 0, seat_z - 0.075)
    oval_h, oval_w = h - seat_z - 0.08, w * 0.84
    ring = tube(ring_path(superellipse(oval_h, oval_w, 2.1, 40)), 0.017, 8, closed=True)
    filling = cushion((oval_h - 0.02, oval_w - 0.02, 0.065), 2.1, 2.6, 10).moved(z=-0.032)
    crest = cushion((0.035, 0.11, 0.03), 2.5, 2.5, 5).moved(-oval_h / 2 - 0.005, 0, -0.012)
    lift = seat_z + 0.06 + oval_h / 2

    def stood(solid: Solid) -> Solid:
        return solid.turned("y", 90).turned("y", -lean).moved(xb - 0.05, 0, lift)

    posts = both_sides(rod((xb + 0.01, 0.24 * w, seat_z - 0.08), (xb - 0.035, 0.26 * w, seat_z + 0.15), 0.016, 0.014))
    parts = of(wood, *legs, rail, stood(ring), stood(crest), *posts) + of(cloth, pad, stood(filling))
    if arms:
        rest = bend(
            [
                (xf - 0.1, 0.45 * w, seat_z - 0.06),
                (xf - 0.14, 0.48 * w, seat_z + 0.16),
                (xf - 0.16, 0.49 * w, seat_z + 0.21),
                (0, 0.47 * w, seat_z + 0.23),
                (xb - 0.04, 0.40 * w, seat_z + 0.26),
            ],
            5,
        )
        parts += of(wood, *both_sides(tube(rest, 0.015)))
        parts += of(cloth, *both_sides(cushion((0.17, 0.05, 0.04), 3, 2.4, 6).moved(0, 0.475 * w, seat_z + 0.235)))
    return parts


def school_chair(size: Size, ply: Material, steel: Material) -> Parts:
    """A schoolroom chair: bent plywood seat and back on steel tube."""
    d, w, h = size
    seat_z, half = 0.44, 0.40 * w
    xf, xb = d / 2 - 0.02, -d / 2 + 0.05
    frame = bend(
        [
            (xf, half, 0.012),
            (xf - 0.03, half, seat_z - 0.07),
            (xf - 0.07, half, seat_z - 0.02),
            (xb + 0.1, half, seat_z - 0.025),
            (xb + 0.03, half, seat_z + 0.06),
            (xb - 0.03, half, h - 0.03),
        ],
        5,
    )
    rear = rod((xb - 0.03, half, 0.01), (xb + 0.12, half, seat_z - 0.03), 0.0115)
    cross = [rod((x, half, z), (x, -half, z), 0.009) for x, z in ((xf - 0.08, seat_z - 0.03), (xb + 0.09, 0.3))]
    u, v = np.meshgrid(np.linspace(-1, 1, 11), np.linspace(0, 1, 9))
    roll = np.array([xf + 0.005, xf, xf - 0.04, xf - 0.12, -0.02, xb + 0.16, xb + 0.1, xb + 0.075, xb + 0.06])
    dip = np.array([-0.03, -0.012, 0, -0.002, -0.012, -0.012, -0.002, 0.006, 0.022])
    seat = np.stack([np.broadcast_to(roll[:, None], u.shape), u * w / 2, seat_z + dip[:, None] + 0.008 * u**2], axis=-1)
    bz = h - 0.19 + v * 0.19
    round_off = np.sqrt(np.clip(1 - np.abs(2 * v - 1) ** 6, 0, 1)) * 0.12 + 0.88
    back = np.stack([xb - 0.005 - 0.05 * v + 0.035 * u**2, -u * w / 2 * round_off, bz], axis=-1)
    feet = both_sides(
        box((0.03, 0.03, 0.012), 0.004).moved(xf, half), box((0.03, 0.03, 0.012), 0.004).moved(xb - 0.03, half)
    )
    return (
        of(ply, slab(seat, 0.011), slab(back, 0.011))
        + of(steel, *both_sides(tube(frame, 0.0115), rear), *cross)
        + of(m.BLACK, *feet)
    )


def wire_chair(size: Size, steel: Material, pad: Material) -> Parts:
    """A shell welded of steel wire, with a seat pad, on a wire base."""
    d, w, h = size
    path = bend(
        [(0.46 * d, 0, 0.43), (0.2 * d, 0, 0.445), (-0.2 * d, 0, 0.44), (-0.36 * d, 0, 0.56), (-0.47 * d, 0, h)], 5
    )
    s_ = np.linspace(0, 1, len(path))[:, None]
    u = np.linspace(-1, 1, 9)[None, :]
    half = w / 2 * np.interp(s_, [0, 0.15, 0.5, 0.8, 1], [0.86, 0.96, 1.0, 0.94, 0.78])
    curl = np.interp(s_, [0, 0.15, 0.5, 0.8, 1], [0.01, 0.03, 0.08, 0.06, 0.02])
    x = path[:, :1] + curl * np.interp(s_, [0, 0.4, 0.7, 1], [0, 0.2, 1, 1]) * u**2
    z = path[:, 2:] + curl * np.interp(s_, [0, 0.4, 0.7, 1], [0.6, 0.5, 0.1, 0.0]) * u**2
    grid = np.stack([x, half * u, z], axis=-1)
    rim = np.concatenate([grid[0], grid[1:, -1], grid[-1, -2::-1], grid[-2:0:-1, 0]])
    wires = [tube(grid[:, k], 0.0032, 5) for k in range(1, 8)] + [
        tube(grid[k], 0.0032, 5) for k in range(2, len(path) - 1, 2)
    ]
    side = bend(
        [
            (0.36 * d, 0.40 * w, 0.006),
            (0.2 * d, 0.34 * w, 0.38),
            (-0.2 * d, 0.34 * w, 0.38),
            (-0.38 * d, 0.40 * w, 0.006),
        ],
        4,
    )
    base = [
        *both_sides(tube(side, 0.007)),
        *(rod((x_, 0.345 * w, 0.375), (x_, -0.345 * w, 0.375), 0.006) for x_ in (0.19 * d, -0.19 * d)),
    ]
    floor = both_sides(rod((0.36 * d, 0.40 * w, 0.008), (-0.38 * d, 0.40 * w, 0.008), 0.006))
    return of(steel, tube(rim, 0.0055, 6, closed=True), *wires, *base, *floor) + of(
        pad, cushion((0.6 * d, 0.78 * w, 0.04), 4, 2.8, 9).moved(0.04 * d, 0, 0.44)
    )


DESIGNS: tuple[Design, ...] = (
    design("chair", "bistro-black", "black bentwood café chair", (0.50, 0.42, 0.88), "classic", bistro_chair, wood=m.BLACK_WOOD, seat=m.BLACK_WOOD),
    design("chair", "bistro-cane", "bentwood bistro chair with a cane seat", (0.51, 0.43, 0.86), "rustic", bistro_chair, wood=m.CHERRY, seat=m.RATTAN),
    design("chair", "wishbone-oak", "oak wishbone chair with a woven seat", (0.53, 0.56, 0.76), "modern", wishbone_chair, wood=m.LIGHT_OAK, cord=m.RATTAN),
    design("chair", "wishbone-black", "black wishbone chair", (0.52, 0.55, 0.75), "minimal", wishbone_chair, wood=m.BLACK_WOOD, cord=m.LINEN),
    design("chair", "oval-linen", "salon chair with an oval linen back", (0.58, 0.50, 0.99), "classic", oval_back_chair, wood=m.WHITEWASH, cloth=m.LINEN),
    design("chair", "oval-arms-blue", "mahogany salon chair with arms and pale blue cloth", (0.61, 0.60, 1.02), "classic", oval_back_chair, wood=m.MAHOGANY, cloth=s.SKY_FABRIC, arms=True),
    design("chair", "school-ply", "plywood school chair on steel tube", (0.50, 0.42, 0.79), "industrial", school_chair, ply=s.PLYWOOD, steel=m.BLACK_STEEL),
    design("chair", "school-duck-egg", "pale blue-grey stacking chair on chrome tube", (0.49, 0.43, 0.80), "minimal", school_chair, ply=s.DUCK_EGG, steel=m.CHROME),
    design("chair", "wire-black", "black wire chair with a leather pad", (0.53, 0.52, 0.83), "industrial", wire_chair, steel=m.BLACK_STEEL, pad=s.COGNAC_LEATHER),
    design("chair", "wire-chrome", "chrome wire chair with a white pad", (0.52, 0.50, 0.82), "minimal", wire_chair, steel=m.CHROME, pad=m.WHITE_COTTON),
)  # fmt: skip
