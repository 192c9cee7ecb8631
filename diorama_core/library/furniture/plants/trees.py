"""Plants as tall as a person: trees, palms, tall leaves."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.plants.foliage import arching_leaf, leaf, pot


def fiddle_tree(size: Size, pot_of: Material, green: Material, leaves: int = 46) -> Parts:
    """A small tree with broad leaves round a forked trunk."""
    d, _, h = size
    ph, pd = 0.2 * h, min(0.24 * h, 0.6 * d)
    rng = np.random.default_rng(5)
    stems = [
        bend(
            [
                (0, 0, ph - 0.05),
                (0.02, 0.01, 0.45 * h),
                (0.03 * k, 0.05 * (k - 1), 0.68 * h),
                (0.1 * d * np.cos(2.1 * k), 0.1 * d * np.sin(2.1 * k), 0.9 * h),
            ],
            4,
        )
        for k in range(3)
    ]
    blades = []
    for k in range(leaves):
        stem = stems[k % 3]
        t = 0.46 + 0.54 * (k + 1) / leaves
        base = stem[min(int(t * (len(stem) - 1)), len(stem) - 1)]
        a = 2.4 * k
        length = 0.34 * d * rng.uniform(0.75, 1.1)
        blades.append(
            arching_leaf(
                base, a, length, length * 0.62, length * rng.uniform(0.2, 0.9), length * rng.uniform(0.2, 0.6), 0.62, 6
            )
        )
    return (
        pot(pd, ph, pot_of, "taper")
        + of(m.BARK, *(tube(s, np.linspace(0.016, 0.006, len(s)), 7) for s in stems))
        + of(green, *blades)
    )


def palm(size: Size, pot_of: Material, green: Material) -> Parts:
    """Arching fronds of narrow leaflets."""
    d, _, h = size
    ph, pd = 0.22 * h, 0.26 * h
    rng = np.random.default_rng(3)
    stalks: list[Solid] = []
    blades: list[Solid] = []
    for k in range(13):
        a = 2.4 * k
        reach, top = d / 2 * rng.uniform(0.55, 0.92), (h - ph) * rng.uniform(0.62, 1.0)
        s = np.linspace(0, 1, 9)
        out = np.array([np.cos(a), np.sin(a), 0])
        curve = (
            np.array([0, 0, ph - 0.03])
            + (reach * s**1.7)[:, None] * out
            + (top * (1.28 * s - 0.42 * s**3.2) / 0.9)[:, None] * np.array([0, 0, 1])
        )
        curve[:, 2] = np.minimum(curve[:, 2], h)
        stalks.append(tube(curve, np.linspace(0.007, 0.002, 9), 5))
        side = np.array([-out[1], out[0], 0])
        for i in range(11):
            j = 3 + i // 2
            base = curve[j] * (1 - 0.5 * (i % 2)) + curve[min(j + 1, 8)] * 0.5 * (i % 2)
            for sgn in (1, -1):
                direction = unit(out * 0.75 + sgn * side * 0.8 + np.array([0, 0, 0.1]))
                length = 0.30 * d * (1 - 0.05 * abs(i - 4))
                t = np.linspace(0, 1, 4)[:, None]
                spine = base + t * length * direction - t**2 * np.array([0, 0, 0.35 * length])
                blades.append(leaf(spine, 0.024, unit(np.cross(direction, [0, 0, 1.0])), 0.2, 0.4))
    return pot(pd, ph, pot_of, "bowl") + of(m.PALE_LEAF, *stalks) + of(green, *blades)


def dracaena(size: Size, pot_of: Material, green: Material) -> Parts:
    """Bare canes with tufts of strap leaves."""
    d, _, h = size
    ph, pd = 0.2 * h, 0.22 * h
    rng = np.random.default_rng(23)
    parts = pot(pd, ph, pot_of, "cylinder")
    blades = []
    for k, share in enumerate((1.0, 0.74, 0.52)):
        a = 2.1 * k
        foot = np.array([0.25 * pd * np.cos(a), 0.25 * pd * np.sin(a), ph - 0.05])
        head = np.array([0.16 * d * np.cos(a), 0.16 * d * np.sin(a), ph + (h - ph) * share * 0.78])
        parts += of(m.BARK, tube(bend([foot, (foot + head) / 2 + 0.012, head], 4), 0.014, 8))
        for i in range(22):
            rise = 0.20 * h * rng.uniform(0.3, 1.1)
            blades.append(
                arching_leaf(
                    head - np.array([0, 0, 0.06 * (i % 4) / 4]),
                    2.4 * i,
                    0.34 * d * rng.uniform(0.8, 1.0),
                    0.034,
                    rise,
                    0.13 * h,
                    0.4,
                    6,
                )
            )
    return parts + of(green, *blades)


def monstera(size: Size, pot_of: Material, green: Material) -> Parts:
    """A few large leaves on long stalks."""
    d, _, h = size
    ph, pd = 0.3 * h, min(0.34 * h, 0.6 * d)
    rng = np.random.default_rng(41)
    blades, stalks = [], []
    for k in range(15):
        a = 2.4 * k
        reach = d / 2 * rng.uniform(0.25, 0.66)
        top = ph + (h - ph) * (0.35 + 0.58 * ((k * 7) % 15) / 14)
        head = np.array([reach * np.cos(a), reach * np.sin(a), top])
        stalks.append(
            tube(
                bend(
                    [
                        (0, 0, ph - 0.03),
                        (reach * 0.4 * np.cos(a), reach * 0.4 * np.sin(a), ph + (top - ph) * 0.7),
                        head,
                    ],
                    4,
                ),
                0.005,
                6,
            )
        )
        length = 0.34 * d * rng.uniform(0.85, 1.1)
        blades.append(arching_leaf(head, a, length, length * 0.85, length * 0.15, length * 0.6, 0.38, 7))
    return pot(pd, ph, pot_of, "stand") + of(m.LEAF, *stalks) + of(green, *blades)


def olive_tree(size: Size, pot_of: Material, green: Material) -> Parts:
    """A slim trunk with a light crown of narrow leaves."""
    d, _, h = size
    ph, pd = 0.2 * h, min(0.24 * h, 0.6 * d)
    rng = np.random.default_rng(19)
    trunk = bend([(0, 0, ph - 0.05), (0.03, 0.01, 0.4 * h), (-0.01, -0.02, 0.62 * h)], 6)
    parts = pot(pd, ph, pot_of, "taper")
    twigs, blades = [tube(trunk, np.linspace(0.018, 0.012, len(trunk)), 8)], []
    for k in range(14):
        a, tilt = 2.4 * k, 0.25 + 0.7 * ((k * 5) % 14) / 14
        reach = d / 2 * rng.uniform(0.6, 0.92)
        tip = np.array(
            [
                reach * np.cos(a) * tilt**0.5,
                reach * np.sin(a) * tilt**0.5,
                0.62 * h + 0.36 * h * (1 - 0.55 * tilt) * rng.uniform(0.8, 1.0),
            ]
        )
        twig = bend([trunk[-1 - k % 3], (trunk[-1] + tip) / 2 + np.array([0, 0, 0.05 * h]), tip], 5)
        twigs.append(tube(twig, np.linspace(0.007, 0.002, len(twig)), 5))
        for i, point in enumerate(twig[3:]):
            for s in (1, -1):
                heading = a + s * (0.7 + 0.3 * rng.random())
                blades.append(
                    arching_leaf(
                        point, heading, 0.10 * h * rng.uniform(0.7, 1.0), 0.036, 0.02 + 0.02 * (i % 3), 0.03, 0.5, 4
                    )
                )
    return parts + of(m.BARK, *twigs) + of(green, *blades)


def banana_plant(size: Size, pot_of: Material, green: Material) -> Parts:
    """Great upright paddles on stout stalks."""
    d, _, h = size
    ph, pd = 0.22 * h, min(0.26 * h, 0.5 * d)
    rng = np.random.default_rng(31)
    stalks, blades = [], []
    for k in range(11):
        a = 2.4 * k
        inner = k / 11
        reach = d / 2 * (0.86 - 0.5 * inner)
        high = ph + (h - ph) * (0.42 + 0.5 * inner)
        foot = (0.02 * np.cos(a), 0.02 * np.sin(a), ph - 0.03)
        neck = np.array([0.3 * reach * np.cos(a), 0.3 * reach * np.sin(a), high * 0.72])
        stalks.append(
            tube(bend([foot, tuple(neck * np.array([0.6, 0.6, 0.8])), tuple(neck)], 4), np.linspace(0.014, 0.006, 9), 6)
        )
        s = np.linspace(0, 1, 8)[:, None]
        out = np.array([np.cos(a), np.sin(a), 0])
        spine = (
            neck
            + s * out * reach * 0.66
            + np.array([0, 0, 1.0]) * ((high - neck[2]) * 1.9 * s - (high - neck[2]) * 1.15 * s**2)
        )
        blades.append(leaf(spine, 0.30 * d * rng.uniform(0.85, 1.05), np.array([-out[1], out[0], 0]), 0.16, 0.45))
    return pot(pd, ph, pot_of, "cylinder") + of(m.PALE_LEAF, *stalks) + of(green, *blades)


def fir(size: Size, stand: Material, green: Material, baubles: tuple[Material, ...] = ()) -> Parts:
    """A little fir tree in tiers, decked with balls if any are given."""
    d, _, h = size
    ph = 0.16 * h
    rng = np.random.default_rng(2)
    parts = pot(0.3 * d, ph, stand, "taper") + of(m.BARK, cylinder(0.02, 0.3 * h, 0.003, 10).moved(z=ph - 0.03))
    blades = []
    for row in range(13):
        f = row / 12
        z = ph + 0.06 * h + (h - ph - 0.14 * h) * f
        reach = d / 2 * (1 - 0.93 * f) + 0.02
        n = max(int(17 * (1 - 0.75 * f)), 5)
        for k in range(n):
            a = 2 * np.pi * (k + 0.5 * (row % 2)) / n + 0.1 * rng.random()
            base = np.array([0.12 * reach * np.cos(a), 0.12 * reach * np.sin(a), z + 0.04 * h])
            blades.append(
                arching_leaf(
                    base,
                    a,
                    reach * rng.uniform(0.86, 1.0),
                    max(0.34 * reach, 0.03),
                    -0.01,
                    0.07 * h + 0.12 * reach,
                    0.6,
                    5,
                )
            )
    blades.append(arching_leaf(np.array([0, 0, h - 0.1 * h]), 0.3, 0.004, 0.05 * d, 0.1 * h, 0.0, 0.3, 5))
    parts += of(green, *blades)
    for k in range(26 if baubles else 0):
        f = ((k * 7) % 26) / 26
        a, reach = 2.4 * k, d / 2 * (1 - 0.93 * f)
        z = ph + 0.05 * h + (h - ph - 0.2 * h) * f
        parts += of(baubles[k % len(baubles)], ball(0.045, 5).moved(reach * np.cos(a), reach * np.sin(a), z - 0.02))
    return parts


SILVER_LEAF = m.Material("silver leaf", "leaf", "#8b9680", 0.6, 0.0, 0.15)
RUBBER_LEAF = m.Material("rubber plant leaf", "leaf", "#44543f", 0.3, 0.0, 0.2)
BAUBLE = m.paint("red bauble", "#8f4a44", 0.2)

DESIGNS: tuple[Design, ...] = (
    design("plant", "fiddle", "fiddle-leaf fig in a terracotta pot", (0.72, 0.83, 1.50), "modern", fiddle_tree, 36, pot_of=m.TERRACOTTA, green=m.LEAF),
    design("plant", "palm", "potted palm in a basket", (1.05, 1.06, 1.45), "rustic", palm, 36, pot_of=m.WICKER, green=m.LEAF),
    design("plant", "dracaena", "dracaena in a dark pot", (0.70, 0.73, 1.40), "modern", dracaena, 36, pot_of=m.DARK_STONEWARE, green=m.LEAF),
    design("plant", "monstera", "monstera on a wooden plant stand", (0.80, 0.77, 1.00), "modern", monstera, 36, pot_of=m.PORCELAIN, green=m.DARK_LEAF),
    design("plant", "olive", "olive tree in a terracotta pot", (0.75, 0.74, 1.55), "rustic", olive_tree, 36, pot_of=m.TERRACOTTA, green=SILVER_LEAF),
    design("plant", "olive-concrete", "small olive tree in a concrete pot", (0.60, 0.58, 1.20), "industrial", olive_tree, 36, pot_of=m.CONCRETE, green=SILVER_LEAF),
    design("plant", "banana", "banana plant in a white pot", (0.95, 0.94, 1.60), "modern", banana_plant, 36, pot_of=m.PORCELAIN, green=m.LEAF),
    design("plant", "bird-of-paradise", "tall broad-leaved plant in a basket", (0.85, 0.84, 1.40), "rustic", banana_plant, 36, pot_of=m.WICKER, green=m.DARK_LEAF),
    design("plant", "rubber", "rubber plant in a dark pot", (0.60, 0.68, 1.25), "industrial", fiddle_tree, 36, pot_of=m.DARK_STONEWARE, green=RUBBER_LEAF, leaves=34),
    design("plant", "fir", "small fir tree in a pot", (0.70, 0.70, 1.10), "rustic", fir, 36, stand=m.WICKER, green=m.DARK_LEAF),
    design("plant", "christmas", "Christmas tree with baubles", (1.10, 1.10, 1.85), "classic", fir, 36, stand=m.IRON, green=m.DARK_LEAF, baubles=(m.BRASS, BAUBLE, m.PORCELAIN)),
)  # fmt: skip
