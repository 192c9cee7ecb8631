"""Bunk and loft beds."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.beds.bedding import bedding
from diorama_core.library.furniture.beds.bunk_beds import bunk_bed
from diorama_core.library.furniture.kit import *


def ladder(x: float, y: float, height: float, material: Material, metal: bool, width: float = 0.36) -> Parts:
    """An upright ladder at (x, y) facing +Y."""
    if metal:
        rails = [rod((x + f * width / 2, y, 0), (x + f * width / 2, y, height), 0.014) for f in (1, -1)]
    else:
        rails = [box((0.03, 0.045, height), 0.005).moved(x + f * width / 2, y) for f in (1, -1)]
    rungs = [
        rod((x - width / 2, y, z), (x + width / 2, y, z), 0.013)
        if metal
        else box((width, 0.05, 0.022), 0.005).moved(x, y, z)
        for z in np.arange(0.26, height - 0.1, 0.26)
    ]
    return of(material, *rails, *rungs)


def metal_bunk(size: Size, steel: Material, duvet: Material) -> Parts:
    """Two beds in a frame of steel tube."""
    d, w, h = size
    r = 0.02
    x, y = d / 2 - r, w / 2 - r - 0.02
    parts = of(steel, *four(rod((x, y, 0), (x, y, h), r)))
    for z in (0.38, h - 0.42):
        parts += of(
            steel,
            *both_sides(rod((-x, y, z - 0.06), (x, y, z - 0.06), 0.017)),
            *(rod((f * x, -y, zz), (f * x, y, zz), 0.015) for f in (1, -1) for zz in (z - 0.06, z + 0.3)),
        )
        parts += of(
            steel,
            *(
                rod((f * x, k, z - 0.06), (f * x, k, z + 0.3), 0.008, segments=7)
                for f in (1, -1)
                for k in np.linspace(-y + 0.14, y - 0.14, 6)
            ),
            box((2 * x, 2 * y, 0.012), 0.002).moved(0, 0, z - 0.075),
        )
        parts += bedding(d - 0.07, w - 0.1, z + 0.09, 0.14, duvet, 1, None)
    for f, span in ((1, 0.62), (-1, 1.0)):
        parts += of(
            steel,
            *(rod((-x, f * y, z), (-x + 2 * x * span, f * y, z), 0.013) for z in (h - 0.12, h - 0.02)),
            rod((-x + 2 * x * span, f * y, h - 0.42), (-x + 2 * x * span, f * y, h - 0.02), 0.013),
        )
    return parts + ladder(0.36 * d, y + 0.02, h - 0.1, steel, True)


def loft_bed(size: Size, frame: Material, duvet: Material, desk: Material, metal: bool = False) -> Parts:
    """A high sleeper with a desk under it."""
    d, w, h = size
    bar = 0.036 if metal else 0.065
    x, y = d / 2 - bar / 2, w / 2 - bar / 2 - 0.02
    z = h - 0.42
    parts = of(frame, *four(box((bar, bar, h), 0.006).moved(x, y)))
    parts += of(
        frame,
        *both_sides(box((2 * x, 0.03, 0.14), 0.006).moved(0, y, z - 0.12)),
        *(box((0.03, 2 * y, 0.14), 0.006).moved(f * x, 0, z - 0.12) for f in (1, -1)),
        box((2 * x, 2 * y, 0.016), 0.002).moved(0, 0, z - 0.06),
    )
    parts += of(
        frame,
        *(box((2 * x, 0.02, 0.07), 0.005).moved(0, -y, zz) for zz in (h - 0.08, h - 0.2)),
        *(box((1.3 * x, 0.02, 0.07), 0.005).moved(-0.35 * x, y, zz) for zz in (h - 0.08, h - 0.2)),
        *(box((0.02, 2 * y, 0.07), 0.005).moved(f * x, 0, zz) for f in (1, -1) for zz in (h - 0.08, h - 0.2)),
    )
    parts += bedding(d - 0.1, w - 0.12, z + 0.1, 0.14, duvet, 1, None)
    parts += of(
        desk,
        box((2 * x - 0.06, 0.56, 0.026), 0.005, 2).moved(0, -y + 0.3, 0.73),
        box((2 * x - 0.06, 0.22, 0.02), 0.004).moved(0, -y + 0.13, 1.02),
    )
    parts += of(
        frame,
        *(box((0.03, 0.5, 0.05), 0.004).moved(f * (x - 0.02), -y + 0.28, 0.68) for f in (1, -1)),
        *(box((0.03, 0.03, 0.74), 0.004).moved(f * (x - 0.06), -y + 0.53) for f in (1, -1)),
    )
    return parts + ladder(0.36 * d, y + 0.025, h - 0.12, frame, metal)


def house_bunk(size: Size, wood: Material, duvet: Material) -> Parts:
    """A bunk bed under a gable, as a little house."""
    d, w, h = size
    eaves = h - 0.34
    parts = list(bunk_bed((d, w, eaves), wood, duvet))
    x, y = d / 2 - 0.03, w / 2 - 0.035
    gable = [beam((f * x, g * y, eaves - 0.02), (f * x, 0, h - 0.03), 0.045, 0.045) for f in (1, -1) for g in (1, -1)]
    return parts + of(
        wood,
        *gable,
        beam((-x, 0, h - 0.03), (x, 0, h - 0.03), 0.045, 0.05),
        *(beam((-x, g * y, eaves - 0.02), (x, g * y, eaves - 0.02), 0.04, 0.045) for g in (1, -1)),
    )


DESIGNS: tuple[Design, ...] = (
    design("bunk bed", "white", "white bunk bed", (2.06, 1.02, 1.60), "modern", bunk_bed, wood=m.WHITE, duvet=m.BLUE_FABRIC),
    design("bunk bed", "steel", "black steel bunk bed", (2.04, 0.98, 1.66), "industrial", metal_bunk, steel=m.BLACK_STEEL, duvet=m.GREY_FABRIC),
    design("bunk bed", "loft-birch", "birch loft bed with a desk under it", (2.06, 1.04, 1.90), "minimal", loft_bed, frame=m.BIRCH, duvet=m.LIGHT_FABRIC, desk=m.WHITE),
    design("bunk bed", "loft-steel", "steel loft bed with a pine desk", (2.04, 1.02, 1.86), "industrial", loft_bed, frame=m.BLACK_STEEL, duvet=m.NAVY_FABRIC, desk=m.PINE, metal=True),
    design("bunk bed", "house-pine", "pine house bunk bed", (2.08, 1.06, 2.02), "rustic", house_bunk, wood=m.PINE, duvet=m.GREEN_FABRIC),
    design("bunk bed", "walnut", "dark walnut bunk bed", (2.10, 1.06, 1.68), "classic", bunk_bed, wood=m.DARK_WALNUT, duvet=s.SKY_FABRIC),
)  # fmt: skip
