"""Lamps on walls; the back, -X, is the wall's."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.lighting.shades import bulb, filament_bulb, shade, spider


def plate(d: float, z: float, radius: float, metal: Material, tall: float = 1.0) -> Parts:
    """The round or oval plate on the wall."""
    disc = prism(superellipse(2 * radius * tall, 2 * radius, 2, 32), 0.016, 0.006).turned("y", 90)
    return of(metal, disc.moved(-d / 2, 0, z))


def shaded_sconce(size: Size, metal: Material, cloth: Material) -> Parts:
    """A curved arm with a cloth shade."""
    d, w, h = size
    r, hs = w / 2, 0.55 * h
    x = d / 2 - r
    arm = tube(
        bend([(-d / 2 + 0.01, 0, 0.2 * h), (-d / 2 + 0.06, 0, 0.1 * h), (x - 0.02, 0, 0.08 * h), (x, 0, 0.22 * h)], 5),
        0.006,
        8,
    )
    cup = lathe([(0.01, 0), (0.025, 0.008), (0.022, 0.014), (0.01, 0.018)], 16).moved(x, 0, 0.21 * h)
    stem = cylinder(0.009, h - hs * 0.5 - 0.22 * h, 0.002, 12).moved(x, 0, 0.22 * h)
    hood = (
        of(cloth, shade(r, r * 0.66, hs).moved(z=h - hs))
        + of(metal, *spider(r * 0.67, h - 0.015))
        + bulb(h - hs * 0.55, 0.024)
    )
    return plate(d, 0.2 * h, 0.05, metal, 1.5) + of(metal, arm, cup, stem) + shifted(hood, x)


def swing_arm(size: Size, metal: Material, hood_of: Material) -> Parts:
    """A two-jointed arm with a metal hood, for reading in bed."""
    d, w, h = size
    z = 0.62 * h
    elbow, head = (-d / 2 + 0.1, w / 2 - 0.03, z), (d / 2 - 0.09, -0.02, z)
    arms = [rod((-d / 2 + 0.03, 0, z), elbow, 0.006), rod(elbow, head, 0.006)]
    knuckles = [
        cylinder(0.012, 0.05, 0.003, 14).moved(p[0], p[1], z - 0.025) for p in ((-d / 2 + 0.03, 0.0), elbow, head)
    ]
    hood = (
        lathe([(0.018, 0.13), (0.03, 0.12), (0.038, 0.085), (0.07, 0.0), (0.067, 0.0), (0.03, 0.09)], 28)
        .turned("y", -32)
        .moved(d / 2 - 0.06, -0.02, z - 0.14)
    )
    return (
        plate(d, z, 0.05, metal)
        + of(metal, *arms, *knuckles)
        + of(hood_of, hood)
        + of(m.LAMP_GLOW, ball(0.055).moved(d / 2 - 0.048, -0.02, z - 0.125))
    )


def up_down(size: Size, metal: Material) -> Parts:
    """A short cylinder that shines up and down."""
    d, w, h = size
    r = w / 2
    x = d / 2 - r
    can = lathe(
        [
            (r - 0.004, 0.0),
            (r, 0.003),
            (r, h - 0.003),
            (r - 0.004, h),
            (r - 0.006, h - 0.02),
            (r - 0.006, 0.02),
            (r - 0.004, 0.0),
        ],
        36,
    )
    discs = [cylinder(r - 0.006, 0.004, 0.001, 28).moved(x, 0, z) for z in (0.016, h - 0.02)]
    bracket = box((d - 2 * r + 0.02, 0.05, h * 0.5), 0.006).moved(-d / 2 + (d - 2 * r) / 2, 0, h * 0.25)
    return of(metal, can.moved(x), bracket) + of(m.LAMP_GLOW, *discs)


def globe_sconce(size: Size, metal: Material, globes: int = 1) -> Parts:
    """Glass globes on a plate or a bar."""
    d, w, h = size
    g = h * 0.72 if globes == 1 else w / globes * 0.72
    x = d / 2 - g / 2
    parts: Parts = []
    if globes == 1:
        parts += plate(d, 0.3 * h, 0.055, metal)
    else:
        parts += of(metal, box((0.02, w * 0.96, 0.05), 0.008, 2).moved(-d / 2 + 0.01, 0, 0.08 * h))
    for k in range(globes):
        y = 0.0 if globes == 1 else w * ((k + 0.5) / globes - 0.5)
        low = h - g
        arm = tube(
            bend(
                [
                    (-d / 2 + 0.01, y, 0.3 * h if globes == 1 else 0.14 * h),
                    (x - 0.03, y, 0.12 * h),
                    (x, y, 0.14 * h),
                    (x, y, low),
                ],
                4,
            ),
            0.007,
            8,
        )
        parts += of(
            metal, arm, lathe([(0.012, -0.02), (0.03, -0.01), (0.034, 0.012), (0.028, 0.014)], 20).moved(x, y, low)
        )
        parts += of(m.LAMP_GLOW, ball(g, 9).moved(x, y, low))
    return parts


def barn_light(size: Size, metal: Material) -> Parts:
    """A gooseneck with a wide enamelled shade."""
    d, w, h = size
    r = w / 2
    x = d / 2 - r
    neck = tube(
        bend(
            [
                (-d / 2 + 0.01, 0, 0.42 * h),
                (-d / 2 + 0.12, 0, 0.75 * h),
                (-d / 2 + 0.24, 0, 0.99 * h),
                (x - 0.06, 0, 0.95 * h),
                (x, 0, 0.62 * h),
            ],
            6,
        ),
        0.009,
        10,
    )
    hood = lathe(
        [
            (r, 0.0),
            (0.96 * r, 0.08 * h),
            (0.5 * r, 0.3 * h),
            (0.22 * r, 0.42 * h),
            (0.2 * r, 0.62 * h),
            (0.05 * r, 0.66 * h),
            (0.16 * r, 0.4 * h),
            (0.46 * r, 0.27 * h),
            (0.93 * r, 0.06 * h),
            (r, 0.0),
        ],
        40,
        np.deg2rad(50),
    )
    return plate(d, 0.42 * h, 0.055, metal) + of(metal, neck, hood.moved(x)) + shifted(bulb(0.14 * h, 0.035), x)


def wall_lantern(size: Size, metal: Material) -> Parts:
    """A glazed lantern on a bracket."""
    d, w, h = size
    x = d / 2 - w / 2
    body, low = 0.58 * h, 0.06 * h
    posts = [
        box((0.01, 0.01, body), 0.002).moved(x + sx * w * 0.4, sy * w * 0.4, low) for sx in (1, -1) for sy in (1, -1)
    ]
    panes = [box((0.002, w * 0.78, body), 0.0005).moved(x + s * w * 0.4, 0, low) for s in (1, -1)] + [
        box((w * 0.78, 0.002, body), 0.0005).moved(x, s * w * 0.4, low) for s in (1, -1)
    ]
    roof = taper((x, 0, low + body - 0.004), (x, 0, low + body + 0.16 * h), w * 1.0, w * 0.2, 0.01)
    floor_ = taper((x, 0, 0.0), (x, 0, low + 0.004), w * 0.3, w * 0.9, 0.006)
    arm = tube(
        bend(
            [
                (-d / 2 + 0.01, 0, 0.55 * h),
                (-d / 2 + 0.05, 0, 0.92 * h),
                (x - 0.05, 0, 0.99 * h),
                (x, 0, 0.93 * h),
                (x, 0, 0.78 * h),
            ],
            5,
        ),
        0.007,
        8,
    )
    return (
        plate(d, 0.55 * h, 0.04, metal, 2.6)
        + of(metal, *posts, roof, floor_, arm)
        + of(m.GLASS, *panes)
        + shifted(of(m.CREAM, cylinder(0.016, 0.3 * h, 0.003, 14).moved(z=low)), x)
        + shifted(
            of(
                m.LAMP_GLOW,
                lathe([(0.004, 0), (0.013, 0.016), (0.008, 0.036), (0.001, 0.055)], 10, np.pi).moved(z=low + 0.3 * h),
            ),
            x,
        )
    )


def picture_light(size: Size, metal: Material) -> Parts:
    """A slim trough over a picture."""
    d, w, h = size
    t = np.linspace(-0.3, np.pi * 0.8, 10)
    r = 0.03
    section = np.stack([d / 2 - r + r * np.cos(t), h - r - 0.005 + r * np.sin(t)], axis=1)
    outer = np.array(
        [np.column_stack([section[:, 0], np.full(len(section), y), section[:, 1]]) for y in (-w / 2, w / 2)]
    )
    from_wall = tube(
        bend(
            [
                (-d / 2 + 0.01, 0, 0.15 * h),
                (-d / 2 + 0.05, 0, 0.5 * h),
                (d / 2 - 0.06, 0, 0.96 * h),
                (d / 2 - r, 0, h - 0.01),
            ],
            5,
        ),
        0.006,
        8,
    )
    ends = [
        cylinder(r, 0.004, 0.001, 20).turned("x", 90).moved(d / 2 - r, s * w / 2 + 0.002, h - r - 0.005)
        for s in (1, -1)
    ]
    glow = cylinder(0.012, w * 0.9, 0.003, 12).turned("x", 90).moved(d / 2 - r - 0.002, w * 0.45, h - r - 0.004)
    return plate(d, 0.15 * h, 0.045, metal) + of(metal, slab(outer, 0.003), from_wall, *ends) + of(m.LAMP_GLOW, glow)


def bulb_sconce(size: Size, wood: Material, metal: Material) -> Parts:
    """A bare bulb on a wooden board."""
    d, w, h = size
    board = box((0.022, w, h), 0.006, 2).moved(-d / 2 + 0.011)
    x = d / 2 - 0.045
    arm = tube(
        bend([(-d / 2 + 0.02, 0, 0.78 * h), (x - 0.02, 0, 0.84 * h), (x, 0, 0.82 * h), (x, 0, 0.74 * h)], 4), 0.007, 8
    )
    return (
        of(wood, board)
        + of(
            metal,
            arm,
            cylinder(0.025, 0.012, 0.003, 20).turned("y", 90).moved(-d / 2 + 0.02, 0, 0.78 * h),
            lathe([(0.03, 0.7 * h), (0.022, 0.74 * h), (0.018, 0.78 * h)], 18).moved(x),
        )
        + shifted(filament_bulb(0.72 * h, scale=1.2), x)
    )


def half_bowl(size: Size, plaster: Material) -> Parts:
    """A plaster half bowl that lights the wall above it."""
    d, w, h = size
    a = np.linspace(-np.pi / 2, np.pi / 2, 17)
    rows = []
    for s, z in ((0.25, 0.0), (0.55, 0.12), (0.85, 0.5), (1.0, 1.0), (0.95, 1.0), (0.8, 0.55), (0.5, 0.2)):
        rows.append(np.stack([-d / 2 + s * d * np.cos(a), s * w / 2 * np.sin(a), np.full_like(a, z * h)], axis=1))
    return of(plaster, loft(np.array(rows), crease_rad=np.deg2rad(50))) + of(
        m.LAMP_GLOW, box((d * 0.5, w * 0.5, 0.01), 0.004).moved(-d * 0.22, 0, h * 0.55)
    )


DESIGNS: tuple[Design, ...] = (
    design("wall lamp", "shaded-brass", "brass wall lamp with a linen shade", (0.22, 0.17, 0.34), "classic", shaded_sconce, metal=m.BRASS, cloth=m.LINEN_SHADE),
    design("wall lamp", "shaded-nickel", "nickel sconce with a white shade", (0.20, 0.16, 0.30), "modern", shaded_sconce, metal=m.STEEL, cloth=m.LINEN_SHADE),
    design("wall lamp", "swing-black", "black swing-arm wall lamp", (0.42, 0.24, 0.26), "industrial", swing_arm, metal=m.BLACK_STEEL, hood_of=m.BLACK_STEEL),
    design("wall lamp", "swing-brass", "brass swing-arm lamp with a cream hood", (0.38, 0.22, 0.25), "modern", swing_arm, metal=m.BRASS, hood_of=m.CREAM),
    design("wall lamp", "up-down", "white up-and-down wall light", (0.13, 0.11, 0.22), "minimal", up_down, metal=m.WHITE),
    design("wall lamp", "up-down-black", "black cylinder wall light", (0.12, 0.10, 0.26), "minimal", up_down, metal=m.CHARCOAL),
    design("wall lamp", "globe", "globe wall lamp on a brass arm", (0.20, 0.15, 0.22), "modern", globe_sconce, metal=m.BRASS),
    design("wall lamp", "vanity", "bathroom light with three globes", (0.18, 0.60, 0.20), "classic", globe_sconce, metal=m.CHROME, globes=3),
    design("wall lamp", "barn", "enamelled barn light", (0.42, 0.30, 0.34), "rustic", barn_light, metal=m.SAGE),
    design("wall lamp", "lantern", "iron wall lantern", (0.22, 0.15, 0.38), "rustic", wall_lantern, metal=m.IRON),
    design("wall lamp", "picture-light", "brass picture light", (0.20, 0.42, 0.14), "classic", picture_light, metal=m.BRASS),
    design("wall lamp", "bulb", "bare bulb on a reclaimed board", (0.15, 0.12, 0.32), "industrial", bulb_sconce, wood=m.RECLAIMED, metal=m.BLACK_STEEL),
    design("wall lamp", "plaster", "plaster uplighter", (0.14, 0.30, 0.14), "minimal", half_bowl, plaster=m.WHITE),
)  # fmt: skip
