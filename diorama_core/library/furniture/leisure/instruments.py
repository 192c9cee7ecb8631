"""Guitars and other instruments that stand about."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *

SPRUCE = m.wood("spruce top", "#d6b37f", 0.3)
EBONY = m.wood("ebony", "#2b2421", 0.4)


def _waisted(length: float, upper: float, lower: float, waist: float, points: int = 56) -> np.ndarray:
    """The outline of a guitar's body, (z, y), its lower bout at z < 0."""
    t = np.arange(points) * 2 * np.pi / points
    c = np.cos(t)
    blend = 0.5 + 0.5 * np.tanh(-2.2 * c)
    width = upper * (1 - blend) + lower * blend
    narrow = 1 - (1 - waist) * np.exp(-(((c - 0.12) / 0.34) ** 2))
    return np.stack([length / 2 * c, width / 2 * np.sin(t) * narrow], axis=1)


def _upright(outline: np.ndarray, thickness: float, bevel: float) -> Solid:
    """A plate of a (z, y) outline, its faces toward -X and +X, from x = 0."""
    plate = prism(outline[:, ::-1], thickness, bevel)
    v, n = plate.vertices, plate.normals
    return replace(plate, vertices=v[:, [2, 0, 1]], normals=n[:, [2, 0, 1]])


def acoustic(length: float, wood: Material, top: Material, scale: float = 1.0) -> Parts:
    """A flat-top guitar upright on z = 0, its face toward +X."""
    body = 0.49 * length
    o = _waisted(body, 0.29 * length * scale, 0.39 * length * scale, 0.82)
    z0 = body / 2
    parts = of(wood, _upright(o, 0.098 * length, 0.006).moved(-0.049 * length, 0, z0)) + of(
        top, _upright(o * 0.985, 0.003, 0.0012).moved(0.049 * length - 0.0015, 0, z0)
    )
    x = 0.05 * length
    hole = cylinder(0.05 * length, 0.002, 0.0004, 32).turned("y", 90).moved(x, 0, z0 + 0.07 * length)
    ring = (
        lathe(
            [
                (0.053 * length, 0),
                (0.062 * length, 0),
                (0.062 * length, 0.0018),
                (0.053 * length, 0.0018),
                (0.053 * length, 0),
            ],
            36,
        )
        .turned("y", 90)
        .moved(x, 0, z0 + 0.07 * length)
    )
    bridge = box((0.008, 0.16 * length, 0.026 * length), 0.003).moved(x + 0.003, 0, z0 - 0.12 * length)
    neck_low, neck_top = z0 + 0.10 * length, 0.86 * length
    board = box((0.012, 0.052 * length, neck_top - neck_low), 0.002).moved(x + 0.004, 0, neck_low)
    neck = box((0.03 * length, 0.048 * length, neck_top - body + 0.01), 0.01, 2).moved(
        x - 0.012 * length, 0, body - 0.01
    )
    frets = [
        box((0.003, 0.05 * length, 0.0016), 0.0005).moved(
            x + 0.0105, 0, neck_top - (neck_top - neck_low) * (1 - 2 ** (-k / 12)) * 1.45
        )
        for k in range(1, 15)
    ]
    head = box((0.018, 0.076 * length, 0.14 * length), 0.005).turned("y", -8).moved(x - 0.004, 0, neck_top)
    pegs = [
        cylinder(0.007, 0.026, 0.002, 10)
        .turned("x", 90 * s)
        .moved(x - 0.012, -s * 0.036 * length, neck_top + 0.035 * length * (k + 0.6))
        for k in range(3)
        for s in (1, -1)
    ]
    strings = [
        rod(
            (x + 0.012, y * 0.036 * length, z0 - 0.12 * length),
            (x + 0.012, y * 0.032 * length, neck_top),
            0.0006,
            segments=4,
        )
        for y in np.linspace(-1, 1, 6)
    ]
    return (
        parts
        + of(EBONY, board, bridge, head, hole)
        + of(m.WALNUT, ring)
        + of(wood, neck)
        + of(m.CHROME, *pegs, *frets, *strings)
    )


def electric(length: float, paint: Material, guard: Material) -> Parts:
    """A solid-body guitar with two horns."""
    body = 0.42 * length
    t = np.arange(64) * 2 * np.pi / 64
    c, s = np.cos(t), np.sin(t)
    r = (
        1
        + 0.10 * np.cos(2 * t)
        - 0.16 * np.exp(-(((t - 0.0) / 0.32) ** 2))
        - 0.16 * np.exp(-(((t - 2 * np.pi) / 0.32) ** 2))
        + 0.13 * np.exp(-(((t - 0.62) / 0.22) ** 2))
        + 0.2 * np.exp(-(((t - 5.66) / 0.22) ** 2))
        - 0.10 * np.exp(-(((t - 1.45) / 0.25) ** 2))
        - 0.10 * np.exp(-(((t - 4.85) / 0.25) ** 2))
    )
    o = np.stack([body / 2 * c * r, 0.165 * length * s * r], axis=1)
    o[:, 0] += body / 2 - o[:, 0].max()
    z0 = -float(o[:, 0].min())
    x = 0.022 * length
    plate = _waisted(0.26 * length, 0.13 * length, 0.2 * length, 0.8)
    parts = of(paint, _upright(o, 0.044 * length, 0.008).moved(-x, 0, z0)) + of(
        guard, _upright(plate, 0.003, 0.001).moved(x, -0.01 * length, z0 - 0.01 * length)
    )
    top, low = 0.88 * length, z0 + 0.06 * length
    parts += of(
        m.BIRCH,
        box((0.024 * length, 0.045 * length, top - low), 0.006, 2).moved(x + 0.002, 0, low),
        box((0.016, 0.075 * length, 0.12 * length), 0.006).turned("y", -6).moved(x, -0.012 * length, top - 0.004),
    )
    parts += of(EBONY, box((0.006, 0.046 * length, top - low), 0.0015).moved(x + 0.015 * length, 0, low))
    bits = [
        box((0.012, 0.07 * length, 0.014 * length), 0.003).moved(x + 0.005, 0, z0 + dz * length)
        for dz in (-0.07, -0.01, 0.04)
    ]
    bits += [box((0.014, 0.08 * length, 0.03 * length), 0.003).moved(x + 0.004, 0, z0 - 0.13 * length)]
    knobs = [
        cylinder(0.012, 0.014, 0.003, 16)
        .turned("y", 90)
        .moved(x + 0.002, -0.1 * length, z0 - 0.05 * length - 0.035 * length * k)
        for k in range(3)
    ]
    pegs = [
        cylinder(0.006, 0.02, 0.002, 10)
        .turned("x", -90)
        .moved(x - 0.004, 0.024 * length, top + 0.017 * length * (k + 0.4))
        for k in range(6)
    ]
    strings = [
        rod(
            (x + 0.02 * length, y * 0.03 * length, z0 - 0.12 * length),
            (x + 0.02 * length, y * 0.019 * length, top),
            0.0006,
            segments=4,
        )
        for y in np.linspace(-1, 1, 6)
    ]
    return parts + of(m.BLACK, *bits[1:3]) + of(m.CHROME, bits[0], bits[3], *knobs, *pegs, *strings)


def on_stand(size: Size, guitar: str, body: Material, second: Material) -> Parts:
    """A guitar leaning in a tubular stand."""
    d, w, h = size
    length = (h - 0.06) / np.cos(np.deg2rad(12)) * 0.985
    one = (
        acoustic(length, body, second, w / (0.39 * length)) if guitar == "acoustic" else electric(length, body, second)
    )
    leaning = [p.moved(0.04).turned("y", -12).moved(d / 2 - 0.12, 0, 0.065) for p in one]
    back = [tube(np.array([(-d / 2 + 0.02, 0, 0.008), (0.02, 0, 0.62 * h)]), 0.009, 8)]
    legs = [tube(np.array([(d / 2 - 0.02, s * w * 0.42, 0.008), (0.0, s * 0.02, 0.3 * h)]), 0.009, 8) for s in (1, -1)]
    rests = [
        tube(
            bend(
                [
                    (0.0, s * 0.02, 0.14 * h),
                    (0.02, s * 0.11, 0.08),
                    (d / 2 - 0.06, s * 0.11, 0.06),
                    (d / 2 - 0.03, s * 0.11, 0.085),
                ],
                4,
            ),
            0.008,
            8,
        )
        for s in (1, -1)
    ]
    return leaning + of(m.BLACK_STEEL, *back, *legs, *rests)


def on_wall(size: Size, guitar: str, body: Material, second: Material) -> Parts:
    """A guitar hung by its head."""
    d, w, h = size
    one = (
        acoustic(h * 0.985, body, second, w / (0.39 * h)) if guitar == "acoustic" else electric(h * 0.985, body, second)
    )
    hook = [
        box((0.014, 0.06, 0.1), 0.005).moved(-d / 2 + 0.007, 0, 0.86 * h),
        *(rod((-d / 2, s * 0.03, 0.87 * h), (0.02, s * 0.034, 0.87 * h), 0.006) for s in (1, -1)),
    ]
    return shifted(one, d / 2 - 0.06) + of(m.BLACK, *hook)


def hand_drum(size: Size, shell: Material, skin: Material) -> Parts:
    """A hand drum laced with rope."""
    d, _, h = size
    r = d / 2
    body = lathe(
        [
            (0.5 * r, 0),
            (0.52 * r, 0.01),
            (0.42 * r, 0.34 * h),
            (0.6 * r, 0.56 * h),
            (0.95 * r, 0.82 * h),
            (0.96 * r, 0.97 * h),
        ],
        36,
        np.deg2rad(60),
    )
    head = lathe([(0.97 * r, 0.94 * h), (r, 0.96 * h), (0.97 * r, 0.995 * h), (0.003, h)], 36, np.deg2rad(60))
    laces = [
        rod(
            (0.98 * r * np.cos(a), 0.98 * r * np.sin(a), 0.95 * h),
            (0.62 * r * np.cos(a + s * 0.16), 0.62 * r * np.sin(a + s * 0.16), 0.56 * h),
            0.003,
            segments=5,
        )
        for a in np.arange(14) * 2 * np.pi / 14
        for s in (1, -1)
    ]
    rings = [
        tube(np.column_stack([superellipse(2 * k * r, 2 * k * r, 2, 36), np.full(36, z * h)]), 0.006, 6, closed=True)
        for k, z in ((0.62, 0.56), (0.99, 0.95))
    ]
    return of(shell, body) + of(skin, head) + of(m.LINEN, *laces, *rings)


DESIGNS: tuple[Design, ...] = (
    design("guitar", "acoustic", "acoustic guitar on a stand", (0.42, 0.41, 1.06), "rustic", on_stand, guitar="acoustic", body=m.MAHOGANY, second=SPRUCE),
    design("guitar", "acoustic-dark", "dark acoustic guitar on a stand", (0.42, 0.40, 1.04), "classic", on_stand, guitar="acoustic", body=m.BLACK_WOOD, second=m.CHERRY),
    design("guitar", "electric", "cream electric guitar on a stand", (0.40, 0.34, 1.00), "modern", on_stand, guitar="electric", body=m.CREAM, second=m.WHITE),
    design("guitar", "electric-black", "black electric guitar on a stand", (0.40, 0.34, 1.00), "industrial", on_stand, guitar="electric", body=m.BLACK, second=m.WHITE),
    design("guitar", "wall", "acoustic guitar hung on the wall", (0.16, 0.39, 1.02), "minimal", on_wall, guitar="acoustic", body=m.WALNUT, second=SPRUCE),
    design("guitar", "ukulele", "ukulele hung on the wall", (0.11, 0.22, 0.60), "rustic", on_wall, guitar="acoustic", body=m.CHERRY, second=m.BIRCH),
    design("drum", "djembe", "laced hand drum", (0.34, 0.34, 0.62), "rustic", hand_drum, 36, shell=m.WALNUT, skin=m.CREAM_LEATHER),
    design("drum", "djembe-dark", "dark hand drum", (0.30, 0.30, 0.56), "classic", hand_drum, 36, shell=m.MAHOGANY, skin=m.LINEN),
    design("drum", "conga", "tall pale drum", (0.32, 0.32, 0.75), "modern", hand_drum, 36, shell=m.BIRCH, skin=m.CREAM_LEATHER),
)  # fmt: skip
