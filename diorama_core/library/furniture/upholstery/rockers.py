"""Rocking chairs on runners: padded, shells, bent wood and slung leather."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.seating.moulded_chairs import shell_chair
from diorama_core.library.furniture.upholstery.cushions import back_cushion


def runner(length: float, y: float, radius: float, x: float = 0.0) -> Solid:
    """A bowed runner on the floor, its ends turned up."""
    t = np.linspace(-1, 1, 15)
    path = np.stack([x + 0.5 * length * t, np.full(15, y), radius + 0.09 * length * t**2], axis=1)
    return tube(path, radius, 8)


def padded_rocker(size: Size, cloth: Material, wood: Material) -> Parts:
    """A winged, padded chair on wooden runners."""
    d, w, h = size
    y = w / 2 - 0.05
    seat_z, xb = 0.43, -0.2 * d
    runners = both_sides(runner(0.96 * d, y - 0.03, 0.017, -0.01))
    legs = both_sides(
        rod((0.24 * d, y - 0.03, 0.045), (0.2 * d, y - 0.06, 0.26), 0.017, 0.02),
        rod((-0.26 * d, y - 0.03, 0.05), (-0.18 * d, y - 0.06, 0.26), 0.017, 0.02),
    )
    base = box((0.56 * d, w - 0.12, 0.1), 0.03, 2).moved(0.02, 0, 0.24)
    seat = cushion((0.58 * d, w - 0.16, 0.14), 6, 3.2, 12).moved(0.05, 0, seat_z - 0.11)
    back = cushion((h - 0.34, w - 0.14, 0.13), 4.5, 3, 14).turned("y", -106).moved(xb - 0.08, 0, 0.34 + (h - 0.34) / 2)
    arm = both_sides(cushion((0.52 * d, 0.09, 0.3), 4.5, 3.4, 9).moved(0.02, y - 0.02, 0.32))
    wing = both_sides(cushion((0.2, 0.075, 0.42), 3.2, 3.2, 8).turned("y", -14).moved(xb - 0.03, y - 0.045, h - 0.52))
    return of(wood, *runners, *legs) + of(cloth, base, seat, back, *arm, *wing)


def shell_rocker(size: Size, shell: Material, wood: Material) -> Parts:
    """A moulded shell on dowels and bent runners."""
    d, w, h = size
    low = 0.12
    seat = shifted(
        [p for p in shell_chair((0.62, w * 0.94, h - low + 0.1), shell, wood, "wood") if p.material == shell],
        0.02,
        0,
        -0.1 + low - 0.02,
    )
    y = 0.36 * w
    runners = both_sides(runner(0.94 * d, y, 0.014))
    legs = both_sides(
        rod((0.28 * d, y, 0.04), (0.14 * d, 0.2 * w, 0.36), 0.009, 0.011),
        rod((-0.26 * d, y, 0.04), (-0.12 * d, 0.2 * w, 0.36), 0.009, 0.011),
        rod((0.28 * d, y, 0.04), (-0.12 * d, 0.2 * w, 0.36), 0.006, 0.006),
    )
    return (
        seat
        + of(wood, *runners, *(rod((x, y, 0.05), (x, -y, 0.05), 0.009) for x in (0.26 * d, -0.25 * d)))
        + of(m.BLACK_STEEL, *legs)
    )


def bentwood_rocker(size: Size, wood: Material, cane: Material) -> Parts:
    """Steam-bent scrolls with a caned seat and back."""
    d, w, h = size
    y, seat_z = w / 2 - 0.03, 0.44
    scroll = bend(
        [
            (-0.42 * d, y, 0.1), (-0.22 * d, y, 0.02), (-0.06 * d, y, 0.02), (0.1 * d, y, 0.02), (0.34 * d, y, 0.06), (0.46 * d, y, 0.2),
            (0.36 * d, y, 0.34), (0.16 * d, y, 0.36), (-0.05 * d, y, 0.3), (-0.18 * d, y, 0.2), (-0.28 * d, y, 0.12), (-0.42 * d, y, 0.1),
        ],
        5,
    )  # fmt: skip
    arm = bend(
        [
            (0.2 * d, y, 0.36),
            (0.34 * d, y, 0.5),
            (0.3 * d, y, 0.66),
            (0.1 * d, y, 0.68),
            (-0.2 * d, y - 0.01, 0.6),
            (-0.26 * d, y - 0.02, seat_z),
        ],
        5,
    )
    stile = bend(
        [
            (0.3 * d, y - 0.02, seat_z),
            (0.0, y - 0.02, seat_z - 0.015),
            (-0.2 * d, y - 0.02, seat_z - 0.01),
            (-0.3 * d, y - 0.025, 0.62),
            (-0.42 * d, y - 0.03, h - 0.06),
            (-0.46 * d, y - 0.07, h - 0.015),
        ],
        5,
    )
    cross = [
        rod((x, y - 0.02, z), (x, -y + 0.02, z), 0.013)
        for x, z in ((0.29 * d, seat_z), (-0.2 * d, seat_z - 0.01), (0.1 * d, 0.02), (-0.2 * d, 0.035))
    ]
    top = tube(
        bend([(-0.46 * d, y - 0.07, h - 0.015), (-0.465 * d, 0, h - 0.008), (-0.46 * d, -y + 0.07, h - 0.015)], 5),
        0.014,
        8,
    )
    seat = box((0.5 * d, 2 * y - 0.06, 0.014), 0.004).moved(0.04 * d, 0, seat_z - 0.008)
    u = np.linspace(-1, 1, 7)[None, :]
    line = bend([(-0.21 * d, 0, seat_z + 0.03), (-0.3 * d, 0, 0.62), (-0.42 * d, 0, h - 0.06)], 4)
    back = np.stack(
        [
            np.broadcast_to(line[:, :1], (9, 7)),
            np.broadcast_to(-u * (y - 0.03), (9, 7)),
            np.broadcast_to(line[:, 2:], (9, 7)),
        ],
        axis=-1,
    )
    return of(wood, *both_sides(tube(scroll, 0.015, 8), tube(arm, 0.014, 8), tube(stile, 0.016, 8)), *cross, top) + of(
        cane, seat, slab(back, 0.01)
    )


def sling_rocker(size: Size, hide: Material, steel: Material) -> Parts:
    """Leather slung in a bent steel frame that runs into its runners."""
    d, w, h = size
    y = w / 2 - 0.015
    side = bend(
        [
            (-0.46 * d, y, 0.1),
            (-0.39 * d, y, 0.042),
            (-0.3 * d, y, 0.018),
            (-0.15 * d, y, 0.018),
            (0.0, y, 0.018),
            (0.25 * d, y, 0.04),
            (0.46 * d, y, 0.13),
            (0.40 * d, y, 0.3),
            (0.30 * d, y, 0.46),
        ],
        6,
    )
    seat_line = bend(
        [
            (0.32 * d, y, 0.47),
            (0.1 * d, y, 0.40),
            (-0.14 * d, y, 0.36),
            (-0.22 * d, y, 0.44),
            (-0.34 * d, y, 0.72),
            (-0.46 * d, y, h - 0.01),
        ],
        6,
    )
    rear = rod((-0.3 * d, y, 0.02), (-0.18 * d, y, 0.4), 0.012)
    arm = bend(
        [(0.36 * d, y, 0.38), (0.32 * d, y, 0.58), (0.2 * d, y, 0.62), (-0.1 * d, y, 0.6), (-0.29 * d, y, 0.6)], 5
    )
    cross = [
        rod((x, y, z), (x, -y, z), 0.012)
        for x, z in ((0.32 * d, 0.47), (-0.46 * d, h - 0.012), (-0.3 * d, 0.02), (0.3 * d, 0.05))
    ]
    u = np.linspace(-1, 1, 7)[None, :]
    n = len(seat_line)
    sheet = np.stack(
        [
            np.broadcast_to(seat_line[:, :1], (n, 7)),
            np.broadcast_to((y - 0.012) * u, (n, 7)),
            seat_line[:, 2:] - 0.02 * (1 - u**2),
        ],
        axis=-1,
    )
    pad = back_cushion(2 * y - 0.1, 0.26, 0.09, 26).moved(-0.36 * d, 0, h - 0.32)
    return of(
        steel, *both_sides(tube(side, 0.0125, 8), tube(seat_line, 0.0125, 8), tube(arm, 0.0125, 8), rear), *cross
    ) + of(hide, slab(sheet[:, ::-1], 0.012), pad)


DESIGNS: tuple[Design, ...] = (
    design("rocking chair", "padded-grey", "grey padded rocking chair on oak runners", (0.92, 0.72, 1.02), "modern", padded_rocker, cloth=m.GREY_FABRIC, wood=m.OAK),
    design("rocking chair", "padded-boucle", "ivory bouclé nursing chair", (0.90, 0.70, 0.98), "minimal", padded_rocker, cloth=s.IVORY_BOUCLE, wood=m.BIRCH),
    design("rocking chair", "shell-white", "white shell rocker", (0.70, 0.64, 0.78), "modern", shell_rocker, shell=m.WHITE, wood=m.BIRCH),
    design("rocking chair", "bentwood", "bentwood rocking chair with cane", (1.02, 0.58, 1.04), "classic", bentwood_rocker, wood=m.DARK_WALNUT, cane=m.RATTAN),
    design("rocking chair", "sling", "leather sling rocker on black steel", (0.90, 0.66, 0.94), "industrial", sling_rocker, hide=s.COGNAC_LEATHER, steel=m.BLACK_STEEL),
)  # fmt: skip
