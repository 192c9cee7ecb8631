"""Dressing tables with mirrors."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

TABLE_M = 0.76
"""Height of the table top."""


def vanity(size: Size, style: Style, mirror: str, pedestals: bool = False) -> Parts:
    """A dressing table; `mirror` is "round", "oval", "square", "triple" or "none" (all of it table)."""
    d, w, h = size
    top_z = h if mirror == "none" else TABLE_M
    t, case_h = 0.024, 0.12
    x, y = d / 2 - 0.045, w / 2 - 0.05
    handle = "knob" if style.handle in ("none", "bar") else style.handle
    parts = of(style.top or style.wood, box((d, w, t), style.edge_m, 2).moved(z=top_z - t))
    if pedestals:
        wide, xf = 0.29 * w, d / 2 - 0.04
        middle = Cavity((d - 0.06, w - 2 * wide, 0.09), (-0.012, 0, top_z - t - 0.09), wall=0.01)
        parts += middle.body(style.wood, 0.003)
        foot = box((d - 0.1, wide - 0.04, 0.085), 0.003).moved(-0.015, w / 2 - wide / 2 - 0.012)
        parts += of(style.wood, *both_sides(foot))
        each = (top_z - t - 0.1) / 3
        for f in (1, -1):
            y = f * (w / 2 - wide / 2 - 0.012)
            cavity = Cavity((d - 0.05, wide, top_z - t - 0.08), (-0.012, y, 0.08))
            parts += cavity.body(style.wood)
            for k in range(3):
                place = (y, 0.09 + each * k, wide - 0.012, each - 0.008)
                parts += drawer_front(xf, *place, style.wood, style.fitting, handle, cavity.behind(*place))
        place = (0.0, top_z - t - 0.085, w - 2 * wide - 0.036, 0.078)
        parts += drawer_front(xf, *place, style.wood, style.fitting, "knob", middle.behind(*place))
    else:
        parts += of(style.frame, *four(leg(style.leg, x, y, top_z - t, 0.045, 0.05)))
        n = 3 if w > 0.95 else 2
        each = (2 * y - 0.05) / n
        between = tuple(-y + 0.025 + each * k for k in range(1, n))
        size_of_case = (2 * x + 0.012, 2 * y + 0.012, case_h)
        cavity = Cavity(size_of_case, (0, 0, top_z - t - case_h), wall=0.01, dividers=between)
        parts += cavity.body(style.wood)
        for k in range(n):
            place = (-y + 0.025 + each * (k + 0.5), top_z - t - case_h + 0.008, each - 0.01, case_h - 0.016)
            parts += drawer_front(x + 0.003, *place, style.wood, style.fitting, handle, cavity.behind(*place))
    return parts + ([] if mirror == "none" else _mirror(d, w, h, top_z, style, mirror))


def _mirror(d: float, w: float, h: float, z: float, style: Style, kind: str) -> Parts:
    """A mirror standing at the back of the table, in a frame of the style's wood or metal."""
    xb = -d / 2 + 0.03
    frame = style.fitting if style.name in ("modern", "industrial") else style.wood
    tall = h - z
    if kind in ("round", "oval"):
        half_h = tall / 2 - 0.03
        half_w = half_h if kind == "round" else min(0.72 * half_h + 0.06, 0.3 * w)
        ring = superellipse(2 * half_h, 2 * half_w, 2, 44)
        rim = tube(ring_path(ring), 0.014, 8, closed=True).turned("y", 90).moved(xb, 0, z + 0.03 + half_h)
        glass = prism(ring * 0.98, 0.008, 0.001).turned("y", 90).pictured().moved(xb - 0.004, 0, z + 0.03 + half_h)
        posts = both_sides(
            rod((xb - 0.012, half_w + 0.02, z), (xb - 0.012, half_w + 0.02, z + 0.06 + half_h), 0.012, 0.009),
            cylinder(0.012, 0.03, 0.004, 12).turned("x", 90).moved(xb - 0.012, half_w + 0.03, z + 0.03 + half_h),
        )
        return of(frame, rim, *posts) + of(m.MIRROR, glass)
    parts: Parts = []
    spans = (
        [(0.0, 0.5 * w, 0.0)]
        if kind == "square"
        else [(0.0, 0.42 * w, 0.0), (0.33 * w, 0.24 * w, -24.0), (-0.33 * w, 0.24 * w, 24.0)]
    )
    for yy, width, turn in spans:
        height = tall - 0.02 if yy == 0 else 0.86 * tall
        one = of(
            frame,
            prism(rounded_rectangle(height, width, 0.03, 4), 0.022, 0.006).turned("y", 90).moved(-0.011, 0, height / 2),
        )
        one += of(
            m.MIRROR,
            prism(rounded_rectangle(height - 0.05, width - 0.05, 0.02, 4), 0.006, 0.001)
            .turned("y", 90)
            .pictured()
            .moved(0.008, 0, height / 2),
        )
        dx = 0.012 if yy else 0.0
        parts += [
            p.turned("z", turn).moved(
                xb + dx + (0.24 * w / 2 * np.sin(np.deg2rad(abs(turn))) if yy else 0.0), yy * 0.985, z + 0.02
            )
            for p in one
        ]
    feet = both_sides(box((0.03, 0.03, 0.03), 0.004).moved(xb - 0.005, 0.18 * w, z - 0.002))
    return parts + of(frame, *feet)


DESIGNS: tuple[Design, ...] = (
    design("vanity table", "round-walnut", "walnut dressing table with a round brass mirror", (0.45, 1.00, 1.36), MODERN, vanity, mirror="round"),
    design("vanity table", "triple-cream", "cream dressing table with a triple mirror", (0.46, 1.15, 1.40), CLASSIC.but(wood=m.CREAM, frame=m.CREAM, top=m.CREAM, leg="cabriole"), vanity, mirror="triple"),
    design("vanity table", "oval-mahogany", "mahogany dressing table with an oval mirror", (0.48, 1.05, 1.42), CLASSIC, vanity, mirror="oval", pedestals=True),
    design("vanity table", "square-pine", "pine dressing table with a mirror", (0.45, 0.95, 1.30), RUSTIC, vanity, mirror="square"),
    design("vanity table", "steel", "reclaimed-wood dressing table on steel", (0.44, 0.95, 1.34), INDUSTRIAL, vanity, mirror="round"),
    design("vanity table", "birch", "birch dressing table with a plain mirror", (0.42, 0.85, 1.26), MINIMAL, vanity, mirror="square"),
    design("vanity table", "blush-low", "blush dressing table without a mirror", (0.45, 1.00, 0.77), MODERN.but(wood=s.BLUSH, frame=m.BRASS, leg="taper"), vanity, mirror="none"),
)  # fmt: skip
