"""Boxes and chests to keep things in."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def carton(size: Size, card: Material, opened: bool = False) -> Parts:
    """A cardboard box, taped shut or open."""
    d, w, h = size
    if not opened:
        tape = box((0.05, w + 0.001, 0.001), 0.0004).moved(z=h - 0.0008)
        drops = both_sides(box((0.05, 0.001, 0.07), 0.0004).moved(0, w / 2, h - 0.07))
        return (
            of(card, box((d, w, h - 0.001), 0.003))
            + of(m.LINEN, tape, *drops)
            + of(m.SHADOW, box((0.0015, w * 0.995, 0.0006), 0.0002).moved(z=h - 0.0002))
        )
    body = 0.8 * h
    t, bd, bw = 0.005, d * 0.74, w * 0.78
    walls = [box((t, bw, body), 0.002).moved(s * (bd - t) / 2, 0, 0) for s in (1, -1)] + [
        box((bd, t, body), 0.002).moved(0, s * (bw - t) / 2, 0) for s in (1, -1)
    ]
    flap_x = [
        box((t, bw * 0.98, 0.3 * bd), 0.002).turned("y", s * 40).moved(s * (bd / 2 - 0.001), 0, body - 0.003)
        for s in (1, -1)
    ]
    flap_y = [
        box((bd * 0.98, t, 0.26 * bw), 0.002).turned("x", -s * 55).moved(0, s * (bw / 2 - 0.001), body - 0.003)
        for s in (1, -1)
    ]
    return of(card, *walls, box((bd, bw, t), 0.002), *flap_x, *flap_y)


def crate(size: Size, wood: Material) -> Parts:
    """A slatted wooden crate."""
    d, w, h = size
    t, n = 0.012, 3
    slat = (h - 0.02 * (n - 1)) / n
    sides = [
        box((d - 2 * t, t, slat), 0.002).moved(0, s * (w - t) / 2, k * (slat + 0.02)) for s in (1, -1) for k in range(n)
    ]
    ends = [box((t, w, slat), 0.002).moved(s * (d - t) / 2, 0, k * (slat + 0.02)) for s in (1, -1) for k in range(n)]
    posts = four(box((0.022, 0.022, h - 0.004), 0.002).moved(d / 2 - t - 0.011, w / 2 - t - 0.011))
    floor = [box((d - 2 * t, w / 4.4, 0.008), 0.002).moved(0, y, 0.002) for y in np.linspace(-0.37 * w, 0.37 * w, 4)]
    return of(wood, *sides, *ends, *posts, *floor)


def storage_tub(size: Size, tub: Material, lid: Material) -> Parts:
    """A plastic storage box with a clipped lid."""
    d, w, h = size
    o = rounded_rectangle(d, w, 0.04, 6)
    body = loft(
        np.array(
            [
                ring_path(o * s, z)
                for s, z in ((0.86, 0), (0.88, 0.01), (0.955, h - 0.05), (0.985, h - 0.048), (0.985, h - 0.03))
            ]
        ),
        crease_rad=np.deg2rad(50),
    )
    clips = both_sides(box((0.09, 0.012, 0.06), 0.004, 2).moved(0, w / 2 - 0.012, h - 0.085))
    return of(tub, body) + of(
        lid, prism(o, 0.022, 0.008).moved(z=h - 0.032), prism(o * 0.9, 0.012, 0.005).moved(z=h - 0.012), *clips
    )


def chest(size: Size, wood: Material, strap: Material) -> Parts:
    """A trunk with metal bands."""
    d, w, h = size
    tall = 0.3 * h
    split = h - tall
    bands = [box((d + 0.004, 0.035, h - 0.002), 0.003).moved(0, s * w * 0.3, 0.001) for s in (1, -1)]
    below = [
        box((0.004, 0.035, split - 0.006), 0.001).moved(f * d / 2, s * w * 0.3, 0.001) for s in (1, -1) for f in (1, -1)
    ]
    above = [box((d + 0.004, 0.035, tall - 0.001), 0.003).moved(0, s * w * 0.3, split) for s in (1, -1)]
    parts = Cavity((d, w, split - 0.004), opens="top").body(wood, 0.006, 2)
    parts += with_role("filler", of(strap, *bands)) + with_role("inside", of(strap, *below))
    parts += of(strap, box((0.012, 0.07, 0.07), 0.003).moved(d / 2 + 0.003, 0, split - 0.045))
    cover = of(wood, box((d, w, tall), 0.02, 2).moved(z=split)) + with_role("inside", of(strap, *above))
    return parts + hinged_lid(-d / 2 - 0.002, split, cover)


def gift_box(size: Size, card: Material, ribbon: Material) -> Parts:
    """A lidded box tied with ribbon."""
    d, w, h = size
    top = h * 0.82
    lid = box((d, w, 0.24 * top), 0.004).moved(z=top * 0.76)
    bands = [box((d * 1.004, 0.09 * w, top * 0.76), 0.001), box((0.09 * d, w * 1.004, top * 0.76), 0.001)]
    over = [
        box((d * 1.012, 0.09 * w, 0.245 * top), 0.001).moved(z=top * 0.76),
        box((0.09 * d, w * 1.012, 0.245 * top), 0.001).moved(z=top * 0.76),
    ]
    loops = [
        tube(
            bend(
                [
                    (0, 0, top),
                    (0.05 * d, s * 0.1 * w, h),
                    (-0.02 * d, s * 0.24 * w, h - 0.02),
                    (0, s * 0.12 * w, top + 0.01),
                    (0, 0, top),
                ],
                4,
            ),
            0.006,
            6,
        ).scaled(x=2.0)
        for s in (1, -1)
    ]
    return of(card, box((d * 0.97, w * 0.97, top * 0.8), 0.003), lid) + of(
        ribbon, *bands, *over, *loops, ball(0.02, 5).moved(z=top - 0.004)
    )


def fabric_cube(size: Size, cloth: Material, tab: Material) -> Parts:
    """A soft open storage cube with a pull."""
    d, w, h = size
    o = rounded_rectangle(d, w, 0.014, 3)
    rows = [(0.985, 0.0), (0.995, 0.01), (1.0, h - 0.006), (0.99, h), (0.955, h), (0.95, 0.02), (0.04, 0.016)]
    body = loft(np.array([ring_path(o * s, z) for s, z in rows]), crease_rad=np.deg2rad(50))
    loop_ = tube(
        bend(
            [
                (d / 2 - 0.002, 0.05, 0.62 * h),
                (d / 2 + 0.012, 0.04, 0.62 * h - 0.01),
                (d / 2 + 0.012, -0.04, 0.62 * h - 0.01),
                (d / 2 - 0.002, -0.05, 0.62 * h),
            ],
            4,
        ),
        0.005,
        6,
    )
    return of(cloth, body) + of(tab, loop_)


def hat_box(size: Size, card: Material, trim: Material) -> Parts:
    """A round lidded box with a cord."""
    d, _, h = size
    r = d / 2
    cord = tube(
        bend(
            [
                (0, r * 0.98, 0.7 * h),
                (0, r * 0.8, 0.98 * h),
                (0, 0, h * 0.995),
                (0, -r * 0.8, 0.98 * h),
                (0, -r * 0.98, 0.7 * h),
            ],
            4,
        ),
        0.004,
        6,
    )
    return of(card, cylinder(r * 0.97, 0.72 * h, 0.004, 44), cylinder(r, 0.2 * h, 0.004, 44).moved(z=0.66 * h)) + of(
        trim, cord, tube(ring_path(superellipse(d * 1.0, d * 1.0, 2, 44), 0.67 * h), 0.003, 5, closed=True)
    )


DESIGNS: tuple[Design, ...] = (
    design("box", "carton", "closed cardboard box", (0.35, 0.45, 0.32), "minimal", carton, 2, card=m.CARDBOARD),
    design("box", "carton-open", "open cardboard box", (0.50, 0.55, 0.42), "minimal", carton, 2, card=m.CARDBOARD, opened=True),
    design("box", "crate", "pine crate", (0.32, 0.46, 0.28), "rustic", crate, 2, wood=m.PINE),
    design("box", "tub", "storage box with a lid", (0.38, 0.54, 0.30), "modern", storage_tub, 2, tub=m.LIGHT_GREY, lid=m.WHITE),
    design("box", "trunk", "old wooden trunk", (0.46, 0.85, 0.46), "rustic", chest, wood=m.WALNUT, strap=m.IRON),
    design("box", "gift", "gift box with a ribbon", (0.24, 0.32, 0.16), "classic", gift_box, 2, card=m.CREAM, ribbon=m.RUST_FABRIC),
    design("box", "cube-grey", "grey fabric storage cube", (0.31, 0.31, 0.31), "modern", fabric_cube, cloth=m.GREY_FABRIC, tab=m.TAN_LEATHER),
    design("box", "cube-natural", "linen storage cube", (0.33, 0.33, 0.30), "rustic", fabric_cube, cloth=m.LINEN, tab=m.BROWN_LEATHER),
    design("box", "hat", "round hat box", (0.36, 0.36, 0.24), "classic", hat_box, 2, card=m.SAGE, trim=m.CREAM),
    design("box", "crate-dark", "reclaimed apple crate", (0.34, 0.50, 0.30), "industrial", crate, 2, wood=m.RECLAIMED),
)  # fmt: skip
