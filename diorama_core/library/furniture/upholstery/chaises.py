"""Chaises longues."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.upholstery.cushions import seat_cushion


def flowing_chaise(size: Size, cover: Material, steel: Material, thick: float = 0.05) -> Parts:
    """A wave of leather or cloth on a steel cradle, with a head roll."""
    d, w, h = size
    line = bend(
        [
            (0.49 * d, 0, 0.36),
            (0.36 * d, 0, 0.42),
            (0.16 * d, 0, 0.50),
            (-0.02 * d, 0, 0.40),
            (-0.14 * d, 0, 0.35),
            (-0.26 * d, 0, 0.45),
            (-0.4 * d, 0, h - 0.16),
            (-0.49 * d, 0, h - 0.03),
        ],
        7,
    )
    u = np.linspace(-1, 1, 5)[None, :]
    n = len(line)
    sheet = np.stack(
        [
            np.broadcast_to(line[:, :1], (n, 5)),
            np.broadcast_to((w / 2 - 0.02) * u, (n, 5)),
            np.broadcast_to(line[:, 2:], (n, 5)),
        ],
        axis=-1,
    )
    edge = np.column_stack([line[:, 0], np.full(n, w / 2 - 0.015), line[:, 2] - thick / 2])
    roll = cylinder(0.07, w - 0.1, 0.02, 20).turned("x", 90).moved(-0.43 * d, w / 2 - 0.05, h - 0.04)
    y = w / 2 - 0.06
    cradle = bend([(0.3 * d, y, 0.42), (0.22 * d, y, 0.2), (0.0, y, 0.1), (-0.22 * d, y, 0.2), (-0.3 * d, y, 0.48)], 6)
    feet = both_sides(
        rod((0.24 * d, y, 0.012), (-0.24 * d, y, 0.012), 0.012),
        rod((0.16 * d, y, 0.012), (0.1 * d, y, 0.14), 0.012),
        rod((-0.16 * d, y, 0.012), (-0.1 * d, y, 0.14), 0.012),
    )
    cross = [rod((x, y, 0.012), (x, -y, 0.012), 0.012) for x in (0.2 * d, -0.2 * d)]
    return of(cover, slab(sheet[:, ::-1], thick), roll) + of(
        steel, *both_sides(tube(edge[::2], 0.012, 8), tube(cradle, 0.012, 8)), *feet, *cross
    )


def scroll_chaise(size: Size, cloth: Material, wood: Material, profile: Leg, bolster: bool = True) -> Parts:
    """A daytime couch: one scrolled end, a low back falling away along one side."""
    d, w, h = size
    seat_z = 0.44
    frame = box((d - 0.06, w - 0.06, 0.1), 0.014, 2).moved(0.0, 0, 0.22)
    feet = four(leg(profile, d / 2 - 0.12, w / 2 - 0.08, 0.24, 0.055))
    base = box((d - 0.02, w - 0.02, 0.1), 0.03, 2).moved(0.0, 0, 0.29)
    seat = [q.moved(0.06, 0, seat_z - 0.13) for q in seat_cushion(d - 0.3, w - 0.08, 0.13)]
    r = 0.075
    line = [
        (-0.5 * d + 0.22, 0.36),
        (-0.5 * d + 0.17, seat_z + 0.06),
        (-0.5 * d + 0.14, h - 0.2),
        (-0.5 * d + 0.10, h - 0.09),
        (-0.5 * d + 0.06, h - r),
    ]
    path = bend([(x, 0.0, z) for x, z in line], 5)
    u = np.linspace(-1, 1, 7)[None, :]
    n = len(path)
    head = np.stack(
        [
            np.broadcast_to(path[:, :1], (n, 7)),
            np.broadcast_to(-u * (w / 2 - 0.01), (n, 7)),
            np.broadcast_to(path[:, 2:], (n, 7)),
        ],
        axis=-1,
    )
    roll = cylinder(r, w, 0.02, 22).turned("x", 90).moved(-0.5 * d + r, w / 2, h - r)
    bosses = [
        cylinder(r * 0.5, 0.01, 0.004, 16).turned("x", 90 * f).moved(-0.5 * d + r, -f * (w / 2 - 0.004), h - r)
        for f in (1, -1)
    ]
    t = np.linspace(0, 1, 15)
    fall = seat_z + 0.03 + (h - seat_z - 0.16) * (1 - t) ** 1.3 * (1 - 0.25 * np.sin(np.pi * t))
    v = np.linspace(0, 1, 5)[:, None]
    side = slab(
        np.stack(
            np.broadcast_arrays(-0.5 * d + 0.16 + t * 0.62 * d, np.full(15, -w / 2 + 0.045), 0.3 + (fall - 0.3) * v),
            axis=-1,
        )[:, ::-1],
        0.075,
    )
    cap = tube(np.column_stack([-0.5 * d + 0.16 + t * 0.62 * d, np.full(15, -w / 2 + 0.045), fall]), 0.04, 8)
    parts = of(wood, frame, *feet, *bosses) + of(cloth, base, *seat, slab(head, 0.1), roll, side, cap)
    if bolster:
        parts += of(
            cloth,
            cylinder(0.085, w - 0.14, 0.03, 20).turned("x", 90).moved(-0.5 * d + 0.28, w / 2 - 0.07, seat_z + 0.07),
        )
    return parts


def long_chaise(size: Size, cloth: Material, frame: Material, profile: Leg) -> Parts:
    """A long seat with a sloping back and no arms, on a slim frame."""
    d, w, h = size
    seat_z = 0.40
    feet = four(leg(profile, d / 2 - 0.1, w / 2 - 0.07, seat_z - 0.15, 0.045))
    rails = [
        *both_sides(
            beam((-d / 2 + 0.06, w / 2 - 0.03, seat_z - 0.15), (d / 2 - 0.03, w / 2 - 0.03, seat_z - 0.15), 0.03, 0.05)
        ),
        *(
            beam(
                (f * (d / 2 - 0.06), -w / 2 + 0.03, seat_z - 0.15),
                (f * (d / 2 - 0.06), w / 2 - 0.03, seat_z - 0.15),
                0.03,
                0.05,
            )
            for f in (1, -1)
        ),
    ]
    seat = [q.moved(0.05, 0, seat_z - 0.14) for q in seat_cushion(d - 0.12, w - 0.02, 0.14)]
    tall = h - seat_z + 0.08
    back = (
        cushion((tall + 0.14, w - 0.03, 0.16), 7, 3, 14)
        .turned("y", -121)
        .moved(-d / 2 + 0.3, 0, seat_z + tall / 2 - 0.06)
    )
    roll = cushion((0.16, w - 0.1, 0.15), 3, 2.2, 9).turned("y", -30).moved(-d / 2 + 0.2, 0, h - 0.12)
    return of(frame, *feet, *rails) + of(cloth, *seat, back, roll)


DESIGNS: tuple[Design, ...] = (
    design("chaise longue", "wave-black", "black leather wave chaise on chrome", (1.62, 0.56, 0.92), "modern", flowing_chaise, cover=m.BLACK_LEATHER, steel=m.CHROME),
    design("chaise longue", "wave-cognac", "cognac leather lounger on black steel", (1.60, 0.60, 0.88), "industrial", flowing_chaise, cover=s.COGNAC_LEATHER, steel=m.BLACK_STEEL),
    design("chaise longue", "scroll-emerald", "emerald velvet chaise with a scrolled end", (1.75, 0.72, 0.86), "classic", scroll_chaise, cloth=s.EMERALD_VELVET, wood=m.MAHOGANY, profile="turned"),
    design("chaise longue", "scroll-linen", "linen chaise with a scrolled end", (1.68, 0.70, 0.82), "rustic", scroll_chaise, cloth=m.LINEN, wood=m.OAK, profile="square", bolster=False),
    design("chaise longue", "long-grey", "plain light grey chaise", (1.65, 0.70, 0.78), "minimal", long_chaise, cloth=m.LIGHT_FABRIC, frame=m.BIRCH, profile="slim"),
    design("chaise longue", "long-blue", "slate blue chaise on walnut legs", (1.72, 0.76, 0.82), "modern", long_chaise, cloth=m.BLUE_FABRIC, frame=m.WALNUT, profile="splay"),
)  # fmt: skip
