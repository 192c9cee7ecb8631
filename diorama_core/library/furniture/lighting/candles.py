"""Candles and what holds them."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

WAX = Material("candle wax", "plain", "#efe6d2", 0.45, 0.0, 0.1, glow=0.06)
FLAME = m.lit("candle flame", "#f0cf98", 0.9)
WICK = m.paint("wick", "#2a2522", 0.95)


def flame(z: float, scale: float = 1.0) -> Parts:
    """A wick and its flame above z."""
    k = scale
    return of(WICK, cylinder(0.0012 * k, 0.012 * k, 0.0003, 6).moved(z=z - 0.003 * k)) + of(
        FLAME,
        lathe([(0.001, 0), (0.0045 * k, 0.008 * k), (0.0038 * k, 0.016 * k), (0.0005, 0.034 * k)], 10, np.pi).moved(
            z=z + 0.005 * k
        ),
    )


def wax(radius: float, height: float, wax_of: Material = WAX) -> Parts:
    """A candle that has burnt a little hollow, its foot on z = 0, flame included."""
    r, h = radius, height
    b = min(0.004, 0.3 * r)
    top = [
        (r, h - b),
        (r - b, h),
        (0.7 * r, h - 0.5 * b),
        (0.45 * r, h - min(0.008, 0.4 * r)),
        (0.0008, h - min(0.01, 0.45 * r)),
    ]
    return of(wax_of, lathe([(r - 0.5 * b, 0), (r, b), *top], 24, np.deg2rad(50))) + flame(
        h - min(0.01, 0.45 * r), 1.0 if r < 0.02 else 1.2
    )


def pillars(size: Size, dish: Material, wax_of: Material = WAX) -> Parts:
    """Three pillar candles of different heights on a tray."""
    d, w, h = size
    o = superellipse(d, w, 3.5, 40)
    parts = of(dish, prism(o, 0.014, 0.005))
    r = 0.17 * min(d, w)
    for x, y, share in ((-0.14 * d, 0.22 * w, 0.94), (0.2 * d, 0.02 * w, 0.55), (-0.12 * d, -0.24 * w, 0.7)):
        parts += shifted(wax(r, share * h - 0.05), x, y, 0.013)
    return parts


STICKS = {
    "turned": (
        (0.5, 0.0),
        (0.52, 0.02),
        (0.34, 0.06),
        (0.13, 0.1),
        (0.24, 0.2),
        (0.12, 0.3),
        (0.2, 0.55),
        (0.12, 0.78),
        (0.26, 0.93),
        (0.24, 1.0),
    ),
    "slim": ((0.5, 0.0), (0.5, 0.03), (0.1, 0.06), (0.08, 0.1), (0.08, 0.88), (0.24, 0.93), (0.22, 1.0)),
    "bobbin": (
        (0.46, 0.0),
        (0.48, 0.04),
        (0.2, 0.1),
        (0.4, 0.22),
        (0.2, 0.34),
        (0.36, 0.46),
        (0.18, 0.58),
        (0.32, 0.7),
        (0.16, 0.82),
        (0.28, 0.94),
        (0.24, 1.0),
    ),
}


def candlestick(size: Size, body: Material, kind: str = "turned") -> Parts:
    """One taper in a turned stick."""
    d, _, h = size
    stick = 0.52 * h
    parts = of(body, lathe([(a * d, b * stick) for a, b in smooth_profile(STICKS[kind], 2)], 28))
    return parts + shifted(wax(0.011, h - stick - 0.03 + 0.012), z=stick - 0.012)


def pair(size: Size, body: Material, kind: str) -> Parts:
    """Two candlesticks of different heights."""
    d, w, h = size
    one = candlestick((d, d, h), body, kind)
    two = candlestick((d, d, h * 0.8), body, kind)
    return shifted(one, 0, w / 2 - d / 2) + shifted(two, 0.0, -w / 2 + d / 2)


def candelabra(size: Size, metal: Material, arms: int = 5) -> Parts:
    """A branched holder with `arms` candles in a row along y."""
    d, w, h = size
    base = 0.42 * h
    foot = [
        (a * d, b * base)
        for a, b in smooth_profile(
            ((0.5, 0.0), (0.5, 0.03), (0.3, 0.1), (0.09, 0.2), (0.15, 0.4), (0.07, 0.6), (0.1, 0.85), (0.06, 1.0)), 2
        )
    ]
    parts = of(metal, lathe(foot, 28))
    side = arms // 2
    for k in range(-side, side + 1):
        y, z = k * (w - 0.05) / (arms - 1), (0.62 - 0.03 * abs(k)) * h
        if k:
            arm = bend([(0, 0, base * 0.9), (0, 0.6 * y, base * 0.82), (0, 1.02 * y, base * 1.02), (0, y, z)], 5)
            parts += of(metal, tube(arm, 0.0055, 8))
        else:
            parts += of(metal, cylinder(0.007, z - base + 0.02, 0.002, 12).moved(z=base - 0.01))
        cup = lathe([(0.006, -0.012), (0.024, 0.0), (0.022, 0.005), (0.013, 0.007), (0.014, 0.022)], 18)
        parts += shifted(of(metal, cup) + shifted(wax(0.01, h - z - 0.05), z=0.012), 0, y, z)
    return parts


def jar_candle(size: Size, glass: Material, label: Material) -> Parts:
    """A scented candle in a glass with a label."""
    _, w, h = size
    r = w / 2
    tall = h * 0.94
    parts = of(glass, hollow(((0.95, 0), (1.0, 0.03), (1.0, 0.97), (0.98, 1.0)), r, tall, 0.003, 0.006, 32))
    parts += of(WAX, cylinder(r - 0.004, 0.62 * tall, 0.002, 28).moved(z=0.007)) + flame(0.62 * tall + 0.008, 1.2)
    t = np.linspace(-0.62, 0.62, 9)
    sheet = np.stack(
        [
            np.stack([(r + 0.0008) * np.cos(t), (r + 0.0008) * np.sin(t), np.full_like(t, z * tall)], axis=1)
            for z in (0.22, 0.6)
        ]
    )
    top = (
        of(m.SHADOW, cylinder(0.0006, h - tall * 0.62 - 0.02, 0.0002, 5).moved(z=tall * 0.62)) if h > tall * 1.2 else []
    )
    return parts + of(label, slab(sheet, 0.0008)) + top


def tealights(size: Size, wood: Material, count: int = 3) -> Parts:
    """Tea lights sunk in a beam."""
    d, w, h = size
    block = box((d, w, h * 0.6), 0.006, 2)
    parts = of(wood, block)
    for k in range(count):
        y = w * ((k + 0.5) / count - 0.5)
        cup = (
            of(m.STEEL, lathe([(0.019, 0), (0.0195, 0.012), (0.0185, 0.012), (0.018, 0.006), (0.001, 0.006)], 24))
            + of(WAX, cylinder(0.018, 0.009, 0.001, 20))
            + flame(0.01)
        )
        parts += shifted(cup, 0, y, h * 0.6 - 0.006)
    return parts


def votive(size: Size, glass: Material) -> Parts:
    """A tea light in a coloured tumbler."""
    _, w, h = size
    r = w / 2
    body = hollow(((0.7, 0), (0.76, 0.03), (0.95, 0.6), (1.0, 1.0)), r, h, 0.004, 0.01, 28)
    return of(glass, body) + shifted(of(WAX, cylinder(0.55 * r, 0.2 * h, 0.002, 20)) + flame(0.2 * h, 1.2), z=0.011)


def hurricane(size: Size, foot: Material) -> Parts:
    """A pillar candle in a tall glass on a wooden foot."""
    _, w, h = size
    r, low = w / 2, 0.14 * h
    base = lathe(
        [
            (0.9 * r, 0),
            (0.94 * r, 0.006),
            (0.5 * r, 0.4 * low),
            (0.6 * r, 0.7 * low),
            (0.96 * r, low - 0.004),
            (0.94 * r, low),
            (0.003, low),
        ],
        36,
    )
    glass = hollow(((0.86, 0), (0.9, 0.02), (1.0, 0.4), (0.88, 0.85), (0.94, 1.0)), r, h - low, 0.003, 0.003, 36).moved(
        z=low
    )
    return of(foot, base) + of(m.GLASS, glass) + shifted(wax(0.46 * r, 0.44 * h), z=low + 0.004)


RUBY = m.lit("amber votive glass", "#b3825c", 0.12)
LABEL = m.paint("label paper", "#d9cfbb", 0.9)

DESIGNS: tuple[Design, ...] = (
    design("candle", "pillars", "three pillar candles on a slate", (0.20, 0.30, 0.22), "modern", pillars, dish=m.DARK_STONEWARE),
    design("candle", "pillars-oak", "three candles on an oak board", (0.18, 0.34, 0.18), "rustic", pillars, dish=m.OAK),
    design("candle", "stick-brass", "taper in a brass candlestick", (0.10, 0.10, 0.36), "classic", candlestick, 36, body=m.BRASS),
    design("candle", "stick-wood", "taper in a bobbin-turned candlestick", (0.10, 0.10, 0.40), "rustic", candlestick, 36, body=m.WALNUT, kind="bobbin"),
    design("candle", "pair-black", "pair of slim black candlesticks", (0.09, 0.24, 0.42), "minimal", pair, body=m.BLACK_STEEL, kind="slim"),
    design("candle", "pair-glass", "pair of glass candlesticks", (0.09, 0.22, 0.34), "modern", pair, body=m.GLASS, kind="turned"),
    design("candle", "candelabra", "silver five-armed candelabra", (0.16, 0.38, 0.44), "classic", candelabra, 2, metal=m.CHROME),
    design("candle", "candelabra-iron", "iron three-armed candelabra", (0.14, 0.30, 0.40), "industrial", candelabra, 2, metal=m.IRON, arms=3),
    design("candle", "jar", "scented candle in a glass", (0.08, 0.08, 0.10), "minimal", jar_candle, glass=m.GLASS, label=LABEL),
    design("candle", "jar-amber", "scented candle in smoked glass", (0.09, 0.09, 0.11), "industrial", jar_candle, glass=m.glass("smoked candle glass", "#7d6a58", 0.4), label=m.CREAM),
    design("candle", "tealights", "tea lights in a wooden beam", (0.09, 0.34, 0.08), "rustic", tealights, 2, wood=m.RECLAIMED),
    design("candle", "votive", "amber votive candle", (0.08, 0.08, 0.09), "classic", votive, 36, glass=RUBY),
    design("candle", "hurricane", "candle in a hurricane glass", (0.16, 0.16, 0.34), "modern", hurricane, 36, foot=m.WALNUT),
)  # fmt: skip
