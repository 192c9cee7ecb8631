"""Lamps that hang from the ceiling or lie against it."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.lighting.shades import bulb, flex, rose, shade, spider


def pendant(
    size: Size, kind: Literal["dome", "drum", "globe", "cone", "bell"], outer: Material, cord: float = 0.45
) -> Parts:
    """A hanging lamp; `cord` is its flex's share of the height."""
    d, _, h = size
    r, hs = d / 2, h * (1 - cord)
    parts = of(
        m.BLACK,
        cylinder(0.003, h - hs, 0.001, 8).moved(z=hs - 0.01),
        cylinder(0.018, 0.06, 0.004, 16).moved(z=hs - 0.02),
        lathe([(0.045, h - 0.025), (0.05, h - 0.02), (0.05, h), (0.01, h)], 24),
    )
    if kind == "globe":
        return parts + of(outer, ball(min(d, hs), 12).scaled(d / min(d, hs), d / min(d, hs), hs / min(d, hs)))
    if kind == "drum":
        return (
            parts
            + of(outer, shade(r, r, hs))
            + of(m.LAMP_GLOW, cylinder(r * 0.96, 0.006, 0.002, 36).moved(z=0.006))
            + of(m.STEEL, *spider(r, hs - 0.01))
        )
    curve = {
        "dome": [(1.0, 0.0), (0.98, 0.25), (0.86, 0.55), (0.6, 0.82), (0.3, 0.96), (0.06, 1.0)],
        "cone": [(1.0, 0.0), (0.62, 0.45), (0.25, 0.86), (0.06, 1.0)],
        "bell": [(1.0, 0.0), (0.82, 0.1), (0.66, 0.35), (0.56, 0.65), (0.38, 0.88), (0.08, 1.0)],
    }[kind]
    outside = [(r * a, hs * b) for a, b in curve]
    inside = [(max(r * a - 0.006, 0.003), hs * b * 0.96) for a, b in reversed(curve)]
    return (
        parts
        + of(outer, lathe([inside[-1], *outside, *inside], 40, np.deg2rad(50)))
        + bulb(hs * 0.25, min(0.05, r * 0.3))
    )


def flush_light(size: Size, rim: Material) -> Parts:
    """A round ceiling light close to the ceiling."""
    d, _, h = size
    r = d / 2
    glass = lathe([(0.01, 0), (r * 0.5, h * 0.1), (r * 0.85, h * 0.35), (r * 0.95, h * 0.7)], 40, np.pi / 2)
    return of(m.LAMP_GLOW, glass) + of(rim, lathe([(r * 0.9, h * 0.66), (r, h * 0.7), (r, h), (r * 0.9, h)], 40))


def linear_pendant(size: Size, metal: Material) -> Parts:
    """A bar of light on two wires."""
    d, w, h = size
    wires = [cylinder(0.002, h - 0.05, 0.001, 6).moved(0, s * w * 0.35, 0.05) for s in (1, -1)]
    return of(
        metal, box((d, w, 0.05), 0.008, 2).moved(z=0.012), *wires, box((d, w * 0.8, 0.025), 0.005).moved(z=h - 0.025)
    ) + of(m.LAMP_GLOW, box((d * 0.8, w - 0.03, 0.016), 0.005))


def lantern_cluster(size: Size, metal: Material) -> Parts:
    """A cage of rods round a bulb."""
    d, _, h = size
    r, hs = d / 2, 0.62 * h
    rings = [
        tube(ring_path(superellipse(2 * a, 2 * a, 2, 28), z), 0.004, 6, closed=True)
        for a, z in ((r * 0.62, 0.005), (r * 0.99, hs * 0.5), (r * 0.4, hs))
    ]
    ribs = [
        tube(
            bend([(r * 0.62, 0, 0.005), (r * 0.99, 0, hs * 0.5), (r * 0.4, 0, hs), (0.02, 0, hs + 0.03)], 5), 0.0035, 6
        ).turned("z", 45 * k)
        for k in range(8)
    ]
    top = [
        cylinder(0.004, h - hs, 0.001, 8).moved(z=hs),
        cylinder(0.02, 0.05, 0.003, 14).moved(z=hs),
        lathe([(0.045, h - 0.02), (0.05, h - 0.015), (0.05, h), (0.01, h)], 24),
        cylinder(0.004, hs * 0.4, 0.001, 8).moved(z=hs * 0.6),
    ]
    return of(metal, *rings, *ribs, *top) + bulb(hs * 0.5, 0.04)


def paper_globe(size: Size, paper: Material) -> Parts:
    """A ribbed paper ball."""
    d, _, h = size
    r = d / 2
    t = np.linspace(0.06, np.pi - 0.06, 61)
    skin = [(float(r * np.sin(a) * (1 + 0.008 * np.cos(40 * a))), float(r * 0.94 * (1 - np.cos(a)))) for a in t]
    return of(paper, lathe(skin, 36, np.pi)) + of(m.BLACK, flex(1.87 * r, h - 0.01)) + rose(h, m.WHITE)


def ring_pendant(size: Size, metal: Material) -> Parts:
    """A thin ring of light on three wires."""
    d, _, h = size
    r, t = d / 2, 0.03
    band = lathe([(r - 0.014, 0), (r, 0), (r, t), (r - 0.014, t), (r - 0.014, 0)], 56)
    lit = lathe(
        [(r - 0.02, 0.003), (r - 0.012, 0.003), (r - 0.012, t - 0.003), (r - 0.02, t - 0.003), (r - 0.02, 0.003)], 56
    )
    wires = [
        rod(((r - 0.008) * np.cos(a), (r - 0.008) * np.sin(a), t), (0, 0, h - 0.03), 0.0012, segments=5)
        for a in np.deg2rad((0, 120, 240))
    ]
    return of(metal, band, *wires) + rose(h, metal, 0.06) + of(m.LAMP_GLOW, lit)


def cluster(size: Size, glass: Material, metal: Material) -> Parts:
    """Three glass drops at different heights below one plate."""
    d, w, h = size
    drop = smooth_profile(((0.16, 1.0), (0.3, 0.9), (0.8, 0.5), (1.0, 0.22), (0.7, 0.02)), 2)
    parts = of(metal, cylinder(min(d, w) * 0.34, 0.02, 0.005, 40).moved(z=h - 0.02))
    each = min(d, w) * 0.26
    for k, low in enumerate((0.0, 0.24, 0.4)):
        a = np.deg2rad(90 + 120 * k)
        x, y, z = (d / 2 - each) * np.cos(a), (w / 2 - each) * np.sin(a), low * h
        tall = 0.3 * h
        outer = [(each * p, z + q * tall) for p, q in reversed(drop)]
        skin = lathe([*outer, *((max(p - 0.004, 0.003), q) for p, q in reversed(outer)), outer[0]], 32, np.pi)
        parts += of(glass, skin.moved(x, y)) + of(
            metal, flex(z + tall, h - 0.01).moved(x, y), cylinder(0.02, 0.05, 0.004, 16).moved(x, y, z + tall - 0.02)
        )
        parts += shifted(bulb(z + 0.42 * tall, each * 0.34), x, y)
    return parts


def track(size: Size, metal: Material, heads: int = 4) -> Parts:
    """Spotlights along a rail."""
    _, w, h = size
    parts = of(metal, box((0.034, w, 0.022), 0.004).moved(z=h - 0.022))
    can = lathe(
        [(0.02, 0.105), (0.036, 0.1), (0.04, 0.09), (0.04, 0.0), (0.034, 0.0), (0.032, 0.03), (0.004, 0.035)], 24
    )
    for k in range(heads):
        y = w * (0.84 * (k / (heads - 1)) - 0.42)
        turn = (28, -24, 34, -30)[k % 4]
        head = [*of(metal, can), *of(m.LAMP_GLOW, cylinder(0.031, 0.006, 0.001, 20).moved(z=0.01))]
        parts += [p.moved(0, 0, -0.07).turned("y", turn).moved(0, y, h - 0.085) for p in head]
        parts += of(
            metal,
            cylinder(0.009, 0.05, 0.002, 12).moved(0, y, h - 0.07),
            cylinder(0.016, 0.016, 0.003, 14).turned("y", 90).moved(-0.008, y, h - 0.078),
        )
    return parts


def flush_panel(size: Size, rim: Material) -> Parts:
    """A square flat light."""
    d, w, h = size
    return of(rim, box((d, w, h * 0.6), 0.012, 2).moved(z=h * 0.4)) + of(
        m.LAMP_GLOW, box((d * 0.92, w * 0.92, h * 0.45), 0.012, 2)
    )


def bowl_light(size: Size, metal: Material, glass: Material) -> Parts:
    """A glass bowl on three rods."""
    d, _, h = size
    r, hs = d / 2, 0.36 * h
    outer = [(0.004, 0.0), (0.3 * r, 0.03 * hs), (0.7 * r, 0.3 * hs), (0.93 * r, 0.66 * hs), (r, hs)]
    inner = [(0.97 * r, hs), (0.9 * r, 0.68 * hs), (0.66 * r, 0.35 * hs), (0.004, 0.1 * hs)]
    rods = [
        rod(
            (r * 0.96 * np.cos(a), r * 0.96 * np.sin(a), hs),
            (0.03 * np.cos(a), 0.03 * np.sin(a), h - 0.05),
            0.004,
            segments=8,
        )
        for a in np.deg2rad((30, 150, 270))
    ]
    nub = lathe([(0.003, -0.03), (0.012, -0.02), (0.02, 0.002), (0.003, 0.01)], 16, np.pi)
    cup = lathe([(0.02, h - 0.07), (0.05, h - 0.05), (0.07, h - 0.012), (0.07, h)], 28)
    return of(glass, lathe([*outer, *inner], 40, np.pi)) + of(
        metal, *rods, nub, cup, tube(ring_path(superellipse(2 * r, 2 * r, 2, 40), hs), 0.005, 6, closed=True)
    )


PAPER_SHADE = m.lit("paper lantern", "#f2ebdd", 0.34)
ALABASTER = m.lit("alabaster", "#eadfca", 0.28, "marble")
SMOKE_GLASS = m.glass("smoked lamp glass", "#6b6560", 0.42)


DESIGNS: tuple[Design, ...] = (
    design("ceiling lamp", "dome-black", "black dome pendant", (0.42, 0.42, 0.45), "industrial", pendant, 36, kind="dome", outer=m.BLACK_STEEL),
    design("ceiling lamp", "drum-linen", "linen drum pendant", (0.50, 0.50, 0.48), "classic", pendant, 36, kind="drum", outer=m.LINEN_SHADE),
    design("ceiling lamp", "drum-white", "wide low drum pendant", (0.60, 0.60, 0.50), "modern", pendant, 36, kind="drum", outer=m.WHITE_COTTON),
    design("ceiling lamp", "globe", "opal globe pendant", (0.30, 0.30, 0.55), "minimal", pendant, 36, kind="globe", outer=m.LAMP_GLOW),
    design("ceiling lamp", "wicker-bell", "wicker bell pendant", (0.48, 0.48, 0.55), "rustic", pendant, 36, kind="bell", outer=m.RATTAN),
    design("ceiling lamp", "cone-sage", "sage cone pendant", (0.36, 0.36, 0.50), "modern", pendant, 36, kind="cone", outer=m.SAGE),
    design("ceiling lamp", "flush", "flush ceiling light", (0.40, 0.40, 0.12), "minimal", flush_light, 36, rim=m.STEEL),
    design("ceiling lamp", "linear", "linear black pendant", (0.08, 1.10, 0.60), "modern", linear_pendant, 2, metal=m.BLACK_STEEL),
    design("ceiling lamp", "linear-oak", "long oak pendant", (0.11, 1.30, 0.75), "rustic", linear_pendant, 2, metal=m.OAK),
    design("ceiling lamp", "cage", "brass cage pendant", (0.36, 0.36, 0.55), "industrial", lantern_cluster, 8, metal=m.BRASS),
    design("ceiling lamp", "paper-globe", "round paper lantern", (0.50, 0.50, 0.80), "minimal", paper_globe, 36, paper=PAPER_SHADE),
    design("ceiling lamp", "ring", "ring of light", (0.70, 0.70, 0.65), "modern", ring_pendant, 36, metal=m.BRASS),
    design("ceiling lamp", "cluster", "cluster of smoked glass pendants", (0.46, 0.46, 0.90), "modern", cluster, 1, glass=SMOKE_GLASS, metal=m.BRASS),
    design("ceiling lamp", "track", "black track with four spotlights", (0.12, 1.20, 0.16), "industrial", track, 2, metal=m.BLACK_STEEL),
    design("ceiling lamp", "track-white", "white track with three spotlights", (0.12, 0.90, 0.16), "minimal", track, 1, metal=m.WHITE, heads=3),
    design("ceiling lamp", "panel", "square flush ceiling light", (0.42, 0.42, 0.09), "minimal", flush_panel, 4, rim=m.WHITE),
    design("ceiling lamp", "alabaster", "alabaster bowl on brass rods", (0.44, 0.44, 0.50), "classic", bowl_light, 3, metal=m.BRASS, glass=ALABASTER),
    design("ceiling lamp", "rattan-dome", "woven rattan pendant", (0.52, 0.52, 0.60), "rustic", pendant, 36, kind="dome", outer=m.RATTAN),
    design("ceiling lamp", "copper-bell", "copper pendant", (0.34, 0.34, 0.56), "industrial", pendant, 36, kind="bell", outer=m.COPPER),
)  # fmt: skip
