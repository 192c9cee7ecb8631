"""Flowers and grasses in vases."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.plants.foliage import arching_leaf


def bunch(size: Size, vase: Material, green: Material, bloom: Material) -> Parts:
    """Cut flowers in a vase."""
    d, _, h = size
    vh, r = 0.5 * h, 0.2 * d
    jar = lathe(
        [
            (r * 0.7, 0),
            (r, 0.03),
            (r * 1.15, vh * 0.4),
            (r * 0.7, vh * 0.85),
            (r * 0.8, vh),
            (r * 0.74, vh),
            (r * 0.6, vh * 0.85),
        ],
        28,
        np.deg2rad(60),
    )
    rng = np.random.default_rng(7)
    stems, heads, blades = [], [], []
    for k in range(14):
        a, reach = 2.4 * k, d / 2 * np.sqrt((k + 0.5) / 14) * 0.82
        top = np.array([reach * np.cos(a), reach * np.sin(a), h * (0.94 - 0.22 * (k / 14) ** 1.5)])
        stems.append(tube(bend([(0, 0, vh * 0.6), (0.3 * top[0], 0.3 * top[1], vh * 1.12), top], 4), 0.0028, 5))
        heads += [ball(0.05, 4).scaled(z=0.8).moved(*(top - np.array([0, 0, 0.02])))] + [
            ball(0.026, 3).scaled(z=0.6).moved(*(top + 0.024 * np.array([np.cos(b), np.sin(b), 0.2])))
            for b in np.arange(5) * 1.257
        ]
        blades.append(
            arching_leaf(
                (top + np.array([0, 0, vh])) * np.array([0.5, 0.5, 0.5]),
                a + 0.8,
                0.2 * d,
                0.035,
                0.03,
                0.05 * rng.uniform(0.5, 1.2),
                0.5,
                5,
            )
        )
    return of(vase, jar) + of(green, *stems, *blades) + of(bloom, *heads)


PETAL = m.paint("cream petals", "#e6d6c2", 0.8)


def grasses(size: Size, vase: Material, dry: Material, plume: Material) -> Parts:
    """Dried grasses with soft plumes in a tall vase."""
    d, _, h = size
    vh, r = 0.4 * h, 0.15 * d
    jar = lathe(
        [
            (a * r, b * vh)
            for a, b in smooth_profile(((0.7, 0), (0.76, 0.02), (1.0, 0.4), (0.8, 0.75), (0.42, 0.95), (0.46, 1.0)), 2)
        ],
        32,
        np.deg2rad(60),
    )
    rng = np.random.default_rng(9)
    stems, heads = [], []
    for k in range(13):
        a, reach = 2.4 * k, d / 2 * np.sqrt((k + 0.5) / 13) * 0.86
        top = np.array([reach * np.cos(a), reach * np.sin(a), h * (0.98 - 0.2 * (k / 13) - 0.05 * rng.random())])
        path = bend(
            [
                (0, 0, vh * 0.6),
                (0.12 * top[0], 0.12 * top[1], vh * 1.15),
                (0.5 * top[0], 0.5 * top[1], 0.72 * h),
                tuple(top),
            ],
            5,
        )
        stems.append(tube(path, 0.0018, 4))
        tail = path[-6:]
        heads.append(tube(tail, 0.022 * np.array([0.25, 0.8, 1.0, 0.9, 0.6, 0.12]), 8))
    return of(vase, jar) + of(dry, *stems) + of(plume, *heads)


def branches(size: Size, vase: Material, bloom: Material) -> Parts:
    """Bare branches with small blossoms in a heavy vase."""
    d, _, h = size
    vh, r = 0.36 * h, 0.2 * d
    jar = lathe(
        [
            (a * r, b * vh)
            for a, b in smooth_profile(((0.5, 0), (0.56, 0.02), (1.0, 0.45), (0.9, 0.7), (0.36, 0.93), (0.42, 1.0)), 2)
        ],
        32,
        np.deg2rad(60),
    )
    rng = np.random.default_rng(21)
    twigs, buds = [], []
    for k in range(7):
        a, reach = 2.4 * k, d / 2 * rng.uniform(0.4, 0.9)
        tip = np.array([reach * np.cos(a), reach * np.sin(a), h * rng.uniform(0.8, 0.97)])
        path = bend(
            [
                (0, 0, 0.5 * vh),
                (0.08 * tip[0], 0.08 * tip[1], vh * 1.1),
                (0.45 * tip[0] + 0.02, 0.45 * tip[1] - 0.02, 0.66 * h),
                tuple(tip),
            ],
            6,
        )
        twigs.append(tube(path, np.linspace(0.005, 0.0015, len(path)), 5))
        for i in range(7, len(path), 3):
            side = path[i] + np.array([rng.uniform(-1, 1), rng.uniform(-1, 1), 0.6]) * 0.06 * h
            twigs.append(rod(tuple(path[i]), tuple(side), 0.0018, 0.001, 4))
            buds += [
                ball(0.022, 3).moved(*(p - np.array([0, 0, 0.011]))) for p in (side, (path[i] + side) / 2, path[i])
            ]
    return of(vase, jar) + of(m.BARK, *twigs) + of(bloom, *buds)


STRAW = m.paint("dry straw", "#c2ab84", 0.9)
PLUME = Material("plume", "shag", "#d9c8ab", 0.98, 0.0, 0.1)
BLOSSOM = m.paint("blossom", "#dcc0bb", 0.85)
WHITE_PETAL = m.paint("white cut petals", "#eee9df", 0.8)
RED_PETAL = m.paint("red petals", "#a83a34", 0.8)
YELLOW_GLAZE = m.paint("yellow glaze", "#d3b24a", 0.25)
MUSTARD_PETAL = m.paint("mustard petals", "#c9ab66", 0.8)


DESIGNS: tuple[Design, ...] = (
    design("plant", "cut-flowers", "cut flowers in a vase", (0.36, 0.34, 0.46), "classic", bunch, 36, vase=m.BLUE_GLAZE, green=m.LEAF, bloom=PETAL),
    design("plant", "grasses", "dried grasses in a clay vase", (0.46, 0.46, 0.90), "rustic", grasses, 36, vase=m.STONEWARE, dry=STRAW, plume=PLUME),
    design("plant", "grasses-black", "plumes in a black vase", (0.40, 0.40, 0.80), "modern", grasses, 36, vase=m.CHARCOAL, dry=STRAW, plume=PLUME),
    design("plant", "blossom", "branches of blossom in a white vase", (0.60, 0.58, 0.95), "minimal", branches, 36, vase=m.PORCELAIN, bloom=BLOSSOM),
    design("plant", "yellow-flowers", "yellow flowers in a stoneware jug", (0.32, 0.31, 0.40), "rustic", bunch, 36, vase=m.DARK_STONEWARE, green=m.LEAF, bloom=MUSTARD_PETAL),
    design("vase", "bouquet", "glass vase with a bouquet of white flowers", (0.32, 0.30, 0.44), "classic", bunch, 36, vase=m.GLASS, green=m.LEAF, bloom=WHITE_PETAL),
    design("vase", "tulips", "yellow vase with red tulips", (0.28, 0.27, 0.50), "modern", bunch, 36, vase=YELLOW_GLAZE, green=m.LEAF, bloom=RED_PETAL),
    design("vase", "twigs", "stoneware vase with twigs in blossom", (0.42, 0.42, 0.80), "minimal", branches, 36, vase=m.STONEWARE, bloom=BLOSSOM),
    design("vase", "plumes", "white vase with plumes", (0.34, 0.34, 0.66), "rustic", grasses, 36, vase=m.PORCELAIN, dry=STRAW, plume=PLUME),
)  # fmt: skip
