"""Pots and pans, knives and boards: what one cooks with."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

BLUE_IRON = m.paint("blue enamelled iron", "#4c6478", 0.3)
GREEN_IRON = m.paint("green enamelled iron", "#5f7362", 0.3)
CAST_IRON = m.metal("cast iron", "#343331", 0.75, 0.2)
COATING = m.paint("pan coating", "#2b2c2e", 0.5)


def loop(y: float, z: float, reach: float, width: float, radius: float = 0.005) -> Solid:
    """A side handle standing out from y."""
    return tube(
        bend(
            [
                (-width / 2, y - 0.004, z),
                (-width * 0.42, y + reach, z + 0.004),
                (width * 0.42, y + reach, z + 0.004),
                (width / 2, y - 0.004, z),
            ],
            4,
        ),
        radius,
        8,
    )


def pot(
    size: Size,
    body: Material,
    trim: Material,
    rounded: float = 0.0,
    lid: Material | None = None,
    glass_lid: bool = False,
) -> Parts:
    """A lidded pot with two handles; `rounded` eases its bottom."""
    d, w, h = size
    r = d / 2
    rim, reach = 0.7 * h, (w - d) / 2
    bend_ = max(rounded, 0.02)
    wall = [
        ((1 - bend_) * r, 0),
        ((1 - 0.3 * bend_) * r, 0.3 * bend_ * r),
        (r * 0.99, bend_ * r),
        (r * 0.99, rim - 0.004),
        (r, rim),
        (0.95 * r, rim),
    ]
    parts = of(body, lathe(wall, 40, np.deg2rad(50)))
    dome = [
        (0.96 * r, rim + 0.001),
        (r, rim + 0.004),
        (0.96 * r, rim + 0.012),
        (0.5 * r, rim + 0.12 * h),
        (0.1 * r, rim + 0.16 * h),
        (0.003, rim + 0.16 * h),
    ]
    parts += of(m.GLASS if glass_lid else lid or body, lathe(dome, 40, np.deg2rad(60)))
    if glass_lid:
        parts += of(trim, tube(ring_path(superellipse(2 * r, 2 * r, 2, 40), rim + 0.005), 0.004, 6, closed=True))
    knob = lathe(
        [(0.01, rim + 0.15 * h), (0.009, rim + 0.2 * h), (0.02, h - 0.012), (0.018, h - 0.002), (0.003, h)],
        20,
        np.deg2rad(50),
    )
    return parts + of(trim, knob, *both_sides(loop(0.985 * r, 0.84 * rim, reach, 0.07, 0.0055)))


def pan(size: Size, body: Material, inside: Material, grip: Material) -> Parts:
    """A frying pan, its handle toward -X."""
    d, w, h = size
    r = w / 2
    x = d / 2 - r
    rim = h * 0.62
    wall = [
        (0.78 * r, 0),
        (0.8 * r, 0.002),
        (r, rim - 0.003),
        (0.995 * r, rim),
        (0.965 * r, rim - 0.001),
        (0.8 * r, 0.008),
    ]
    dish = lathe(wall, 44, np.deg2rad(50)).moved(x)
    face = cylinder(0.8 * r, 0.003, 0.001, 40).moved(x, 0, 0.006)
    start = x - r * 0.95
    arm = beam((start, 0, rim * 0.8), (start - 0.06, 0, rim * 1.05), 0.026, 0.009, 0.004)
    path = [(start - 0.05, 0, rim * 1.05), (start - 0.11, 0, h * 0.86), (-d / 2 + 0.012, 0, h - 0.012)]
    return (
        of(body, dish, arm)
        + of(inside, face)
        + of(
            grip, tube(bend(path, 6), [*np.linspace(0.009, 0.013, 6), *np.linspace(0.013, 0.011, 7)], 10).scaled(y=1.25)
        )
    )


def saucepan(size: Size, body: Material, grip: Material) -> Parts:
    """A saucepan with its lid, the handle toward -X."""
    d, w, h = size
    r = w / 2
    x = d / 2 - r
    rim = 0.66 * h
    wall = [(0.95 * r, 0), (r, 0.005), (r, rim - 0.003), (1.02 * r, rim), (0.95 * r, rim)]
    dome = [(0.99 * r, rim + 0.001), (0.98 * r, rim + 0.006), (0.5 * r, rim + 0.12 * h), (0.003, rim + 0.15 * h)]
    knob = lathe([(0.008, 0), (0.007, 0.012), (0.018, 0.022), (0.015, 0.03), (0.003, 0.032)], 18).moved(x, 0, h - 0.032)
    handle = tube(
        bend([(x - r * 0.97, 0, rim * 0.86), (x - r - 0.05, 0, rim * 0.95), (-d / 2 + 0.01, 0, rim * 1.12)], 6),
        np.linspace(0.007, 0.011, 13),
        10,
    )
    return of(body, lathe(wall, 40, np.deg2rad(50)).moved(x), lathe(dome, 40, np.deg2rad(60)).moved(x)) + of(
        grip, handle.scaled(y=1.3), knob
    )


def wok(size: Size, body: Material, grip: Material) -> Parts:
    """A round-bottomed wok with a long wooden handle and a loop."""
    d, w, h = size
    r = w / 2
    x = d / 2 - r - 0.03
    rim = 0.82 * h
    a = np.linspace(0.18, 1, 9)
    outer = [(float(r * s), float(rim * (s**2.2))) for s in a]
    inner = [(s - 0.002, z + 0.003) for s, z in reversed(outer)]
    bowl = lathe([(0.16 * r, 0.0), *outer, *inner, (0.003, 0.03)], 44, np.deg2rad(50))
    long = tube(
        bend([(x - r * 0.96, 0, rim * 0.9), (x - r - 0.06, 0, rim), (-d / 2 + 0.01, 0, h - 0.012)], 5),
        np.linspace(0.01, 0.014, 11),
        10,
    )
    ear = loop(0.0, 0.0, 0.035, 0.09, 0.005).turned("z", -90).moved(x + r * 0.97, 0, rim * 0.94)
    return of(body, bowl.moved(x), ear) + of(grip, long)


def knife_block(size: Size, wood: Material, handle: Material) -> Parts:
    """A slanted block with knives, their handles toward +X."""
    d, w, h = size
    lean = 24.0
    tall = h * 0.74
    block = prism(rounded_rectangle(d * 0.5, w, 0.012, 3), tall, 0.006).turned("y", lean).moved(-d * 0.2)
    grips: list[Solid] = []
    for row, (x, count, length) in enumerate(((-0.14, 2, 0.115), (0.02, 3, 0.1), (0.16, 4, 0.085))):
        for y in (np.arange(count) - (count - 1) / 2) * w / 4.3:
            grip = box((0.026 - 0.004 * row, 0.016, length), 0.006, 2).moved(x * d, float(y), tall - 0.006)
            grips.append(grip.turned("y", lean).moved(-d * 0.2))
    low = float(block.vertices[:, 2].min())
    foot = box((d * 0.62, w, 0.03), 0.006, 2).moved(-d * 0.02)
    return [Part(wood, block.moved(z=-low)), *of(wood, foot), *of(handle, *(g.moved(z=-low) for g in grips))]


def utensil_crock(size: Size, clay: Material) -> Parts:
    """Wooden spoons, a whisk and a spatula in a crock."""
    d, w, h = size
    r, tall = min(d, w) * 0.36, 0.42 * h
    crock = hollow(((0.88, 0), (0.94, 0.02), (1.0, 0.5), (0.97, 0.95), (1.0, 1.0)), r, tall, 0.007, 0.01, 32)
    spoon = [
        rod((0, 0, 0.02), (0, 0, 0.78 * h), 0.0055, 0.0045, 8),
        cushion((0.014, 0.05, 0.09), 2, 2.4, 6).moved(z=0.76 * h),
    ]
    turner = [
        rod((0, 0, 0.02), (0, 0, 0.76 * h), 0.0055, 0.0045, 8),
        box((0.006, 0.06, 0.1), 0.003, 2).moved(z=0.74 * h),
    ]
    wires = [
        tube(
            bend(
                [
                    (0, 0, 0.62 * h),
                    (0, 0.03, 0.74 * h),
                    (0, 0.024, 0.86 * h),
                    (0, 0, 0.9 * h),
                    (0, -0.024, 0.86 * h),
                    (0, -0.03, 0.74 * h),
                    (0, 0, 0.62 * h),
                ],
                4,
            ),
            0.0013,
            5,
        ).turned("z", a)
        for a in (0, 60, 120)
    ]
    whisk = [cylinder(0.008, 0.62 * h, 0.003, 12)]

    def put(solids: list[Solid], tilt: float, heading: float, scale: float = 1.0) -> list[Solid]:
        return [s.scaled(z=scale).turned("y", tilt).turned("z", heading) for s in solids]

    return (
        of(clay, crock)
        + of(m.OAK, *put(spoon, 10, 20, 1.04), *put(turner, 11, 140, 0.98))
        + of(m.WALNUT, *put(spoon, 12, 265, 0.95))
        + of(m.STEEL, *put(wires, 9, 80), *put(whisk, 9, 80))
    )


def cutlery(size: Size, metal: Material) -> Parts:
    """Knife, fork and spoon laid side by side, tips toward -X."""
    d, w, _ = size
    stem = [rod((d / 2 - 0.01, 0, 0.004), (-0.22 * d, 0, 0.005), 0.0045, 0.0026, 8).scaled(y=1.5, z=0.8)]
    knife = [
        *stem,
        prism([(-d / 2, 0.002), (-0.1 * d, -0.008), (-0.08 * d, 0.007), (-0.3 * d, 0.009)], 0.0016, 0.0006).moved(
            z=0.003
        ),
    ]
    tines = [
        rod((-0.3 * d, y, 0.006), (-0.48 * d, y * 1.1, 0.008), 0.0016, 0.001, 6)
        for y in (-0.0085, -0.003, 0.003, 0.0085)
    ]
    fork = [*stem, cushion((0.06 * d * 2, 0.022, 0.005), 3, 2.2, 5).moved(-0.24 * d, 0, 0.003), *tines]
    spoon = [*stem, cushion((0.26 * d, 0.038, 0.009), 2, 2.2, 7).moved(-0.33 * d, 0, 0.002)]
    out = [s.moved(y=y) for solids, y in ((fork, 0.4 * w), (knife, 0.0), (spoon, -0.36 * w)) for s in solids]
    return of(metal, *out)


def board(size: Size, wood: Material, kind: str = "plain") -> Parts:
    """A cutting board: "plain" (rounded rectangle), "paddle" (with a handle), or "block" (thick, on feet)."""
    d, w, h = size
    if kind == "paddle":
        blade = prism(rounded_rectangle(d * 0.72, w, 0.03, 5), h, 0.005).moved(d * 0.14)
        handle = prism(rounded_rectangle(d * 0.34, w * 0.24, 0.02, 4), h, 0.005).moved(-d * 0.33)
        hole = cylinder(w * 0.05, h * 0.04, 0.0005, 20).moved(-d * 0.43, 0, h - 0.0003)
        return of(wood, blade, handle) + of(m.SHADOW, hole)
    if kind == "block":
        feet = [
            cylinder(0.014, 0.012, 0.002, 12).moved(sx * d * 0.38, sy * w * 0.4) for sx in (1, -1) for sy in (1, -1)
        ]
        ys = (np.arange(9) - 4) * w / 9
        strips = [box((d, w / 9 - 0.0006, h - 0.01), 0.003).moved(0, float(y), 0.01) for y in ys]
        return of(wood, *strips[::2]) + of(m.WALNUT, *strips[1::2]) + of(m.SHADOW, *feet)
    return of(wood, prism(rounded_rectangle(d, w, 0.025, 5), h, 0.005))


def board_set(size: Size) -> Parts:
    """Three boards leaning together on a stand of wire."""
    d, w, h = size
    parts: Parts = []
    for k, (wood, share, y, tilt) in enumerate(
        ((m.WALNUT, 1.0, -0.06, 12), (m.OAK, 0.82, 0.1, 12.5), (m.MARBLE, 0.6, -0.08, 13))
    ):
        blade = prism(rounded_rectangle(h * share * 0.98, w * (0.72 - 0.08 * k), 0.03, 5), 0.016, 0.004).turned(
            "y", -90
        )
        blade = (
            blade.moved(z=-float(blade.vertices[:, 2].min()))
            .turned("y", -tilt)
            .moved(0.012 + 0.02 * k + d * 0.08, y * w)
        )
        parts += of(wood, blade)
    base = [rod((d / 2 - 0.004, y, 0.003), (-d / 2 + 0.004, y, 0.003), 0.003, segments=8) for y in (-0.2 * w, 0.2 * w)]
    back = [rod((-0.042, y, 0.6 * h), (-d / 2 + 0.004, y, 0.003), 0.003, segments=8) for y in (-0.2 * w, 0.2 * w)]
    return [p.moved(z=0.006) for p in parts] + of(m.STEEL, *base, *back)


DESIGNS: tuple[Design, ...] = (
    design("cooking pot", "steel", "steel stockpot with a glass lid", (0.26, 0.34, 0.24), "modern", pot, 2, body=m.STAINLESS, trim=m.STEEL, glass_lid=True),
    design("cooking pot", "casserole-blue", "blue cast-iron casserole", (0.26, 0.33, 0.18), "classic", pot, 2, body=BLUE_IRON, trim=m.STEEL, rounded=0.12),
    design("cooking pot", "casserole-green", "green cast-iron casserole", (0.22, 0.28, 0.16), "rustic", pot, 2, body=GREEN_IRON, trim=m.BRASS, rounded=0.12),
    design("cooking pot", "pan", "non-stick frying pan", (0.48, 0.28, 0.08), "modern", pan, body=m.CHARCOAL, inside=COATING, grip=m.BLACK),
    design("cooking pot", "skillet", "cast-iron skillet", (0.42, 0.27, 0.07), "rustic", pan, body=CAST_IRON, inside=CAST_IRON, grip=CAST_IRON),
    design("cooking pot", "pan-copper", "copper frying pan", (0.44, 0.25, 0.08), "classic", pan, body=m.COPPER, inside=m.STEEL, grip=m.BRASS),
    design("cooking pot", "saucepan", "steel saucepan with a lid", (0.36, 0.18, 0.16), "minimal", saucepan, body=m.STAINLESS, grip=m.BLACK),
    design("cooking pot", "wok", "steel wok with a wooden handle", (0.58, 0.34, 0.13), "industrial", wok, body=CAST_IRON, grip=m.BIRCH),
    design("utensils", "knife-block", "oak knife block", (0.20, 0.11, 0.30), "modern", knife_block, wood=m.OAK, handle=m.BLACK),
    design("utensils", "knife-block-dark", "black knife block with steel handles", (0.18, 0.10, 0.28), "industrial", knife_block, wood=m.BLACK_WOOD, handle=m.STEEL),
    design("utensils", "crock", "wooden spoons in a stoneware crock", (0.18, 0.18, 0.32), "rustic", utensil_crock, clay=m.STONEWARE),
    design("utensils", "crock-white", "kitchen utensils in a white pot", (0.17, 0.17, 0.31), "minimal", utensil_crock, clay=m.PORCELAIN),
    design("utensils", "cutlery", "knife, fork and spoon", (0.21, 0.13, 0.012), "classic", cutlery, metal=m.CHROME),
    design("cutting board", "oak", "oak cutting board", (0.28, 0.40, 0.02), "minimal", board, 2, wood=m.OAK),
    design("cutting board", "paddle", "walnut board with a handle", (0.44, 0.22, 0.018), "rustic", board, wood=m.WALNUT, kind="paddle"),
    design("cutting board", "block", "chopping block of oak and walnut", (0.32, 0.44, 0.06), "classic", board, 2, wood=m.OAK, kind="block"),
    design("cutting board", "marble", "square marble board", (0.30, 0.30, 0.018), "modern", board, 4, wood=m.MARBLE),
    design("cutting board", "set", "three boards leaning together", (0.16, 0.34, 0.40), "modern", board_set),
)  # fmt: skip
