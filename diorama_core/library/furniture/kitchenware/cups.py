"""Mugs, teacups and what is drunk from with a handle or without."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


def cup(size: Size, clay: Material, kind: Literal["mug", "tea"]) -> Parts:
    """A mug, or a teacup on its saucer."""
    _, w, h = size
    r = 0.39 * w if kind == "mug" else 0.31 * w
    lift = 0.0 if kind == "mug" else 0.012
    profile: Profile = (
        ((0.88, 0), (0.94, 0.02), (1.0, 0.08), (1.0, 0.98), (0.98, 1.0))
        if kind == "mug"
        else ((0.45, 0), (0.5, 0.03), (0.82, 0.4), (0.98, 0.9), (1.0, 1.0))
    )
    body = hollow(profile, r, h - lift, 0.004, 0.006).moved(0, 0.09 * w if kind == "mug" else 0, lift)
    y0 = (0.09 * w if kind == "mug" else 0.0) - r * 0.95
    ear = tube(
        bend(
            [
                (0, y0, lift + 0.82 * h),
                (0, y0 - 0.26 * w * 0.9, lift + 0.72 * h),
                (0, y0 - 0.22 * w, lift + 0.34 * h),
                (0, y0 + (0.0 if kind == "mug" else 0.004), lift + 0.2 * h),
            ],
            5,
        ),
        0.0055,
        8,
    )
    parts = of(clay, body, ear)
    if kind == "tea":
        s = w / 2
        parts += of(
            clay,
            lathe(
                [(0.5 * s, 0), (0.55 * s, 0.002), (s, 0.012), (0.98 * s, 0.015), (0.5 * s, 0.007), (0.004, 0.006)],
                40,
                np.deg2rad(50),
            ),
        )
    return parts


def beaker(size: Size, clay: Material, rim: Material) -> Parts:
    """A thrown beaker without a handle, its glaze running out above the foot."""
    _, w, h = size
    outline = ((0.7, 0), (0.74, 0.02), (0.9, 0.3), (0.98, 0.7), (1.0, 1.0))
    skin = [(w / 2 * a, b * h) for a, b in ((0.86, 0.24), (0.9, 0.3), (0.98, 0.7), (1.0, 0.97))]
    dip = lathe(
        [(r + t, z) for t, ring in ((0.0006, skin), (-0.002, skin[::-1])) for r, z in ring]
        + [(skin[0][0] + 0.0006, skin[0][1])],
        36,
        np.pi,
    )
    return of(clay, hollow(outline, w / 2, h, 0.004, 0.006)) + of(rim, dip)


def enamel_mug(size: Size, enamel: Material, rim: Material) -> Parts:
    """A tin mug with a rolled dark rim."""
    _, w, h = size
    r = 0.4 * w
    y = 0.08 * w
    body = hollow(((0.97, 0), (1.0, 0.02), (1.0, 0.98), (0.995, 1.0)), r, h * 0.99, 0.0018, 0.003).moved(0, y)
    lip = tube(ring_path(superellipse(2 * r, 2 * r, 2, 40), h - 0.003), 0.0026, 6, closed=True).moved(0, y)
    back = y - r
    ear = tube(
        bend(
            [
                (0, back, 0.8 * h),
                (0, back - 0.2 * w, 0.78 * h),
                (0, back - 0.2 * w, 0.36 * h),
                (0, back + 0.002, 0.28 * h),
            ],
            5,
        ),
        0.0035,
        8,
    )
    return of(enamel, body) + of(rim, lip, ear.scaled(x=2.2))


COFFEE = m.paint("coffee", "#3d2a20", 0.25)


def espresso(size: Size, clay: Material, saucer: Material) -> Parts:
    """A small cup of coffee on a saucer."""
    _, w, h = size
    s = w / 2
    r = 0.27 * w
    plate = lathe(
        [(0.5 * s, 0), (0.55 * s, 0.002), (s, 0.011), (0.98 * s, 0.014), (0.5 * s, 0.006), (0.004, 0.005)],
        40,
        np.deg2rad(50),
    )
    body = hollow(((0.6, 0), (0.66, 0.03), (0.95, 0.5), (1.0, 1.0)), r, h - 0.01, 0.004, 0.006, 28).moved(z=0.01)
    ear = tube(
        bend([(0, -r * 0.9, 0.8 * h), (0, -r * 1.55, 0.76 * h), (0, -r * 1.45, 0.44 * h), (0, -r * 0.82, 0.4 * h)], 4),
        0.0042,
        8,
    )
    coffee = cylinder(r * 0.93, 0.003, 0.001, 28).moved(z=0.84 * h)
    return of(saucer, plate) + of(clay, body, ear) + of(COFFEE, coffee)


DESIGNS: tuple[Design, ...] = (
    design("cup", "mug-white", "white mug", (0.085, 0.12, 0.095), "minimal", cup, clay=m.PORCELAIN, kind="mug"),
    design("cup", "mug-stone", "stoneware mug", (0.09, 0.125, 0.10), "rustic", cup, clay=m.DARK_STONEWARE, kind="mug"),
    design("cup", "tea", "teacup on a saucer", (0.145, 0.145, 0.075), "classic", cup, clay=m.PORCELAIN, kind="tea"),
    design("cup", "beaker", "hand-thrown beaker", (0.085, 0.085, 0.10), "rustic", beaker, 36, clay=m.STONEWARE, rim=m.BLUE_GLAZE),
    design("cup", "beaker-dark", "dark beaker with a pale glaze", (0.08, 0.08, 0.085), "minimal", beaker, 36, clay=m.DARK_STONEWARE, rim=m.CREAM),
    design("cup", "enamel", "enamel mug with a blue rim", (0.09, 0.12, 0.085), "industrial", enamel_mug, enamel=m.PORCELAIN, rim=m.NAVY),
    design("cup", "espresso", "espresso cup on a saucer", (0.12, 0.12, 0.065), "modern", espresso, clay=m.PORCELAIN, saucer=m.PORCELAIN),
    design("cup", "espresso-green", "green coffee cup on an oak saucer", (0.13, 0.13, 0.07), "rustic", espresso, clay=m.GREEN_GLAZE, saucer=m.OAK),
)  # fmt: skip
