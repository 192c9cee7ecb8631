"""Bunk beds."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.beds.bedding import bedding
from diorama_core.library.furniture.kit import *


def bunk_bed(size: Size, wood: Material, duvet: Material) -> Parts:
    """Two single beds one above the other, with a ladder."""
    d, w, h = size
    posts = four(box((0.065, 0.065, h), 0.008, 2).moved(d / 2 - 0.033, w / 2 - 0.033))
    parts = of(wood, *posts)
    for z in (0.42, h - 0.42):
        rails = [
            *both_sides(box((d - 0.06, 0.028, 0.13), 0.006).moved(0, w / 2 - 0.033, z - 0.2)),
            *(box((0.028, w - 0.06, 0.13), 0.006).moved(s * (d / 2 - 0.033), 0, z - 0.2) for s in (1, -1)),
            box((d - 0.08, w - 0.08, 0.02), 0.002).moved(0, 0, z - 0.14),
        ]
        boards = [
            box((0.022, w - 0.08, 0.09), 0.005).moved(s * (d / 2 - 0.033), 0, zz)
            for s in (1, -1)
            for zz in (z + 0.05, z + 0.22)
        ]
        parts += of(wood, *rails, *boards)
        parts += bedding(d - 0.09, w - 0.1, z, 0.14, duvet, 1, None)
    guard = [
        *(box((d - 0.06, 0.022, 0.08), 0.005).moved(0, -w / 2 + 0.033, h - zz) for zz in (0.12, 0.26)),
        *(box((d * 0.62, 0.022, 0.08), 0.005).moved(-0.17 * d, w / 2 - 0.033, h - zz) for zz in (0.12, 0.26)),
    ]
    x = d / 2 - 0.5
    ladder = [
        beam((x + s * 0.18, w / 2 - 0.01, 0), (x + s * 0.18, w / 2 - 0.01, h - 0.1), 0.045, 0.022) for s in (1, -1)
    ]
    rungs = [
        rod((x - 0.18, w / 2 - 0.01, z), (x + 0.18, w / 2 - 0.01, z), 0.014) for z in np.arange(0.28, h - 0.35, 0.27)
    ]
    return parts + of(wood, *guard, *ladder, *rungs)


DESIGNS: tuple[Design, ...] = (
    design("bunk bed", "bunk", "pine bunk bed with a ladder", (2.06, 1.00, 1.62), "rustic", bunk_bed, id="bed-bunk", wood=m.PINE, duvet=m.LIGHT_FABRIC),
)  # fmt: skip
