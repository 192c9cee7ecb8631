"""Baskets, for laundry and for anything."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


def woven_basket(
    size: Size, cane: Material, outline: Literal["round", "square"], handles: bool = True, lid: bool = False
) -> Parts:
    """A woven basket."""
    d, w, h = size
    o = superellipse(d, w, 2.0 if outline == "round" else 7.0, 44)
    body_h = h - (0.05 if handles and not lid else 0.03 if lid else 0.012)
    layers = [
        (0.8, 0),
        (0.84, 0.012),
        (0.97, body_h * 0.6),
        (0.95, body_h),
        (0.91, body_h),
        (0.92, body_h * 0.6),
        (0.8, 0.02),
        (0.03, 0.016),
    ]
    parts = of(
        cane,
        loft(np.array([ring_path(o * s, z) for s, z in layers]), crease_rad=np.deg2rad(50)),
        tube(ring_path(o * 0.945, body_h), 0.013, 7, closed=True),
    )
    if lid:
        parts += of(
            cane,
            loft(
                np.array(
                    [
                        ring_path(o * s, z)
                        for s, z in ((0.96, body_h + 0.002), (0.98, body_h + 0.012), (0.6, h - 0.012), (0.05, h - 0.01))
                    ]
                ),
                crease_rad=np.deg2rad(60),
            ),
        )
    if handles and not lid:
        ear = tube(
            bend(
                [
                    (-0.07, 0.455 * w, body_h - 0.01),
                    (-0.05, 0.475 * w, h - 0.008),
                    (0.05, 0.475 * w, h - 0.008),
                    (0.07, 0.455 * w, body_h - 0.01),
                ],
                4,
            ),
            0.009,
            8,
        )
        parts += of(m.TAN_LEATHER, *both_sides(ear))
    return parts


def wire_basket(size: Size, wire: Material) -> Parts:
    """A basket of welded wire."""
    d, w, h = size
    hoops = [
        tube(ring_path(superellipse(d * s, w * s, 6, 36), z), 0.003 if z < h - 0.02 else 0.005, 5, closed=True)
        for s, z in ((0.84, 0.004), (0.89, h * 0.33), (0.94, h * 0.66), (0.985, h - 0.006))
    ]
    o, top = superellipse(d * 0.84, w * 0.84, 6, 28), superellipse(d * 0.985, w * 0.985, 6, 28)
    ribs = [rod((*a, 0.004), (*b, h - 0.006), 0.002, segments=5) for a, b in zip(o, top, strict=True)]
    floor = [
        rod((-0.42 * d, y, 0.004), (0.42 * d, y, 0.004), 0.002, segments=5) for y in np.linspace(-0.4 * w, 0.4 * w, 9)
    ]
    return of(wire, *hoops, *ribs, *floor)


def rope_basket(size: Size, rope: Material, band: Material) -> Parts:
    """Coils of rope with a coloured foot and two loops."""
    d, w, h = size
    n = max(int(h * 0.86 / 0.022), 6)
    step = h * 0.86 / n
    lower: list[Solid] = []
    upper: list[Solid] = []
    for k in range(n):
        s = 0.9 + 0.1 * np.sin(np.pi * min((k + 0.5) / n, 1.0) * 0.75)
        coil = tube(
            ring_path(superellipse(d * s - step, w * s - step, 2, 36), step * (k + 0.5)), step * 0.54, 6, closed=True
        )
        (lower if k < n * 0.3 else upper).append(coil)
    ears = both_sides(
        tube(
            bend(
                [
                    (-0.07, w * 0.45, h * 0.8),
                    (-0.06, w * 0.465, h - 0.012),
                    (0.06, w * 0.465, h - 0.012),
                    (0.07, w * 0.45, h * 0.8),
                ],
                4,
            ),
            step * 0.5,
            7,
        )
    )
    base = prism(superellipse(d * 0.86, w * 0.86, 2, 36), 0.012, 0.004)
    return of(band, *lower, base) + of(rope, *upper, *ears)


def laundry_bag(size: Size, cloth: Material, wood: Material) -> Parts:
    """A cloth bag in a folding wooden frame."""
    d, w, h = size
    legs = [
        rod((s * d * 0.46, y, 0.0), (-s * d * 0.46, y, h - 0.012), 0.011, segments=10)
        for s in (1, -1)
        for y in (w / 2 - 0.014, -w / 2 + 0.014)
    ]
    bars = [
        rod((s * d * 0.46, -w / 2 + 0.01, h - 0.014), (s * d * 0.46, w / 2 - 0.01, h - 0.014), 0.012, segments=10)
        for s in (1, -1)
    ]
    o = rounded_rectangle(d * 0.9, w * 0.84, 0.05, 5)
    rows = [
        (0.6, 0.14 * h),
        (0.8, 0.16 * h),
        (0.93, 0.4 * h),
        (0.97, 0.8 * h),
        (1.0, h - 0.02),
        (0.96, h - 0.02),
        (0.88, 0.4 * h),
        (0.05, 0.2 * h),
    ]
    return of(wood, *legs, *bars) + of(
        cloth, loft(np.array([ring_path(o * s, z) for s, z in rows]), crease_rad=np.deg2rad(60))
    )


def plastic_basket(size: Size, plastic: Material) -> Parts:
    """A moulded laundry basket with slots and grips."""
    d, w, h = size
    o = rounded_rectangle(d, w, 0.09, 6)
    rows = [
        (0.76, 0.0),
        (0.79, 0.012),
        (0.96, h - 0.03),
        (1.0, h - 0.022),
        (1.0, h - 0.004),
        (0.98, h),
        (0.93, h - 0.008),
        (0.77, 0.016),
        (0.04, 0.014),
    ]
    body = loft(np.array([ring_path(o * s, z) for s, z in rows]), crease_rad=np.deg2rad(50))
    slots = []
    for row in range(3):
        z = h * (0.26 + 0.2 * row)
        s = 0.79 + 0.17 * (z / h)
        for y in np.linspace(-0.34, 0.34, 6) * w:
            slots += [
                box((0.006, w * 0.07, h * 0.12), 0.003).turned("y", 8 * f).moved(f * (d * s / 2 - 0.001), float(y), z)
                for f in (1, -1)
            ]
        for x in np.linspace(-0.26, 0.26, 4) * d:
            slots += [
                box((d * 0.09, 0.006, h * 0.12), 0.003).turned("x", -8 * f).moved(float(x), f * (w * s / 2 - 0.001), z)
                for f in (1, -1)
            ]
    return of(plastic, body) + of(m.SHADOW, *slots)


ROPE = m.Material("jute rope", "knit", "#b79e75", 0.95, 0.0, 0.1)

DESIGNS: tuple[Design, ...] = (
    design("basket", "round", "round wicker basket with handles", (0.42, 0.44, 0.38), "rustic", woven_basket, 2, cane=m.WICKER, outline="round"),
    design("laundry basket", "hamper", "lidded laundry hamper", (0.40, 0.46, 0.58), "classic", woven_basket, 2, id="basket-hamper", cane=m.RATTAN, outline="square", lid=True),
    design("basket", "shelf", "dark rectangular shelf basket", (0.30, 0.40, 0.26), "modern", woven_basket, 2, cane=m.DARK_WICKER, outline="square"),
    design("basket", "wire", "black wire basket", (0.30, 0.38, 0.24), "industrial", wire_basket, 2, wire=m.BLACK_STEEL),
    design("basket", "rope-navy", "rope basket with a navy foot", (0.36, 0.38, 0.34), "modern", rope_basket, 2, rope=m.LINEN, band=m.NAVY_FABRIC),
    design("basket", "rope-natural", "jute rope basket", (0.30, 0.32, 0.26), "rustic", rope_basket, 2, rope=ROPE, band=ROPE),
    design("basket", "low-rattan", "low oval rattan basket", (0.32, 0.46, 0.20), "minimal", woven_basket, 2, cane=m.RATTAN, outline="round"),
    design("laundry basket", "frame", "linen laundry bag in a wooden frame", (0.42, 0.50, 0.62), "rustic", laundry_bag, 2, cloth=m.LINEN, wood=m.OAK),
    design("laundry basket", "frame-grey", "grey laundry bag in a black frame", (0.40, 0.48, 0.60), "industrial", laundry_bag, 2, cloth=m.GREY_FABRIC, wood=m.BLACK_WOOD),
    design("laundry basket", "plastic", "white laundry basket", (0.42, 0.60, 0.30), "modern", plastic_basket, 2, plastic=m.WHITE),
    design("laundry basket", "wicker-dark", "dark wicker laundry hamper", (0.38, 0.44, 0.56), "minimal", woven_basket, 2, cane=m.DARK_WICKER, outline="square", lid=True),
)  # fmt: skip
