"""Small things of a bathroom: brushes, paper, soap, scales, towels on their rails."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

TISSUE = Material("tissue", "paper", "#eeece7", 0.95, 0.0, 0.2)


def toilet_brush(size: Size, supporter: Material, handle: Material, square: bool = False) -> Parts:
    """A brush in its pot, only the handle in sight."""
    d, w, h = size
    tall = 0.36 * h
    if square:
        pot = prism(rounded_rectangle(d, w, 0.014, 4), tall, 0.005)
    else:
        pot = lathe(
            [(0.46 * d, 0), (0.5 * d, 0.006), (0.48 * d, tall - 0.01), (0.44 * d, tall), (0.12 * d, tall + 0.006)], 32
        )
    stem = [
        cylinder(0.0065, h - tall, 0.002, 14).moved(z=tall - 0.01),
        lathe([(0.012, 0), (0.2 * d, 0.004), (0.19 * d, 0.012), (0.01, 0.016)], 24).moved(z=tall),
        cylinder(0.011, 0.09, 0.005, 16).moved(z=h - 0.09),
    ]
    return of(supporter, pot) + of(handle, *stem)


def paper_roll(radius: float, width: float) -> Parts:
    """A roll lying along y about the origin."""
    roll = lathe(
        [
            (0.02, -width / 2),
            (radius - 0.004, -width / 2),
            (radius, -width / 2 + 0.004),
            (radius, width / 2 - 0.004),
            (radius - 0.004, width / 2),
            (0.02, width / 2),
            (0.02, -width / 2),
        ],
        36,
    ).turned("x", 90)
    tail = box((0.001, width, 0.09), 0.0003).moved(radius - 0.0005, 0, -0.09)
    return of(TISSUE, roll, tail)


def roll_holder(size: Size, metal: Material, plate: Material | None = None) -> Parts:
    """A roll on an arm from the wall."""
    d, w, h = size
    r = 0.052
    z = h - r - 0.004 if plate is None else h - r - 0.03
    x = d / 2 - r
    parts = shifted(paper_roll(r, w * 0.78), x, 0, z)
    arm = tube(
        bend([(-d / 2 + 0.008, w * 0.44, z), (x - 0.02, w * 0.45, z), (x, w * 0.44, z), (x, 0.3 * w, z)], 4), 0.007, 8
    )
    parts += of(
        metal,
        arm,
        rod((x, w * 0.42, z), (x, -w * 0.46, z), 0.007),
        cylinder(0.026, 0.01, 0.003, 24).turned("y", 90).moved(-d / 2, w * 0.44, z),
    )
    if plate is not None:
        parts += of(
            plate,
            box((d, w, 0.02), 0.005, 2).moved(z=h - 0.02),
            box((0.014, w, h * 0.6), 0.004).moved(-d / 2 + 0.007, 0, h * 0.4 - 0.01),
        )
    return parts


def roll_stand(size: Size, metal: Material) -> Parts:
    """A free-standing holder with spare rolls below."""
    d, w, h = size
    post = cylinder(0.008, h - 0.01, 0.003, 16).moved(-d * 0.2)
    z = h - 0.06
    arm = tube(bend([(-d * 0.2, 0, z), (-d * 0.2, 0.03, z + 0.004), (-d * 0.2, w * 0.46, z)], 4), 0.007, 8)
    foot = cylinder(0.48 * min(d, w), 0.012, 0.004, 40)
    spare = [
        lathe(
            [(0.02, 0), (0.052, 0.0), (0.054, 0.004), (0.054, 0.096), (0.052, 0.1), (0.02, 0.1), (0.02, 0)], 36
        ).moved(0.02, 0, 0.014 + 0.102 * k)
        for k in range(2)
    ]
    return of(metal, post, arm, foot) + of(TISSUE, *spare) + shifted(paper_roll(0.05, 0.1), -d * 0.2, w * 0.19, z)


def roll_stack(size: Size) -> Parts:
    """Three rolls in a pyramid, lying."""
    d, w, _ = size
    r = w / 4
    parts: Parts = []
    for y, z in ((-r, r), (r, r), (0.0, r + 1.732 * r)):
        roll = lathe(
            [
                (0.36 * r, -d / 2),
                (r - 0.004, -d / 2),
                (r, -d / 2 + 0.004),
                (r, d / 2 - 0.004),
                (r - 0.004, d / 2),
                (0.36 * r, d / 2),
                (0.36 * r, -d / 2),
            ],
            32,
        ).turned("y", 90)
        core = lathe(
            [
                (0.33 * r, -d / 2 + 0.001),
                (0.37 * r, -d / 2 + 0.001),
                (0.37 * r, d / 2 - 0.001),
                (0.33 * r, d / 2 - 0.001),
                (0.33 * r, -d / 2 + 0.001),
            ],
            24,
        ).turned("y", 90)
        parts += of(TISSUE, roll.moved(0, y, z)) + of(m.CARDBOARD, core.moved(0, y, z))
    return parts


def soap_set(size: Size, clay: Material, metal: Material) -> Parts:
    """A pump bottle, a tumbler with brushes and a dish on a tray."""
    d, w, h = size
    tray = prism(rounded_rectangle(d, w, 0.02, 4), 0.012, 0.004)
    r = 0.3 * d
    bottle = lathe(
        [(0.94 * r, 0.012), (r, 0.018), (r, 0.56 * h), (0.8 * r, 0.64 * h), (0.36 * r, 0.68 * h)], 28, np.deg2rad(50)
    ).moved(0, w * 0.32)
    pump = [
        cylinder(0.34 * r, 0.05 * h, 0.002, 16).moved(0, w * 0.32, 0.67 * h),
        cylinder(0.14 * r, 0.24 * h, 0.001, 10).moved(0, w * 0.32, 0.7 * h),
        box((1.2 * r, 0.4 * r, 0.06 * h), 0.004, 2).moved(0.3 * r, w * 0.32, 0.93 * h),
    ]
    cup = hollow(((0.9, 0), (0.96, 0.03), (1.0, 1.0)), 0.9 * r, 0.5 * h, 0.004, 0.006, 28).moved(0, 0, 0.012)
    brushes = [
        [
            rod((0, 0, 0.03), (0, 0, 0.86 * h), 0.0045, 0.0035, 8),
            box((0.011, 0.008, 0.028), 0.002).moved(0.004, 0, 0.8 * h),
        ]
        for _ in range(2)
    ]
    dish = (
        lathe(
            [(0.5 * r, 0), (0.55 * r, 0.003), (0.95 * r, 0.016), (0.93 * r, 0.018), (0.5 * r, 0.007), (0.003, 0.006)],
            30,
        )
        .scaled(y=1.25)
        .moved(0, -w * 0.31, 0.012)
    )
    soap = prism(superellipse(0.045, 0.065, 2.6, 28), 0.022, 0.009).moved(0, -w * 0.31, 0.022)
    parts = of(m.OAK, tray) + of(clay, bottle, cup, dish) + of(metal, *pump) + of(m.CREAM, soap)
    for tone, solids, a, lean in ((m.BLUE_GLAZE, brushes[0], 30, 9), (m.BIRCH, brushes[1], 200, 8)):
        parts += of(tone, *(s.turned("y", lean).turned("z", a) for s in solids))
    return parts


def scales(size: Size, top: Material, rim: Material) -> Parts:
    """Bathroom scales."""
    d, w, h = size
    plate = prism(rounded_rectangle(d, w, 0.04, 6), h * 0.5, 0.004).moved(z=h * 0.5)
    show = box((0.035, 0.085, 0.0016), 0.0006).moved(-d * 0.34, 0, h - 0.0008)
    bars = [
        cylinder(0.02, 0.003, 0.001, 24).moved(sx * d * 0.24, sy * w * 0.3, h - 0.0015)
        for sx in (1, -1)
        for sy in (1, -1)
    ]
    feet = four(cylinder(0.02, h * 0.5, 0.003, 16).moved(d * 0.38, w * 0.38))
    return (
        of(top, plate)
        + of(rim, prism(rounded_rectangle(d * 0.9, w * 0.9, 0.03, 4), h * 0.3, 0.003).moved(z=h * 0.2), *feet)
        + of(m.SCREEN, show)
        + of(m.STEEL, *bars)
    )


DESIGNS: tuple[Design, ...] = (
    design("toilet brush", "steel", "steel toilet brush", (0.10, 0.10, 0.40), "modern", toilet_brush, 36, supporter=m.STAINLESS, handle=m.CHROME),
    design("toilet brush", "white", "white toilet brush", (0.11, 0.11, 0.37), "minimal", toilet_brush, 36, supporter=m.WHITE, handle=m.WHITE),
    design("toilet brush", "stone", "toilet brush in a square stone pot", (0.10, 0.10, 0.39), "rustic", toilet_brush, 4, supporter=m.STONEWARE, handle=m.BLACK_STEEL, square=True),
    design("toilet paper", "chrome", "toilet roll on a chrome arm", (0.14, 0.14, 0.12), "modern", roll_holder, metal=m.CHROME),
    design("toilet paper", "shelf", "toilet roll under a walnut shelf", (0.13, 0.16, 0.16), "rustic", roll_holder, metal=m.BLACK_STEEL, plate=m.WALNUT),
    design("toilet paper", "stand", "brass toilet-roll stand", (0.18, 0.18, 0.62), "classic", roll_stand, metal=m.BRASS),
    design("toilet paper", "stack", "three toilet rolls", (0.10, 0.22, 0.205), "minimal", roll_stack, 2),
    design("soap dispenser", "set", "soap, cup and dish on a tray", (0.11, 0.30, 0.18), "classic", soap_set, clay=m.PORCELAIN, metal=m.BRASS),
    design("soap dispenser", "set-dark", "dark bathroom set on a tray", (0.11, 0.29, 0.18), "industrial", soap_set, clay=m.DARK_STONEWARE, metal=m.BLACK_STEEL),
    design("soap dispenser", "set-green", "green bathroom set on a tray", (0.11, 0.28, 0.17), "rustic", soap_set, clay=m.GREEN_GLAZE, metal=m.STEEL),
    design("bathroom scale", "glass", "white bathroom scales", (0.30, 0.30, 0.028), "modern", scales, top=m.PORCELAIN, rim=m.GREY),
    design("bathroom scale", "black", "black bathroom scales", (0.28, 0.32, 0.026), "minimal", scales, top=m.BLACK, rim=m.CHARCOAL),
    design("bathroom scale", "wood", "bamboo-topped bathroom scales", (0.29, 0.29, 0.03), "rustic", scales, top=m.BIRCH, rim=m.GREY),
)  # fmt: skip
