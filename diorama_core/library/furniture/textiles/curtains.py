"""Curtains."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def drape(w: float, h: float, depth: float, folds: float, phase: float, gather: float = 1.0) -> np.ndarray:
    """A hanging cloth as a grid: folds along y, hanging on z = h; `gather` < 1 ties it in at a third of its height."""
    u, v = np.meshgrid(np.linspace(0, 1, int(folds * 8) + 1), np.linspace(0, 1, 14), indexing="ij")
    tie = 1 - (1 - gather) * np.exp(-(((v - 0.38) / 0.22) ** 2))
    wave = np.sin(2 * np.pi * folds * u + phase + 0.4 * np.sin(3 * v + 5 * u))
    x = depth / 2 * wave * (0.55 + 0.45 * (1 - v) ** 0.5) * (0.75 + 0.25 * np.sin(9 * u + phase))
    y = (u - 0.5) * w * tie + 0.01 * np.sin(6 * v + 14 * u) * (1 - v)
    return np.stack([x, y, v * h], axis=-1)


def curtain(size: Size, cloth: Material, rail: Material, panels: int = 2, gather: float = 1.0) -> Parts:
    """Curtains on a pole."""
    d, w, h = size
    z = h - 0.035
    each = w * (0.94 if panels == 1 else 0.3)
    spots = (0.0,) if panels == 1 else (-w / 2 + each / 2 + 0.04, w / 2 - each / 2 - 0.04)
    parts: Parts = []
    for k, y in enumerate(spots):
        grid = drape(each, z - 0.03, d * 0.72, max(each / 0.11, 4), 1.3 * k, gather)
        parts += of(cloth, slab(grid[::-1], 0.006).moved(0.0, y, 0.0))
        parts += of(
            rail,
            *(
                tube(ring_path(superellipse(0.046, 0.046, 2, 14)), 0.003, 5, closed=True)
                .turned("x", 90)
                .moved(0, y + f * each, z)
                for f in np.linspace(-0.45, 0.45, 7)
            ),
        )
        if gather < 1:
            parts += of(
                cloth,
                cylinder(each * gather * 0.5, 0.05, 0.01, 20).scaled(x=d * 0.8 / (each * gather)).moved(0, y, z * 0.36),
            )
    pole = rod((0, -w / 2 + 0.03, z), (0, w / 2 - 0.03, z), 0.013, segments=12)
    stays = [rod((-d / 2, s * (w / 2 - 0.07), z), (0, s * (w / 2 - 0.07), z), 0.007) for s in (1, -1)]
    ends = both_sides(ball(0.05).moved(0, w / 2 - 0.025, z - 0.025))
    return parts + of(rail, pole, *stays, *ends)


def valance(size: Size, cloth: Material, trim: Material) -> Parts:
    """Tied-back curtains under a pelmet."""
    d, w, h = size
    parts = curtain((d * 0.86, w * 0.94, h - 0.02), cloth, trim, 2, 0.55)
    box_ = box((d, w, 0.22), 0.012, 2).moved(0, 0, h - 0.22)
    band = box((d + 0.004, w + 0.004, 0.02), 0.004).moved(0, 0, h - 0.215)
    return parts + of(cloth, box_) + of(trim, band)


def tab_top(size: Size, cloth: Material, rail: Material) -> Parts:
    """Flat panels hung from the pole by loops."""
    d, w, h = size
    z = h - 0.03
    parts: Parts = []
    each = w * 0.46
    for k, y in enumerate((w * 0.25, -w * 0.25)):
        grid = drape(each, z - 0.07, d * 0.5, 4, 1.1 * k + 0.4)
        parts += of(cloth, slab(grid[::-1], 0.005).moved(0, y, 0))
        loops = [
            box((0.034, 0.045, 0.11), 0.012, 2).moved(0, y + f * each, z - 0.082) for f in np.linspace(-0.46, 0.46, 6)
        ]
        parts += of(cloth, *loops)
    pole = rod((0, -w / 2 + 0.01, z), (0, w / 2 - 0.01, z), 0.012, segments=12)
    stays = [rod((-d / 2, s * (w / 2 - 0.06), z), (0, s * (w / 2 - 0.06), z), 0.007) for s in (1, -1)]
    return parts + of(rail, pole, *stays)


SHEER = Material("sheer voile", "weave", "#eeece6", 0.9, 0.0, 0.1, alpha=0.55)
STRIPED_CURTAIN = Material("striped curtain", "stripes", "#7f8d97", 0.92, 0.0, 0.9)
RUST_VELVET = m.fabric("rust velvet", "#8a5a44", 0.05)


DESIGNS: tuple[Design, ...] = (
    design("curtain", "linen-pair", "pair of linen curtains", (0.14, 1.80, 2.30), "modern", curtain, cloth=m.LINEN, rail=m.BLACK_STEEL),
    design("curtain", "blue-tied", "pair of slate blue curtains tied back", (0.15, 1.70, 2.25), "classic", curtain, cloth=m.BLUE_FABRIC, rail=m.BRASS, gather=0.62),
    design("curtain", "white-single", "single white curtain", (0.12, 1.00, 2.20), "minimal", curtain, cloth=m.WHITE_COTTON, rail=m.STEEL, panels=1),
    design("curtain", "green-single", "forest green curtain", (0.13, 0.80, 2.30), "classic", curtain, cloth=m.GREEN_FABRIC, rail=m.BRASS, panels=1),
    design("curtain", "sheer-pair", "pair of sheer white curtains", (0.13, 1.80, 2.35), "minimal", curtain, cloth=SHEER, rail=m.WHITE),
    design("curtain", "charcoal-pair", "pair of charcoal curtains on a black pole", (0.14, 1.90, 2.40), "industrial", curtain, cloth=m.CHARCOAL_FABRIC, rail=m.BLACK_STEEL),
    design("curtain", "velvet-tied", "tied rust velvet curtains with a pelmet", (0.18, 1.70, 2.35), "classic", valance, cloth=RUST_VELVET, trim=m.BRASS),
    design("curtain", "tab-oatmeal", "tab-top oatmeal curtains on a wooden pole", (0.12, 1.50, 2.20), "rustic", tab_top, cloth=m.OATMEAL, rail=m.OAK),
    design("curtain", "striped", "striped linen curtains", (0.14, 1.70, 2.30), "modern", curtain, cloth=STRIPED_CURTAIN, rail=m.STEEL),
)  # fmt: skip
