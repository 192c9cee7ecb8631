"""Lamps that stand, sit and hang."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Literal

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, of, shifted
from diorama_core.library.furniture.solids import (
    Solid,
    ball,
    bend,
    box,
    cylinder,
    lathe,
    ring_path,
    rod,
    smooth_profile,
    superellipse,
    tube,
)
from diorama_core.library.record import SymmetryFold


def shade(bottom: float, top: float, height: float, pleats: int = 0) -> Solid:
    """A lampshade open above and below, on z = 0; radii of its rims."""
    t = 0.004
    solid = lathe([(bottom - t, 0.004), (bottom, 0), (top, height), (top - t, height), (bottom - t, 0.004)], 40)
    if not pleats:
        return solid
    angle = np.arctan2(solid.vertices[:, 1], solid.vertices[:, 0])
    factor = 1 + 0.02 * np.cos(pleats * angle)
    return replace(solid, vertices=solid.vertices * np.column_stack([factor, factor, np.ones(len(factor))]))


def bulb(z: float, radius: float = 0.03) -> Parts:
    """A lit globe with its middle at z."""
    return of(m.LAMP_GLOW, ball(2 * radius).moved(z=z - radius))


def spider(radius: float, z: float) -> list[Solid]:
    """The three wires that hold a shade."""
    return [
        rod((0, 0, z), (radius * np.cos(a), radius * np.sin(a), z), 0.002, segments=5)
        for a in np.deg2rad((0, 120, 240))
    ]


def shaded_lamp(
    size: Size,
    profile: tuple[tuple[float, float], ...],
    body: Material,
    cloth: Material,
    shade_h: float = 0.42,
    flare: float = 0.72,
    foot: Material | None = None,
    pleats: int = 0,
) -> Parts:
    """A turned body (radius and height as fractions of the width and of the body) under a cloth shade."""
    d, _, h = size
    r, hs = d / 2, shade_h * h
    neck = h - hs * 0.75
    parts = of(body, lathe([(a * r, b * neck) for a, b in smooth_profile(profile)], 36, np.deg2rad(50)))
    parts += of(
        foot or m.BRASS,
        cylinder(0.008, hs * 0.5).moved(z=neck - 0.005),
        *spider(r * flare * 1.02, h - 0.02),
        cylinder(0.006, 0.02).moved(z=h - 0.03),
    )
    return parts + bulb(h - hs * 0.5) + of(cloth, shade(r, r * flare, hs, pleats).moved(z=h - hs))


def desk_lamp(size: Size, paint: Material, joint: Material) -> Parts:
    """A jointed desk lamp with a metal hood."""
    d, w, h = size
    x0 = -d / 2 + w * 0.45
    elbow, head = (x0 - 0.02, 0.0, h * 0.62), (d / 2 - 0.08, 0.0, h * 0.93)
    arms = [rod((x0, s, 0.03), (elbow[0], s, elbow[2]), 0.005) for s in (0.012, -0.012)] + [
        rod((elbow[0], s, elbow[2]), (head[0], s, head[2]), 0.005) for s in (0.012, -0.012)
    ]
    hood = (
        lathe([(0.02, 0.13), (0.03, 0.125), (0.036, 0.09), (0.075, 0.0), (0.072, 0.0), (0.033, 0.085), (0.02, 0.1)], 32)
        .turned("y", -24)
        .moved(head[0] + 0.03, 0, head[2] - 0.12)
    )
    joints = [
        cylinder(0.014, 0.044, 0.003, 16).turned("x", 90).moved(p[0], 0.022, p[2])
        for p in ((x0, 0, 0.035), elbow, head)
    ]
    glow = ball(0.06).moved(head[0] + 0.045, 0, head[2] - 0.115)
    return (
        of(paint, lathe([(w * 0.44, 0), (w * 0.45, 0.006), (w * 0.42, 0.02), (0.03, 0.028)], 36).moved(x0), hood)
        + of(joint, *arms, *joints)
        + of(m.LAMP_GLOW, glow)
    )


def globe_lamp(size: Size, foot: Material) -> Parts:
    """A glowing glass globe on a low foot."""
    d, _, h = size
    base = h - d * 0.97
    return of(foot, lathe([(d * 0.3, 0), (d * 0.31, 0.006), (d * 0.27, base * 0.7), (d * 0.2, base + 0.02)], 32)) + of(
        m.LAMP_GLOW, ball(d, 12).moved(z=h - d)
    )


def mushroom_lamp(size: Size, body: Material) -> Parts:
    """A one-piece lamp with a domed head."""
    d, _, h = size
    r = d / 2
    a = np.linspace(0.05, np.pi / 2, 12)
    dome = [(r * np.sin(x), h * 0.62 + (h * 0.38) * np.cos(x)) for x in a[::-1]]
    inside = [(r * 0.94 * np.sin(x), h * 0.62 + (h * 0.35) * np.cos(x)) for x in a]
    stem = lathe(
        [(r * 0.62, 0), (r * 0.64, 0.01), (r * 0.42, h * 0.2), (r * 0.34, h * 0.45), (r * 0.4, h * 0.75)],
        36,
        np.deg2rad(60),
    )
    return of(body, stem, lathe([inside[-1], *dome, *inside], 40, np.deg2rad(60))) + bulb(h * 0.72, r * 0.3)


def floor_shade(
    size: Size, stand: Literal["pole", "tripod", "arc"], metal: Material, cloth: Material, shade_h: float = 0.26
) -> Parts:
    """A floor lamp with a cloth drum on a pole, three legs or an arc."""
    d, _, h = size
    if stand == "arc":
        return _arc(size, metal, cloth)
    r = d / 2 if stand == "pole" else 0.46 * d
    hood = (
        of(cloth, shade(r, r * 0.84, shade_h).moved(z=h - shade_h))
        + bulb(h - shade_h * 0.5, 0.035)
        + of(metal, *spider(r * 0.85, h - 0.02))
    )
    if stand == "pole":
        foot = lathe([(0.145, 0), (0.15, 0.006), (0.14, 0.018), (0.02, 0.03), (0.012, 0.05)], 36)
        return of(metal, foot, cylinder(0.011, h - 0.05, 0.002, 16).moved(z=0.025)) + hood
    hub = h - shade_h - 0.06
    legs = [rod((d * 0.5, 0, 0), (0.018, 0, hub), 0.012, 0.018).turned("z", 60 + 120 * k) for k in range(3)]
    return (
        of(metal, *legs)
        + of(m.BRASS, cylinder(0.034, 0.05, 0.004).moved(z=hub - 0.03), cylinder(0.008, shade_h * 0.8).moved(z=hub))
        + hood
    )


def _arc(size: Size, metal: Material, cloth: Material) -> Parts:
    d, w, h = size
    x0, x1, r = -d / 2 + 0.16, d / 2 - w / 2, w / 2
    t = np.linspace(0, np.pi * 0.93, 22)
    path = np.stack(
        [x0 + (x1 - x0) * (1 - np.cos(t)) / 1.976, np.zeros(22), 0.45 * h + 0.545 * h * np.sin(t) ** 0.9], axis=1
    )
    path = np.concatenate([[(x0, 0, 0.03)], path])
    end = path[-1]
    hood = lathe(
        [
            (0.02, 0.20),
            (r * 0.55, 0.185),
            (r * 0.86, 0.12),
            (r, 0.0),
            (r - 0.006, 0.0),
            (r * 0.83, 0.115),
            (r * 0.5, 0.178),
        ],
        36,
        np.deg2rad(50),
    )
    z = end[2] - 0.2
    return (
        of(metal, tube(path, 0.012, 10), rod(end, (x1, 0, z + 0.19), 0.008), cylinder(0.16, 0.04, 0.006, 36).moved(x0))
        + of(cloth, hood.moved(x1, 0, z))
        + shifted(bulb(z + 0.05, 0.045), x1)
    )


def torchiere(size: Size, metal: Material, bowl: Material) -> Parts:
    """An uplighter: a bowl on a tall pole."""
    d, _, h = size
    r = d / 2
    dish = lathe(
        [
            (0.02, h - 0.11),
            (r * 0.5, h - 0.085),
            (r * 0.85, h - 0.04),
            (r, h),
            (r - 0.008, h),
            (r * 0.8, h - 0.035),
            (r * 0.4, h - 0.07),
            (0.01, h - 0.08),
        ],
        36,
        np.deg2rad(60),
    )
    foot = lathe([(r * 0.8, 0), (r * 0.82, 0.008), (r * 0.76, 0.02), (0.03, 0.035), (0.014, 0.06)], 36)
    return of(metal, foot, cylinder(0.013, h - 0.14, 0.002, 16).moved(z=0.04)) + of(bowl, dish)


def reading_lamp(size: Size, metal: Material) -> Parts:
    """A floor reading lamp with a small adjustable head."""
    d, w, h = size
    x0 = -d / 2 + w / 2
    path = bend(
        [
            (x0, 0, 0.02),
            (x0, 0, h * 0.75),
            (x0 + 0.02, 0, h - 0.05),
            (x0 + 0.12, 0, h - 0.01),
            (d / 2 - 0.12, 0, h - 0.04),
        ],
        8,
    )
    hood = (
        lathe([(0.018, 0.15), (0.028, 0.14), (0.034, 0.1), (0.07, 0), (0.067, 0), (0.03, 0.1)], 28)
        .turned("y", -30)
        .moved(d / 2 - 0.1, 0, h - 0.17)
    )
    foot = lathe([(w * 0.48, 0), (w * 0.5, 0.006), (w * 0.46, 0.018), (0.02, 0.026)], 36).moved(x0)
    return of(metal, tube(path, 0.009, 10), hood, foot) + of(
        m.LAMP_GLOW, ball(0.055).moved(d / 2 - 0.085, 0, h - 0.155)
    )


def column_lamp(size: Size, wood: Material) -> Parts:
    """A paper column on a wooden frame."""
    d, w, h = size
    s = 0.022
    posts = [box((s, s, h), 0.003).moved(x * (d / 2 - s / 2), y * (w / 2 - s / 2)) for x in (1, -1) for y in (1, -1)]
    bars = [box((d, s, s), 0.003).moved(0, y * (w / 2 - s / 2), z) for y in (1, -1) for z in (0.12, h * 0.45, h - s)]
    bars += [box((s, w, s), 0.003).moved(x * (d / 2 - s / 2), 0, z) for x in (1, -1) for z in (0.12, h * 0.45, h - s)]
    return of(wood, *posts, *bars) + of(m.LAMP_GLOW, box((d - 1.4 * s, w - 1.4 * s, h - 0.16), 0.004).moved(z=0.14))


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


def chandelier(size: Size, metal: Material, arms: int) -> Parts:
    """Curved arms with little shades round a turned stem."""
    d, _, h = size
    r, low = d / 2 - 0.05, 0.08
    stem = lathe(
        [
            (0.008, 0),
            (0.035, 0.03),
            (0.05, 0.07),
            (0.02, 0.12),
            (0.03, 0.2),
            (0.012, 0.28),
            (0.01, h - 0.03),
            (0.05, h - 0.02),
            (0.055, h),
        ],
        24,
    )
    parts = of(metal, stem)
    for k in range(arms):
        path = bend([(0.03, 0, low + 0.02), (0.4 * r, 0, low - 0.04), (0.85 * r, 0, low), (r, 0, low + 0.08)], 5)
        bits = of(
            metal,
            tube(path, 0.007, 8),
            lathe([(0.01, 0), (0.03, 0.01), (0.028, 0.016), (0.01, 0.02)], 16).moved(r, 0, low + 0.08),
        )
        bits += of(m.WHITE, cylinder(0.011, 0.06, 0.002, 12).moved(r, 0, low + 0.095)) + of(
            m.LINEN_SHADE, shade(0.05, 0.03, 0.075).moved(r, 0, low + 0.14)
        )
        parts += [p.turned("z", 360 / arms * k) for p in bits]
    return parts


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


URN = (
    (0.34, 0.0),
    (0.36, 0.015),
    (0.2, 0.06),
    (0.3, 0.14),
    (0.52, 0.36),
    (0.54, 0.5),
    (0.4, 0.72),
    (0.16, 0.86),
    (0.12, 0.93),
    (0.05, 1.0),
)
BOTTLE = ((0.36, 0.0), (0.44, 0.03), (0.48, 0.25), (0.46, 0.45), (0.26, 0.68), (0.14, 0.8), (0.12, 0.95), (0.05, 1.0))
COLUMN = ((0.42, 0.0), (0.43, 0.02), (0.4, 0.05), (0.09, 0.07), (0.075, 0.1), (0.075, 0.96), (0.04, 1.0))
ORB = (
    (0.2, 0.0),
    (0.36, 0.04),
    (0.56, 0.2),
    (0.62, 0.4),
    (0.56, 0.6),
    (0.36, 0.77),
    (0.14, 0.84),
    (0.1, 0.9),
    (0.04, 1.0),
)
CANDLE = (
    (0.4, 0.0),
    (0.42, 0.02),
    (0.3, 0.05),
    (0.12, 0.09),
    (0.18, 0.16),
    (0.1, 0.22),
    (0.14, 0.45),
    (0.1, 0.75),
    (0.2, 0.82),
    (0.08, 0.88),
    (0.04, 1.0),
)


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 36
) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d(
        "lamp",
        "urn-blue",
        "blue ceramic table lamp",
        (0.36, 0.36, 0.60),
        "classic",
        partial(shaded_lamp, profile=URN, body=m.BLUE_GLAZE, cloth=m.LINEN_SHADE),
    ),
    _d(
        "lamp",
        "bottle-white",
        "white bottle table lamp",
        (0.30, 0.30, 0.52),
        "modern",
        partial(shaded_lamp, profile=BOTTLE, body=m.PORCELAIN, cloth=m.LINEN_SHADE, flare=0.85),
    ),
    _d(
        "lamp",
        "column-brass",
        "slim brass table lamp",
        (0.28, 0.28, 0.50),
        "modern",
        partial(shaded_lamp, profile=COLUMN, body=m.BRASS, cloth=m.WHITE_COTTON, flare=0.95, shade_h=0.36),
    ),
    _d(
        "lamp",
        "orb-stone",
        "round stoneware lamp",
        (0.38, 0.38, 0.56),
        "rustic",
        partial(shaded_lamp, profile=ORB, body=m.STONEWARE, cloth=m.OATMEAL, flare=0.8),
    ),
    _d(
        "lamp",
        "candlestick",
        "turned wooden lamp with a pleated shade",
        (0.32, 0.32, 0.62),
        "classic",
        partial(shaded_lamp, profile=CANDLE, body=m.WALNUT, cloth=m.LINEN_SHADE, flare=0.6, pleats=40),
    ),
    _d(
        "lamp",
        "desk-black",
        "black jointed desk lamp",
        (0.42, 0.20, 0.50),
        "industrial",
        partial(desk_lamp, paint=m.BLACK_STEEL, joint=m.STEEL),
        1,
    ),
    _d(
        "lamp",
        "desk-sage",
        "sage jointed desk lamp",
        (0.40, 0.18, 0.46),
        "modern",
        partial(desk_lamp, paint=m.SAGE, joint=m.BRASS),
        1,
    ),
    _d("lamp", "globe", "glass globe lamp", (0.24, 0.24, 0.30), "minimal", partial(globe_lamp, foot=m.BRASS)),
    _d(
        "lamp",
        "mushroom",
        "terracotta mushroom lamp",
        (0.30, 0.30, 0.36),
        "modern",
        partial(mushroom_lamp, body=m.TERRACOTTA),
    ),
    _d(
        "floor lamp",
        "pole-black",
        "black floor lamp with a linen drum shade",
        (0.42, 0.42, 1.58),
        "minimal",
        partial(floor_shade, stand="pole", metal=m.BLACK_STEEL, cloth=m.LINEN_SHADE),
    ),
    _d(
        "floor lamp",
        "pole-brass",
        "brass floor lamp",
        (0.38, 0.38, 1.50),
        "classic",
        partial(floor_shade, stand="pole", metal=m.BRASS, cloth=m.WHITE_COTTON, shade_h=0.3),
    ),
    _d(
        "floor lamp",
        "tripod-oak",
        "oak tripod floor lamp",
        (0.52, 0.52, 1.52),
        "modern",
        partial(floor_shade, stand="tripod", metal=m.OAK, cloth=m.LINEN_SHADE),
        1,
    ),
    _d(
        "floor lamp",
        "arc",
        "arched steel floor lamp",
        (1.15, 0.36, 1.95),
        "modern",
        partial(floor_shade, stand="arc", metal=m.STEEL, cloth=m.BLACK_STEEL),
        1,
    ),
    _d(
        "floor lamp",
        "torchiere",
        "uplighter with an alabaster bowl",
        (0.38, 0.38, 1.76),
        "classic",
        partial(torchiere, metal=m.IRON, bowl=m.LAMP_GLOW),
    ),
    _d(
        "floor lamp",
        "reading",
        "black reading lamp",
        (0.45, 0.26, 1.40),
        "industrial",
        partial(reading_lamp, metal=m.BLACK_STEEL),
        1,
    ),
    _d(
        "floor lamp",
        "column",
        "paper column lamp",
        (0.28, 0.28, 1.30),
        "minimal",
        partial(column_lamp, wood=m.WALNUT),
        4,
    ),
    _d(
        "ceiling lamp",
        "dome-black",
        "black dome pendant",
        (0.42, 0.42, 0.45),
        "industrial",
        partial(pendant, kind="dome", outer=m.BLACK_STEEL),
    ),
    _d(
        "ceiling lamp",
        "drum-linen",
        "linen drum pendant",
        (0.50, 0.50, 0.48),
        "classic",
        partial(pendant, kind="drum", outer=m.LINEN_SHADE),
    ),
    _d(
        "ceiling lamp",
        "globe",
        "opal globe pendant",
        (0.30, 0.30, 0.55),
        "minimal",
        partial(pendant, kind="globe", outer=m.LAMP_GLOW),
    ),
    _d(
        "ceiling lamp",
        "wicker-bell",
        "wicker bell pendant",
        (0.48, 0.48, 0.55),
        "rustic",
        partial(pendant, kind="bell", outer=m.RATTAN),
    ),
    _d(
        "ceiling lamp",
        "cone-sage",
        "sage cone pendant",
        (0.36, 0.36, 0.50),
        "modern",
        partial(pendant, kind="cone", outer=m.SAGE),
    ),
    _d(
        "ceiling lamp",
        "chandelier",
        "iron chandelier with five shades",
        (0.66, 0.66, 0.55),
        "classic",
        partial(chandelier, metal=m.IRON, arms=5),
    ),
    _d(
        "ceiling lamp",
        "chandelier-brass",
        "brass chandelier with eight shades",
        (0.80, 0.80, 0.62),
        "classic",
        partial(chandelier, metal=m.BRASS, arms=8),
    ),
    _d(
        "ceiling lamp", "flush", "flush ceiling light", (0.40, 0.40, 0.12), "minimal", partial(flush_light, rim=m.STEEL)
    ),
    _d(
        "ceiling lamp",
        "linear",
        "linear black pendant",
        (0.08, 1.10, 0.60),
        "modern",
        partial(linear_pendant, metal=m.BLACK_STEEL),
        2,
    ),
    _d(
        "ceiling lamp",
        "cage",
        "brass cage pendant",
        (0.36, 0.36, 0.55),
        "industrial",
        partial(lantern_cluster, metal=m.BRASS),
        4,
    ),
)
