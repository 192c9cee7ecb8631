"""Benches with lids, slats, backs and buttons."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.storage.chests import blanket_box
from diorama_core.library.furniture.tables.occasional_tables import waterfall_table


def slatted_bench(size: Size, wood: Material, legs: Material) -> Parts:
    """Close slats along the length on a black frame."""
    d, w, h = size
    n = 9
    each = d / n
    slats = [box((each * 0.62, w, 0.034), 0.004).moved(-d / 2 + each * (k + 0.5), 0, h - 0.034) for k in range(n)]
    cross = [box((d - 0.01, 0.03, 0.03), 0.003).moved(0, y, h - 0.06) for y in (-0.32 * w, 0.0, 0.32 * w)]
    frames = [
        *both_sides(
            beam((d / 2 - 0.05, 0.32 * w, h - 0.05), (d / 2 - 0.02, 0.32 * w, 0), 0.03, 0.03),
            beam((-d / 2 + 0.05, 0.32 * w, h - 0.05), (-d / 2 + 0.02, 0.32 * w, 0), 0.03, 0.03),
        )
    ]
    return of(wood, *slats, *cross) + of(legs, *frames)


def settle(size: Size, wood: Material, cloth: Material | None) -> Parts:
    """A high-backed wooden bench with solid ends."""
    d, w, h = size
    seat_h = 0.45
    ends = both_sides(
        box((d, 0.032, 0.64), 0.012, 2).moved(0, w / 2 - 0.016),
        box((0.05, 0.032, h), 0.01, 2).moved(-d / 2 + 0.025, w / 2 - 0.016),
        cushion((0.14, 0.05, 0.05), 3, 3, 6).moved(d / 2 - 0.07, w / 2 - 0.02, 0.61),
    )
    planks = [
        box((0.02, w - 0.05, 0.115), 0.005).moved(-d / 2 + 0.03, 0, z) for z in np.arange(seat_h + 0.02, h - 0.16, 0.12)
    ]
    top = beam((-d / 2 + 0.03, -w / 2 + 0.02, h - 0.045), (-d / 2 + 0.03, w / 2 - 0.02, h - 0.045), 0.04, 0.09, 0.012)
    seat = [
        box((d - 0.03, w - 0.05, 0.03), 0.008, 2).moved(0.01, 0, seat_h - 0.03),
        box((0.022, w - 0.05, seat_h - 0.06), 0.004).moved(d / 2 - 0.06, 0, 0.03),
    ]
    parts = of(wood, *ends, *planks, top, *seat)
    return parts + (
        of(cloth, cushion((d - 0.06, w - 0.08, 0.06), 11, 3.4, 12).moved(0.02, 0, seat_h - 0.004))
        if cloth is not None
        else []
    )


def buttoned_bench(size: Size, cloth: Material, wood: Material, profile: Leg) -> Parts:
    """A deep-buttoned bench for the end of a bed."""
    d, w, h = size
    v, u = np.meshgrid(np.linspace(-1, 1, 21), np.linspace(-1, 1, 61), indexing="ij")
    x, y = v * d / 2, u * w / 2
    wave = np.clip(np.cos(2 * np.pi * x / (d / 1.5)) * np.cos(2 * np.pi * y / (w / 6)), 0, 1) ** 2
    edge = np.clip((1 - u**14) * (1 - v**8), 0, 1) ** 0.5
    upper = np.stack([x, y, h - 0.09 + (0.09 - 0.03 * wave) * edge], axis=-1)
    lower = upper * np.array([1, 1, 0]) + np.array([0, 0, h - 0.15])
    rail = box((d - 0.02, w - 0.02, 0.05), 0.008, 2).moved(z=h - 0.19)
    studs = [
        ball(0.014, 4).moved(sx * (d / 2 - 0.004), k, h - 0.14)
        for sx in (1, -1)
        for k in np.linspace(-w / 2 + 0.05, w / 2 - 0.05, int(w / 0.09))
    ]
    welt = tube(ring_path(superellipse(d * 0.995, w * 0.997, 16, 56), h - 0.145), 0.005, 5, closed=True)
    return (
        of(wood, *four(leg(profile, d / 2 - 0.07, w / 2 - 0.09, h - 0.18, 0.05)), rail)
        + of(cloth, shell(upper, lower, 1.0), welt)
        + of(m.BRASS, *studs)
    )


DESIGNS: tuple[Design, ...] = (
    design("bench", "slatted-walnut", "slatted walnut bench", (0.46, 1.20, 0.38), "modern", slatted_bench, 2, wood=m.WALNUT, legs=m.BLACK_STEEL),
    design("bench", "slatted-birch", "slatted birch bench", (0.40, 1.10, 0.42), "minimal", slatted_bench, 2, wood=m.BIRCH, legs=m.BIRCH),
    design("bench", "waterfall-birch", "birch waterfall bench", (0.36, 1.20, 0.45), "minimal", waterfall_table, 2, wood=m.BIRCH),
    design("bench", "settle-pine", "pine settle", (0.48, 1.20, 1.05), "rustic", settle, wood=m.PINE, cloth=None),
    design("bench", "pew-oak", "oak pew with a linen cushion", (0.50, 1.50, 0.95), "rustic", settle, wood=m.OAK, cloth=m.LINEN),
    design("bench", "buttoned-plum", "buttoned plum velvet bench on bowed legs", (0.46, 1.25, 0.48), "classic", buttoned_bench, 2, cloth=s.PLUM_VELVET, wood=m.MAHOGANY, profile="cabriole"),
    design("bench", "lidded-cream", "cream storage bench with a linen seat", (0.42, 1.10, 0.48), "classic", blanket_box, wood=m.CREAM, panels=3, feet=m.CREAM, cushioned=m.LINEN),
    design("bench", "lidded-steel", "charcoal locker-room bench with a leather seat", (0.40, 1.15, 0.46), "industrial", blanket_box, wood=m.CHARCOAL, panels=0, feet=m.BLACK_STEEL, cushioned=s.COGNAC_LEATHER),
)  # fmt: skip
