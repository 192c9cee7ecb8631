"""Plants for tables, sills and shelves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.plants.foliage import arching_leaf, leaf, pot


def snake_plant(size: Size, pot_of: Material, green: Material, shape: str = "cylinder") -> Parts:
    """Upright blades."""
    d, _, h = size
    ph, pd = 0.3 * h, min(d * 0.9, 0.42 * h)
    rng = np.random.default_rng(11)
    blades = []
    for k in range(16):
        a, r = 2.4 * k, pd * 0.36 * np.sqrt((k + 0.5) / 16)
        base = np.array([r * np.cos(a), r * np.sin(a), ph - 0.03])
        length = (h - ph) * rng.uniform(0.62, 1.0)
        s = np.linspace(0, 1, 7)[:, None]
        lean = np.array([np.cos(a), np.sin(a), 0]) * 0.16 * length
        spine = base + s * np.array([0, 0, length]) + s**2 * lean
        turn = a + rng.uniform(0.6, 2.2)
        blades.append(leaf(spine, 0.055 + 0.02 * rng.random(), np.array([np.cos(turn), np.sin(turn), 0]), 0.35, 0.45))
    return pot(pd, ph, pot_of, shape) + of(green, *blades)


def rosette(
    size: Size, pot_of: Material, green: Material, leaves: int, width: float, shape: str = "taper", droop: float = 0.7
) -> Parts:
    """Strap leaves from the middle: spider plant, aloe, dracaena's head."""
    d, _, h = size
    ph = 0.42 * h
    pd = min(0.55 * d, 1.1 * ph)
    rng = np.random.default_rng(17)
    blades = []
    for k in range(leaves):
        inner = k / leaves
        reach = d / 2 * (0.95 - 0.55 * inner) * rng.uniform(0.85, 1.0)
        rise = (h - ph) * (0.5 + 0.9 * inner)
        blades.append(
            arching_leaf(
                np.array([0, 0, ph - 0.03]), 2.4 * k, reach, width, rise * 1.25, rise * droop * (1.1 - inner), 0.35
            )
        )
    return pot(pd, ph, pot_of, shape) + of(green, *blades)


def bushy(
    size: Size,
    pot_of: Material,
    green: Material,
    leaves: int = 120,
    leaf_size: float = 0.075,
    flowers: Material | None = None,
    shape: str = "taper",
) -> Parts:
    """A dome of small leaves, in flower if asked."""
    d, _, h = size
    ph = 0.42 * h
    pd = min(0.62 * d, ph * 1.15)
    rng = np.random.default_rng(29)
    centre, radii = np.array([0, 0, ph + (h - ph) * 0.42]), np.array([d / 2 * 0.85, d / 2 * 0.85, (h - ph) * 0.5])
    blades, blooms, stems = [], [], []
    for k in range(leaves):
        z = 1 - 1.55 * (k + 0.5) / leaves
        a = 2.39996 * k
        r = np.sqrt(max(1 - z * z, 0.0))
        direction = np.array([r * np.cos(a), r * np.sin(a), z])
        base = centre + direction * radii * (0.3 + 0.6 * np.sqrt(rng.random()))
        size_k = leaf_size * rng.uniform(0.8, 1.2)
        blades.append(arching_leaf(base, a, size_k, size_k * 0.6, size_k * (0.3 + 0.5 * z), size_k * 0.4, 0.5, 5))
        if k % 16 == 0:
            stems.append(tube(bend([(0, 0, ph - 0.03), (base * 0.5 + np.array([0, 0, ph * 0.45])), base], 3), 0.003, 5))
        if flowers is not None and k % 6 == 0:
            blooms.append(ball(0.034, 4).scaled(z=0.7).moved(*(centre + direction * radii * 1.02)))
    return (
        pot(pd, ph, pot_of, shape) + of(m.BARK, *stems) + of(green, *blades) + (of(flowers, *blooms) if flowers else [])
    )


def cactus(size: Size, pot_of: Material, green: Material) -> Parts:
    """A ribbed column with an arm."""
    d, _, h = size
    ph, pd = 0.34 * h, min(0.6 * d, 0.4 * h)

    def column(r: float, height: float) -> Solid:
        solid = lathe(
            [
                (r * 0.8, 0),
                (r, height * 0.12),
                (r, height * 0.8),
                (r * 0.85, height * 0.93),
                (r * 0.4, height * 0.99),
                (0.004, height),
            ],
            48,
            np.pi,
        )
        angle = np.arctan2(solid.vertices[:, 1], solid.vertices[:, 0])
        f = 1 + 0.09 * np.cos(12 * angle)
        return replace(solid, vertices=solid.vertices * np.column_stack([f, f, np.ones(len(f))]))

    r = pd * 0.26
    arm = tube(
        bend([(0, r * 0.5, h * 0.58), (0, r * 1.9, h * 0.6), (0, r * 2.1, h * 0.72), (0, r * 2.1, h * 0.84)], 5),
        [*np.full(14, r * 0.5), r * 0.42, r * 0.2],
        12,
    )
    return pot(pd, ph, pot_of, "taper") + of(green, column(r, h - ph + 0.03).moved(z=ph - 0.03), arm)


def trailing(size: Size, pot_of: Material, green: Material, vines: int = 15, hanging: bool = False) -> Parts:
    """Heart-shaped leaves on stems that fall over the pot's rim; in a hanger if asked."""
    d, _, h = size
    rng = np.random.default_rng(37)
    pd, ph = 0.52 * d, 0.36 * d
    z0 = (0.44 if hanging else 0.56) * h
    parts = [p.moved(z=z0) for p in pot(pd, ph, pot_of, "bowl")]
    stems, blades = [], []
    for k in range(vines):
        a = 2.4 * k
        out = np.array([np.cos(a), np.sin(a), 0])
        fall = z0 * rng.uniform(0.45, 1.0) if k % 3 else -0.05
        reach = d / 2 * rng.uniform(0.7, 0.95)
        path = bend(
            [
                (0.1 * pd * np.cos(a), 0.1 * pd * np.sin(a), z0 + ph - 0.03),
                tuple(out * pd * 0.42 + np.array([0, 0, z0 + ph + 0.1 * d])),
                tuple(out * reach * 0.9 + np.array([0, 0, z0 + 0.6 * ph])),
                tuple(out * reach + np.array([0, 0, z0 - fall + 0.03])),
            ],
            5,
        )
        stems.append(tube(path, 0.0022, 4))
        for i, point in enumerate(path[3:]):
            size_k = 0.15 * d * rng.uniform(0.75, 1.1)
            blades.append(
                arching_leaf(
                    point, a + (0.9 if i % 2 else -0.9), size_k, size_k * 0.8, size_k * 0.12, size_k * 0.62, 0.34, 5
                )
            )
    parts += of(m.PALE_LEAF, *stems) + of(green, *blades)
    if hanging:
        top = np.array([0, 0, h])
        cords = [
            rod(
                tuple(top - np.array([0, 0, 0.01])),
                (0.5 * pd * np.cos(a), 0.5 * pd * np.sin(a), z0 + 0.8 * ph),
                0.004,
                segments=5,
            )
            for a in np.deg2rad((30, 150, 270))
        ]
        cords += [
            tube(
                bend(
                    [
                        (0.5 * pd * np.cos(a), 0.5 * pd * np.sin(a), z0 + 0.8 * ph),
                        (0.5 * pd * np.cos(a), 0.5 * pd * np.sin(a), z0 + 0.3 * ph),
                        (0, 0, z0 - 0.02),
                    ],
                    3,
                ),
                0.004,
                5,
            )
            for a in np.deg2rad((30, 150, 270))
        ]
        parts += of(m.LINEN, *cords, ball(0.03, 5).moved(z=h - 0.03))
    else:
        legs = [rod((0.42 * pd, 0, 0), (0.2 * pd, 0, z0), 0.008, 0.01).turned("z", 60 + 120 * k) for k in range(3)]
        parts += of(m.OAK, *legs, cylinder(0.36 * pd, 0.014, 0.004, 28).moved(z=z0 - 0.012))
    return parts


def succulents(size: Size, bowl_of: Material, greens: tuple[Material, ...]) -> Parts:
    """Rosettes of thick leaves planted together in a low bowl."""
    d, w, h = size
    ph = 0.5 * h
    parts = pot(min(d, w), ph, bowl_of, "bowl")
    for k, (x, y, r) in enumerate(
        (
            (0.0, 0.2, 0.25),
            (0.2, -0.12, 0.21),
            (-0.2, -0.1, 0.22),
            (0.02, -0.28, 0.15),
            (0.22, 0.2, 0.15),
            (-0.2, 0.2, 0.16),
        )
    ):
        blades = []
        centre = np.array([x * d * 0.8, y * w * 0.8, ph - 0.02])
        for i in range(22):
            inner = i / 22
            length = r * d * (1 - 0.55 * inner)
            blades.append(
                arching_leaf(
                    centre + np.array([0, 0, 0.02 * inner]),
                    2.4 * i + k,
                    length,
                    0.34 * r * d,
                    length * (0.3 + 1.3 * inner),
                    length * 0.2,
                    0.66,
                    5,
                )
            )
        parts += of(greens[k % len(greens)], *blades)
    return parts


def orchid(size: Size, pot_of: Material, bloom: Material) -> Parts:
    """Two arching stems of moth-like flowers over broad leaves."""
    _, w, h = size
    ph, pd = 0.24 * h, 0.27 * h
    parts = pot(pd, ph, pot_of, "cylinder")
    blades = [
        arching_leaf(np.array([0, 0, ph - 0.02]), a, 0.34 * w, 0.07 * w + 0.03, 0.09 * h, 0.13 * h, 0.55, 6)
        for a in (0.3, 1.7, 3.3, 4.6, 5.6)
    ]
    stems, petals, hearts = [], [], []
    for s in (1, -1):
        path = bend(
            [
                (0, 0.01 * s, ph),
                (0.02, 0.05 * s * w, 0.62 * h),
                (0.04, 0.18 * s * w, 0.93 * h),
                (0.08, 0.40 * s * w, 0.9 * h),
                (0.1, 0.47 * s * w, 0.8 * h),
            ],
            6,
        )
        stems.append(tube(path, np.linspace(0.004, 0.002, len(path)), 6))
        for i in range(11, len(path), 2):
            at = path[i] + np.array([0.014, 0, -0.01])
            for k in range(5):
                a = 2 * np.pi * k / 5 + 0.3
                tip = np.array([0.006, np.cos(a), np.sin(a)]) * np.array([1, 0.034, 0.034])
                t = np.linspace(0, 1, 5)[:, None]
                petals.append(
                    leaf(
                        at + t * tip + np.array([0.008, 0, 0]) * t**2,
                        0.03,
                        np.array([0, -np.sin(a), np.cos(a)]),
                        0.1,
                        0.6,
                    )
                )
            hearts.append(ball(0.012, 4).moved(*(at + np.array([0.004, 0, -0.006]))))
    return parts + of(m.DARK_LEAF, *blades) + of(m.LEAF, *stems) + of(bloom, *petals) + of(HEART, *hearts)


def bonsai(size: Size, pot_of: Material, green: Material) -> Parts:
    """A bent little trunk with cushions of fine leaves in a shallow dish."""
    d, w, h = size
    ph = 0.14 * h
    o = superellipse(0.52 * d, 0.66 * w, 3.4, 36)
    dish = loft(
        np.array(
            [
                ring_path(o * s, z)
                for s, z in ((0.84, 0.0), (0.9, 0.01), (0.96, 0.7 * ph), (1.0, ph), (0.92, ph), (0.9, ph - 0.015))
            ]
        ),
        crease_rad=np.deg2rad(50),
    )
    trunk = bend(
        [
            (0, 0.06 * w, ph - 0.02),
            (0.02, 0.12 * w, 0.3 * h),
            (0.0, -0.1 * w, 0.5 * h),
            (0.01, -0.04 * w, 0.7 * h),
            (0.0, 0.03 * w, 0.85 * h),
        ],
        6,
    )
    rng = np.random.default_rng(4)
    limbs = [tube(trunk, np.linspace(0.03, 0.008, len(trunk)), 9)]
    blades = []
    for x, y, z, r in (
        (0.0, 0.03, 0.88, 0.2),
        (0.05, 0.3, 0.64, 0.2),
        (-0.05, -0.32, 0.72, 0.18),
        (0.1, -0.22, 0.52, 0.15),
        (0.06, 0.28, 0.44, 0.14),
    ):
        centre = np.array([x * d, y * w, z * h])
        near = trunk[np.abs(trunk[:, 2] - (z - 0.08) * h).argmin()]
        limbs.append(
            tube(bend([near, (near + centre) / 2 + np.array([0, 0, 0.01]), centre], 4), np.linspace(0.01, 0.004, 9), 6)
        )
        for k in range(46):
            a, up = 2.4 * k, 1 - 1.2 * (k + 0.5) / 46
            out = np.sqrt(max(1 - up * up, 0.0))
            base = centre + np.array(
                [out * np.cos(a) * r * d, out * np.sin(a) * r * w, up * 0.5 * r * h]
            ) * rng.uniform(0.75, 1.0)
            blades.append(arching_leaf(base, a, 0.085 * d, 0.055 * d, 0.03 * d * (0.6 + up), 0.02 * d, 0.5, 4))
    return (
        of(pot_of, dish)
        + of(m.SOIL, prism(o * 0.9, 0.012, 0.003).moved(z=ph - 0.02))
        + of(m.BARK, *limbs)
        + of(green, *blades)
    )


def terrarium(size: Size, metal: Material) -> Parts:
    """Small ferns and moss under a glass bell."""
    d, _, h = size
    r = d / 2
    base = cylinder(r, 0.1 * h, 0.006, 40)
    dome = [(0.93 * r, 0.1 * h), (0.93 * r, 0.55 * h), (0.84 * r, 0.76 * h), (0.5 * r, 0.92 * h), (0.12 * r, 0.95 * h)]
    moss = lathe([(0.84 * r, 0.1 * h), (0.8 * r, 0.17 * h), (0.4 * r, 0.21 * h), (0.003, 0.23 * h)], 28, np.pi)
    rng = np.random.default_rng(13)
    blades = [
        arching_leaf(
            np.array([0.3 * r * np.cos(a), 0.3 * r * np.sin(a), 0.19 * h]),
            a,
            0.46 * r * rng.uniform(0.6, 1.0),
            0.05 * d,
            0.45 * h * rng.uniform(0.5, 1.0),
            0.2 * h,
            0.45,
            6,
        )
        for a in np.arange(19) * 2.4
    ]
    stones = [
        ball(0.16 * r, 5).scaled(z=0.7).moved(0.55 * r * np.cos(a), 0.55 * r * np.sin(a), 0.15 * h)
        for a in (0.4, 1.0, 4.2)
    ]
    knob = ball(0.08 * h, 6).moved(z=0.92 * h)
    return (
        of(m.OAK, base)
        + of(m.GLASS, lathe(smooth_profile(tuple(dome), 2), 40, np.pi))
        + of(MOSS, moss)
        + of(m.LEAF, *blades)
        + of(m.STONEWARE, *stones)
        + of(metal, knob)
    )


HEART = m.paint("orchid heart", "#b58a5a", 0.7)
MOSS = Material("moss", "speckle", "#6d7a4d", 0.95, 0.0, 0.1)
BLUE_GREEN = Material("blue-green leaf", "leaf", "#7d938a", 0.6, 0.0, 0.1)
ROSY_LEAF = Material("rosy leaf", "leaf", "#9a7f78", 0.6, 0.0, 0.1)
WHITE_PETAL = m.paint("white petals", "#efe9e2", 0.7)
MAUVE_PETAL = m.paint("mauve petals", "#b795ab", 0.7)


PINK_PETAL = m.paint("pale pink petals", "#cfa7a0", 0.8)


DESIGNS: tuple[Design, ...] = (
    design("plant", "snake", "snake plant in a white pot", (0.34, 0.39, 0.78), "modern", snake_plant, 36, pot_of=m.PORCELAIN, green=m.DARK_LEAF),
    design("plant", "spider", "spider plant", (0.48, 0.45, 0.42), "classic", rosette, 36, pot_of=m.TERRACOTTA, green=m.PALE_LEAF, leaves=34, width=0.022),
    design("plant", "aloe", "aloe in a stoneware pot", (0.32, 0.29, 0.34), "minimal", rosette, 36, pot_of=m.STONEWARE, green=m.PALE_LEAF, leaves=18, width=0.04, shape="cylinder", droop=0.25),
    design("plant", "herb", "pot of herbs", (0.24, 0.23, 0.28), "rustic", bushy, 36, pot_of=m.TERRACOTTA, green=m.LEAF, leaves=200, leaf_size=0.05),
    design("plant", "shrub", "leafy shrub in a grey pot", (0.62, 0.63, 0.85), "classic", bushy, 36, pot_of=m.CONCRETE, green=m.DARK_LEAF, leaves=300, leaf_size=0.13),
    design("plant", "flowering", "flowering pot plant", (0.32, 0.31, 0.36), "classic", bushy, 36, pot_of=m.BLUE_GLAZE, green=m.DARK_LEAF, leaves=200, leaf_size=0.07, flowers=PINK_PETAL, shape="bowl"),
    design("plant", "cactus", "cactus in a terracotta pot", (0.22, 0.26, 0.46), "industrial", cactus, 36, pot_of=m.TERRACOTTA, green=m.PALE_LEAF),
    design("plant", "pothos", "trailing pothos in a stoneware bowl", (0.42, 0.42, 0.50), "modern", trailing, 36, pot_of=m.STONEWARE, green=m.LEAF),
    design("plant", "ivy", "trailing ivy in a brass pot", (0.40, 0.40, 0.56), "classic", trailing, 36, pot_of=m.BRASS, green=m.DARK_LEAF, vines=18),
    design("hanging plant", "macrame", "hanging plant in a corded bowl", (0.44, 0.44, 0.95), "rustic", trailing, 36, pot_of=m.PORCELAIN, green=m.LEAF, hanging=True),
    design("hanging plant", "terracotta", "trailing plant in a hanging terracotta bowl", (0.40, 0.40, 0.85), "classic", trailing, 36, pot_of=m.TERRACOTTA, green=m.PALE_LEAF, vines=17, hanging=True),
    design("hanging plant", "black", "trailing plant in a black hanging bowl", (0.42, 0.42, 1.05), "industrial", trailing, 36, pot_of=m.CHARCOAL, green=m.DARK_LEAF, vines=14, hanging=True),
    design("plant", "succulents", "bowl of succulents", (0.26, 0.26, 0.14), "minimal", succulents, 1, bowl_of=m.CONCRETE, greens=(m.PALE_LEAF, BLUE_GREEN, ROSY_LEAF)),
    design("plant", "orchid", "white orchid", (0.24, 0.46, 0.56), "classic", orchid, 1, pot_of=m.PORCELAIN, bloom=WHITE_PETAL),
    design("plant", "orchid-mauve", "mauve orchid", (0.22, 0.42, 0.50), "modern", orchid, 1, pot_of=m.DARK_STONEWARE, bloom=MAUVE_PETAL),
    design("plant", "bonsai", "bonsai in a shallow dish", (0.32, 0.40, 0.36), "minimal", bonsai, 1, pot_of=m.BLUE_GLAZE, green=m.DARK_LEAF),
    design("plant", "terrarium", "ferns under a glass bell", (0.24, 0.24, 0.34), "industrial", terrarium, 36, metal=m.BRASS),
    design("plant", "snake-tall", "tall snake plant in a concrete pot", (0.38, 0.42, 0.95), "industrial", snake_plant, 36, pot_of=m.CONCRETE, green=m.LEAF),
)  # fmt: skip
