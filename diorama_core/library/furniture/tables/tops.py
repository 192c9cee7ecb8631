"""Tops on legs, pedestals, rods and frames: what tables of every height share."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

Outline = str
"""Shape of a top: "square", "soft", "round" or "oval"."""


def table_top(d: float, w: float, thickness: float, outline: Outline) -> Solid:
    """A top standing on z = 0."""
    if outline == "square":
        return box((d, w, thickness), min(0.006, thickness / 3), 2)
    if outline == "soft":
        return prism(rounded_rectangle(d, w, 0.12 * min(d, w), 8), thickness, min(0.008, thickness / 3))
    return prism(superellipse(d, w, 2.0 if outline == "round" else 2.6, 56), thickness, min(0.009, thickness / 3))


def leg_table(
    size: Size,
    top: Material,
    legs: Material,
    outline: Outline = "square",
    shape: str = "taper",
    apron: float = 0.08,
    shelf: Material | None = None,
) -> Parts:
    """Four legs at the corners under an apron; `shape` is "taper", "square", "splay" or "turned"."""
    d, w, h = size
    t = float(np.clip(0.03 * max(d, w), 0.018, 0.036))
    thick = float(np.clip(0.055 * (h + 0.3), 0.03, 0.075))
    inset = thick * 0.9 if outline in ("square", "soft") else 0.19 * min(d, w)
    x, y = d / 2 - inset, w / 2 - inset
    parts = of(top, table_top(d, w, t, outline).moved(z=h - t))
    parts += of(legs, *four(_leg(shape, x, y, h - t, thick)))
    if apron:
        z, ax, ay = h - t - apron / 2, x - thick * 0.1, y - thick * 0.1
        parts += of(
            legs,
            *(beam((s * ax, -ay, z), (s * ax, ay, z), 0.02, apron) for s in (1, -1)),
            *both_sides(beam((-ax, ay, z), (ax, ay, z), 0.02, apron)),
        )
    if shelf is not None:
        parts += of(shelf, box((2 * x - 0.01, 2 * y - 0.01, 0.018), 0.004).moved(z=0.24 * h))
    return parts


def _leg(shape: str, x: float, y: float, h: float, thick: float) -> Solid:
    if shape == "square":
        return box((thick, thick, h), 0.005).moved(x, y)
    if shape == "splay":
        return rod((x + 0.06 * h, y + 0.06 * h, 0), (x - 0.06 * h, y - 0.06 * h, h), thick * 0.24, thick * 0.42, 14)
    if shape == "turned":
        r = thick / 2
        profile = [
            (0.45, 0),
            (0.62, 0.015),
            (0.5, 0.05),
            (0.72, 0.09),
            (0.55, 0.12),
            (0.68, 0.2),
            (0.98, 0.52),
            (0.8, 0.68),
            (1.0, 0.72),
            (0.7, 0.75),
            (1.0, 0.8),
        ]
        return joined(
            [lathe([(r * a, h * b) for a, b in profile], 18), box((thick, thick, h * 0.22), 0.004).moved(z=h * 0.78)]
        ).moved(x, y)
    return taper((x, y, 0), (x, y, h), thick * 0.55, thick, 0.005)


def pedestal_table(size: Size, top: Material, foot: Material, outline: Outline = "round", kind: str = "tulip") -> Parts:
    """One column in the middle; `kind` is "tulip", "claw", "disc" or "drum"."""
    d, w, h = size
    t = float(np.clip(0.028 * max(d, w), 0.016, 0.034))
    r = min(d, w) / 2
    parts = of(top, table_top(d, w, t, outline).moved(z=h - t))
    z = h - t
    if kind == "tulip":
        profile = [
            (0.62 * r, 0),
            (0.63 * r, 0.008),
            (0.5 * r, 0.02),
            (0.24 * r, 0.07 * z + 0.02),
            (0.10 * r, 0.25 * z),
            (0.075 * r, 0.5 * z),
            (0.10 * r, 0.75 * z),
            (0.22 * r, 0.93 * z),
            (0.42 * r, z),
        ]
        return parts + of(foot, lathe(profile, 36, np.pi / 2))
    if kind == "drum":
        return parts + of(
            foot, cylinder(0.62 * r, z - 0.012, 0.008, 40).moved(z=0.012), cylinder(0.55 * r, 0.02, 0.002, 32)
        )
    if kind == "disc":
        return parts + of(
            foot,
            lathe([(0.56 * r, 0), (0.57 * r, 0.006), (0.55 * r, 0.016), (0.06, 0.026)], 36),
            cylinder(0.032, z).moved(z=0.01),
            cylinder(0.2 * r, 0.012).moved(z=z - 0.012),
        )
    legs = []
    for k in range(4):
        path = bend([(0.03, 0, 0.36 * z), (0.3 * r, 0, 0.26 * z), (0.6 * r, 0, 0.06 * z), (0.78 * r, 0, 0.02)], 5)
        legs.append(tube(path, np.linspace(0.036, 0.02, len(path)), 10).turned("z", 45 + 90 * k))
    column = lathe(
        [
            (0.04, 0.24 * z),
            (0.062, 0.3 * z),
            (0.045, 0.4 * z),
            (0.06, 0.55 * z),
            (0.04, 0.7 * z),
            (0.07, 0.9 * z),
            (0.11, z),
        ],
        24,
    )
    return parts + of(foot, column, *legs)


def hairpin_table(size: Size, top: Material, steel: Material, outline: Outline = "square") -> Parts:
    """A top on four bent-rod legs."""
    d, w, h = size
    t, e = 0.03, 0.07 if outline == "square" else 0.2 * min(d, w)
    x, y = d / 2 - e, w / 2 - e
    pin = bend(
        [
            (x, y - 0.09, h - t),
            (x + 0.028, y + 0.012, 0.03),
            (x + 0.032, y + 0.032, 0.007),
            (x + 0.012, y + 0.028, 0.03),
            (x - 0.09, y, h - t),
        ],
        5,
    )
    return of(top, table_top(d, w, t, outline).moved(z=h - t)) + of(
        steel, *four(tube(pin, 0.006)), *four(box((0.1, 0.1, 0.005), 0.002).moved(x - 0.04, y - 0.04, h - t - 0.005))
    )


def frame_table(
    size: Size, top: Material, frame: Material, shelf: Material | None = None, outline: Outline = "square"
) -> Parts:
    """A square-section steel frame with a top, and a lower shelf if asked."""
    d, w, h = size
    t, s = 0.025, 0.024
    x, y, z = d / 2 - s / 2, w / 2 - s / 2, h - t
    legs = four(box((s, s, z), 0.003).moved(x, y))
    levels = [z - s] + ([0.16 * h] if shelf is not None else [0.0])
    rails = [box((s, w, s), 0.003).moved(sx * x, 0, zz) for sx in (1, -1) for zz in levels]
    rails += [box((d, s, s), 0.003).moved(0, sy * y, zz) for sy in (1, -1) for zz in levels]
    parts = of(frame, *legs, *rails) + of(top, table_top(d, w, t, outline).moved(z=h - t))
    return parts + (of(shelf, box((d - 2 * s, w - 2 * s, 0.016), 0.003).moved(z=0.16 * h + s - 0.016)) if shelf else [])


def glass_table(size: Size, frame: Material, outline: Outline = "soft") -> Parts:
    """A glass top on a frame of bent tube."""
    d, w, h = size
    x, y = d / 2 - 0.06, w / 2 - 0.12
    hoop = np.array(
        [
            (x, y, h - 0.022),
            (x, y, 0.03),
            (x - 0.02, y, 0.012),
            (-x + 0.02, y, 0.012),
            (-x, y, 0.03),
            (-x, y, h - 0.022),
        ]
    )
    ties = [rod((s * x, -y, h - 0.024), (s * x, y, h - 0.024), 0.01) for s in (1, -1)]
    return of(m.GLASS, table_top(d, w, 0.012, outline).moved(z=h - 0.012)) + of(
        frame, *both_sides(tube(hoop, 0.012, 10)), *ties
    )
