"""Cribs and changing tables."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def crib(size: Size, style: Style, sheet: Material, solid_ends: bool = True, spindles: bool = False) -> Parts:
    """A cot: barred long sides, solid or barred ends, a low mattress. The longer side is along y."""
    d, w, h = size
    bar, low = 0.04, 0.16
    x, y = d / 2 - bar / 2, w / 2 - bar / 2
    mattress_z = 0.48
    wood = style.wood if style.name != "industrial" else style.frame
    posts = [box((bar, bar, h - low * 0.4), 0.008).moved(sx * x, sy * y, low * 0.4) for sx in (1, -1) for sy in (1, -1)]
    feet = four(leg("bun" if style.leg in ("turned", "square") else "splay", x, y, low * 0.6, 0.05, 0.1))
    parts = of(wood, *posts) + of(style.frame, *feet)
    top = h - 0.02
    for f in (1, -1):
        parts += of(wood, *(beam((f * x, -y, z), (f * x, y, z), 0.026, 0.05, 0.01) for z in (low + 0.03, top - 0.02)))
        ys = np.linspace(-y + 0.075, y - 0.075, int(w / 0.085))
        parts += of(
            wood,
            *(
                rod((f * x, k, low + 0.03), (f * x, k, top - 0.02), 0.008, segments=8)
                if spindles or style.name == "industrial"
                else box((0.012, 0.026, top - low - 0.05), 0.004).moved(f * x, k, low + 0.03)
                for k in ys
            ),
        )
    for f in (1, -1):
        if solid_ends:
            rise = 0.05 if style.name in ("classic", "rustic") else 0.0
            panel = box((2 * x, 0.02, top - low - 0.02 - rise), 0.005).moved(0, f * y, low)
            cap = beam((-x - 0.02, f * y, top - 0.01), (x + 0.02, f * y, top - 0.01), 0.045, 0.026, 0.01)
            parts += of(style.wood, panel, cap)
            if rise:
                parts += of(style.wood, beam((-x, f * y, top - 0.04), (x, f * y, top - 0.04), 0.024, 0.06, 0.01))
        else:
            parts += of(
                wood,
                *(beam((-x, f * y, z), (x, f * y, z), 0.026, 0.05, 0.01) for z in (low + 0.03, top - 0.02)),
                *(
                    rod((k, f * y, low + 0.03), (k, f * y, top - 0.02), 0.008, segments=8)
                    for k in np.linspace(-x + 0.075, x - 0.075, int(d / 0.085))
                ),
            )
    mattress = prism(rounded_rectangle(2 * x - 0.03, 2 * y - 0.03, 0.03, 4), 0.12, 0.02).moved(z=mattress_z - 0.12)
    cover = prism(rounded_rectangle(2 * x - 0.05, 1.0 * y, 0.04, 4), 0.03, 0.012).moved(
        0, -0.44 * y, mattress_z - 0.008
    )
    soft = pillow((0.26, 0.34, 0.08)).moved(0, 0.66 * y, mattress_z - 0.005)
    return (
        parts
        + of(m.WHITE_COTTON, mattress, soft)
        + of(sheet, cover)
        + of(wood, box((2 * x, 2 * y, 0.018), 0.002).moved(0, 0, mattress_z - 0.14))
    )


def changing_table(size: Size, style: Style, pad: Material, drawers: int = 2, open_shelves: int = 1) -> Parts:
    """A padded top inside a low rail, drawers or open shelves under it."""
    d, w, h = size
    deck, t = h - 0.1, 0.022
    x, y = d / 2 - 0.02, w / 2 - 0.02
    wood = style.wood
    ends = both_sides(box((d - 0.01, t, deck - 0.1), 0.004).moved(0, w / 2 - t / 2, 0.1))
    parts = of(
        wood,
        *ends,
        box((d, w, t), 0.005, 2).moved(z=deck - t),
        box((0.01, w - 0.02, deck - 0.12), 0.002).moved(-d / 2 + 0.012, 0, 0.1),
    )
    parts += of(
        style.frame,
        *four(leg("taper" if style.leg in ("splay", "turned") else "slim", x - 0.03, y - 0.03, 0.11, 0.045)),
    )
    parts += of(
        wood,
        *both_sides(box((d, 0.018, 0.1), 0.006, 2).moved(0, w / 2 - 0.009, deck - 0.002)),
        *(
            box((0.018, w, 0.1 if f < 0 else 0.05), 0.006, 2).moved(f * (d / 2 - 0.009), 0, deck - 0.002)
            for f in (1, -1)
        ),
    )
    levels = drawers + open_shelves
    each = (deck - t - 0.12) / max(levels, 1)
    for k in range(levels):
        z = 0.12 + each * k
        parts += of(wood, box((d - 0.03, w - 2 * t + 0.004, 0.018), 0.003).moved(-0.004, 0, z - 0.018))
        if k >= open_shelves:
            parts += of(wood, box((d - 0.05, w - 2 * t, each - 0.02), 0.002).moved(-0.012, 0, z)) + drawer_front(
                d / 2 - 0.036,
                0,
                z + 0.003,
                w - 2 * t - 0.006,
                each - 0.026,
                wood,
                style.fitting,
                "knob" if style.handle == "none" else style.handle,
            )
    cushion_ = cushion((d - 0.08, w - 0.1, 0.075), 12, 3.4, 10).moved(0.0, 0, deck - 0.004)
    return parts + of(pad, cushion_)


DESIGNS: tuple[Design, ...] = (
    design("crib", "oak-modern", "oak cot with white bars", (0.72, 1.30, 0.92), MODERN.but(wood=m.LIGHT_OAK, frame=m.LIGHT_OAK), crib, 2, sheet=s.SKY_FABRIC),
    design("crib", "white-spindle", "white spindle crib", (0.74, 1.34, 0.96), CLASSIC.but(wood=m.WHITE, frame=m.WHITE), crib, 2, sheet=m.ROSE_FABRIC, solid_ends=False, spindles=True),
    design("crib", "pine", "pine cot with panelled ends", (0.70, 1.28, 0.98), RUSTIC, crib, 2, sheet=m.LINEN),
    design("crib", "birch", "plain birch cot", (0.68, 1.26, 0.86), MINIMAL, crib, 2, sheet=m.LIGHT_FABRIC),
    design("crib", "iron", "black iron crib with reclaimed ends", (0.72, 1.32, 1.00), INDUSTRIAL, crib, 2, sheet=m.GREY_FABRIC),
    design("changing table", "oak", "oak changing table with drawers", (0.52, 0.90, 0.96), MODERN.but(wood=m.OAK, frame=m.OAK), changing_table, pad=m.WHITE_COTTON),
    design("changing table", "white", "white changing table with open shelves", (0.50, 0.78, 0.92), MINIMAL.but(wood=m.WHITE, frame=m.BIRCH), changing_table, pad=m.LIGHT_FABRIC, drawers=0, open_shelves=2),
    design("changing table", "cream", "cream changing dresser", (0.54, 0.95, 1.00), CLASSIC.but(wood=m.CREAM, frame=m.CREAM), changing_table, pad=s.SKY_FABRIC, drawers=3, open_shelves=0),
    design("changing table", "pine", "pine changing table", (0.52, 0.85, 0.95), RUSTIC, changing_table, pad=m.LINEN, drawers=1, open_shelves=2),
    design("changing table", "charcoal", "charcoal changing table on steel feet", (0.50, 0.84, 0.94), INDUSTRIAL.but(wood=m.CHARCOAL, fitting=m.STEEL), changing_table, pad=m.GREY_FABRIC),
)  # fmt: skip
