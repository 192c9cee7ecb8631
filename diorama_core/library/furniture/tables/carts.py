"""Drinks trolleys and kitchen carts."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def castor(r: float = 0.035) -> Parts:
    """A wheel standing on z = 0 under its fork."""
    return of(m.BLACK, cylinder(r, 0.022, 0.006, 18).turned("x", 90).moved(0, 0.011, r)) + of(
        m.STEEL, rod((0, 0, r), (0, 0, 2 * r + 0.02), 0.008, segments=8)
    )


def tube_trolley(size: Size, frame: Material, decks: Material, levels: int = 2, big_wheels: bool = False) -> Parts:
    """Two bent hoops with trays between them and a rail round each tray."""
    d, w, h = size
    y, x, r = w / 2 - 0.03, d / 2 - 0.015, 0.011
    z0 = 0.09
    hoop = bend(
        [
            (x, y, z0),
            (x, y, h - 0.1),
            (x - 0.03, y, h - 0.02),
            (0, y, h - 0.011),
            (-x + 0.03, y, h - 0.02),
            (-x, y, h - 0.1),
            (-x, y, z0),
        ],
        5,
    )
    parts = of(frame, *both_sides(tube(hoop, r, 8)))
    for z in np.linspace(0.2, h - 0.16, levels):
        parts += of(decks, box((2 * x, 2 * y, 0.012), 0.003).moved(z=z))
        parts += of(
            frame,
            *(rod((f * x, -y, z + 0.055), (f * x, y, z + 0.055), 0.006, segments=8) for f in (1, -1)),
            *(rod((f * x, -y, z), (f * x, y, z), 0.008, segments=8) for f in (1, -1)),
        )
    for sx in (1, -1):
        for sy in (1, -1):
            parts += [p.moved(sx * x, sy * y) for p in castor(0.035)]
    if big_wheels:
        wheel = tube(
            [(0.13 * np.cos(a), 0, 0.13 + 0.13 * np.sin(a)) for a in np.linspace(0, 2 * np.pi, 29)[:-1]],
            0.008,
            6,
            closed=True,
        )
        spokes = [
            rod((0, 0, 0.13), (0.13 * np.cos(a), 0, 0.13 + 0.13 * np.sin(a)), 0.004, segments=6)
            for a in np.linspace(0, 2 * np.pi, 9)[:-1]
        ]
        parts += of(frame, *both_sides(*(q.moved(-x + 0.11, y + 0.02, 0.008) for q in (wheel, *spokes))))
    return parts


def wooden_trolley(size: Size, frame: Material, top: Material, levels: int = 2, towel: Material = m.STEEL) -> Parts:
    """A butcher's trolley: thick top, slatted shelves, a towel rail."""
    d, w, h = size
    bar = 0.04 if frame.metallic < 0.2 else 0.026
    x, y = d / 2 - bar / 2 - 0.01, w / 2 - bar / 2 - 0.05
    posts = four(box((bar, bar, h - 0.12), 0.005).moved(x, y, 0.08))
    rails = [
        *both_sides(beam((-x, y, h - 0.08), (x, y, h - 0.08), 0.02, 0.08)),
        *(beam((f * x, -y, h - 0.08), (f * x, y, h - 0.08), 0.02, 0.08) for f in (1, -1)),
    ]
    parts = of(frame, *posts, *rails) + of(top, box((d, w - 0.06, 0.042), 0.008, 2).moved(0, 0, h - 0.042))
    for z in np.linspace(0.2, 0.58 * h, levels):
        parts += of(frame, *both_sides(beam((-x, y, z - 0.012), (x, y, z - 0.012), 0.018, 0.03)))
        parts += of(
            top if frame.metallic > 0.2 else frame,
            *(box((0.06, 2 * y + bar, 0.016), 0.004).moved(px, 0, z) for px in np.linspace(-x + 0.035, x - 0.035, 5)),
        )
    parts += of(
        towel,
        rod((-x, w / 2 - 0.01, h - 0.1), (x, w / 2 - 0.01, h - 0.1), 0.008),
        *(rod((f * x, y, h - 0.1), (f * x, w / 2 - 0.01, h - 0.1), 0.006) for f in (1, -1)),
    )
    for sx in (1, -1):
        for sy in (1, -1):
            parts += [p.moved(sx * x, sy * y) for p in castor(0.035)]
    return parts


DESIGNS: tuple[Design, ...] = (
    design("bar cart", "brass-glass", "brass and glass drinks trolley", (0.42, 0.75, 0.84), "modern", tube_trolley, 2, frame=m.BRASS, decks=m.GLASS),
    design("bar cart", "walnut-tray", "walnut tea trolley with large wheels", (0.46, 0.80, 0.82), "classic", tube_trolley, frame=m.DARK_WALNUT, decks=m.WALNUT, big_wheels=True),
    design("bar cart", "steel", "black steel cart with three reclaimed shelves", (0.40, 0.72, 0.90), "industrial", tube_trolley, 2, frame=m.BLACK_STEEL, decks=m.RECLAIMED, levels=3),
    design("bar cart", "white-slim", "slim white utility cart", (0.36, 0.56, 0.86), "minimal", tube_trolley, 2, frame=m.metal("white steel", "#dedcd6", 0.5, 0.1), decks=m.WHITE, levels=3),
    design("bar cart", "butcher-oak", "oak butcher's trolley", (0.50, 0.85, 0.90), "rustic", wooden_trolley, frame=m.OAK, top=m.OAK),
    design("bar cart", "kitchen-sage", "sage kitchen cart with a pine top", (0.48, 0.82, 0.88), "rustic", wooden_trolley, frame=m.SAGE, top=m.PINE),
    design("bar cart", "prep-steel", "kitchen cart of steel with a birch top", (0.48, 0.80, 0.89), "industrial", wooden_trolley, frame=m.BLACK_STEEL, top=m.BIRCH, towel=m.BLACK_STEEL),
)  # fmt: skip
