"""Ottomans with a lid, with buttons, and plain blocks."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def lidded_ottoman(size: Size, cloth: Material, trim: Material) -> Parts:
    """A box with a padded lid."""
    d, w, h = size
    feet = four(cylinder(0.02, 0.04, 0.003, 14).moved(d / 2 - 0.06, w / 2 - 0.06))
    body = box((d - 0.01, w - 0.01, h - 0.16), 0.018, 2).moved(z=0.035)
    lid = box((d, w, 0.06), 0.018, 2).moved(z=h - 0.12)
    pad = cushion((d, w, 0.09), 12, 3.4, 12).moved(z=h - 0.09)
    seam = tube(ring_path(superellipse(d * 0.995, w * 0.995, 14, 52), h - 0.062), 0.004, 4, closed=True)
    gap = box((d - 0.014, w - 0.014, 0.01), 0.004).moved(z=h - 0.127)
    return of(trim, *feet) + of(m.SHADOW, gap) + of(cloth, body, lid, pad, seam)


def buttoned_ottoman(size: Size, cloth: Material, wood: Material, profile: Leg, round_top: bool = False) -> Parts:
    """A deep pad drawn in by buttons, on turned legs."""
    d, w, h = size
    square = 2.0 if round_top else 9.0
    inset = 0.31 if round_top else 0.42
    n = 33
    grid = np.linspace(-1, 1, n)
    v, u = np.meshgrid(grid, grid, indexing="ij")
    x, y = (
        (v * np.sqrt(1 - u**2 / 2) * d / 2, u * np.sqrt(1 - v**2 / 2) * w / 2) if round_top else (v * d / 2, u * w / 2)
    )
    pitch = min(d, w) / 3.2
    wave = 0.5 + 0.5 * np.cos(2 * np.pi * x / pitch) * np.cos(2 * np.pi * y / pitch)
    edge = np.clip((1 - u**8) * (1 - v**8), 0, 1) ** 0.5
    top = np.stack([x, y, h - 0.16 + (0.16 - 0.03 * wave**2) * edge], axis=-1)
    bottom = top * np.array([1, 1, 0]) + np.array([0, 0, h - 0.19])
    side = prism(superellipse(d * 0.985, w * 0.985, square if round_top else 14.0, 44), h - 0.3, 0.012).moved(z=0.14)
    frame = prism(superellipse(d * 0.96, w * 0.96, square if round_top else 14.0, 44), 0.03, 0.006).moved(z=0.115)
    feet = four(leg(profile, inset * d, inset * w, 0.12, 0.055))
    return of(wood, *feet, frame) + of(cloth, shell(top, bottom, np.pi / 2.5), side)


def block_ottoman(size: Size, cloth: Material, base: Material) -> Parts:
    """A soft cube."""
    d, w, h = size
    return of(base, box((d - 0.1, w - 0.1, 0.03), 0.003)) + of(
        cloth,
        box((d * 0.985, w * 0.985, h - 0.1), 0.045, 3).moved(z=0.025),
        cushion((d, w, 0.16), 14, 3.6, 12).moved(z=h - 0.16),
    )


DESIGNS: tuple[Design, ...] = (
    design("ottoman", "lid-cognac", "cognac leather storage ottoman", (0.46, 0.46, 0.45), "industrial", lidded_ottoman, 4, cloth=s.COGNAC_LEATHER, trim=m.BLACK_STEEL),
    design("ottoman", "lid-charcoal", "long charcoal storage ottoman", (0.45, 1.10, 0.46), "industrial", lidded_ottoman, 2, cloth=m.CHARCOAL_FABRIC, trim=m.BLACK_STEEL),
    design("ottoman", "buttoned-plum", "buttoned plum velvet ottoman", (0.62, 0.82, 0.44), "classic", buttoned_ottoman, 2, cloth=s.PLUM_VELVET, wood=m.MAHOGANY, profile="bun"),
    design("ottoman", "buttoned-round", "round buttoned linen ottoman", (0.86, 0.86, 0.42), "rustic", buttoned_ottoman, 4, cloth=m.LINEN, wood=m.OAK, profile="bun", round_top=True),
    design("ottoman", "block-boucle", "ivory bouclé block", (0.62, 0.62, 0.40), "minimal", block_ottoman, 4, cloth=s.IVORY_BOUCLE, base=m.BLACK),
    design("ottoman", "block-grey", "wide light grey block ottoman", (0.66, 0.95, 0.39), "minimal", block_ottoman, 2, cloth=m.LIGHT_FABRIC, base=m.BLACK),
)  # fmt: skip
