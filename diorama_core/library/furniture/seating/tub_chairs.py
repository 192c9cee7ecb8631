"""Upholstered chairs for the table: tub backs, slipcovers and high padded backs."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


def tub_chair(
    size: Size, cloth: Material, legs: Material, profile: Leg | Literal["trumpet"] = "taper", channels: int = 0
) -> Parts:
    """A dining chair whose padded back wraps round the sitter; `channels` stitches it upright."""
    d, w, h = size
    seat_z, low = 0.48, 0.40
    n = max(6 * channels, 36) + 1
    a = np.linspace(-2.05, 2.05, n)
    v = np.linspace(0, 1, 7)[:, None]
    rise = low + (h - low) * (0.62 + 0.38 * np.clip(np.cos(a * 0.72), 0, 1) ** 0.8)
    swell = 1 + (0.022 * np.abs(np.cos(channels * a / 4.1 * np.pi)) if channels else 0.0)
    rx, ry = d * 0.47 * swell, w * 0.46 * swell
    flare = 0.88 + 0.12 * v
    x = -rx * np.cos(a) * flare + 0.03
    y = -ry * np.sin(a) * flare
    z = low + (rise - low) * v
    wall = slab(np.stack(np.broadcast_arrays(x, y, z), axis=-1)[:, ::-1], 0.055)
    rim = tube(np.stack([x[-1], y[-1], z[-1]], axis=1), 0.029, 8)
    ends = [ball(0.058, 5).moved(x[-1, k], y[-1, k], z[-1, k] - 0.029) for k in (0, -1)]
    fronts = [tube(np.stack([x[:, k], y[:, k], z[:, 0]], axis=1), 0.028, 8) for k in (0, -1)]
    seat = cushion((d * 0.84, w * 0.86, 0.12), 3.2, 3.4, 12).moved(0.035, 0, seat_z - 0.095)
    deck = cushion((d * 0.80, w * 0.84, 0.07), 3.2, 5, 8).moved(0.02, 0, low - 0.025)
    padded = of(cloth, wall, rim, *ends, *fronts, seat, deck)
    if profile == "trumpet":
        return padded + of(legs, trumpet(low - 0.01, 0.44 * min(d, w), 0.026))
    feet = four(leg(profile, 0.30 * d, 0.33 * w, low - 0.01, 0.036, 0.14)) if profile != "slim" else _sled(d, w, low)
    return padded + of(legs, *feet)


def _sled(d: float, w: float, z: float) -> tuple[Solid, ...]:
    hoop = np.array(
        [
            (0.3 * d, 0, z),
            (0.34 * d, 0, 0.02),
            (0.32 * d, 0, 0.009),
            (-0.32 * d, 0, 0.009),
            (-0.34 * d, 0, 0.02),
            (-0.3 * d, 0, z),
        ]
    )
    return both_sides(tube(hoop, 0.0095, 8).moved(y=0.34 * w))


def slipcover_chair(size: Size, cloth: Material, piping: Material) -> Parts:
    """A high-backed chair under a loose cover whose skirt reaches almost to the floor."""
    d, w, h = size
    seat_z, t = 0.48, 0.08
    skirt = _skirt(d, w, seat_z - 0.05)
    seat = cushion((d - t + 0.02, w, 0.1), 9, 3.6, 12).moved(t / 2, 0, seat_z - 0.075)
    back = (
        cushion((h - 0.28, w * 0.98, t), 8, 3.4, 12)
        .turned("y", -95)
        .moved(-d / 2 + t / 2 + 0.005, 0, 0.28 + (h - 0.28) / 2)
    )
    welt = tube(ring_path(superellipse(d * 0.985, w * 0.99, 9, 48), seat_z - 0.06), 0.005, 5, closed=True)
    return of(cloth, skirt, seat, back) + of(piping, welt)


def _skirt(d: float, w: float, h: float) -> Solid:
    """Cloth falling in slight folds from the seat to just above the floor."""
    k = 96
    ring = superellipse(d * 0.985, w * 0.985, 9, k)
    out = ring / np.linalg.norm(ring, axis=1, keepdims=True)
    a = np.arange(k) * 2 * np.pi / k
    rows = []
    for share in np.linspace(0, 1, 6):
        fold = 0.007 * np.sin(24 * a) * share + 0.006 * share
        rows.append(np.column_stack([ring + out * fold[:, None], np.full(k, h * (1 - share) + 0.012 * share)]))
    outer = np.array(rows)
    closed = np.concatenate([outer, outer[:, :1]], axis=1)[:, ::-1]
    inner = closed * np.array([0.97, 0.97, 1.0])
    return shell(closed[:, ::-1], inner[:, ::-1])


def high_back_chair(size: Size, cloth: Material, legs: Material, profile: Leg, buttons: bool = False) -> Parts:
    """A padded chair with a tall straight back; buttoned like a formal dining chair when asked."""
    d, w, h = size
    seat_z, t = 0.49, 0.075
    feet = four(leg(profile, 0.40 * d, 0.40 * w, seat_z - 0.1, 0.042))
    apron = box((d * 0.9, w * 0.92, 0.045), 0.014, 2).moved(0, 0, seat_z - 0.13)
    seat = cushion((d * 0.98, w, 0.1), 8, 3.6, 12).moved(0, 0, seat_z - 0.1)
    centre_z = (h + seat_z - 0.08) / 2
    back = cushion((h - seat_z + 0.08, w * 0.95, t), 7, 3.4, 12).turned("y", -98).moved(-d / 2 + 0.085, 0, centre_z)
    parts = of(legs, *feet) + of(cloth, apron, seat, back)
    if buttons:
        lean = np.tan(np.deg2rad(8))
        rows = [(seat_z + 0.16, (-0.11, 0.11)), (seat_z + 0.26, (0.0,)), (seat_z + 0.36, (-0.11, 0.11))]
        studs = [
            ball(0.018, 4).moved(-d / 2 + 0.085 + t / 2 - 0.007 - lean * (z - centre_z), y, z - 0.009)
            for z, ys in rows
            if z < h - 0.08
            for y in ys
        ]
        parts += of(cloth, *studs)
    return parts


DESIGNS: tuple[Design, ...] = (
    design("chair", "tub-emerald", "emerald velvet tub dining chair on brass legs", (0.58, 0.57, 0.80), "modern", tub_chair, cloth=s.EMERALD_VELVET, legs=m.BRASS, profile="taper", channels=9),
    design("chair", "tub-boucle", "ivory bouclé dining chair", (0.57, 0.58, 0.76), "minimal", tub_chair, cloth=s.IVORY_BOUCLE, legs=m.LIGHT_OAK, profile="splay"),
    design("chair", "tub-cognac", "cognac leather tub chair on a steel sled", (0.59, 0.58, 0.79), "industrial", tub_chair, cloth=s.COGNAC_LEATHER, legs=m.BLACK_STEEL, profile="slim"),
    design("chair", "tub-pedestal-blush", "blush tub chair on a brass pedestal", (0.58, 0.58, 0.77), "modern", tub_chair, cloth=m.ROSE_FABRIC, legs=m.BRASS, profile="trumpet"),
    design("chair", "tub-pedestal-graphite", "graphite tub chair on a black pedestal", (0.60, 0.60, 0.79), "minimal", tub_chair, cloth=m.CHARCOAL_FABRIC, legs=m.BLACK_STEEL, profile="trumpet"),
    design("chair", "slipcover-linen", "dining chair under a linen slipcover", (0.60, 0.49, 0.98), "rustic", slipcover_chair, cloth=m.LINEN, piping=m.TAUPE_FABRIC),
    design("chair", "slipcover-grey", "dining chair under a grey slipcover", (0.58, 0.47, 0.94), "minimal", slipcover_chair, cloth=m.LIGHT_FABRIC, piping=m.LIGHT_FABRIC),
    design("chair", "high-back-oxblood", "oxblood leather dining chair with a buttoned high back", (0.60, 0.50, 1.08), "classic", high_back_chair, cloth=s.OXBLOOD_LEATHER, legs=m.DARK_WALNUT, profile="turned", buttons=True),
    design("chair", "high-back-oatmeal", "oatmeal high-backed dining chair on oak legs", (0.59, 0.48, 1.04), "rustic", high_back_chair, cloth=m.OATMEAL, legs=m.OAK, profile="square"),
)  # fmt: skip
