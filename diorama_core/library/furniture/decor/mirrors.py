"""Mirrors on walls and on the floor."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


def mirror(
    size: Size, bar: Material, outline: Literal["square", "round", "arch", "oval"], width: float = 0.03
) -> Parts:
    """A wall mirror."""
    d, w, h = size
    if outline == "square":
        glass = box((0.004, w - width, h - width), 0.0008).pictured().moved(0, 0, width / 2)
        return of(
            bar, *frame(d, w, h, width), box((d * 0.5, w - width, h - width), 0.002).moved(-d / 4, 0, width / 2)
        ) + of(m.MIRROR, glass)
    o = wall_outline(outline, w, h)
    upright = stand_up(o * 0.97, 0.005)
    back = stand_up(o * 0.985, d * 0.55).moved(-d / 2)
    ring = tube(np.column_stack([np.zeros(len(o)), o]), d / 2, 10, closed=True).scaled(x=0.999)
    inner = replace(ring, vertices=ring.vertices * np.array([1.0, 1 - width / w, 1 - width / h]))
    return of(bar, inner, back) + of(m.MIRROR, upright.pictured().moved(0.002))


def sunburst(size: Size, metal: Material) -> Parts:
    """A round mirror in a ring of rays."""
    d, w, _ = size
    r = w / 2
    rays = [
        rod((0, 0.5 * r, 0), (0, r * (1.0 if k % 2 else 0.82), 0), 0.007, 0.003, 6).turned("x", 360 / 36 * k)
        for k in range(36)
    ]
    return [
        p.moved(0, 0, r)
        for p in of(
            metal,
            *rays,
            tube(np.column_stack([np.zeros(40), superellipse(1.06 * r, 1.06 * r, 2, 40)]), d / 2, 10, closed=True),
        )
        + of(m.MIRROR, stand_up(superellipse(1.02 * r, 1.02 * r, 2, 40), 0.006).pictured())
    ]


def pebble(size: Size, bar: Material) -> Parts:
    """A mirror of no regular outline."""
    d, w, h = size
    t = np.arange(56) * 2 * np.pi / 56
    r = 1 + 0.09 * np.cos(2 * t + 0.6) + 0.06 * np.cos(3 * t + 1.2)
    o = np.stack([r * np.cos(t), r * np.sin(t)], axis=1)
    o = (o - (o.max(axis=0) + o.min(axis=0)) / 2) / np.ptp(o, axis=0) * np.array([w - d, h - d])
    rim = tube(np.column_stack([np.zeros(len(o)), o]), d / 2, 8, closed=True)
    return of(bar, rim, stand_up(o, d * 0.4).moved(-d / 2)) + of(m.MIRROR, stand_up(o, 0.004).pictured())


def window_mirror(size: Size, bar: Material, columns: int = 3, rows: int = 4) -> Parts:
    """A mirror divided like a factory window."""
    d, w, h = size
    parts = mirror(size, bar, "square", 0.03)
    bars = [
        box((d * 0.6, 0.014, h - 0.04), 0.003).moved(d * 0.1, -w / 2 + w * k / columns, 0.02) for k in range(1, columns)
    ]
    bars += [box((d * 0.6, w - 0.04, 0.014), 0.003).moved(d * 0.1, 0, h * k / rows - 0.007) for k in range(1, rows)]
    return parts + of(bar, *bars)


def leaning(size: Size, bar: Material, width: float, arch: bool = False) -> Parts:
    """A tall mirror that leans back on its strut, as if against the wall."""
    d, w, h = size
    lean = float(np.rad2deg(np.arcsin(min((d - 0.04) / h, 0.3))))
    tall = (h - 0.03 * np.sin(np.deg2rad(lean))) / np.cos(np.deg2rad(lean))
    upright = mirror((0.035, w, tall), bar, "arch" if arch else "square", width)
    low = min(float(p.solid.vertices[:, 2].min()) for p in upright)
    leant = [p.moved(z=-low).turned("y", -lean) for p in upright]
    foot = min(float(p.solid.vertices[:, 2].min()) for p in leant)
    front, high = d / 2 - 0.03, 0.62 * h
    hinge = (front - high * np.tan(np.deg2rad(lean)) - 0.03, 0, high)
    strut = lowered(beam(hinge, (-d / 2 + 0.014, 0, 0.01), 0.3 * w, 0.012, 0.003))
    return [p.moved(front, 0, -foot) for p in leant] + of(m.SHADOW, strut)


def cheval(size: Size, wood: Material) -> Parts:
    """A dressing mirror that swings between two posts."""
    d, w, h = size
    posts = both_sides(
        lathe(
            [
                (0.024, 0.1),
                (0.03, 0.16),
                (0.018, 0.22),
                (0.02, 0.5 * h),
                (0.026, 0.56 * h),
                (0.014, 0.6 * h),
                (0.02, 0.64 * h),
                (0.003, 0.66 * h),
            ],
            18,
        ).moved(0, w / 2 - 0.03)
    )
    feet = both_sides(
        tube(
            bend(
                [
                    (-d / 2 + 0.012, w / 2 - 0.03, 0.012),
                    (-0.1 * d, w / 2 - 0.03, 0.09),
                    (0, w / 2 - 0.03, 0.13),
                    (0.1 * d, w / 2 - 0.03, 0.09),
                    (d / 2 - 0.012, w / 2 - 0.03, 0.012),
                ],
                4,
            ),
            0.016,
            8,
        )
    )
    rail = rod((0, -w / 2 + 0.03, 0.15), (0, w / 2 - 0.03, 0.15), 0.014)
    glass = [
        p.moved(z=-(h - 0.24) / 2).turned("y", -5).moved(z=0.22 + (h - 0.24) / 2)
        for p in mirror((0.03, w - 0.11, h - 0.24), wood, "oval", 0.02)
    ]
    low = min(float(p.solid.vertices[:, 2].min()) for p in glass)
    glass = [p.moved(z=0.2 - low) for p in glass]
    pins = both_sides(rod((0, w / 2 - 0.06, 0.6 * h), (0, w / 2 - 0.02, 0.6 * h), 0.008))
    return of(wood, *posts, *feet, rail) + glass + of(m.BRASS, *pins)


def vanity_mirror(size: Size, metal: Material) -> Parts:
    """A round mirror on a foot, for a dressing table."""
    d, w, h = size
    r = w / 2
    z = h - r
    ring = tube(
        np.column_stack([np.zeros(40), superellipse(2 * r - 0.016, 2 * r - 0.016, 2, 40)]), 0.008, 8, closed=True
    )
    disc = stand_up(superellipse(2 * r - 0.014, 2 * r - 0.014, 2, 40), 0.004).pictured()
    head = [
        p.turned("y", -8).moved(0, 0, z)
        for p in of(metal, ring, stand_up(superellipse(2 * r - 0.016, 2 * r - 0.016, 2, 40), 0.005).moved(-0.006))
        + of(m.MIRROR, disc)
    ]
    foot = lathe(
        [(d * 0.48, 0), (d * 0.5, 0.006), (d * 0.4, 0.016), (0.012, 0.03), (0.007, 0.06), (0.007, z - r * 0.94)], 32
    )
    return of(metal, foot) + head


DESIGNS: tuple[Design, ...] = (
    design("mirror", "oak", "rectangular mirror in an oak frame", (0.035, 0.65, 0.95), "modern", mirror, bar=m.OAK, outline="square"),
    design("mirror", "round-brass", "round brass mirror", (0.03, 0.75, 0.75), "modern", mirror, bar=m.BRASS, outline="round", width=0.02),
    design("mirror", "arch-black", "arched black mirror", (0.03, 0.70, 1.20), "industrial", mirror, bar=m.BLACK_STEEL, outline="arch", width=0.02),
    design("mirror", "gilt", "gilt-framed mirror", (0.05, 0.80, 1.10), "classic", mirror, bar=m.BRASS, outline="square", width=0.07),
    design("mirror", "oval", "oval walnut mirror", (0.035, 0.55, 0.80), "classic", mirror, bar=m.WALNUT, outline="oval", width=0.02),
    design("mirror", "sunburst", "sunburst mirror", (0.03, 0.80, 0.80), "classic", sunburst, metal=m.BRASS),
    design("mirror", "pebble", "mirror of an irregular outline", (0.03, 0.62, 0.95), "minimal", pebble, bar=m.LIGHT_OAK),
    design("mirror", "window", "black window mirror", (0.03, 0.75, 1.10), "industrial", window_mirror, bar=m.BLACK_STEEL),
    design("mirror", "round-rattan", "round rattan mirror", (0.04, 0.65, 0.65), "rustic", mirror, bar=m.RATTAN, outline="round", width=0.04),
    design("mirror", "reclaimed", "mirror in a broad reclaimed frame", (0.04, 0.70, 0.95), "rustic", mirror, bar=m.RECLAIMED, outline="square", width=0.09),
    design("mirror", "round-black", "large round black mirror", (0.028, 0.95, 0.95), "modern", mirror, bar=m.BLACK_STEEL, outline="round", width=0.02),
    design("mirror", "frameless", "slim steel-edged mirror", (0.025, 0.60, 0.80), "minimal", mirror, bar=m.STEEL, outline="square", width=0.01),
    design("floor mirror", "arch-brass", "arched brass floor mirror", (0.35, 0.75, 1.75), "modern", leaning, bar=m.BRASS, width=0.02, arch=True),
    design("floor mirror", "oak", "leaning oak floor mirror", (0.36, 0.70, 1.70), "minimal", leaning, bar=m.OAK, width=0.04),
    design("floor mirror", "gilt", "leaning gilt mirror", (0.38, 0.90, 1.85), "classic", leaning, bar=m.BRASS, width=0.09),
    design("floor mirror", "cheval", "mahogany swing mirror", (0.48, 0.66, 1.62), "classic", cheval, wood=m.MAHOGANY),
    design("floor mirror", "cheval-white", "white swing mirror", (0.46, 0.62, 1.55), "rustic", cheval, wood=m.WHITE),
    design("vanity mirror", "brass", "round brass table mirror", (0.15, 0.22, 0.34), "modern", vanity_mirror, metal=m.BRASS),
    design("vanity mirror", "chrome", "chrome make-up mirror", (0.13, 0.18, 0.30), "classic", vanity_mirror, metal=m.CHROME),
    design("vanity mirror", "black", "black table mirror", (0.15, 0.24, 0.36), "industrial", vanity_mirror, metal=m.BLACK_STEEL),
)  # fmt: skip
