"""Sculptures and other things to look at."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *

BRONZE = m.metal("bronze", "#6b5640", 0.4)


PLASTER = m.paint("plaster", "#e6e1d8", 0.85)


def bust(size: Size, stone: Material, plinth: Material) -> Parts:
    """A head and shoulders on a small plinth, without a face to know."""
    d, w, h = size
    z = 0.16 * h
    base = [
        box((0.5 * d, 0.42 * w, 0.06 * h), 0.006, 2),
        lathe([(0.2 * w, 0.05 * h), (0.14 * w, 0.08 * h), (0.13 * w, 0.14 * h), (0.19 * w, z + 0.01)], 28),
    ]
    rows = []
    for s, height, depth, shift in (
        (0.3, 0.0, 0.34, 0.0),
        (0.62, 0.06, 0.5, 0.0),
        (0.98, 0.22, 0.62, 0.0),
        (1.0, 0.32, 0.6, -0.02),
        (0.72, 0.42, 0.5, -0.04),
        (0.32, 0.47, 0.34, -0.05),
        (0.27, 0.53, 0.3, -0.03),
        (0.27, 0.58, 0.3, 0.0),
    ):
        o = superellipse(depth * d, s * w, 2.4, 32)
        rows.append(np.column_stack([o[:, 0] + shift * d, o[:, 1], np.full(len(o), z + height * (h - z))]))
    torso = loft(np.array(rows), crease_rad=np.pi)
    head = (
        cushion((0.62 * d, 0.36 * w, 0.44 * (h - z)), 2.0, 2.3, 10)
        .turned("y", 6)
        .moved(0.04 * d, 0, z + 0.55 * (h - z))
    )
    nose = cushion((0.1 * d, 0.06 * w, 0.12 * h), 2, 2, 5).moved(0.33 * d, 0, z + 0.72 * (h - z))
    hair = cushion((0.66 * d, 0.4 * w, 0.3 * (h - z)), 2.2, 2.4, 9).moved(-0.03 * d, 0, z + 0.70 * (h - z))
    brow = cushion((0.08 * d, 0.24 * w, 0.035 * h), 2, 2, 5).moved(0.28 * d, 0, z + 0.81 * (h - z))
    chin = cushion((0.16 * d, 0.12 * w, 0.07 * h), 2, 2, 5).moved(0.25 * d, 0, z + 0.57 * (h - z))
    return of(stone, torso, head, nose, hair, brow, chin) + of(plinth, *base)


def loop_form(size: Size, stone: Material, plinth: Material) -> Parts:
    """A standing loop that swells and thins, on a block."""
    d, w, h = size
    t = np.linspace(0, 2 * np.pi, 49)[:-1]
    low = 0.12 * h
    r = (h - low) / 2
    path = np.stack(
        [0.26 * d * np.sin(2 * t), 0.38 * w * np.sin(t) * (1 + 0.2 * np.cos(t)), low + r * 0.98 - 0.84 * r * np.cos(t)],
        axis=1,
    )
    radii = 0.105 * w * (1.15 + 0.5 * np.cos(t))
    return of(stone, tube(path, radii, 14, closed=True)) + of(plinth, box((0.6 * d, 0.5 * w, low + 0.02), 0.005, 2))


def knot(size: Size, clay: Material) -> Parts:
    """A thick rope of clay tied in a trefoil, lying."""
    d, w, h = size
    t = np.linspace(0, 2 * np.pi, 73)[:-1]
    path = np.stack([(np.sin(t) + 2 * np.sin(2 * t)) / 3, (np.cos(t) - 2 * np.cos(2 * t)) / 3, -np.sin(3 * t)], axis=1)
    r = 0.27 * h
    half = np.array([d / 2 - r, w / 2 - r, h / 2 - r])
    path = path / np.abs(path).max(axis=0) * half + np.array([0, 0, h / 2])
    return of(clay, tube(path, r, 14, closed=True))


def stack_of_stones(size: Size, tones: tuple[Material, ...]) -> Parts:
    """Balanced pebbles."""
    d, w, h = size
    shares = np.array([0.3, 0.24, 0.18, 0.16, 0.12])
    parts: Parts = []
    z = 0.0
    for k, s in enumerate(shares):
        tall = s * h
        f = 1.0 - 0.17 * k
        pebble = cushion((d * f, w * f * (0.92 + 0.06 * (k % 2)), tall * 1.06), 2.2, 2.2, 9).turned("z", 37 * k)
        parts += of(tones[k % len(tones)], pebble.moved(0.02 * d * (-1) ** k, 0.015 * w * (k % 3), z))
        z += tall * 0.985
    return parts


def deer(size: Size, metal: Material) -> Parts:
    """A standing deer, simplified, facing +X."""
    d, w, h = size
    body = cushion((0.56 * d, 0.4 * w, 0.22 * h), 2.3, 2.2, 9).moved(-0.08 * d, 0, 0.4 * h)
    legs = [
        tube(
            bend(
                [
                    (x, s * 0.11 * w, 0.48 * h),
                    (x + 0.015 * d, s * 0.12 * w, 0.26 * h),
                    (x - 0.005 * d, s * 0.12 * w, 0.0),
                ],
                4,
            ),
            np.linspace(0.05 * h, 0.016 * h, 9),
            8,
        )
        for x in (0.1 * d, -0.27 * d)
        for s in (1, -1)
    ]
    neck = tube(
        bend([(0.1 * d, 0, 0.5 * h), (0.2 * d, 0, 0.62 * h), (0.25 * d, 0, 0.74 * h)], 5),
        np.linspace(0.075 * h, 0.04 * h, 11),
        10,
    )
    head = cushion((0.26 * d, 0.16 * w, 0.09 * h), 2.0, 2.2, 7).turned("y", 14).moved(0.32 * d, 0, 0.71 * h)
    ears = both_sides(
        cushion((0.03 * d, 0.14 * w, 0.05 * h), 2, 2, 4).turned("x", 24).moved(0.24 * d, 0.12 * w, 0.76 * h)
    )
    antlers: list[Solid] = []
    for s in (1, -1):
        stem = bend(
            [(0.25 * d, s * 0.05 * w, 0.78 * h), (0.2 * d, s * 0.26 * w, 0.86 * h), (0.24 * d, s * 0.42 * w, 0.98 * h)],
            5,
        )
        antlers.append(tube(stem, np.linspace(0.014 * h, 0.005 * h, len(stem)), 6))
        for k in (3, 6):
            antlers.append(
                rod(tuple(stem[k]), (stem[k][0] + 0.1 * d, stem[k][1], stem[k][2] + 0.09 * h), 0.01 * h, 0.004 * h, 6)
            )
    tail = cushion((0.06 * d, 0.08 * w, 0.09 * h), 2, 2, 4).moved(-0.36 * d, 0, 0.48 * h)
    return of(metal, body, *legs, neck, head, *ears, *antlers, tail)


def bird(size: Size, wood: Material, metal: Material) -> Parts:
    """A wooden bird on wire legs."""
    d, w, h = size
    low = 0.34 * h
    t = np.linspace(0, 1, 11)
    radii = 0.44 * w * np.sin(np.pi * np.clip(0.06 + 0.9 * t, 0, 1)) ** 0.75 + 0.006
    path = np.stack([-0.44 * d + 0.8 * d * t, 0 * t, low + 0.3 * h + 0.12 * h * np.sin(2.2 * t)], axis=1)
    head = ball(0.46 * w, 8).moved(0.25 * d, 0, h - 0.46 * w)
    beak = (
        lathe([(0.05 * w, 0), (0.1 * w, 0.0), (0.002, 0.16 * d)], 12)
        .turned("y", 96)
        .moved(0.25 * d + 0.2 * w, 0, h - 0.24 * w)
    )
    legs = [
        rod((0.02 * d, s * 0.1 * w, low + 0.1 * h), (0.04 * d, s * 0.12 * w, 0.0), 0.003, segments=6) for s in (1, -1)
    ]
    foot = [cylinder(0.3 * w, 0.008, 0.002, 28).moved(0.04 * d)]
    return of(wood, tube(path, radii, 16), head) + of(metal, beak, *legs, *foot)


def dancer(size: Size, metal: Material) -> Parts:
    """A slender standing figure with raised arms."""
    d, w, h = size
    base = of(m.MARBLE, cylinder(0.32 * min(d, w), 0.05 * h, 0.004, 32))
    legs = [
        tube(
            bend(
                [
                    (0.02 * s * d, s * 0.03 * w, 0.47 * h),
                    (0.06 * d * s, s * 0.06 * w, 0.26 * h),
                    (0.1 * d * s, s * 0.02 * w, 0.05 * h),
                ],
                4,
            ),
            np.linspace(0.042 * h, 0.014 * h, 9),
            9,
        )
        for s in (1, -1)
    ]
    torso = tube(
        bend(
            [
                (0, 0, 0.44 * h),
                (0.02 * d, 0, 0.54 * h),
                (-0.02 * d, 0, 0.64 * h),
                (0.0, 0, 0.72 * h),
                (0.02 * d, 0, 0.78 * h),
            ],
            4,
        ),
        [
            0.05 * h,
            0.056 * h,
            0.058 * h,
            0.054 * h,
            0.048 * h,
            0.043 * h,
            0.04 * h,
            0.042 * h,
            0.047 * h,
            0.052 * h,
            0.052 * h,
            0.048 * h,
            0.04 * h,
            0.03 * h,
            0.02 * h,
            0.016 * h,
            0.016 * h,
        ],
        12,
    )
    arms = [
        tube(
            bend(
                [
                    (0, s * 0.06 * w, 0.72 * h),
                    (0.04 * d, s * 0.3 * w, 0.78 * h),
                    (0.0, s * 0.36 * w, 0.9 * h),
                    (-0.06 * d, s * 0.14 * w, 0.985 * h),
                ],
                4,
            ),
            np.linspace(0.018 * h, 0.008 * h, 13),
            8,
        )
        for s in (1, -1)
    ]
    skirt = lathe([(0.06 * h, 0.5 * h), (0.2 * h, 0.40 * h), (0.195 * h, 0.395 * h), (0.05 * h, 0.47 * h)], 30, np.pi)
    ripple = 1 + 0.06 * np.cos(9 * np.arctan2(skirt.vertices[:, 1], skirt.vertices[:, 0]))
    skirt = replace(skirt, vertices=skirt.vertices * np.column_stack([ripple, ripple, np.ones_like(ripple)]))
    return base + of(
        metal,
        *legs,
        torso,
        *arms,
        skirt,
        cushion((0.085 * h, 0.075 * h, 0.1 * h), 2, 2.2, 7).moved(0.02 * d, 0, 0.78 * h),
    )


def sphere_on_block(size: Size, stone: Material, plinth: Material) -> Parts:
    """A ball on a cube on a slab."""
    d, w, h = size
    k = min(d, w)
    return of(
        plinth,
        box((d, w, 0.1 * h), 0.004, 2),
        box((0.5 * k, 0.5 * k, 0.42 * h), 0.004, 2).moved(0.1 * d, 0.1 * w, 0.1 * h),
    ) + of(
        stone,
        ball(0.48 * h, 11).moved(0.1 * d, 0.1 * w, 0.515 * h),
        cylinder(0.13 * k, 0.26 * h, 0.004, 28).moved(-0.24 * d, -0.26 * w, 0.1 * h),
    )


def hourglass(size: Size, wood: Material) -> Parts:
    """A sand-glass between two discs."""
    d, _, h = size
    r = d / 2
    t = 0.07 * h
    bulb = smooth_profile(((0.5, 0.0), (0.74, 0.12), (0.7, 0.3), (0.12, 0.5), (0.7, 0.7), (0.74, 0.88), (0.5, 1.0)), 3)
    span = h - 2 * t
    glass = lathe([(a * r, t + b * span) for a, b in bulb], 28, np.pi)
    sand = lathe(
        [
            (0.46 * r, t + 0.01 * span),
            (0.66 * r, t + 0.13 * span),
            (0.5 * r, t + 0.22 * span),
            (0.003, t + 0.29 * span),
        ],
        24,
        np.pi,
    )
    posts = [
        lathe(
            [
                (0.07 * r, t),
                (0.11 * r, t + 0.2 * span),
                (0.06 * r, h / 2),
                (0.11 * r, t + 0.8 * span),
                (0.07 * r, h - t),
            ],
            10,
        ).moved(0.8 * r * np.cos(a), 0.8 * r * np.sin(a))
        for a in np.deg2rad((0, 120, 240))
    ]
    return (
        of(wood, *(cylinder(r, t, 0.005, 32).moved(z=z) for z in (0.0, h - t)), *posts)
        + of(m.GLASS, glass)
        + of(SAND, sand)
    )


SAND = m.paint("sand", "#d3bf98", 0.95)


def model_ship(size: Size, wood: Material, sail: Material) -> Parts:
    """A little sailing boat on a stand, its bow toward +Y."""
    d, w, h = size
    z = 0.1 * h
    rows = []
    for s in np.linspace(-1, 1, 11):
        beam_ = 0.36 * d * (1 - np.abs(s) ** (2.6 if s < 0 else 1.8)) + 0.004
        sheer = z + 0.15 * h + 0.05 * h * s**2
        t = np.linspace(np.pi, 2 * np.pi, 9)
        rows.append(
            np.stack(
                [beam_ * np.cos(t), np.full_like(t, 0.46 * w * s), sheer + (0.13 * h * (1 - 0.5 * s**2)) * np.sin(t)],
                axis=1,
            )
        )
    hull = loft(np.array(rows), crease_rad=np.deg2rad(70))
    mast = [
        cylinder(0.008, 0.78 * h, 0.002, 10).moved(0, 0.02 * w, 0.22 * h - 0.02),
        rod((0, 0.02 * w, 0.3 * h), (0, -0.38 * w, 0.31 * h), 0.005),
    ]
    from_stand = [box((0.3 * d, 0.02, z + 0.05 * h), 0.004).moved(0, s * 0.2 * w) for s in (1, -1)] + [
        box((0.36 * d, 0.6 * w, 0.02), 0.005)
    ]
    main = loft(
        np.array([[(x, 0.0, 0.34 * h), (x, 0.0, 0.97 * h), (x, -0.37 * w, 0.35 * h)] for x in (0.006, -0.006)]),
        crease_rad=0.3,
    )
    jib = loft(
        np.array([[(x, 0.06 * w, 0.34 * h), (x, 0.42 * w, 0.3 * h), (x, 0.05 * w, 0.88 * h)] for x in (-0.006, 0.006)]),
        crease_rad=0.3,
    )
    return of(wood, hull, *mast) + of(sail, main, jib) + of(m.WALNUT, *from_stand)


def bookend(size: Size, stone: Material) -> Parts:
    """A pair of arched bookends."""
    d, w, h = size
    quarter = [
        (0.0, 0.0),
        (0.46 * w, 0.0),
        *((0.46 * w * np.cos(a), h * np.sin(a)) for a in np.linspace(0.1, np.pi / 2, 10)),
    ]
    half = prism(quarter, d, 0.004).turned("x", 90).turned("z", 90).moved(-d / 2, 0.02)
    return of(stone, *both_sides(half))


DESIGNS: tuple[Design, ...] = (
    design("sculpture", "bust", "plaster bust on a plinth", (0.18, 0.26, 0.42), "classic", bust, stone=PLASTER, plinth=m.MARBLE),
    design("sculpture", "loop", "looping stone sculpture", (0.14, 0.22, 0.36), "modern", loop_form, stone=m.MARBLE, plinth=m.BLACK_WOOD),
    design("sculpture", "loop-bronze", "looping bronze on a stone block", (0.13, 0.20, 0.40), "industrial", loop_form, stone=BRONZE, plinth=m.CONCRETE),
    design("sculpture", "knot", "knotted clay form", (0.24, 0.24, 0.11), "minimal", knot, clay=m.CREAM),
    design("sculpture", "pebbles", "balanced stones", (0.15, 0.16, 0.26), "rustic", stack_of_stones, tones=(m.DARK_STONEWARE, m.STONEWARE, m.GRANITE, m.CONCRETE)),
    design("sculpture", "deer", "bronze deer", (0.28, 0.14, 0.34), "classic", deer, metal=BRONZE),
    design("sculpture", "bird", "wooden bird on wire legs", (0.20, 0.09, 0.17), "minimal", bird, wood=m.OAK, metal=m.BLACK_STEEL),
    design("sculpture", "dancer", "bronze dancer", (0.15, 0.20, 0.42), "classic", dancer, metal=BRONZE),
    design("sculpture", "solids", "stone ball and block", (0.16, 0.22, 0.24), "modern", sphere_on_block, stone=m.MARBLE, plinth=m.GRANITE),
    design("sculpture", "hourglass", "walnut sand-glass", (0.12, 0.12, 0.24), "rustic", hourglass, 36, wood=m.WALNUT),
    design("sculpture", "ship", "model sailing boat", (0.12, 0.34, 0.42), "rustic", model_ship, wood=m.CHERRY, sail=m.LINEN),
    design("sculpture", "bookends", "pair of marble bookends", (0.08, 0.24, 0.14), "minimal", bookend, stone=m.MARBLE),
)  # fmt: skip
