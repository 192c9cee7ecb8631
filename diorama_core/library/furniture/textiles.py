"""Pillows, curtains and rugs."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, of
from diorama_core.library.furniture.solids import (
    ball,
    box,
    cushion,
    cylinder,
    pillow,
    ring_path,
    rod,
    slab,
    superellipse,
    tube,
)
from diorama_core.library.record import SymmetryFold

RED_RUG = Material("madder carpet", "persian", "#7f4d45", 0.95, 0.0, 1.0)
BLUE_RUG = Material("indigo carpet", "persian", "#566276", 0.95, 0.0, 1.0)
STRIPED_RUG = Material("striped carpet", "stripes", "#7d8288", 0.95, 0.0, 1.0)
BERBER_RUG = Material("berber carpet", "diamonds", "#dcd3c2", 0.95, 0.0, 1.0)
JUTE = Material("jute", "wicker", "#b79e75", 0.95, 0.0, 0.1)
STRIPED_CLOTH = Material("striped linen", "stripes", "#8b98a5", 0.92, 0.0, 0.5)


def scatter_cushion(size: Size, cloth: Material, piping: Material | None = None, lean: float = 68.0) -> Parts:
    """A cushion leaning back as against a sofa; its face toward +X."""
    _, w, h = size
    thick = 0.15
    face = pillow((h, w, thick), 14)
    parts = of(cloth, replace(face, uv=face.vertices[:, 1::-1]))
    if piping is not None:
        a = np.sin(np.linspace(-1, 1, 15) * np.pi / 2)
        edge = np.concatenate(
            [
                [(x, -1) for x in a[:-1]],
                [(1, y) for y in a[:-1]],
                [(x, 1) for x in a[:0:-1]],
                [(-1, y) for y in a[:0:-1]],
            ]
        )
        u, v = edge.T
        outline = np.stack(
            [u * (1 - 0.05 * (1 - v**2) * np.abs(u)) * h / 2, v * (1 - 0.05 * (1 - u**2) * np.abs(v)) * w / 2], axis=1
        )
        parts += of(piping, tube(ring_path(outline, thick / 2), 0.006, 6, closed=True))
    return [p.turned("y", -lean) for p in parts]


def bed_pillow(size: Size, cloth: Material) -> Parts:
    """A bed pillow lying flat."""
    return of(cloth, pillow(size, 14, 0.025))


def round_cushion(size: Size, cloth: Material) -> Parts:
    """A round cushion with a button, lying flat."""
    d, w, h = size
    rim = tube(ring_path(superellipse(d * 0.985, w * 0.985, 2, 48), h / 2), 0.006, 6, closed=True)
    return of(cloth, cushion((d, w, h), 2.0, 2.5, 14), rim, cylinder(0.02, 0.012, 0.004, 16).moved(z=h - 0.008))


def bolster(size: Size, cloth: Material) -> Parts:
    """A cylindrical bolster lying along y."""
    _, w, h = size
    r = h / 2
    body = cylinder(r, w, 0.03, 32).turned("x", 90).moved(0, w / 2, r)
    rims = [
        tube(ring_path(superellipse(2 * r * 0.985, 2 * r * 0.985, 2, 32)), 0.006, 6, closed=True)
        .turned("x", 90)
        .moved(0, s * (w / 2 - 0.028), r)
        for s in (1, -1)
    ]
    return of(cloth, body, *rims)


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


def roller_blind(size: Size, cloth: Material) -> Parts:
    """A blind rolled down from a case."""
    d, w, h = size
    return of(
        cloth,
        box((0.004, w - 0.03, h - 0.05), 0.001).moved(-0.01, 0, 0.02),
        cylinder(d * 0.32, w - 0.03, 0.003, 20).turned("x", 90).moved(0, w / 2 - 0.015, h - d * 0.42),
    ) + of(
        m.WHITE,
        box((0.016, w - 0.03, 0.022), 0.006, 2).moved(-0.01),
        *both_sides(box((d, 0.012, d), 0.004).moved(0, w / 2 - 0.006, h - d)),
    )


def slatted_blind(size: Size, slat: Material) -> Parts:
    """A Venetian blind."""
    d, w, h = size
    zs = np.arange(0.04, h - 0.06, 0.042)
    slats = [box((0.048, w - 0.02, 0.003), 0.001).turned("y", -28).moved(0, 0, z) for z in zs]
    cords = [rod((0.0, s * w * 0.32, 0.02), (0.0, s * w * 0.32, h - 0.03), 0.0015, segments=5) for s in (1, -1)]
    return of(slat, *slats, box((d, w, 0.045), 0.006, 2).moved(z=h - 0.045), box((0.05, w - 0.02, 0.018), 0.006)) + of(
        m.LINEN, *cords
    )


def rug(size: Size, pile: Material, pictured: bool, fringe: Material | None = None) -> Parts:
    """A flat carpet; fringes at both ends (+X and -X)."""
    d, w, h = size
    length = d - (0.1 if fringe else 0.0)
    body = box((length, w, h), h * 0.4)
    if pictured:
        x, y = body.vertices[:, 0], body.vertices[:, 1]
        body = replace(body, uv=np.stack([y / w + 0.5, x / length + 0.5], axis=1))
    parts = of(pile, body)
    if fringe is not None:
        n = int(w / 0.04)
        tufts = [
            rod((s * length / 2, y, h * 0.3), (s * (length / 2 + 0.05), y + 0.004, h * 0.2), 0.003, 0.005, 4)
            for s in (1, -1)
            for y in -w / 2 + w * (np.arange(n) + 0.5) / n
        ]
        parts += of(fringe, *tufts)
    return parts


def braided_rug(size: Size, jute: Material) -> Parts:
    """Concentric braids."""
    d, w, h = size
    rings = max(int(min(d, w) / 2 / 0.055), 4)
    step = min(d, w) / 2 / rings
    braids = [
        tube(
            ring_path(superellipse(d - 2 * step * (k + 0.5), w - 2 * step * (k + 0.5), 2.0, 40), 0.0),
            step * 0.52,
            5,
            closed=True,
        )
        for k in range(rings)
    ]
    return of(jute, *(b.scaled(z=h / (step * 1.04)).moved(z=h / 2) for b in braids))


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 1
) -> Design:
    return Design(f"{category}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d(
        "pillow",
        "linen",
        "linen scatter cushion",
        (0.24, 0.46, 0.44),
        "modern",
        partial(scatter_cushion, cloth=m.LINEN),
    ),
    _d(
        "pillow",
        "rust",
        "rust scatter cushion",
        (0.24, 0.44, 0.43),
        "rustic",
        partial(scatter_cushion, cloth=m.RUST_FABRIC),
    ),
    _d(
        "pillow",
        "navy-piped",
        "navy cushion with light piping",
        (0.25, 0.48, 0.46),
        "classic",
        partial(scatter_cushion, cloth=m.NAVY_FABRIC, piping=m.LINEN),
    ),
    _d(
        "pillow",
        "lumbar-grey",
        "long grey lumbar cushion",
        (0.20, 0.60, 0.32),
        "minimal",
        partial(scatter_cushion, cloth=m.GREY_FABRIC),
    ),
    _d(
        "pillow",
        "striped",
        "striped linen cushion",
        (0.24, 0.48, 0.45),
        "classic",
        partial(scatter_cushion, cloth=STRIPED_CLOTH, piping=m.BLUE_FABRIC),
    ),
    _d(
        "pillow",
        "bed-white",
        "white bed pillow",
        (0.46, 0.68, 0.16),
        "minimal",
        partial(bed_pillow, cloth=m.WHITE_COTTON),
        2,
    ),
    _d(
        "pillow",
        "round-rose",
        "round dusty rose cushion",
        (0.40, 0.40, 0.14),
        "modern",
        partial(round_cushion, cloth=m.ROSE_FABRIC),
        36,
    ),
    _d(
        "pillow",
        "bolster-olive",
        "olive bolster",
        (0.19, 0.55, 0.19),
        "classic",
        partial(bolster, cloth=m.OLIVE_FABRIC),
        2,
    ),
    _d(
        "curtain",
        "linen-pair",
        "pair of linen curtains",
        (0.14, 1.80, 2.30),
        "modern",
        partial(curtain, cloth=m.LINEN, rail=m.BLACK_STEEL),
    ),
    _d(
        "curtain",
        "blue-tied",
        "pair of slate blue curtains tied back",
        (0.15, 1.70, 2.25),
        "classic",
        partial(curtain, cloth=m.BLUE_FABRIC, rail=m.BRASS, gather=0.62),
    ),
    _d(
        "curtain",
        "white-single",
        "single white curtain",
        (0.12, 1.00, 2.20),
        "minimal",
        partial(curtain, cloth=m.WHITE_COTTON, rail=m.STEEL, panels=1),
    ),
    _d(
        "curtain",
        "green-single",
        "forest green curtain",
        (0.13, 0.80, 2.30),
        "classic",
        partial(curtain, cloth=m.GREEN_FABRIC, rail=m.BRASS, panels=1),
    ),
    _d("curtain", "roller", "linen roller blind", (0.09, 1.10, 1.50), "minimal", partial(roller_blind, cloth=m.LINEN)),
    _d("curtain", "venetian", "oak Venetian blind", (0.07, 1.10, 1.40), "modern", partial(slatted_blind, slat=m.OAK)),
    _d(
        "rug",
        "persian-red",
        "madder red Persian rug",
        (2.40, 1.60, 0.014),
        "classic",
        partial(rug, pile=RED_RUG, pictured=True, fringe=m.LINEN),
        2,
    ),
    _d(
        "rug",
        "persian-blue",
        "indigo Persian rug",
        (2.90, 2.00, 0.014),
        "classic",
        partial(rug, pile=BLUE_RUG, pictured=True, fringe=m.LINEN),
        2,
    ),
    _d(
        "rug",
        "striped",
        "striped flat-weave rug",
        (2.00, 1.40, 0.012),
        "modern",
        partial(rug, pile=STRIPED_RUG, pictured=True),
        2,
    ),
    _d(
        "rug",
        "berber",
        "cream berber rug with diamonds",
        (2.30, 1.60, 0.022),
        "modern",
        partial(rug, pile=BERBER_RUG, pictured=True),
        2,
    ),
    _d(
        "rug",
        "plain-grey",
        "plain grey rug",
        (2.00, 1.40, 0.018),
        "minimal",
        partial(rug, pile=m.LIGHT_FABRIC, pictured=False),
        2,
    ),
    _d(
        "rug",
        "round-jute",
        "round braided jute rug",
        (1.60, 1.60, 0.016),
        "rustic",
        partial(braided_rug, jute=JUTE),
        36,
    ),
    _d(
        "rug",
        "mat",
        "small taupe mat",
        (0.90, 0.60, 0.014),
        "minimal",
        partial(rug, pile=m.TAUPE_FABRIC, pictured=False),
        2,
    ),
)
