"""Rocking chairs."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def rocking_chair(size: Size, wood: Material, cloth: Material) -> Parts:
    """A spindle-backed rocking chair."""
    d, w, h = size
    y = w / 2 - 0.05
    t = np.linspace(-1, 1, 15)
    runner = np.stack([0.49 * d * t, np.full(15, y), 0.016 + 0.085 * t**2], axis=1)
    seat_z = 0.43
    sides = [
        tube(runner, 0.018, 8),
        rod((0.26 * d, y, 0.04), (0.2 * d, y - 0.02, 0.64), 0.016),
        rod((-0.22 * d, y, 0.04), (-0.2 * d, y - 0.03, seat_z), 0.018),
        tube(bend([(0.26 * d, y - 0.01, 0.645), (0, y + 0.005, 0.655), (-0.30 * d, y - 0.04, 0.66)], 5), 0.017, 8),
        rod((-0.2 * d, y - 0.03, seat_z), (-0.40 * d, y - 0.04, h - 0.02), 0.018, 0.013),
    ]
    spindles = [
        rod((-0.2 * d, s * 0.85, seat_z), (-0.385 * d, s, h - 0.06), 0.007, segments=7)
        for s in np.linspace(-y + 0.1, y - 0.1, 7)
    ]
    top = beam((-0.39 * d, -y + 0.02, h - 0.05), (-0.39 * d, y - 0.02, h - 0.05), 0.024, 0.09, 0.01)
    seat = box((0.5 * d, 2 * y, 0.035), 0.012, 2).moved(0.02, 0, seat_z - 0.035)
    return of(wood, *both_sides(*sides), *spindles, top, seat) + of(
        cloth, cushion((0.46 * d, 2 * y - 0.04, 0.06), 6, 2.4).moved(0.02, 0, seat_z - 0.01)
    )


DESIGNS: tuple[Design, ...] = (
    design("rocking chair", "rocking", "rocking chair with spindles", (0.88, 0.64, 1.04), "rustic", rocking_chair, id="armchair-rocking", wood=m.OAK, cloth=m.LINEN),
)  # fmt: skip
