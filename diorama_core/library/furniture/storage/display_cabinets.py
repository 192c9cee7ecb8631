"""Glazed cabinets, empty."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *


def curio(size: Size, wood: Material, levels: int) -> Parts:
    """A glazed display cabinet: closed below, glass doors' frames above, shelves visible."""
    d, w, h = size
    low = 0.38 * h
    lower = case((d, w, low), wood, ["pair"], base="plinth", base_h=0.08, panel="shaker", handle="knob", pull=m.BRASS)
    pitch = (h - low - 0.04) / levels
    upper = open_case(
        (d - 0.05, w - 0.02, h - 0.03), wood, [low + 0.02 + pitch * k for k in range(1, levels)], 0.02, base=low
    )
    x, half = d / 2 - 0.03, (w - 0.02) / 4
    frames: Parts = []
    for s in (1, -1):
        y, hh = s * half, h - low - 0.05
        frames += of(
            wood,
            *(box((0.02, 0.045, hh), 0.003).moved(x, y + f * (half - 0.024), low + 0.012) for f in (1, -1)),
            *(box((0.02, 2 * half - 0.006, 0.045), 0.003).moved(x, y, z) for z in (low + 0.012, h - 0.083)),
            box((0.012, 0.014, hh), 0.002).moved(x, y, low + 0.012),
        )
    return lower + shifted(upper, -0.02) + frames + of(wood, box((d, w + 0.01, 0.035), 0.01, 2).moved(z=h - 0.035))


DESIGNS: tuple[Design, ...] = (
    design("display cabinet", "display", "glazed walnut display cabinet", (0.42, 0.95, 1.90), "classic", curio, id="cabinet-display", wood=m.WALNUT, levels=4),
)  # fmt: skip
