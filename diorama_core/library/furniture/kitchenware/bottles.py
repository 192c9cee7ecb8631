"""Bottles for wine, water, oil and soap."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


def bottle(size: Size, glass: Material, kind: Literal["wine", "water", "spray"], cap: Material) -> Parts:
    """A wine or water bottle, or a pump dispenser."""
    d, _, h = size
    r = d / 2
    if kind == "wine":
        body = lathe(
            [
                (0.9 * r, 0),
                (r, 0.01),
                (r, 0.58 * h),
                (0.86 * r, 0.66 * h),
                (0.4 * r, 0.76 * h),
                (0.34 * r, 0.9 * h),
                (0.38 * r, 0.92 * h),
                (0.36 * r, 0.95 * h),
            ],
            28,
            np.deg2rad(50),
        )
        return (
            of(glass, body)
            + of(cap, cylinder(0.36 * r, 0.12 * h, 0.002, 20).moved(z=0.88 * h))
            + of(m.PAPER, cylinder(r * 1.006, 0.24 * h, 0.001, 28).moved(z=0.2 * h))
        )
    if kind == "water":
        return of(
            glass,
            lathe(
                [(0.92 * r, 0), (r, 0.01), (r, 0.68 * h), (0.7 * r, 0.8 * h), (0.42 * r, 0.86 * h)], 28, np.deg2rad(50)
            ),
        ) + of(cap, cylinder(0.48 * r, 0.15 * h, 0.003, 24).moved(z=0.85 * h))
    pump = [
        cylinder(0.34 * r, 0.06 * h, 0.002, 18).moved(z=0.72 * h),
        cylinder(0.14 * r, 0.18 * h, 0.001, 12).moved(z=0.76 * h),
        box((1.1 * r, 0.4 * r, 0.06 * h), 0.004, 2).moved(0.28 * r, 0, 0.94 * h),
    ]
    return of(
        glass,
        lathe([(0.94 * r, 0), (r, 0.008), (r, 0.64 * h), (0.85 * r, 0.7 * h), (0.4 * r, 0.73 * h)], 28, np.deg2rad(50)),
    ) + of(cap, *pump)


GREEN_BOTTLE = m.glass("green bottle glass", "#3c4b3a", 0.82)
AMBER_GLASS = m.glass("amber glass", "#7a4f2c", 0.78)
CLEAR_BOTTLE = m.glass("bottle glass", "#a3b5af", 0.18)
OIL = m.paint("olive oil", "#a89a4e", 0.3)
MILK = m.paint("milk", "#f1eee4", 0.5)
WAX = m.paint("red seal", "#7c3f3a", 0.5)


def filled_bottle(size: Size, liquid: Material, stopper: Material, share: float = 0.62, flip: bool = False) -> Parts:
    """A clear bottle with something in it and a stopper, wired if `flip`."""
    d, _, h = size
    r = d / 2
    neck = h * 0.93
    outline = [
        (0.9 * r, 0),
        (r, 0.008),
        (r, 0.55 * h),
        (0.84 * r, 0.66 * h),
        (0.36 * r, 0.78 * h),
        (0.32 * r, 0.9 * h),
        (0.38 * r, neck),
    ]
    inside = [
        (0.84 * r, 0.008),
        (0.92 * r, 0.014),
        (0.92 * r, share * 0.55 * h / 0.62),
        (0.003, share * 0.55 * h / 0.62),
    ]
    parts = of(CLEAR_BOTTLE, lathe(outline, 28, np.deg2rad(50))) + of(liquid, lathe(inside, 24, np.deg2rad(50)))
    parts += of(
        stopper,
        lathe(
            [(0.3 * r, neck - 0.012), (0.32 * r, neck), (0.4 * r, neck + 0.004), (0.36 * r, h - 0.003), (0.003, h)], 20
        ),
    )
    if flip:
        wire = tube(
            bend([(0, 0.4 * r, neck - 0.02), (0, 0.52 * r, neck), (0, 0.3 * r, h - 0.004), (0, 0, h - 0.002)], 4),
            0.0013,
            5,
        )
        parts += of(m.STEEL, *both_sides(wire))
    return parts


def decanter(size: Size, liquid: Material) -> Parts:
    """A broad crystal decanter with a ball stopper."""
    d, _, h = size
    r = d / 2
    body = [
        (0.6 * r, 0),
        (0.7 * r, 0.006),
        (r, 0.16 * h),
        (0.92 * r, 0.34 * h),
        (0.34 * r, 0.56 * h),
        (0.2 * r, 0.66 * h),
        (0.22 * r, 0.76 * h),
        (0.36 * r, 0.8 * h),
    ]
    drink = [(0.55 * r, 0.01), (0.66 * r, 0.014), (0.92 * r, 0.16 * h), (0.88 * r, 0.28 * h), (0.003, 0.28 * h)]
    top = ball(0.2 * h, 8).moved(z=0.8 * h)
    return of(CLEAR_BOTTLE, lathe(smooth_profile(tuple(body), 2), 36, np.deg2rad(50)), top) + of(
        liquid, lathe(drink, 28, np.deg2rad(60))
    )


def carton(size: Size, card: Material, band: Material) -> Parts:
    """A gable-topped milk carton."""
    d, w, h = size
    low = h * 0.74
    ends = np.array([[(-d / 2, 0, low), (d / 2, 0, low), (0.004, 0, h * 0.93), (-0.004, 0, h * 0.93)]])
    roof = loft(np.concatenate([ends + np.array([0, -w / 2, 0]), ends + np.array([0, w / 2, 0])])[:, ::-1])
    fin = box((0.006, w, h * 0.1), 0.002).moved(z=h * 0.9)
    cap = cylinder(0.016, 0.016, 0.003, 18).turned("y", 38).moved(d * 0.27, 0, h * 0.83)
    return of(card, box((d, w, low), 0.003), roof, fin) + of(
        band, box((d + 0.001, w + 0.001, h * 0.3), 0.003).moved(z=h * 0.2), cap
    )


DESIGNS: tuple[Design, ...] = (
    design("bottle", "wine", "bottle of wine", (0.078, 0.078, 0.30), "classic", bottle, 36, glass=GREEN_BOTTLE, kind="wine", cap=m.MAHOGANY),
    design("bottle", "water", "steel water bottle", (0.07, 0.07, 0.25), "modern", bottle, 36, glass=m.SAGE, kind="water", cap=m.STEEL),
    design("bottle", "dispenser", "soap dispenser", (0.075, 0.075, 0.19), "minimal", bottle, glass=m.STONEWARE, kind="spray", cap=m.BRASS),
    design("bottle", "olive-oil", "bottle of olive oil with a cork", (0.075, 0.075, 0.29), "rustic", filled_bottle, 36, liquid=OIL, stopper=m.BIRCH),
    design("bottle", "swing-top", "swing-top bottle", (0.085, 0.085, 0.31), "industrial", filled_bottle, 2, liquid=m.PORCELAIN, stopper=m.PORCELAIN, share=0.02, flip=True),
    design("bottle", "milk", "glass milk bottle", (0.09, 0.09, 0.24), "classic", filled_bottle, 36, liquid=MILK, stopper=m.STEEL, share=0.7),
    design("bottle", "decanter", "whisky decanter", (0.14, 0.14, 0.26), "classic", decanter, 36, liquid=AMBER_GLASS),
    design("bottle", "bordeaux", "amber bottle of dessert wine", (0.07, 0.07, 0.32), "minimal", bottle, 36, glass=AMBER_GLASS, kind="wine", cap=WAX),
    design("bottle", "carton", "milk carton", (0.07, 0.07, 0.235), "modern", carton, 2, card=m.WHITE, band=m.BLUE_GLAZE),
)  # fmt: skip
