"""Jars with lids, and fruit."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

CEREAL = Material("dry pasta", "speckle", "#c9a86e", 0.9, 0.0, 0.1)
BEANS = Material("coffee beans", "speckle", "#4b3528", 0.6, 0.0, 0.08)
JAM = m.paint("jam", "#7d3a3a", 0.3)
GINGHAM = Material("gingham", "check", "#a05a52", 0.92, 0.0, 0.08)
APPLE = Material("apple", "clay", "#a5544a", 0.4, 0.0, 0.1)
GREEN_APPLE = Material("green apple", "clay", "#9aa860", 0.4, 0.0, 0.1)
ORANGE = Material("orange", "clay", "#cd9560", 0.6, 0.0, 0.05)
BANANA = Material("banana", "clay", "#d3bb72", 0.55, 0.0, 0.2)
LEMON = Material("lemon", "clay", "#d6c370", 0.55, 0.0, 0.05)


def canister(size: Size, glass: Material, lid: Material, fill: Material | None, share: float = 0.7) -> Parts:
    """A straight jar with a flat lid and something in it."""
    _, w, h = size
    r, neck = w / 2, h * 0.88
    parts = of(glass, hollow(((0.96, 0), (1.0, 0.02), (1.0, 0.97), (0.97, 1.0)), r, neck, 0.003, 0.006, 32))
    if fill is not None:
        parts += of(fill, cylinder(r - 0.006, share * neck, 0.004, 28).moved(z=0.008))
    knob = ball(0.2 * w, 6).moved(z=h - 0.2 * w)
    return parts + of(lid, cylinder(r * 1.01, h - neck - 0.16 * w, 0.005, 32).moved(z=neck), knob)


def clip_jar(size: Size, fill: Material) -> Parts:
    """A preserving jar with a wire clip."""
    _, w, h = size
    r = w / 2 * 0.93
    body = hollow(((0.94, 0), (1.0, 0.02), (1.0, 0.8), (0.86, 0.92), (0.88, 1.0)), r, h * 0.86, 0.003, 0.006, 32)
    lid = lathe(
        [(0.9 * r, h * 0.88), (0.92 * r, h * 0.9), (0.86 * r, h * 0.97), (0.5 * r, h), (0.003, h)], 32, np.deg2rad(60)
    )
    seal = cylinder(0.9 * r, 0.006, 0.002, 32).moved(z=h * 0.865)
    clip = tube(
        bend([(r * 0.2, r * 0.98, h * 0.8), (0, r * 1.04, h * 0.86), (0, r * 0.9, h * 0.98), (0, 0, h * 1.0)], 4),
        0.0016,
        5,
    )
    catch = tube(
        bend([(r * 0.9, 0.012, h * 0.9), (r * 1.07, 0.012, h * 0.84), (r * 1.05, 0.012, h * 0.7)], 4), 0.0016, 5
    )
    inside = cylinder(r * 0.95, h * 0.58, 0.006, 28).moved(z=0.008)
    return of(m.GLASS, body, lid) + of(fill, inside) + of(RUBBER, seal) + of(m.STEEL, *both_sides(clip, catch))


RUBBER = m.paint("rubber seal", "#a8745a", 0.8)


def ginger_jar(size: Size, clay: Material, band: Material) -> Parts:
    """A shouldered porcelain jar with a domed lid."""
    _, w, h = size
    r, neck = w / 2, 0.78 * h
    body = lathe(
        [
            (a * r, b * neck)
            for a, b in smooth_profile(((0.6, 0), (0.64, 0.02), (0.8, 0.3), (1.0, 0.7), (0.9, 0.88), (0.5, 1.0)))
        ],
        40,
        np.deg2rad(60),
    )
    lid = lathe(
        [
            (0.56 * r, neck - 0.004),
            (0.58 * r, neck + 0.06 * h),
            (0.5 * r, neck + 0.13 * h),
            (0.12 * r, neck + 0.16 * h),
        ],
        36,
        np.deg2rad(50),
    )
    knob = ball(0.09 * h, 6).moved(z=h - 0.09 * h)
    rings = []
    for a, b, z in ((0.647, 0.66, 0.05), (0.885, 0.87, 0.885)):
        low, high = z * neck, z * neck + 0.02 * h
        skin = [
            (a * r - 0.003, low),
            (a * r + 0.0012, low + 0.002),
            (b * r + 0.0012, high - 0.002),
            (b * r - 0.003, high),
        ]
        rings.append(lathe([*skin, skin[0]], 40, np.pi))
    return of(clay, body, lid, knob) + of(band, *rings)


def crock(size: Size, clay: Material, lid: Material) -> Parts:
    """A stoneware crock with a wooden lid."""
    _, w, h = size
    r, neck = w / 2, 0.86 * h
    body = lathe(
        [
            (0.9 * r, 0),
            (0.95 * r, 0.006),
            (r, 0.12 * neck),
            (r, 0.9 * neck),
            (0.94 * r, 0.96 * neck),
            (0.97 * r, neck),
            (0.9 * r, neck),
        ],
        36,
        np.deg2rad(45),
    )
    return of(clay, body) + of(
        lid,
        cylinder(0.95 * r, 0.07 * h, 0.004, 36).moved(z=neck - 0.002),
        cylinder(0.2 * r, 0.08 * h, 0.006, 20).moved(z=h * 0.92),
    )


def jam_jar(size: Size) -> Parts:
    """A jar of jam under a cloth cap."""
    _, w, h = size
    r = w / 2 * 0.9
    body = lathe(
        [(0.9 * r, 0), (r, 0.006), (r, 0.66 * h), (0.86 * r, 0.76 * h), (0.86 * r, 0.84 * h)], 32, np.deg2rad(50)
    )
    cap = lathe(
        [
            (1.1 * r, 0.76 * h),
            (1.0 * r, 0.82 * h),
            (0.88 * r, 0.84 * h),
            (0.94 * r, 0.96 * h),
            (0.8 * r, h),
            (0.003, h),
        ],
        36,
        np.deg2rad(60),
    )
    label = cylinder(r * 1.005, 0.3 * h, 0.001, 32).moved(z=0.2 * h)
    return (
        of(m.GLASS, body)
        + of(JAM, cylinder(r * 0.95, 0.66 * h, 0.004, 28).moved(z=0.006))
        + of(GINGHAM, cap)
        + of(m.PAPER, label)
    )


def apple(diameter: float) -> Solid:
    """An apple without its stalk."""
    r = diameter / 2
    outline = (
        (0.02, 0.16),
        (0.3, 0.03),
        (0.62, 0.2),
        (0.97, 0.85),
        (0.98, 1.2),
        (0.7, 1.66),
        (0.34, 1.74),
        (0.02, 1.52),
    )
    return lathe([(a * r, b * r) for a, b in smooth_profile(outline, 3)], 24, np.pi)


def _banana(length: float) -> Solid:
    t = np.linspace(-1.0, 1.0, 9)
    path = np.stack([0 * t, length / 2 * np.sin(t), length * 0.55 * (1 - np.cos(t))], axis=1)
    return tube(path, [0.003, 0.011, 0.016, 0.018, 0.018, 0.018, 0.016, 0.008, 0.004], 8)


def fruit_bowl(size: Size, clay: Material) -> Parts:
    """A wide bowl heaped with apples, oranges and bananas."""
    d, _, h = size
    r = d / 2
    dish = [
        (0.4 * r, 0),
        (0.43 * r, 0.004),
        (0.46 * r, 0.04 * h),
        (0.8 * r, 0.2 * h),
        (r, 0.5 * h),
        (0.97 * r, 0.5 * h),
        (0.76 * r, 0.22 * h),
        (0.003, 0.07 * h),
    ]
    parts = of(clay, lathe(dish, 40, np.deg2rad(50)))
    a = 0.36 * r * 1.55
    z = 0.16 * h
    for k, (material, lift) in enumerate(((APPLE, 0), (ORANGE, 0), (GREEN_APPLE, 0), (APPLE, 0), (ORANGE, 0))):
        angle = 2 * np.pi * k / 5 + 0.3
        x, y = 0.52 * r * np.cos(angle), 0.52 * r * np.sin(angle)
        solid = apple(a) if material is not ORANGE else ball(a, 7)
        parts += of(material, solid.moved(x, y, z + lift))
        if material is not ORANGE:
            parts += of(
                m.BARK,
                tube(
                    bend([(x, y, z + a * 0.72), (x + 0.003, y, z + a * 0.8), (x + 0.006, y, z + a * 0.92)], 2),
                    0.0016,
                    5,
                ),
            )
    parts += of(GREEN_APPLE, apple(a).moved(0, 0, z + 0.4 * a))
    bunch = [
        _banana(1.25 * r).turned("x", 4).turned("z", 12 * k - 14).moved(-0.12 * r + 0.19 * r * k, 0.02, h - 0.32 * r)
        for k in range(3)
    ]
    return parts + of(BANANA, *bunch)


def fruit_pile(size: Size, fruit: Material, count: int, stalk: bool) -> Parts:
    """Single pieces of fruit lying together."""
    d, w, h = size
    a = h
    spots = ((-0.5, -0.5), (0.5, -0.42), (-0.46, 0.48), (0.5, 0.5))[:count]
    parts: Parts = []
    for x, y in spots:
        at = (x * (d - a), y * (w - a)) if count > 1 else (0.0, 0.0)
        parts += of(fruit, (apple(a * 1.12) if stalk else ball(a, 8)).moved(*at))
        if stalk:
            parts += of(
                m.BARK,
                tube(
                    bend([(*at, a * 0.84), (at[0] + 0.002, at[1], a * 0.92), (at[0] + 0.005, at[1], a * 0.995)], 2),
                    0.0015,
                    5,
                ),
            )
    return parts


def bananas(size: Size) -> Parts:
    """A hand of bananas, lying."""
    _, w, _ = size
    solids = [_banana(w).turned("x", 0).turned("y", -62 + 22 * k).moved(0.0 + 0.01 * k, 0, 0.016) for k in range(5)]
    return of(BANANA, *solids) + of(m.BARK, box((0.02, 0.014, 0.016), 0.005).moved(0.02, w * 0.42, 0.05))


def lemons(size: Size, dish: Material) -> Parts:
    """Lemons in a shallow dish."""
    d, _, h = size
    r = d / 2
    bowl = [
        (0.5 * r, 0),
        (0.54 * r, 0.004),
        (0.95 * r, 0.34 * h),
        (r, 0.44 * h),
        (0.97 * r, 0.45 * h),
        (0.5 * r, 0.1 * h),
        (0.003, 0.09 * h),
    ]
    one = lathe(
        [(0.002, 0), (0.006, 0.004), (0.02, 0.014), (0.028, 0.038), (0.02, 0.062), (0.008, 0.072), (0.003, 0.08)],
        16,
        np.pi,
    ).moved(z=-0.04)
    k = r / 0.13
    spots = ((0.05, 0.0, 0.0, 10), (-0.03, 0.05, 0.0, 75), (-0.03, -0.05, 0.0, -50), (0.0, 0.0, 0.045, 30))
    fruit = [
        one.scaled(k, k, k).turned("y", 90).turned("z", a).moved(x * k, y * k, 0.1 * h + 0.03 * k + z * k)
        for x, y, z, a in spots
    ]
    return of(dish, lathe(bowl, 40, np.deg2rad(50))) + of(LEMON, *fruit)


DESIGNS: tuple[Design, ...] = (
    design("jar", "pasta", "glass jar of pasta", (0.11, 0.11, 0.26), "modern", canister, 36, glass=m.GLASS, lid=m.BIRCH, fill=CEREAL),
    design("jar", "coffee", "glass jar of coffee beans", (0.11, 0.11, 0.17), "industrial", canister, 36, glass=m.GLASS, lid=m.BLACK_STEEL, fill=BEANS),
    design("jar", "canister-cream", "cream kitchen canister", (0.13, 0.13, 0.19), "rustic", canister, 36, glass=m.CREAM, lid=m.OAK, fill=None),
    design("jar", "clip", "preserving jar with a wire clip", (0.12, 0.12, 0.20), "rustic", clip_jar, 1, fill=CEREAL),
    design("jar", "ginger", "blue and white ginger jar", (0.20, 0.20, 0.30), "classic", ginger_jar, 36, clay=m.PORCELAIN, band=m.NAVY),
    design("jar", "ginger-green", "green lidded jar", (0.17, 0.17, 0.24), "classic", ginger_jar, 36, clay=m.GREEN_GLAZE, band=m.BRASS),
    design("jar", "crock", "stoneware crock with a wooden lid", (0.16, 0.16, 0.18), "minimal", crock, 36, clay=m.STONEWARE, lid=m.OAK),
    design("jar", "jam", "jar of jam", (0.08, 0.08, 0.11), "rustic", jam_jar, 36),
    design("fruit", "bowl", "bowl of fruit", (0.30, 0.30, 0.20), "modern", fruit_bowl, clay=m.PORCELAIN),
    design("fruit", "bowl-wood", "wooden bowl of fruit", (0.34, 0.34, 0.21), "rustic", fruit_bowl, clay=m.WALNUT),
    design("fruit", "lemons", "dish of lemons", (0.26, 0.26, 0.12), "minimal", lemons, dish=m.BLUE_GLAZE),
    design("fruit", "apple", "red apple", (0.075, 0.075, 0.075), "classic", fruit_pile, 36, fruit=APPLE, count=1, stalk=True),
    design("fruit", "oranges", "four oranges", (0.16, 0.16, 0.075), "classic", fruit_pile, fruit=ORANGE, count=4, stalk=False),
    design("fruit", "bananas", "hand of bananas", (0.14, 0.20, 0.09), "modern", bananas),
)  # fmt: skip
