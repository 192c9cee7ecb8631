"""Blenders and mixers."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

BLUE_ENAMEL = m.paint("blue enamel", "#5b7489", 0.25)


CREAM_ENAMEL = m.paint("cream enamel", "#e2d8c3", 0.25)


def blender(size: Size, body: Material, trim: Material) -> Parts:
    """A jug blender."""
    d, w, h = size
    low = 0.4 * h
    foot = loft(
        np.array(
            [
                ring_path(rounded_rectangle(d * s, w * 0.92 * s, 0.05, 5), z)
                for s, z in ((0.98, 0), (1.0, 0.01), (0.94, 0.3 * low), (0.66, 0.92 * low), (0.62, low))
            ]
        ),
        crease_rad=np.deg2rad(50),
    )
    jug = loft(
        np.array(
            [
                ring_path(rounded_rectangle(d * s, w * 0.9 * s, 0.03, 4), z)
                for s, z in ((0.5, low), (0.54, low + 0.02), (0.74, h * 0.93), (0.7, h * 0.93), (0.5, low + 0.03))
            ]
        ),
        crease_rad=np.deg2rad(50),
    )
    lid = prism(rounded_rectangle(d * 0.76, w * 0.7, 0.03, 4), 0.02, 0.006).moved(z=h * 0.925)
    cap = cylinder(0.16 * d, h * 0.05, 0.005, 24).moved(z=h * 0.95)
    ear = tube(
        bend([(0, w * 0.28, h * 0.88), (0, w * 0.47, h * 0.86), (0, w * 0.45, h * 0.56), (0, w * 0.24, h * 0.48)], 5),
        0.009,
        8,
    )
    dial = cylinder(0.026, 0.016, 0.004, 24).turned("y", 78).moved(d * 0.4, 0, low * 0.42)
    collar = lathe([(0.3 * d, low - 0.004), (0.32 * d, low), (0.3 * d, low + 0.014), (0.26 * d, low + 0.02)], 28)
    return of(body, foot) + of(m.GLASS, jug) + of(trim, lid, cap, ear, collar) + of(m.STEEL, dial)


def mixer(size: Size, body: Material, trim: Material) -> Parts:
    """A stand mixer with a steel bowl, its head toward +X."""
    d, w, h = size
    foot = prism(superellipse(d * 0.9, w * 0.92, 3, 44), 0.035, 0.012).moved(0.02 * d)
    column = loft(
        np.array(
            [
                ring_path(superellipse(d * a, w * b, 2.6, 32), z) + np.array([-d * 0.32 + o, 0, 0])
                for a, b, z, o in ((0.26, 0.6, 0.02, 0.0), (0.22, 0.5, 0.3 * h, -0.01), (0.26, 0.5, 0.68 * h, 0.0))
            ]
        )
    )
    t = np.linspace(0, 1, 9)
    radii = h * 0.17 * (0.62 + 0.5 * np.sin(np.pi * (0.15 + 0.62 * t)))
    rings = np.array(
        [
            np.column_stack([np.full(28, -d * 0.46 + 0.9 * d * s), superellipse(1.7 * r, 1.7 * r, 2.3, 28)])
            + np.array([0, 0, 0.8 * h])
            for s, r in zip(t, radii, strict=True)
        ]
    )
    head = loft(rings, crease_rad=np.deg2rad(60))
    bowl = lathe(
        [
            (0.3 * w, 0.035),
            (0.32 * w, 0.04),
            (0.26 * w, 0.05),
            (0.42 * w, 0.14 * h),
            (0.52 * w, 0.46 * h),
            (0.5 * w, 0.46 * h),
            (0.4 * w, 0.16 * h),
            (0.003, 0.08 * h),
        ],
        40,
        np.deg2rad(50),
    ).moved(d * 0.2)
    whisk = [cylinder(0.014, 0.26 * h, 0.003, 14).moved(d * 0.2, 0, 0.4 * h)]
    band = tube(
        np.column_stack([np.full(28, d * 0.02), superellipse(1.72 * radii[4], 1.72 * radii[4], 2.3, 28)])
        + np.array([0, 0, 0.8 * h]),
        0.004,
        6,
        closed=True,
    )
    knob = cylinder(0.018, 0.014, 0.004, 18).turned("x", 90).moved(-d * 0.2, -0.13 * h, 0.78 * h)
    hub = cylinder(0.03, 0.02, 0.005, 24).turned("y", 90).moved(d * 0.425, 0, 0.8 * h)
    return of(body, foot, column, head) + of(trim, bowl, *whisk, band, knob, hub)


DESIGNS: tuple[Design, ...] = (
    design("blender", "black", "black jug blender", (0.19, 0.20, 0.40), "modern", blender, body=m.BLACK, trim=m.BLACK),
    design("blender", "steel", "steel jug blender", (0.18, 0.20, 0.41), "industrial", blender, body=m.STAINLESS, trim=m.BLACK),
    design("blender", "mixer-blue", "blue stand mixer with a steel bowl", (0.38, 0.24, 0.36), "classic", mixer, body=BLUE_ENAMEL, trim=m.STEEL),
    design("blender", "mixer-cream", "cream stand mixer", (0.36, 0.23, 0.35), "rustic", mixer, body=CREAM_ENAMEL, trim=m.CHROME),
)  # fmt: skip
