"""Stools for pianos, dressing tables, workshops and children's rooms, and chairs for the very young."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def padded_stool(
    size: Size, cloth: Material, wood: Material, profile: Leg, round_top: bool = False, buttons: bool = False
) -> Parts:
    """An upholstered stool on four legs, as stands before pianos and dressing tables."""
    d, w, h = size
    square = 2.0 if round_top else 9.0
    inset = 0.30 if round_top else 0.42
    legs = four(leg(profile, inset * d, inset * w, h - 0.1, 0.042, 0.08))
    frame = prism(superellipse(d * 0.94, w * 0.96, square, 40), 0.05, 0.008).moved(z=h - 0.14)
    pad = cushion((d, w, 0.1), square, 3.0, 12).moved(z=h - 0.1)
    welt = tube(ring_path(superellipse(d * 0.99, w * 0.99, square, 44), h - 0.05), 0.0045, 5, closed=True)
    parts = of(wood, *legs, frame) + of(cloth, pad, welt)
    if buttons:
        studs = [ball(0.016, 4).moved(0, y, h - 0.013) for y in np.linspace(-0.3, 0.3, 3) * w]
        parts += of(cloth, *studs)
    return parts


def drum_stool(size: Size, cloth: Material, band: Material) -> Parts:
    """A plush drum on a metal band, pleated round its side."""
    d, _, h = size
    n = 96
    a = np.arange(n) * 2 * np.pi / n
    pleat = 1 - 0.018 * np.abs(np.sin(16 * a)) ** 0.7
    profile = [(0.90, 0.035), (0.95, 0.06), (0.97, 0.5 * h), (0.98, h - 0.1)]
    rings = np.array(
        [
            [(0.5 * d * r * p * np.cos(t), 0.5 * d * r * p * np.sin(t), z) for t, p in zip(a, pleat, strict=True)]
            for r, z in profile
        ]
    )
    side = loft(rings)
    pad = cushion((d, d, 0.11), 2.0, 3.2, 12).moved(z=h - 0.11)
    return of(cloth, side, pad) + of(band, cylinder(0.44 * d, 0.04, 0.004, 36))


def tractor_stool(size: Size, seat: Material, steel: Material) -> Parts:
    """A workshop stool: pressed tractor seat on three steel legs."""
    d, w, h = size
    share, a = np.meshgrid(np.linspace(0.03, 1, 8), np.linspace(0, 2 * np.pi, 37), indexing="ij")
    waist = (
        1 - 0.10 * np.exp(-(((a - np.pi) / 0.32) ** 2)) - 0.12 * np.exp(-((np.minimum(a, 2 * np.pi - a) / 0.3) ** 2))
    )
    x, y = share * waist * 0.46 * d * np.cos(a), share * 0.49 * w * np.sin(a)
    u, v = y / (0.49 * w), x / (0.46 * d)
    z = h - 0.055 + 0.03 * u**2 * (1 + 0.5 * np.clip(v, 0, 1)) + 0.05 * np.clip(-v - 0.35, 0, 1) ** 1.5
    z += 0.014 * np.exp(-((u / 0.16) ** 2)) * np.clip(v, 0, 1) - 0.03 * np.clip(v - 0.7, 0, 1)
    shell = slab(np.stack([x, y, z], axis=-1), 0.01)
    legs = [rod((0.46 * d, 0, 0), (0.05, 0, h - 0.07), 0.012, 0.014).turned("z", 60 + 120 * k) for k in range(3)]
    ring_r = 0.46 * d + (0.05 - 0.46 * d) * 0.3
    ring = tube(ring_path(superellipse(2 * ring_r, 2 * ring_r, 2, 30), 0.3 * (h - 0.07)), 0.009, 6, closed=True)
    return of(seat, shell) + of(steel, *legs, ring, cylinder(0.06, 0.03, 0.004, 18).moved(z=h - 0.085))


def milking_stool(size: Size, wood: Material) -> Parts:
    """A thick round seat on three turned legs."""
    d, _, h = size
    r = d / 2
    top = prism(superellipse(d, d, 2, 44), 0.045, 0.012).moved(z=h - 0.045)
    leg_profile = [
        (0.014, 0),
        (0.019, 0.12 * h),
        (0.024, 0.5 * h),
        (0.017, 0.62 * h),
        (0.021, 0.68 * h),
        (0.017, h - 0.04),
    ]
    legs = [lathe(leg_profile, 12).turned("y", -13).moved(r * 0.84, 0, 0).turned("z", 60 + 120 * k) for k in range(3)]
    return of(wood, top, *legs)


def bent_ply_stool(size: Size, ply: Material) -> Parts:
    """One sheet of plywood bent into a stool."""
    d, w, h = size
    t = np.linspace(0, 1, 40)
    corner = 0.055
    path = np.array(
        [
            (0, -w / 2 + 0.008, 0),
            (0, -w / 2 + 0.02, h - corner),
            (0, -w / 2 + 0.03, h - 0.02),
            (0, -w / 2 + 0.075, h - 0.008),
            (0, 0, h - 0.02),
            (0, w / 2 - 0.075, h - 0.008),
            (0, w / 2 - 0.03, h - 0.02),
            (0, w / 2 - 0.02, h - corner),
            (0, w / 2 - 0.008, 0),
        ]
    )
    dense = np.stack([np.interp(t * 8, np.arange(9), path[:, k]) for k in range(3)], axis=1)
    u = np.linspace(-1, 1, 5)[None, :]
    waist = 1 - 0.08 * np.sin(np.pi * np.abs(2 * t - 1))[:, None]
    sheet = np.stack(
        [-u * d / 2 * waist, np.broadcast_to(dense[:, 1:2], (40, 5)), np.broadcast_to(dense[:, 2:], (40, 5))], axis=-1
    )
    return of(
        ply, slab(sheet[:, ::-1], 0.016), beam((0, -w / 2 + 0.02, 0.4 * h), (0, w / 2 - 0.02, 0.4 * h), 0.05, 0.014)
    )


def high_chair(size: Size, frame: Material, seat: Material, tray: Material, profile: Leg) -> Parts:
    """A child's high chair: seat with a wrap-around back, tray, foot rest."""
    d, w, h = size
    seat_z = 0.56 * h
    x, y = d / 2 - 0.02, w / 2 - 0.02
    one = (
        taper((x, y, 0), (x * 0.5, y * 0.66, seat_z), 0.028, 0.036)
        if profile in ("square", "taper")
        else rod((x, y, 0), (x * 0.5, y * 0.66, seat_z), 0.012, 0.017, 12)
    )
    legs = [one, one.mirrored(), one.mirrored(0), one.mirrored().mirrored(0)]
    z = 0.3 * seat_z
    px, py = x * 0.85, y * 0.898
    rails = [
        *(beam((f * px, -py, z), (f * px, py, z), 0.018, 0.022) for f in (1, -1)),
        *both_sides(beam((-px, py, z), (px, py, z), 0.018, 0.022)),
    ]
    rest = box((0.1, w * 0.5, 0.016), 0.005).moved(0.29 * d, 0, 0.62 * seat_z)
    hang = both_sides(beam((0.26 * d, 0.24 * w, 0.63 * seat_z), (0.2 * d, 0.24 * w, seat_z - 0.01), 0.016, 0.022))
    base = prism(superellipse(0.56 * d, 0.68 * w, 4, 32), 0.03, 0.01).moved(-0.02, 0, seat_z - 0.015)
    a = np.linspace(-1.9, 1.9, 31)
    v = np.linspace(0, 1, 5)[:, None]
    top = seat_z + 0.16 + (h - seat_z - 0.16) * np.clip(np.cos(a * 0.72), 0, 1) ** 0.9
    wall = np.stack(
        np.broadcast_arrays(
            -0.04 - 0.26 * d * np.cos(a) * (1 + 0.1 * v),
            -0.34 * w * np.sin(a) * (1 + 0.06 * v),
            seat_z + (top - seat_z) * v,
        ),
        axis=-1,
    )
    table = prism(superellipse(0.42 * d, 0.92 * w, 3.4, 36), 0.02, 0.008).moved(0.27 * d, 0, seat_z + 0.19)
    lip = tube(ring_path(superellipse(0.41 * d, 0.90 * w, 3.4, 36), seat_z + 0.212), 0.006, 6, closed=True).moved(
        0.27 * d
    )
    arms = both_sides(beam((-0.1 * d, 0.35 * w, seat_z + 0.17), (0.3 * d, 0.36 * w, seat_z + 0.185), 0.026, 0.02))
    return (
        of(frame, *legs, *rails, rest, *hang, *arms) + of(seat, base, slab(wall[:, ::-1], 0.016)) + of(tray, table, lip)
    )


DESIGNS: tuple[Design, ...] = (
    design("stool", "piano-mahogany", "mahogany piano stool with a buttoned leather seat", (0.36, 0.56, 0.50), "classic", padded_stool, 2, cloth=m.BLACK_LEATHER, wood=m.MAHOGANY, profile="turned", buttons=True),
    design("stool", "vanity-cabriole", "dressing stool with pale blue cloth and bowed legs", (0.42, 0.50, 0.46), "classic", padded_stool, 2, cloth=s.SKY_FABRIC, wood=m.WHITEWASH, profile="cabriole"),
    design("stool", "plush-blush", "pleated blush velvet stool", (0.40, 0.40, 0.42), "modern", drum_stool, 36, cloth=s.BLUSH_VELVET, band=m.BRASS),
    design("stool", "plush-teal", "pleated teal velvet stool", (0.44, 0.44, 0.45), "modern", drum_stool, 36, cloth=s.TEAL_VELVET, band=m.BLACK),
    design("stool", "tractor", "workshop stool with a tractor seat", (0.42, 0.42, 0.62), "industrial", tractor_stool, seat=m.IRON, steel=m.BLACK_STEEL),
    design("stool", "tractor-low", "low steel stool with a pressed seat", (0.40, 0.42, 0.46), "industrial", tractor_stool, seat=m.metal("galvanised steel", "#9aa0a2", 0.5, 0.3), steel=m.BLACK_STEEL),
    design("stool", "milking-oak", "three-legged oak milking stool", (0.32, 0.32, 0.40), "rustic", milking_stool, 36, wood=m.OAK),
    design("stool", "bent-ply", "bent plywood stool", (0.32, 0.42, 0.44), "minimal", bent_ply_stool, 2, ply=s.PLYWOOD),
    design("stool", "round-padded-oatmeal", "round padded stool on splayed birch legs", (0.40, 0.40, 0.45), "minimal", padded_stool, 36, cloth=m.OATMEAL, wood=m.BIRCH, profile="splay", round_top=True),
    design("high chair", "birch", "birch high chair", (0.55, 0.50, 0.92), "minimal", high_chair, frame=m.BIRCH, seat=m.WHITE, tray=m.WHITE, profile="splay"),
    design("high chair", "oak", "oak high chair with a tray", (0.58, 0.52, 0.98), "classic", high_chair, frame=m.OAK, seat=m.OAK, tray=m.OAK, profile="square"),
    design("high chair", "sage", "sage high chair on beech legs", (0.56, 0.54, 0.94), "modern", high_chair, frame=m.LIGHT_OAK, seat=m.SAGE, tray=m.CREAM, profile="splay"),
    design("high chair", "steel", "high chair on black steel with a pine tray", (0.57, 0.52, 0.95), "industrial", high_chair, frame=m.BLACK_STEEL, seat=m.CHARCOAL, tray=m.PINE, profile="splay"),
    design("high chair", "pine", "farmhouse pine high chair", (0.60, 0.52, 1.00), "rustic", high_chair, frame=m.PINE, seat=m.PINE, tray=m.PINE, profile="square"),
)  # fmt: skip
