"""Lamps that stand on the floor."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.lighting.shades import bulb, shade, spider


def turned_pole(size: Size, wood: Material, cloth: Material) -> Parts:
    """A turned wooden column on a round foot under a pleated shade."""
    d, _, h = size
    r, hs = d / 2, 0.3
    neck = h - hs * 0.7
    profile = (
        (0.15, 0.0),
        (0.155, 0.012),
        (0.09, 0.03),
        (0.03, 0.05),
        (0.042, 0.09),
        (0.022, 0.12),
        (0.03, 0.4),
        (0.02, 0.46),
        (0.036, 0.5),
        (0.018, 0.54),
        (0.022, 0.92),
        (0.03, 0.96),
        (0.01, 1.0),
    )
    parts = of(wood, lathe([(a, b * neck) for a, b in smooth_profile(profile, 2)], 28))
    parts += of(m.BRASS, cylinder(0.008, hs * 0.6, 0.002, 12).moved(z=neck - 0.01), *spider(r * 0.62, h - 0.02))
    return parts + bulb(h - hs * 0.5, 0.035) + of(cloth, shade(r, r * 0.6, hs, 48).moved(z=h - hs))


def floor_shade(
    size: Size, stand: Literal["pole", "tripod", "arc"], metal: Material, cloth: Material, shade_h: float = 0.26
) -> Parts:
    """A floor lamp with a cloth drum on a pole, three legs or an arc."""
    d, _, h = size
    if stand == "arc":
        return _arc(size, metal, cloth)
    r = d / 2 if stand == "pole" else 0.46 * d
    hood = (
        of(cloth, shade(r, r * 0.84, shade_h).moved(z=h - shade_h))
        + bulb(h - shade_h * 0.5, 0.035)
        + of(metal, *spider(r * 0.85, h - 0.02))
    )
    if stand == "pole":
        foot = lathe([(0.145, 0), (0.15, 0.006), (0.14, 0.018), (0.02, 0.03), (0.012, 0.05)], 36)
        return of(metal, foot, cylinder(0.011, h - 0.05, 0.002, 16).moved(z=0.025)) + hood
    hub = h - shade_h - 0.06
    # Feet end below the rim of the shade, so that the lamp stands about the middle of its box.
    legs = [rod((r - 0.02, 0, 0), (0.018, 0, hub), 0.012, 0.018).turned("z", 60 + 120 * k) for k in range(3)]
    return (
        of(metal, *legs)
        + of(m.BRASS, cylinder(0.034, 0.05, 0.004).moved(z=hub - 0.03), cylinder(0.008, shade_h * 0.8).moved(z=hub))
        + hood
    )


def _arc(size: Size, metal: Material, cloth: Material) -> Parts:
    d, w, h = size
    x0, x1, r = -d / 2 + 0.16, d / 2 - w / 2, w / 2
    t = np.linspace(0, np.pi * 0.93, 22)
    path = np.stack(
        [x0 + (x1 - x0) * (1 - np.cos(t)) / 1.976, np.zeros(22), 0.45 * h + 0.545 * h * np.sin(t) ** 0.9], axis=1
    )
    path = np.concatenate([[(x0, 0, 0.03)], path])
    end = path[-1]
    hood = lathe(
        [
            (0.02, 0.20),
            (r * 0.55, 0.185),
            (r * 0.86, 0.12),
            (r, 0.0),
            (r - 0.006, 0.0),
            (r * 0.83, 0.115),
            (r * 0.5, 0.178),
        ],
        36,
        np.deg2rad(50),
    )
    z = end[2] - 0.2
    return (
        of(metal, tube(path, 0.012, 10), rod(end, (x1, 0, z + 0.19), 0.008), cylinder(0.16, 0.04, 0.006, 36).moved(x0))
        + of(cloth, hood.moved(x1, 0, z))
        + shifted(bulb(z + 0.05, 0.045), x1)
    )


def torchiere(size: Size, metal: Material, bowl: Material) -> Parts:
    """An uplighter: a bowl on a tall pole."""
    d, _, h = size
    r = d / 2
    dish = lathe(
        [
            (0.02, h - 0.11),
            (r * 0.5, h - 0.085),
            (r * 0.85, h - 0.04),
            (r, h),
            (r - 0.008, h),
            (r * 0.8, h - 0.035),
            (r * 0.4, h - 0.07),
            (0.01, h - 0.08),
        ],
        36,
        np.deg2rad(60),
    )
    foot = lathe([(r * 0.8, 0), (r * 0.82, 0.008), (r * 0.76, 0.02), (0.03, 0.035), (0.014, 0.06)], 36)
    return of(metal, foot, cylinder(0.013, h - 0.14, 0.002, 16).moved(z=0.04)) + of(bowl, dish)


def reading_lamp(size: Size, metal: Material) -> Parts:
    """A floor reading lamp with a small adjustable head."""
    d, w, h = size
    x0 = -d / 2 + w / 2
    path = bend(
        [
            (x0, 0, 0.02),
            (x0, 0, h * 0.75),
            (x0 + 0.02, 0, h - 0.05),
            (x0 + 0.12, 0, h - 0.01),
            (d / 2 - 0.12, 0, h - 0.04),
        ],
        8,
    )
    hood = (
        lathe([(0.018, 0.15), (0.028, 0.14), (0.034, 0.1), (0.07, 0), (0.067, 0), (0.03, 0.1)], 28)
        .turned("y", -30)
        .moved(d / 2 - 0.1, 0, h - 0.17)
    )
    foot = lathe([(w * 0.48, 0), (w * 0.5, 0.006), (w * 0.46, 0.018), (0.02, 0.026)], 36).moved(x0)
    return of(metal, tube(path, 0.009, 10), hood, foot) + of(
        m.LAMP_GLOW, ball(0.055).moved(d / 2 - 0.085, 0, h - 0.155)
    )


def column_lamp(size: Size, wood: Material) -> Parts:
    """A paper column on a wooden frame."""
    d, w, h = size
    s = 0.022
    posts = [box((s, s, h), 0.003).moved(x * (d / 2 - s / 2), y * (w / 2 - s / 2)) for x in (1, -1) for y in (1, -1)]
    bars = [box((d, s, s), 0.003).moved(0, y * (w / 2 - s / 2), z) for y in (1, -1) for z in (0.12, h * 0.45, h - s)]
    bars += [box((s, w, s), 0.003).moved(x * (d / 2 - s / 2), 0, z) for x in (1, -1) for z in (0.12, h * 0.45, h - s)]
    return of(wood, *posts, *bars) + of(m.LAMP_GLOW, box((d - 1.4 * s, w - 1.4 * s, h - 0.16), 0.004).moved(z=0.14))


def paper_tower(size: Size, paper: Material, metal: Material) -> Parts:
    """A tall ribbed paper lantern on thin legs."""
    d, _, h = size
    r, low = d / 2, 0.1 * h
    t = np.linspace(0, 1, 91)
    waist = 0.8 + 0.2 * np.cos(2 * np.pi * 2 * t)
    profile = [
        (float(r * a * (0.985 + 0.015 * np.cos(2 * np.pi * 30 * s))), float(low + s * (h - low)))
        for s, a in zip(t, waist, strict=True)
    ]
    legs = [rod((r * 0.9, 0, 0), (r * 0.7, 0, low + 0.02), 0.005).turned("z", 120 * k) for k in range(3)]
    return of(paper, lathe(profile, 28, np.pi)) + of(
        metal, *legs, tube(ring_path(superellipse(1.8 * r, 1.8 * r, 2, 30), 0.006), 0.005, 6, closed=True)
    )


def studio_lamp(size: Size, wood: Material, metal: Material) -> Parts:
    """A spotlight with a drum hood on a wooden tripod."""
    d, w, h = size
    hub = h * 0.72
    foot = d * 0.48
    legs = [rod((foot, 0, 0.0), (0.03, 0, hub), 0.011, 0.016).turned("z", 60 + 120 * k) for k in range(3)]
    r = min(w * 0.36, 0.17)
    hood = lathe(
        [
            (0.3 * r, -1.3 * r),
            (0.62 * r, -1.25 * r),
            (0.7 * r, -0.5 * r),
            (0.98 * r, 0.0),
            (r, 0.6 * r),
            (0.965 * r, 0.6 * r),
            (0.94 * r, 0.02 * r),
            (0.6 * r, -0.4 * r),
            (0.02, -0.5 * r),
        ],
        36,
        np.deg2rad(50),
    )
    head = of(metal, hood) + bulb(-0.1 * r, 0.3 * r)
    head = [p.turned("y", 78).moved(0.02, 0, h - r) for p in head]
    yoke = tube(
        bend(
            [
                (0, r * 1.06, h - r),
                (0, r * 0.9, h - 1.9 * r),
                (0, 0, h - 2.25 * r),
                (0, -r * 0.9, h - 1.9 * r),
                (0, -r * 1.06, h - r),
            ],
            5,
        ),
        0.007,
        8,
    )
    stem = cylinder(0.014, h - 2.2 * r - hub + 0.06, 0.002, 14).moved(z=hub - 0.05)
    return of(wood, *legs) + of(metal, yoke, stem, cylinder(0.045, 0.05, 0.006, 24).moved(z=hub - 0.04)) + head


def tree_lamp(size: Size, metal: Material, hood_of: Material, heads: int = 3) -> Parts:
    """A pole with small cones at different heights."""
    d, _, h = size
    foot = lathe([(0.15, 0), (0.155, 0.006), (0.145, 0.02), (0.03, 0.03), (0.014, 0.05)], 36)
    parts = of(metal, foot, cylinder(0.012, h - 0.02, 0.002, 16).moved(z=0.02))
    cone = lathe([(0.02, 0.15), (0.032, 0.14), (0.075, 0.0), (0.072, 0.0), (0.028, 0.125)], 28)
    for k in range(heads):
        z = h * (0.95 - 0.17 * k)
        bits = of(metal, rod((0, 0, z), (d * 0.26, 0, z + 0.03), 0.006)) + of(
            hood_of, cone.turned("y", -38).moved(d * 0.34, 0, z - 0.06)
        )
        bits += of(m.LAMP_GLOW, ball(0.055).moved(d * 0.36, 0, z - 0.055))
        parts += [p.turned("z", 120 * k + 30) for p in bits]
    return parts


def shelf_lamp(size: Size, wood: Material, cloth: Material) -> Parts:
    """A square paper shade on a slim stand of three shelves."""
    d, w, h = size
    s, hs = 0.02, 0.3 * h
    posts = four(box((s, s, h), 0.003).moved(d / 2 - s / 2, w / 2 - s / 2))
    boards = [box((d - 0.004, w - 0.004, 0.016), 0.003).moved(z=z) for z in (0.06, 0.24 * h, 0.46 * h)]
    rails = [box((d, s, s), 0.003).moved(0, f * (w - s) / 2, z) for f in (1, -1) for z in (h - hs - 0.02, h - s)]
    rails += [box((s, w, s), 0.003).moved(f * (d - s) / 2, 0, z) for f in (1, -1) for z in (h - hs - 0.02, h - s)]
    return of(wood, *posts, *boards, *rails) + of(
        cloth, box((d - 1.2 * s, w - 1.2 * s, hs - 0.02), 0.003).moved(z=h - hs)
    )


def light_line(size: Size, metal: Material) -> Parts:
    """A leaning line of light on a round foot."""
    d, w, h = size
    foot = cylinder(w * 0.5, 0.014, 0.004, 40).moved(-d / 2 + w * 0.5)
    a, b = (-d / 2 + w * 0.5, 0, 0.01), (d / 2 - 0.02, 0, h - 0.01)
    lean = float(np.rad2deg(np.arctan2(b[0] - a[0], b[2] - a[2])))
    length = float(np.hypot(b[0] - a[0], b[2] - a[2]))
    strip = box((0.006, 0.02, length * 0.92), 0.002).moved(0.012, 0, 0.04).turned("y", lean).moved(*a)
    return of(metal, foot, box((0.02, 0.026, length), 0.005).turned("y", lean).moved(*a)) + of(m.LAMP_GLOW, strip)


PAPER_SHADE = m.lit("lantern paper", "#f1e9da", 0.32)


DESIGNS: tuple[Design, ...] = (
    design("floor lamp", "pole-black", "black floor lamp with a linen drum shade", (0.42, 0.42, 1.58), "minimal", floor_shade, 36, stand="pole", metal=m.BLACK_STEEL, cloth=m.LINEN_SHADE),
    design("floor lamp", "pole-brass", "brass floor lamp", (0.38, 0.38, 1.50), "classic", floor_shade, 36, stand="pole", metal=m.BRASS, cloth=m.WHITE_COTTON, shade_h=0.3),
    design("floor lamp", "tripod-oak", "oak tripod floor lamp", (0.52, 0.52, 1.52), "modern", floor_shade, 3, stand="tripod", metal=m.OAK, cloth=m.LINEN_SHADE),
    design("floor lamp", "arc", "arched steel floor lamp", (1.15, 0.36, 1.95), "modern", floor_shade, stand="arc", metal=m.STEEL, cloth=m.BLACK_STEEL),
    design("floor lamp", "torchiere", "uplighter with an alabaster bowl", (0.38, 0.38, 1.76), "classic", torchiere, 36, metal=m.IRON, bowl=m.LAMP_GLOW),
    design("floor lamp", "reading", "black reading lamp", (0.45, 0.26, 1.40), "industrial", reading_lamp, metal=m.BLACK_STEEL),
    design("floor lamp", "column", "paper column lamp", (0.28, 0.28, 1.30), "minimal", column_lamp, 4, wood=m.WALNUT),
    design("floor lamp", "paper-tower", "tall paper lantern", (0.34, 0.34, 1.35), "minimal", paper_tower, 36, paper=PAPER_SHADE, metal=m.BLACK_STEEL),
    design("floor lamp", "studio", "studio spotlight on a wooden tripod", (0.62, 0.58, 1.55), "industrial", studio_lamp, 1, wood=m.WALNUT, metal=m.BLACK_STEEL),
    design("floor lamp", "tree", "brass floor lamp with three heads", (0.55, 0.55, 1.62), "modern", tree_lamp, 1, metal=m.BRASS, hood_of=m.BRASS),
    design("floor lamp", "tree-white", "white floor lamp with three heads", (0.52, 0.52, 1.55), "minimal", tree_lamp, 1, metal=m.WHITE, hood_of=m.WHITE),
    design("floor lamp", "shelf", "floor lamp with shelves and a linen shade", (0.28, 0.28, 1.60), "modern", shelf_lamp, 4, wood=m.BLACK_WOOD, cloth=m.LINEN_SHADE),
    design("floor lamp", "line", "slim leaning light", (0.36, 0.26, 1.48), "minimal", light_line, 1, metal=m.BLACK_STEEL),
    design("floor lamp", "arc-brass", "brass arc lamp with a white dome", (1.05, 0.38, 1.90), "modern", floor_shade, 1, stand="arc", metal=m.BRASS, cloth=m.PORCELAIN),
    design("floor lamp", "tripod-black", "black tripod lamp with a linen drum", (0.50, 0.50, 1.48), "industrial", floor_shade, 3, stand="tripod", metal=m.BLACK_WOOD, cloth=m.LINEN_SHADE),
    design("floor lamp", "pole-turned", "turned wooden floor lamp", (0.44, 0.44, 1.60), "classic", turned_pole, 36, wood=m.MAHOGANY, cloth=m.LINEN_SHADE),
)  # fmt: skip
