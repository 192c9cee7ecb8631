"""Chandeliers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.lighting.shades import flex, rose, shade
from diorama_core.library.furniture.solids import axis_rotation


def chandelier(size: Size, metal: Material, arms: int) -> Parts:
    """Curved arms with little shades round a turned stem."""
    d, _, h = size
    r, low = d / 2 - 0.05, 0.08
    stem = lathe(
        [
            (0.008, 0),
            (0.035, 0.03),
            (0.05, 0.07),
            (0.02, 0.12),
            (0.03, 0.2),
            (0.012, 0.28),
            (0.01, h - 0.03),
            (0.05, h - 0.02),
            (0.055, h),
        ],
        24,
    )
    parts = of(metal, stem)
    for k in range(arms):
        path = bend([(0.03, 0, low + 0.02), (0.4 * r, 0, low - 0.04), (0.85 * r, 0, low), (r, 0, low + 0.08)], 5)
        bits = of(
            metal,
            tube(path, 0.007, 8),
            lathe([(0.01, 0), (0.03, 0.01), (0.028, 0.016), (0.01, 0.02)], 16).moved(r, 0, low + 0.08),
        )
        bits += of(m.WHITE, cylinder(0.011, 0.06, 0.002, 12).moved(r, 0, low + 0.095)) + of(
            m.LINEN_SHADE, shade(0.05, 0.03, 0.075).moved(r, 0, low + 0.14)
        )
        parts += [p.turned("z", 360 / arms * k) for p in bits]
    return parts


def crystal(size: Size, metal: Material, arms: int = 6) -> Parts:
    """Arms with candles, hung all over with glass drops."""
    d, _, h = size
    r = d / 2 - 0.03
    base = 0.34 * h
    stem = lathe(
        [
            (0.01, 0.06 * h),
            (0.05, 0.1 * h),
            (0.03, 0.18 * h),
            (0.02, base),
            (0.045, base + 0.06),
            (0.018, base + 0.1),
            (0.03, 0.6 * h),
            (0.012, 0.66 * h),
            (0.008, h - 0.03),
            (0.05, h - 0.02),
            (0.055, h),
        ],
        24,
    )
    parts = of(metal, stem)
    drop = lathe([(0.001, -0.05), (0.008, -0.038), (0.0095, -0.03), (0.003, -0.008), (0.001, 0)], 6, 0.1)
    bead = ball(0.016, 3)
    arm = bend([(0.02, 0, base + 0.04), (0.35 * r, 0, base - 0.05), (0.8 * r, 0, base - 0.04), (r, 0, base + 0.05)], 5)
    high = bend([(0.02, 0, 0.62 * h), (0.25 * r, 0, 0.66 * h), (0.42 * r, 0, 0.6 * h)], 4)
    cup = lathe([(0.012, 0), (0.035, 0.008), (0.03, 0.014), (0.011, 0.018)], 16)
    swag = [tuple(p) for p in bend([(0.42 * r, 0, 0.6 * h), (0.66 * r, 0, base + 0.1), (r, 0, base + 0.05)], 5)]
    bits = of(metal, tube(arm, 0.006, 8), tube(high, 0.004, 6), cup.moved(r, 0, base + 0.05)) + of(
        m.CREAM, cylinder(0.01, 0.07, 0.002, 12).moved(r, 0, base + 0.066)
    )
    bits += of(
        m.LAMP_GLOW,
        lathe([(0.006, 0), (0.011, 0.014), (0.007, 0.032), (0.001, 0.045)], 10, np.pi).moved(r, 0, base + 0.136),
    )
    glass = [drop.moved(r + 0.02 * np.cos(a), 0.02 * np.sin(a), base + 0.052) for a in np.arange(4) * np.pi / 2]
    glass += [drop.moved(x, 0, z) for x, _, z in (arm[6], arm[10], high[-1])]
    glass += [bead.moved(x, y, z - 0.008) for x, y, z in swag[1:-1:2]]
    bits += of(CRYSTAL, *glass)
    for k in range(arms):
        parts += [p.turned("z", 360 / arms * k) for p in bits]
    return (
        parts
        + of(
            CRYSTAL,
            ball(0.05, 6).moved(z=0.0),
            *(drop.moved(0.045 * np.cos(a), 0.045 * np.sin(a), 0.1 * h) for a in np.arange(8) * np.pi / 4),
        )
        + of(metal, flex(0.045, 0.07 * h))
    )


def sputnik(size: Size, metal: Material, arms: int = 14) -> Parts:
    """Rods in all directions from one ball, a bulb at the end of each."""
    d, _, h = size
    r, z = d / 2 - 0.035, d / 2
    k = np.arange(arms) + 0.5
    tilt = np.arccos(1 - 2 * k / arms)
    turn = np.pi * (1 + 5**0.5) * k
    directions = np.stack([np.cos(turn) * np.sin(tilt), np.sin(turn) * np.sin(tilt), np.cos(tilt) * 0.94], axis=1)
    rods = [rod((0, 0, z), tuple(v * r + np.array([0, 0, z])), 0.0045, segments=8) for v in directions]
    sockets = [
        rod(tuple(v * (r - 0.05) + np.array([0, 0, z])), tuple(v * r + np.array([0, 0, z])), 0.012, segments=12)
        for v in directions
    ]
    bulbs = [ball(0.07, 6).moved(*(v * (r + 0.005) + np.array([0, 0, z - 0.035]))) for v in directions]
    return (
        of(
            metal,
            *rods,
            *sockets,
            ball(0.11, 8).moved(z=z - 0.055),
            cylinder(0.007, h - z - 0.02, 0.001, 12).moved(z=z),
        )
        + rose(h, metal, 0.06)
        + of(m.LAMP_GLOW, *bulbs)
    )


def wheel(size: Size, wood: Material, iron: Material, lamps: int = 6) -> Parts:
    """A wooden ring with candle lights, hung by chains."""
    d, _, h = size
    r, z = d / 2, 0.02
    band = lathe([(r - 0.045, z), (r, z), (r, z + 0.06), (r - 0.045, z + 0.06), (r - 0.045, z)], 48)
    straps = [
        lathe(
            [
                (r - 0.001, z + s),
                (r + 0.003, z + s),
                (r + 0.003, z + s + 0.008),
                (r - 0.001, z + s + 0.008),
                (r - 0.001, z + s),
            ],
            48,
        )
        for s in (0.006, 0.046)
    ]
    chains = [
        rod(
            (0.95 * r * np.cos(a), 0.95 * r * np.sin(a), z + 0.06),
            (0.02 * np.cos(a), 0.02 * np.sin(a), h - 0.12),
            0.005,
            segments=6,
        )
        for a in np.deg2rad((30, 150, 270))
    ]
    bits = of(iron, cylinder(0.03, 0.012, 0.003, 16).moved(r - 0.022, 0, z + 0.06)) + of(
        m.CREAM, cylinder(0.013, 0.09, 0.002, 12).moved(r - 0.022, 0, z + 0.07)
    )
    bits += of(
        m.LAMP_GLOW,
        lathe([(0.006, 0), (0.014, 0.016), (0.009, 0.04), (0.001, 0.06)], 10, np.pi).moved(r - 0.022, 0, z + 0.16),
    )
    parts = (
        of(wood, band)
        + of(
            iron,
            *straps,
            *chains,
            cylinder(0.006, 0.12, 0.001, 8).moved(z=h - 0.13),
            cylinder(0.03, 0.03, 0.004, 16).moved(z=h - 0.14),
        )
        + rose(h, iron, 0.06)
    )
    for k in range(lamps):
        parts += [p.turned("z", 360 / lamps * k) for p in bits]
    return parts


def branches(size: Size, metal: Material) -> Parts:
    """Two crossing bars with glass globes at their ends."""
    _, w, h = size
    r = 0.075
    parts = of(metal, cylinder(0.008, h - 0.1, 0.001, 12).moved(z=0.09)) + rose(h, metal, 0.06)
    for turn, z, length in ((0, 0.13, w - 2 * r), (62, 0.24, w * 0.78 - 2 * r), (120, 0.34, w * 0.62 - 2 * r)):
        bar = of(metal, rod((0, -length / 2, z), (0, length / 2, z), 0.007))
        for s in (1, -1):
            bar += of(metal, cylinder(0.016, 0.04, 0.003, 14).moved(0, s * length / 2, z - 0.02)) + of(
                m.LAMP_GLOW,
                ball(2 * r, 9).moved(
                    0, s * length / 2, z - 0.02 - (2 * r if s > 0 else 0.0) + (0.0 if s > 0 else 0.04)
                ),
            )
        parts += [p.turned("z", turn) for p in bar]
    return parts


def rings(size: Size, metal: Material, tilts_deg: Sequence[float]) -> Parts:
    """Rings of light below one another, each tilted on three wires from the rose; the lowest is the largest."""
    d, _, h = size
    parts: Parts = []
    for k, tilt_deg in enumerate(tilts_deg):
        r = d / 2 * (1.0 - 0.14 * k)
        low = r * np.sin(np.deg2rad(abs(tilt_deg)))
        z = low if k == 0 else low + (0.78 * h - low) * k / len(tilts_deg)
        band = lathe([(r - 0.012, 0), (r, 0), (r, 0.03), (r - 0.012, 0.03), (r - 0.012, 0)], 56)
        lit = lathe(
            [(r - 0.018, 0.003), (r - 0.01, 0.003), (r - 0.01, 0.027), (r - 0.018, 0.027), (r - 0.018, 0.003)], 56
        )
        turn = 140.0 * k
        parts += of(metal, band.turned("y", tilt_deg).turned("z", turn).moved(z=z))
        parts += of(m.LAMP_GLOW, lit.turned("y", tilt_deg).turned("z", turn).moved(z=z))
        around = np.deg2rad([0.0, 120.0, 240.0])
        edge = (r - 0.006) * np.stack([np.cos(around), np.sin(around), np.zeros(3)], axis=1)
        ends = edge @ (axis_rotation("z", turn) @ axis_rotation("y", tilt_deg)).T + [0.0, 0.0, z + 0.03]
        parts += of(metal, *(rod((*map(float, end),), (0, 0, h - 0.03), 0.0012, segments=5) for end in ends))
    return parts + rose(h, metal, 0.07)


CRYSTAL = m.glass("crystal", "#e3e9ea", 0.38, 0.03)


DESIGNS: tuple[Design, ...] = (
    design("chandelier", "iron", "iron chandelier with five shades", (0.66, 0.66, 0.55), "classic", chandelier, 36, id="ceiling-lamp-chandelier", metal=m.IRON, arms=5),
    design("chandelier", "brass", "brass chandelier with eight shades", (0.80, 0.80, 0.62), "classic", chandelier, 36, id="ceiling-lamp-chandelier-brass", metal=m.BRASS, arms=8),
    design("chandelier", "crystal", "crystal chandelier", (0.62, 0.62, 0.70), "classic", crystal, 1, metal=m.BRASS),
    design("chandelier", "sputnik", "brass starburst chandelier", (0.72, 0.72, 0.90), "modern", sputnik, 1, metal=m.BRASS),
    design("chandelier", "sputnik-black", "black starburst chandelier", (0.60, 0.60, 0.80), "industrial", sputnik, 1, metal=m.BLACK_STEEL, arms=11),
    design("chandelier", "wheel", "wagon-wheel chandelier", (0.80, 0.80, 0.75), "rustic", wheel, 1, wood=m.RECLAIMED, iron=m.IRON),
    design("chandelier", "globes", "branching chandelier with glass globes", (0.85, 0.95, 0.70), "minimal", branches, 1, metal=m.BLACK_STEEL),
    design("chandelier", "rings-gold", "chandelier of three tilted gold rings", (0.62, 0.62, 1.00), "modern", rings, 1, metal=m.BRASS, tilts_deg=[10.0, -16.0, 8.0]),
    design("chandelier", "rings-black", "chandelier of two level black rings", (0.80, 0.80, 0.75), "minimal", rings, 3, metal=m.BLACK_STEEL, tilts_deg=[0.0, 0.0]),
    design("chandelier", "shades-long", "brass chandelier with six shades on a long rod", (0.58, 0.58, 1.05), "classic", chandelier, 2, metal=m.BRASS, arms=6),
)  # fmt: skip
