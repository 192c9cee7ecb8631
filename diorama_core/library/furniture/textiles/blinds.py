"""Blinds."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


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


def roman_blind(size: Size, cloth: Material) -> Parts:
    """A cloth blind gathered in soft folds below."""
    d, w, h = size
    v = np.linspace(0, 1, 33)
    fold = np.where(v < 0.42, np.abs(np.sin(v / 0.42 * 3 * np.pi)) ** 0.6, 0.0)
    x = -d * 0.3 + d * 0.72 * fold
    z = np.where(v < 0.42, v / 0.42 * 0.24 * h, 0.24 * h + (v - 0.42) / 0.58 * 0.76 * h) * 0.985 + 0.01
    u = np.linspace(-0.5, 0.5, 5)
    grid = np.stack(
        [
            np.broadcast_to(x[None, :], (5, 33)),
            np.broadcast_to(u[:, None] * (w - 0.01), (5, 33)),
            np.broadcast_to(z[None, :], (5, 33)),
        ],
        axis=-1,
    )
    return of(cloth, slab(grid[::-1], 0.004), box((0.04, w, 0.03), 0.006).moved(-d * 0.3, 0, h - 0.03))


def pleated_blind(size: Size, cloth: Material, rail: Material) -> Parts:
    """A honeycomb blind between two rails."""
    d, w, h = size
    count = int((h - 0.06) / 0.022)
    v = np.arange(2 * count + 1)
    x = np.where(v % 2 == 0, -d * 0.22, d * 0.34)
    z = 0.03 + v * (h - 0.065) / (2 * count)
    u = np.array([-0.5, 0.0, 0.5])
    shape = (3, len(v))
    grid = np.stack(
        [
            np.broadcast_to(x[None, :], shape),
            np.broadcast_to(u[:, None] * (w - 0.012), shape),
            np.broadcast_to(z[None, :], shape),
        ],
        axis=-1,
    )
    return of(cloth, slab(grid[::-1], 0.003)) + of(
        rail, box((d, w, 0.036), 0.006, 2).moved(z=h - 0.036), box((d * 0.8, w, 0.02), 0.006, 2).moved(z=0.012)
    )


def vertical_blind(size: Size, cloth: Material) -> Parts:
    """Upright slats, half turned."""
    d, w, h = size
    ys = (np.arange(int(w / 0.085)) + 0.5) * 0.085
    ys -= ys.mean()
    vanes = [box((0.002, 0.088, h - 0.07), 0.0006).turned("z", 34).moved(0, float(y), 0.02) for y in ys]
    return of(cloth, *vanes) + of(m.WHITE, box((d * 0.6, w, 0.045), 0.006, 2).moved(z=h - 0.045))


def woven_blind(size: Size, reed: Material, wood: Material) -> Parts:
    """Reeds rolled up from below to a third."""
    d, w, h = size
    low = 0.22 * h
    zs = np.arange(low + 0.03, h - 0.04, 0.02)
    slats = [rod((-d * 0.2, -w / 2, float(z)), (-d * 0.2, w / 2, float(z)), 0.0085, segments=5) for z in zs]
    roll = cylinder(0.034, w, 0.004, 20).turned("x", 90).moved(0.0, w / 2, low)
    cords = [
        rod((-d * 0.2 + 0.011, s * w * 0.32, low), (-d * 0.2 + 0.011, s * w * 0.32, h - 0.03), 0.003, segments=5)
        for s in (1, -1)
    ]
    return (
        of(reed, *slats, roll)
        + of(wood, box((d * 0.7, w, 0.05), 0.006, 2).moved(-d * 0.1, 0, h - 0.05))
        + of(m.LINEN, *cords)
    )


DESIGNS: tuple[Design, ...] = (
    design("blinds", "roller", "linen roller blind", (0.09, 1.10, 1.50), "minimal", roller_blind, id="curtain-roller", cloth=m.LINEN),
    design("blinds", "venetian", "oak Venetian blind", (0.07, 1.10, 1.40), "modern", slatted_blind, id="curtain-venetian", slat=m.OAK),
    design("blinds", "venetian-white", "white Venetian blind", (0.07, 1.20, 1.30), "modern", slatted_blind, 2, slat=m.WHITE),
    design("blinds", "venetian-black", "black Venetian blind", (0.07, 1.00, 1.50), "industrial", slatted_blind, 2, slat=m.CHARCOAL),
    design("blinds", "roman-linen", "linen Roman blind", (0.09, 1.00, 1.40), "classic", roman_blind, cloth=m.LINEN),
    design("blinds", "roman-blue", "slate blue Roman blind", (0.09, 1.20, 1.50), "rustic", roman_blind, cloth=m.BLUE_FABRIC),
    design("blinds", "pleated", "pleated white blind", (0.06, 0.90, 1.40), "minimal", pleated_blind, cloth=m.WHITE_COTTON, rail=m.WHITE),
    design("blinds", "vertical", "vertical blinds", (0.11, 1.60, 2.00), "modern", vertical_blind, cloth=m.LIGHT_FABRIC),
    design("blinds", "reed", "woven reed blind", (0.09, 1.00, 1.40), "rustic", woven_blind, reed=m.RATTAN, wood=m.OAK),
    design("blinds", "roller-grey", "grey roller blind", (0.08, 1.00, 1.60), "minimal", roller_blind, cloth=m.CHARCOAL_FABRIC),
)  # fmt: skip
