"""Pots with foliage."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, of
from diorama_core.library.furniture.solids import Solid, ball, bend, cylinder, lathe, rod, tube, unit


def pot(diameter: float, height: float, material: Material, shape: str = "taper") -> Parts:
    """A filled pot on z = 0; `shape` is "taper", "bowl", "cylinder" or "stand" (on wooden legs)."""
    r = diameter / 2
    rim = {
        "taper": [(0.72, 0), (0.74, 0.01), (0.96, 0.84), (1.0, 0.85), (1.0, 1.0)],
        "bowl": [(0.5, 0), (0.56, 0.02), (0.96, 0.5), (1.0, 0.8), (0.92, 1.0)],
        "cylinder": [(0.97, 0), (1.0, 0.02), (1.0, 1.0)],
        "stand": [(0.94, 0.35), (1.0, 0.38), (1.0, 1.0)],
    }[shape]
    wall = [(a * r, b * height) for a, b in rim]
    top = wall[-1][0]
    parts = of(material, lathe([*wall, (top - 0.012, height), (top - 0.014, height - 0.025)], 32)) + of(
        m.SOIL, cylinder(top - 0.012, 0.012, 0.002, 24).moved(z=height - 0.036)
    )
    if shape == "stand":
        parts += of(
            m.OAK,
            *(rod((r * 0.86, 0, 0), (r * 0.86, 0, 0.72 * height), 0.012).turned("z", 45 + 90 * k) for k in range(4)),
            *(
                rod((-r * 0.86, 0, 0.33 * height), (r * 0.86, 0, 0.33 * height), 0.01).turned("z", 45 + 90 * k)
                for k in range(2)
            ),
        )
    return parts


def leaf(spine: np.ndarray, width: float, side: np.ndarray, fold: float = 0.25, tip: float = 0.5) -> Solid:
    """A thin closed leaf along a spine, folded along its middle; widest at the share `tip` of its length."""
    s = np.linspace(0, 1, len(spine))
    shape = (s / tip) ** 0.7 * (s < tip) + ((1 - s) / (1 - tip)) ** 0.75 * (s >= tip)
    half = width / 2 * shape[:, None]
    half[0] = half[-1] = 0.0
    along = unit(np.gradient(spine, axis=0))
    across = unit(side - along * (along @ side)[:, None])
    up = np.cross(along, across)
    left, right = spine + half * (across + fold * up), spine - half * (across - fold * up)
    lift = 0.0009 * up * (half > 0)
    vertices = np.concatenate([left, spine + lift, right, left, spine - lift, right])
    normals = np.concatenate([unit(up - fold * across), up, unit(up + fold * across)])
    reach = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(spine, axis=0), axis=1))])
    uv = np.column_stack([np.tile(reach, 6), np.concatenate([half[:, 0], 0 * s, -half[:, 0]] * 2)])
    return Solid(vertices, _leaf_faces(len(spine)), np.concatenate([normals, -normals]), uv)


@cache
def _leaf_faces(n: int) -> np.ndarray:
    """Upper and lower face of a leaf of n points along: left, spine and right rows of each."""
    i = np.arange(n - 1)
    quads = []
    for first, second in ((0, 1), (1, 2)):
        a, b = first * n + i, second * n + i
        upper = np.stack([a, b, b + 1, a + 1], axis=1)
        quads += [upper, upper[:, ::-1] + 3 * n]
    q = np.concatenate(quads)
    return np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])


def arching_leaf(
    base: np.ndarray,
    heading: float,
    length: float,
    width: float,
    rise: float,
    droop: float,
    tip: float = 0.5,
    points: int = 7,
) -> Solid:
    """A leaf that rises from `base` and droops toward `heading` (radians)."""
    s = np.linspace(0, 1, points)
    out = np.array([np.cos(heading), np.sin(heading), 0.0])
    z = rise * s - droop * s**2
    r = length * (s * 0.85 + 0.15 * s**2)
    spine = base + r[:, None] * out + z[:, None] * np.array([0, 0, 1.0])
    return leaf(spine, width, np.array([-out[1], out[0], 0.0]), 0.22, tip)


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


def _d(name: str, caption: str, size: Size, style: str, build: Builder) -> Design:
    return Design(f"plant-{name}", "plant", caption, size, style, build, 36)


PETAL = m.paint("cream petals", "#e6d6c2", 0.8)
PINK_PETAL = m.paint("pale pink petals", "#cfa7a0", 0.8)

DESIGNS: tuple[Design, ...] = (
    _d(
        "snake",
        "snake plant in a white pot",
        (0.34, 0.39, 0.78),
        "modern",
        partial(snake_plant, pot_of=m.PORCELAIN, green=m.DARK_LEAF),
    ),
    _d(
        "fiddle",
        "fiddle-leaf fig in a terracotta pot",
        (0.72, 0.83, 1.50),
        "modern",
        partial(fiddle_tree, pot_of=m.TERRACOTTA, green=m.LEAF),
    ),
    _d("palm", "potted palm in a basket", (1.05, 1.06, 1.45), "rustic", partial(palm, pot_of=m.WICKER, green=m.LEAF)),
    _d(
        "spider",
        "spider plant",
        (0.48, 0.45, 0.42),
        "classic",
        partial(rosette, pot_of=m.TERRACOTTA, green=m.PALE_LEAF, leaves=34, width=0.022),
    ),
    _d(
        "aloe",
        "aloe in a stoneware pot",
        (0.32, 0.29, 0.34),
        "minimal",
        partial(rosette, pot_of=m.STONEWARE, green=m.PALE_LEAF, leaves=18, width=0.04, shape="cylinder", droop=0.25),
    ),
    _d(
        "dracaena",
        "dracaena in a dark pot",
        (0.70, 0.73, 1.40),
        "modern",
        partial(dracaena, pot_of=m.DARK_STONEWARE, green=m.LEAF),
    ),
    _d(
        "herb",
        "pot of herbs",
        (0.24, 0.23, 0.28),
        "rustic",
        partial(bushy, pot_of=m.TERRACOTTA, green=m.LEAF, leaves=200, leaf_size=0.05),
    ),
    _d(
        "shrub",
        "leafy shrub in a grey pot",
        (0.62, 0.63, 0.85),
        "classic",
        partial(bushy, pot_of=m.CONCRETE, green=m.DARK_LEAF, leaves=300, leaf_size=0.13),
    ),
    _d(
        "flowering",
        "flowering pot plant",
        (0.32, 0.31, 0.36),
        "classic",
        partial(
            bushy, pot_of=m.BLUE_GLAZE, green=m.DARK_LEAF, leaves=200, leaf_size=0.07, flowers=PINK_PETAL, shape="bowl"
        ),
    ),
    _d(
        "monstera",
        "monstera on a wooden plant stand",
        (0.80, 0.77, 1.00),
        "modern",
        partial(monstera, pot_of=m.PORCELAIN, green=m.DARK_LEAF),
    ),
    _d(
        "cactus",
        "cactus in a terracotta pot",
        (0.22, 0.26, 0.46),
        "industrial",
        partial(cactus, pot_of=m.TERRACOTTA, green=m.PALE_LEAF),
    ),
    _d(
        "cut-flowers",
        "cut flowers in a vase",
        (0.36, 0.34, 0.46),
        "classic",
        partial(bunch, vase=m.BLUE_GLAZE, green=m.LEAF, bloom=PETAL),
    ),
)
