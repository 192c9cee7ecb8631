"""Kettles and toasters."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

BLUE_ENAMEL = m.paint("blue enamel", "#5b7489", 0.25)


CREAM_ENAMEL = m.paint("cream enamel", "#e2d8c3", 0.25)


MINT_ENAMEL = m.paint("mint enamel", "#a9bdae", 0.25)


def _spout(r: float, low: float, high: float, reach: float, radius: float) -> Parts:
    path = bend(
        [
            (r * 0.75, 0, low),
            (r * 1.15, 0, low + 0.35 * (high - low)),
            (r + reach * 0.7, 0, high - 0.02),
            (r + reach, 0, high),
        ],
        5,
    )
    return of(m.STEEL, tube(path, np.linspace(radius, 0.45 * radius, len(path)), 12))


def electric_kettle(size: Size, body: Material, trim: Material, glass: bool = False) -> Parts:
    """A jug kettle on its base, its spout toward +X and its handle behind."""
    d, w, h = size
    r = 0.5 * w
    x = d / 2 - r - 0.03
    z, tall = 0.022, h - 0.05
    base = cylinder(r * 0.98, 0.02, 0.006, 36).moved(x)
    skin = [(1.0, 0.0), (1.0, 0.02), (0.97, 0.3), (0.82, 0.8), (0.76, 1.0)]
    jug = lathe([(a * r, z + b * tall) for a, b in skin], 36, np.deg2rad(50))
    lid = lathe(
        [(0.76 * r, z + tall), (0.7 * r, z + tall + 0.012), (0.3 * r, z + tall + 0.02), (0.003, z + tall + 0.021)],
        32,
        np.deg2rad(60),
    )
    lip = loft(
        np.array(
            [
                ring_path(superellipse(0.05 * s, 0.06 * s, 2, 16), 0.0) + np.array([x + 0.78 * r + o, 0, z + tall * f])
                for s, o, f in ((0.2, -0.012, 0.74), (0.8, 0.0, 0.86), (1.0, 0.012, 0.995))
            ]
        )
    )
    back = x - r
    handle = tube(
        bend(
            [
                (back + 0.2 * r, 0, z + tall * 0.99),
                (back - 0.035, 0, z + tall * 0.96),
                (back - 0.05, 0, z + tall * 0.6),
                (back - 0.02, 0, z + tall * 0.22),
                (back + 0.02, 0, z + tall * 0.2),
            ],
            5,
        ),
        0.012,
        10,
    )
    parts = of(trim, base, lid, handle.scaled(y=1.4), cylinder(0.02, 0.012, 0.003, 16).moved(x, 0, z + tall + 0.018))
    if glass:
        band = cylinder(r * 1.005, 0.045, 0.004, 36).moved(x, 0, z)
        rim = lathe(
            [
                (0.79 * r, z + 0.9 * tall),
                (0.77 * r, z + tall),
                (0.73 * r, z + tall),
                (0.75 * r, z + 0.9 * tall),
                (0.79 * r, z + 0.9 * tall),
            ],
            36,
        ).moved(x)
        return parts + of(m.GLASS, jug.moved(x)) + of(body, band, rim, lip)
    return parts + of(body, jug.moved(x), lip)


def stove_kettle(size: Size, body: Material, trim: Material) -> Parts:
    """A squat whistling kettle with a bail handle."""
    d, w, h = size
    r = 0.5 * w
    x = d / 2 - r - 0.045
    low = 0.6 * h
    pot = lathe(
        [
            (a * r, b * low)
            for a, b in smooth_profile(
                ((0.9, 0.0), (1.0, 0.05), (0.97, 0.4), (0.62, 0.86), (0.3, 1.0), (0.02, 1.02)), 3
            )
        ],
        40,
        np.deg2rad(50),
    )
    knob = ball(0.035, 6).moved(x, 0, low - 0.002)
    bail = tube(
        bend(
            [
                (x + 0.0, 0.62 * r, 0.82 * low),
                (x, 0.66 * r, 0.8 * h),
                (x, 0.3 * r, h - 0.012),
                (x, -0.3 * r, h - 0.012),
                (x, -0.66 * r, 0.8 * h),
                (x, -0.62 * r, 0.82 * low),
            ],
            5,
        ),
        0.006,
        8,
    )
    grip = tube(
        bend(
            [(x, 0.36 * r, h - 0.022), (x, 0.12 * r, h - 0.012), (x, -0.12 * r, h - 0.012), (x, -0.36 * r, h - 0.022)],
            4,
        ),
        0.012,
        10,
    )
    return (
        of(body, pot.moved(x))
        + of(trim, knob, grip)
        + of(m.STEEL, bail)
        + shifted(_spout(0.72 * r, 0.42 * low, 0.98 * low, d / 2 - x - 0.72 * r, 0.02), x)
    )


def pour_over_kettle(size: Size, body: Material, trim: Material) -> Parts:
    """A gooseneck kettle with a wooden grip."""
    d, w, h = size
    r = 0.5 * w
    x = 0.0
    low = 0.86 * h
    pot = lathe(
        [(1.0 * r, 0), (1.0 * r, 0.01), (0.82 * r, 0.7 * low), (0.62 * r, 0.96 * low), (0.6 * r, low)],
        36,
        np.deg2rad(40),
    )
    lid = lathe(
        [
            (0.62 * r, low - 0.004),
            (0.6 * r, low + 0.008),
            (0.1 * r, low + 0.014),
            (0.06 * r, low + 0.02),
            (0.14 * r, h - 0.008),
            (0.1 * r, h),
        ],
        28,
    )
    neck = bend(
        [
            (x + 0.9 * r, 0, 0.2 * h),
            (x + 1.35 * r, 0, 0.24 * h),
            (x + 1.3 * r, 0, 0.6 * h),
            (d / 2 - 0.03, 0, 0.88 * h),
            (d / 2, 0, 0.85 * h),
        ],
        5,
    )
    grip = tube(
        bend(
            [
                (x - 0.72 * r, 0, 0.78 * h),
                (-d / 2 + 0.03, 0, 0.84 * h),
                (-d / 2 + 0.012, 0, 0.6 * h),
                (-d / 2 + 0.025, 0, 0.3 * h),
            ],
            5,
        ),
        [*np.linspace(0.007, 0.011, 8), *np.linspace(0.011, 0.007, 8)],
        10,
    )
    return of(body, pot, lid, tube(neck, np.linspace(0.011, 0.005, len(neck)), 10)) + of(trim, grip)


def toaster(size: Size, body: Material, trim: Material, square: bool = False, slots: int = 2) -> Parts:
    """A toaster, its slots along y, lever and dial on its +Y end."""
    d, w, h = size
    low = 0.014
    radius = 0.018 if square else 0.3 * min(d, h)
    section = rounded_rectangle(h - low, d, radius, 6)
    shell = prism(section, w * 0.94, 0.012).turned("x", 90).turned("y", -90)
    v = shell.vertices
    mid = (v.max(axis=0) + v.min(axis=0)) / 2
    shell = shell.moved(*(-mid + np.array([0, 0, low + (h - low) / 2])))
    gaps = [
        box((0.03, w * 0.68, 0.006), 0.002).moved(s * d * 0.17, 0, h - 0.004) for s in ((1, -1) if slots == 2 else (0,))
    ]
    feet = four(cylinder(0.012, 0.018, 0.002, 10).moved(d * 0.32, w * 0.36))
    end = w / 2
    lever = [
        box((0.012, 0.006, h * 0.5), 0.002).moved(0, end - 0.014, 0.24 * h),
        box((0.045, 0.026, 0.018), 0.007, 2).moved(0, end - 0.012, 0.66 * h),
    ]
    dial = cylinder(0.02, 0.02, 0.004, 20).turned("x", -90).moved(0, end - 0.02, 0.2 * h)
    band = [prism(section * 0.985, 0.012, 0.004).turned("x", 90).turned("y", -90)]
    band = [
        b.moved(
            *(
                -((b.vertices.max(axis=0) + b.vertices.min(axis=0)) / 2)
                + np.array([0, s * w * 0.47, low + (h - low) / 2])
            )
        )
        for b in band
        for s in (1, -1)
    ]
    front = box((0.004, w * 0.5, 0.008), 0.002).moved(d / 2 - 0.001, 0, 0.3 * h)
    return of(body, shell) + of(trim, *band, front) + of(m.BLACK, *gaps, *feet, *lever, dial)


DESIGNS: tuple[Design, ...] = (
    design("kettle", "steel", "brushed steel electric kettle", (0.24, 0.16, 0.25), "modern", electric_kettle, body=m.STAINLESS, trim=m.BLACK),
    design("kettle", "white", "white electric kettle", (0.23, 0.15, 0.24), "minimal", electric_kettle, body=m.WHITE, trim=m.LIGHT_GREY),
    design("kettle", "glass", "glass electric kettle", (0.24, 0.16, 0.26), "modern", electric_kettle, body=m.STEEL, trim=m.BLACK, glass=True),
    design("kettle", "whistling-cream", "cream whistling kettle", (0.25, 0.20, 0.22), "classic", stove_kettle, body=CREAM_ENAMEL, trim=m.BIRCH),
    design("kettle", "whistling-blue", "blue enamel kettle", (0.24, 0.19, 0.21), "rustic", stove_kettle, body=BLUE_ENAMEL, trim=m.BLACK),
    design("kettle", "gooseneck", "black gooseneck kettle with a wooden grip", (0.30, 0.15, 0.19), "industrial", pour_over_kettle, body=m.BLACK_STEEL, trim=m.WALNUT),
    design("toaster", "steel", "two-slice steel toaster", (0.18, 0.30, 0.20), "modern", toaster, 2, body=m.STAINLESS, trim=m.BLACK),
    design("toaster", "retro", "mint retro toaster", (0.19, 0.31, 0.20), "classic", toaster, 2, body=MINT_ENAMEL, trim=m.CHROME),
    design("toaster", "cream", "cream toaster", (0.18, 0.29, 0.19), "rustic", toaster, 2, body=CREAM_ENAMEL, trim=m.STEEL),
    design("toaster", "black", "slim black long-slot toaster", (0.13, 0.38, 0.19), "minimal", toaster, 2, body=m.CHARCOAL, trim=m.STEEL, square=True, slots=1),
)  # fmt: skip
