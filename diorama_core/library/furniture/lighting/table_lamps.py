"""Lamps with a shade for tables and night stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.lighting.shades import bulb, filament_bulb, shade, spider


def shaded_lamp(
    size: Size,
    profile: tuple[tuple[float, float], ...],
    body: Material,
    cloth: Material,
    shade_h: float = 0.42,
    flare: float = 0.72,
    foot: Material | None = None,
    pleats: int = 0,
) -> Parts:
    """A turned body (radius and height as fractions of the width and of the body) under a cloth shade."""
    d, _, h = size
    r, hs = d / 2, shade_h * h
    neck = h - hs * 0.75
    parts = of(body, lathe([(a * r, b * neck) for a, b in smooth_profile(profile)], 36, np.deg2rad(50)))
    parts += of(
        foot or m.BRASS,
        cylinder(0.008, hs * 0.5).moved(z=neck - 0.005),
        *spider(r * flare * 1.02, h - 0.02),
        cylinder(0.006, 0.02).moved(z=h - 0.03),
    )
    return parts + bulb(h - hs * 0.5) + of(cloth, shade(r, r * flare, hs, pleats).moved(z=h - hs))


def globe_lamp(size: Size, foot: Material) -> Parts:
    """A glowing glass globe on a low foot."""
    d, _, h = size
    base = h - d * 0.97
    return of(foot, lathe([(d * 0.3, 0), (d * 0.31, 0.006), (d * 0.27, base * 0.7), (d * 0.2, base + 0.02)], 32)) + of(
        m.LAMP_GLOW, ball(d, 12).moved(z=h - d)
    )


def mushroom_lamp(size: Size, body: Material) -> Parts:
    """A one-piece lamp with a domed head."""
    d, _, h = size
    r = d / 2
    a = np.linspace(0.05, np.pi / 2, 12)
    dome = [(r * np.sin(x), h * 0.62 + (h * 0.38) * np.cos(x)) for x in a[::-1]]
    inside = [(r * 0.94 * np.sin(x), h * 0.62 + (h * 0.35) * np.cos(x)) for x in a]
    stem = lathe(
        [(r * 0.62, 0), (r * 0.64, 0.01), (r * 0.42, h * 0.2), (r * 0.34, h * 0.45), (r * 0.4, h * 0.75)],
        36,
        np.deg2rad(60),
    )
    return of(body, stem, lathe([inside[-1], *dome, *inside], 40, np.deg2rad(60))) + bulb(h * 0.72, r * 0.3)


def stained_glass_lamp(size: Size, foot: Material, glass: Material) -> Parts:
    """A leaded glass shade like a flower over a bronze stem."""
    d, _, h = size
    r, hs = d / 2, 0.42 * h
    dome = [(0.12, 1.0), (0.3, 0.95), (0.62, 0.72), (0.86, 0.4), (1.0, 0.0)]
    outer = [(r * a, h - hs + 0.94 * hs * b) for a, b in smooth_profile(tuple(dome), 2)]
    inner = [(a * 0.975, z - 0.003) for a, z in reversed(outer)]
    hood = lathe([*outer, *inner, outer[0]], 40, np.pi)
    v = hood.vertices
    hood = replace(hood, uv=np.column_stack([np.arctan2(v[:, 1], v[:, 0]) / (2 * np.pi) * 3, (v[:, 2] - h + hs) / hs]))
    ribs = [tube(np.array([(a + 0.001, 0, z) for a, z in outer]), 0.0022, 4).turned("z", 30 * k) for k in range(12)]
    rim = tube(ring_path(superellipse(2 * r, 2 * r, 2, 40), h - hs), 0.004, 6, closed=True)
    stem = lathe(
        [
            (a * r, b * (h - hs * 0.3))
            for a, b in smooth_profile(
                ((0.5, 0), (0.52, 0.02), (0.3, 0.07), (0.1, 0.12), (0.16, 0.25), (0.09, 0.4), (0.07, 0.7), (0.09, 1.0))
            )
        ],
        32,
    )
    cap = lathe([(0.14 * r, h - 0.07 * hs), (0.1 * r, h - 0.03 * hs), (0.03 * r, h)], 20)
    return of(foot, stem, cap, rim, *ribs) + of(glass, hood) + bulb(h - hs * 0.55, 0.03)


def paper_lamp(size: Size, paper: Material, wood: Material) -> Parts:
    """A ribbed paper body on three short legs."""
    d, _, h = size
    r, low = d / 2, 0.12 * h
    t = np.linspace(0, 1, 45)
    wave = 1 + 0.02 * np.cos(2 * np.pi * 15 * t)
    profile = [
        (float(r * (0.45 + 0.55 * np.sin(np.pi * (0.1 + 0.8 * s))) * f * 0.99), float(low + s * (h - low)))
        for s, f in zip(t, wave, strict=True)
    ]
    legs = [rod((r * 0.42, 0, 0), (r * 0.3, 0, low + 0.03), 0.006).turned("z", 120 * k) for k in range(3)]
    return of(paper, lathe(profile, 32, np.pi)) + of(wood, *legs)


def bare_bulb_lamp(size: Size, base: Material, metal: Material) -> Parts:
    """A clear bulb on a block."""
    d, _, h = size
    low = h - 0.135 * h / 0.22
    k = h / 0.22
    lit = [p.turned("x", 180) for p in filament_bulb(0.0, scale=k)]
    return (
        of(base, box((d, d, low - 0.01), 0.008, 2))
        + of(metal, cylinder(0.018 * k, 0.03, 0.003, 20).moved(z=low - 0.012))
        + shifted(lit, z=low + 0.008)
    )


def pipe_lamp(size: Size, iron: Material) -> Parts:
    """Plumber's pipe bent into a lamp, a bulb at its end."""
    d, w, h = size
    x = -d / 2 + 0.05
    top = h - 0.03
    path = [
        (x, 0, 0.02),
        (x, 0, top - 0.02),
        (x + 0.02, 0, top),
        (d / 2 - 0.06, 0, top),
        (d / 2 - 0.04, 0, top - 0.02),
        (d / 2 - 0.04, 0, top - 0.07),
    ]
    pipe = tube(np.array(path), 0.013, 12)
    joints = [cylinder(0.02, 0.035, 0.003, 16).moved(x, 0, z) for z in (0.02, top - 0.05)]
    joints += [cylinder(0.02, 0.035, 0.003, 16).turned("y", 90).moved(s, 0, top) for s in (x + 0.015, d / 2 - 0.095)]
    valve = [
        tube(ring_path(superellipse(0.07, 0.07, 2, 20)), 0.005, 6, closed=True)
        .turned("y", 90)
        .moved(x + 0.045, 0, h * 0.45),
        rod((x, 0, h * 0.45), (x + 0.045, 0, h * 0.45), 0.006),
    ]
    spokes = [rod((x + 0.045, y, h * 0.45), (x + 0.045, -y, h * 0.45), 0.003, segments=6) for y in (0.033,)]
    flange = cylinder(0.07, 0.014, 0.003, 28).moved(x)
    lamp = shifted(filament_bulb(top - 0.07, scale=1.15), d / 2 - 0.04)
    return (
        of(iron, pipe, *joints, flange, *valve, *spokes)
        + lamp
        + of(m.RECLAIMED, box((d * 0.7, w, 0.022), 0.004).moved(-d * 0.15))
    )


def lantern(size: Size, metal: Material) -> Parts:
    """A glazed lantern with a handle and a lit candle of electric light."""
    d, w, h = size
    body = h * 0.74
    s = 0.012
    posts = four(box((s, s, body - 0.03), 0.002).moved(d * 0.44, w * 0.44, 0.02))
    roof = taper((0, 0, 0), (0, 0, h * 0.13), 1.0, 0.3, 0.02).scaled(d, w, 1.0).moved(z=body - 0.012)
    panes = [box((0.002, w * 0.86, body - 0.05), 0.0005).moved(f * d * 0.44, 0, 0.03) for f in (1, -1)] + [
        box((d * 0.86, 0.002, body - 0.05), 0.0005).moved(0, f * w * 0.44, 0.03) for f in (1, -1)
    ]
    ring = (
        tube(ring_path(superellipse(0.09, 0.09, 2, 24)), 0.004, 6, closed=True).turned("x", 90).moved(0, 0, h - 0.047)
    )
    light = cylinder(0.28 * d, body * 0.45, 0.006, 24).moved(z=0.02)
    flame = lathe([(0.003, 0), (0.009, 0.012), (0.006, 0.028), (0.001, 0.045)], 10, np.pi).moved(z=0.03 + body * 0.45)
    return (
        of(
            metal,
            box((d, w, 0.022), 0.004),
            *posts,
            roof,
            ring,
            cylinder(0.12 * d, 0.03, 0.004, 16).moved(z=body + h * 0.11),
        )
        + of(m.GLASS, *panes)
        + of(m.CREAM, light)
        + of(m.LAMP_GLOW, flame)
    )


def stacked_lamp(size: Size, body: tuple[Material, ...], cloth: Material) -> Parts:
    """Balls piled on each other under a drum shade."""
    d, _, h = size
    r, hs = d / 2, 0.4 * h
    neck = h - hs * 0.8
    diameters = (0.66 * r, 0.58 * r, 0.5 * r)
    share = (neck - 0.04) / sum(diameters)
    parts: Parts = of(m.BRASS, cylinder(0.42 * r, 0.02, 0.005, 32))
    z = 0.02
    for k, size_k in enumerate(diameters):
        one = ball(size_k * 1.25, 9).scaled(z=share / 1.25 * 1.03)
        parts += of(body[k % len(body)], one.moved(z=z))
        z += size_k * share
    parts += of(m.BRASS, cylinder(0.008, hs * 0.9, 0.002, 12).moved(z=z), *spider(r * 0.9, h - 0.02))
    return parts + bulb(h - hs * 0.5) + of(cloth, shade(r, r * 0.88, hs).moved(z=h - hs))


def block_lamp(
    size: Size,
    body: Material,
    cloth: Material,
    foot: Material,
    column: float = 0.34,
    shade_h: float = 0.34,
    deep: float = 0.5,
) -> Parts:
    """A square column under an oblong box of cloth.

    Args:
        size: Its extents.
        body: What the column is made of.
        cloth: What the shade is made of.
        foot: What plate, neck and finial are made of.
        column: Width of the column, as a share of the shade's.
        shade_h: Height of the shade, as a share of the whole.
        deep: Depth of the column, as a share of its width.
    """
    d, w, h = size
    hs, plate, finial = shade_h * h, 0.018, 0.022
    low, neck = h - finial - hs, 0.05 * h
    wide, deep_m = column * w, max(deep * column * w, 0.04)
    t = 0.004
    walls = [box((t, w, hs), 0.0015).moved(f * (d - t) / 2) for f in (1, -1)]
    walls += [box((d, t, hs), 0.0015).moved(0, f * (w - t) / 2) for f in (1, -1)]
    spokes = [rod((0, -w / 2, h - finial - 0.012), (0, w / 2, h - finial - 0.012), 0.002, segments=6)]
    return (
        of(body, box((deep_m, wide, low - neck - plate), 0.006, 2).moved(z=plate))
        + of(
            foot,
            box((1.5 * deep_m, 1.25 * wide, plate), 0.003),
            cylinder(0.008, h - low + neck - 0.01, 0.002, 12).moved(z=low - neck - 0.004),
            ball(0.018, 4).moved(z=h - 0.018),
            *spokes,
        )
        + bulb(low + 0.4 * hs, min(0.03, 0.3 * d))
        + of(cloth, *(wall.moved(z=low) for wall in walls))
    )


LEADED = m.Material("leaded glass", "medallion", "#7d8f7a", 0.3, 0.0, 1.0, glow=0.18)
PAPER_SHADE = m.lit("rice paper", "#f0e8d8", 0.3)


URN = (
    (0.34, 0.0),
    (0.36, 0.015),
    (0.2, 0.06),
    (0.3, 0.14),
    (0.52, 0.36),
    (0.54, 0.5),
    (0.4, 0.72),
    (0.16, 0.86),
    (0.12, 0.93),
    (0.05, 1.0),
)


BOTTLE = ((0.36, 0.0), (0.44, 0.03), (0.48, 0.25), (0.46, 0.45), (0.26, 0.68), (0.14, 0.8), (0.12, 0.95), (0.05, 1.0))


COLUMN = ((0.42, 0.0), (0.43, 0.02), (0.4, 0.05), (0.09, 0.07), (0.075, 0.1), (0.075, 0.96), (0.04, 1.0))


ORB = (
    (0.2, 0.0),
    (0.36, 0.04),
    (0.56, 0.2),
    (0.62, 0.4),
    (0.56, 0.6),
    (0.36, 0.77),
    (0.14, 0.84),
    (0.1, 0.9),
    (0.04, 1.0),
)


GOURD = (
    *((0.34, 0.0), (0.36, 0.02), (0.52, 0.12), (0.58, 0.24), (0.5, 0.38), (0.28, 0.5)),
    *((0.34, 0.6), (0.36, 0.68), (0.28, 0.79), (0.12, 0.88), (0.1, 0.94), (0.04, 1.0)),
)


TOTEM = (
    *((0.36, 0.0), (0.37, 0.02), (0.2, 0.045), (0.34, 0.09), (0.4, 0.16), (0.34, 0.23), (0.14, 0.275)),
    *((0.28, 0.32), (0.34, 0.39), (0.28, 0.46), (0.12, 0.505), (0.23, 0.545), (0.28, 0.61), (0.23, 0.675)),
    *((0.1, 0.715), (0.16, 0.75), (0.19, 0.79), (0.16, 0.83), (0.08, 0.87), (0.06, 0.94), (0.04, 1.0)),
)


CANDLE = (
    (0.4, 0.0),
    (0.42, 0.02),
    (0.3, 0.05),
    (0.12, 0.09),
    (0.18, 0.16),
    (0.1, 0.22),
    (0.14, 0.45),
    (0.1, 0.75),
    (0.2, 0.82),
    (0.08, 0.88),
    (0.04, 1.0),
)


DESIGNS: tuple[Design, ...] = (
    design("lamp", "urn-blue", "blue ceramic table lamp", (0.36, 0.36, 0.60), "classic", shaded_lamp, 36, profile=URN, body=m.BLUE_GLAZE, cloth=m.LINEN_SHADE),
    design("lamp", "bottle-white", "white bottle table lamp", (0.30, 0.30, 0.52), "modern", shaded_lamp, 36, profile=BOTTLE, body=m.PORCELAIN, cloth=m.LINEN_SHADE, flare=0.85),
    design("lamp", "column-brass", "slim brass table lamp", (0.28, 0.28, 0.50), "modern", shaded_lamp, 36, profile=COLUMN, body=m.BRASS, cloth=m.WHITE_COTTON, flare=0.95, shade_h=0.36),
    design("lamp", "orb-stone", "round stoneware lamp", (0.38, 0.38, 0.56), "rustic", shaded_lamp, 36, profile=ORB, body=m.STONEWARE, cloth=m.OATMEAL, flare=0.8),
    design("lamp", "candlestick", "turned wooden lamp with a pleated shade", (0.32, 0.32, 0.62), "classic", shaded_lamp, 36, profile=CANDLE, body=m.WALNUT, cloth=m.LINEN_SHADE, flare=0.6, pleats=40),
    design("lamp", "globe", "glass globe lamp", (0.24, 0.24, 0.30), "minimal", globe_lamp, 36, foot=m.BRASS),
    design("lamp", "mushroom", "terracotta mushroom lamp", (0.30, 0.30, 0.36), "modern", mushroom_lamp, 36, body=m.TERRACOTTA),
    design("lamp", "stained-glass", "stained glass table lamp", (0.38, 0.38, 0.52), "classic", stained_glass_lamp, 4, foot=m.IRON, glass=LEADED),
    design("lamp", "paper", "rice paper lamp on three legs", (0.26, 0.26, 0.42), "minimal", paper_lamp, 36, paper=PAPER_SHADE, wood=m.OAK),
    design("lamp", "bare-bulb", "bare bulb on a concrete block", (0.10, 0.10, 0.22), "industrial", bare_bulb_lamp, 4, base=m.CONCRETE, metal=m.BRASS),
    design("lamp", "pipe", "pipe lamp with a valve", (0.28, 0.16, 0.42), "industrial", pipe_lamp, 1, iron=m.BLACK_STEEL),
    design("lamp", "lantern", "black lantern with a candle", (0.18, 0.18, 0.38), "rustic", lantern, 4, metal=m.BLACK_STEEL),
    design("lamp", "stacked", "lamp of stacked oak balls", (0.32, 0.32, 0.54), "modern", stacked_lamp, 36, body=(m.OAK, m.WALNUT), cloth=m.LINEN_SHADE),
    design("lamp", "mushroom-white", "small white mushroom lamp", (0.24, 0.24, 0.30), "minimal", mushroom_lamp, 36, body=m.CREAM),
    design("lamp", "column-black", "black metal table lamp with a grey shade", (0.26, 0.26, 0.48), "industrial", shaded_lamp, 36, profile=COLUMN, body=m.BLACK_STEEL, cloth=m.LIGHT_FABRIC, flare=0.9, shade_h=0.36),
    design("lamp", "urn-green", "green glazed lamp with an empire shade", (0.40, 0.40, 0.64), "classic", shaded_lamp, 36, profile=URN, body=m.GREEN_GLAZE, cloth=m.LINEN_SHADE, flare=0.55),
    design("lamp", "gourd-celadon", "pale green gourd lamp with a drum shade", (0.38, 0.38, 0.62), "classic", shaded_lamp, 36, profile=GOURD, body=m.GREEN_GLAZE, cloth=m.LINEN_SHADE, flare=0.88, shade_h=0.38),
    design("lamp", "gourd-white", "white gourd lamp", (0.32, 0.32, 0.56), "modern", shaded_lamp, 36, profile=GOURD, body=m.PORCELAIN, cloth=m.LINEN_SHADE, flare=0.74),
    design("lamp", "totem-silver", "silver lamp of stacked globes", (0.34, 0.34, 0.68), "modern", shaded_lamp, 36, profile=TOTEM, body=m.CHROME, cloth=m.WHITE_COTTON, flare=0.86, shade_h=0.36),
    design("lamp", "block-stone", "stone block lamp with an oblong shade", (0.20, 0.40, 0.58), "modern", block_lamp, 2, body=m.CONCRETE, cloth=m.LINEN_SHADE, foot=m.CHROME),
    design("lamp", "block-walnut", "walnut column lamp with a square shade", (0.28, 0.28, 0.55), "minimal", block_lamp, 4, body=m.WALNUT, cloth=m.WHITE_COTTON, foot=m.BLACK_STEEL, column=0.32, shade_h=0.40, deep=1.0),
)  # fmt: skip
