"""Fans that stand and fans that hang."""

from __future__ import annotations

from functools import cache

import numpy as np

from diorama_core.library.furniture.kit import *


@cache
def _blade(length: float, width: float, pitch_deg: float, root: float) -> Solid:
    """A fan blade along +y from its root, turned about its length."""
    v, u = np.meshgrid(np.linspace(0, 1, 5), np.linspace(-0.5, 0.5, 5), indexing="ij")
    half = width * (0.42 + 0.58 * np.sin(np.pi * np.clip(0.12 + 0.72 * v, 0, 1)))
    twist = np.deg2rad(pitch_deg) * (1 - 0.3 * v)
    surface = np.stack([half * u * np.sin(twist), root + v * (length - root), half * u * np.cos(twist)], axis=-1)
    return slab(surface, 0.004)


def fan_head(radius: float, body: Material, cage: Material, blades: int = 4) -> Parts:
    """A caged fan facing +X, its middle at the origin."""
    depth = 0.36 * radius
    rings = []
    for share, x in ((1.0, 0.0), (0.72, 0.8), (0.4, 1.0)):
        for side in (1, -1) if x else (1,):
            o = superellipse(2 * radius * share, 2 * radius * share, 2, 36)
            rings.append(
                tube(
                    np.column_stack([np.full(len(o), side * x * depth / 2), o]), 0.0035 if x else 0.006, 5, closed=True
                )
            )
    spokes = []
    for side in (1, -1):
        path = [
            (side * depth * 0.5 * f, 0, radius * r) for f, r in ((1.02, 0.14), (1.0, 0.4), (0.8, 0.72), (0.0, 0.995))
        ]
        wire = tube(bend(path, 2), 0.0018, 4)
        spokes += [wire.turned("x", 18 * k) for k in range(20)]
    hub = lathe(
        [
            (radius * 0.16, -depth * 0.5),
            (radius * 0.17, depth * 0.45),
            (radius * 0.12, depth * 0.56),
            (0.003, depth * 0.58),
        ],
        20,
    )
    motor = lathe(
        [
            (0.003, -depth * 1.15),
            (radius * 0.2, -depth * 1.1),
            (radius * 0.28, -depth * 0.8),
            (radius * 0.26, -depth * 0.48),
        ],
        24,
        np.pi,
    )
    wings = [
        _blade(radius * 0.9, radius * 0.62, 28.0, radius * 0.13).turned("x", 360 / blades * k) for k in range(blades)
    ]
    return of(cage, *rings, *spokes) + of(body, hub.turned("y", 90), motor.turned("y", 90)) + of(m.LIGHT_GREY, *wings)


def fan(size: Size, stand: str, body: Material, cage: Material) -> Parts:
    """A fan with a cage on a pole ("pole"), a low foot ("desk"), three legs ("tripod") or in a drum ("drum")."""
    d, w, h = size
    r = w / 2 * (0.94 if stand == "drum" else 1.0)
    z = h - r
    x = 0.06 if stand != "drum" else 0.0
    if stand == "drum":
        z = h / 2 + 0.02
        head = shifted(fan_head(r * 0.9, body, cage, 3), 0, 0, z)
        shell = lathe(
            [(r * 0.93, -d * 0.3), (r, -d * 0.28), (r, d * 0.28), (r * 0.93, d * 0.3), (r * 0.93, -d * 0.3)], 40
        ).turned("y", 90)
        legs = [
            tube(
                bend(
                    [
                        (-d / 2, s * w * 0.36, 0.012),
                        (0, s * w * 0.48, 0.012),
                        (0, s * w * 0.5, 0.1),
                        (0, s * w * 0.49, z),
                    ],
                    4,
                ),
                0.012,
                8,
            )
            for s in (1, -1)
        ]
        feet = [rod((d / 2, s * w * 0.36, 0.012), (-d / 2, s * w * 0.36, 0.012), 0.012) for s in (1, -1)]
        return head + of(body, shell.moved(z=z), *legs, *feet)
    head = shifted(turned(fan_head(r, body, cage), "y", -6), x, 0, z)
    neck = [
        cylinder(0.024, 0.07, 0.006, 16).moved(x - 0.1, 0, z - 0.06),
        box((0.06, 0.03, 0.06), 0.01, 2).moved(x - 0.08, 0, z - 0.04),
    ]
    px = x - 0.1
    if stand == "tripod":
        hub = z * 0.55
        legs = [
            rod((px + 0.3 * np.cos(a), 0.3 * np.sin(a), 0.0), (px, 0, hub), 0.012, 0.015)
            for a in np.deg2rad((60, 180, 300))
        ]
        return (
            head
            + of(m.OAK, *legs)
            + of(
                body,
                cylinder(0.014, z - hub, 0.002, 14).moved(px, 0, hub - 0.02),
                cylinder(0.03, 0.05, 0.005, 18).moved(px, 0, hub - 0.03),
                *neck,
            )
        )
    foot_r = 0.2 if stand == "pole" else r * 0.62
    foot = lathe([(foot_r * 0.97, 0), (foot_r, 0.008), (foot_r * 0.93, 0.022), (0.05, 0.042), (0.024, 0.06)], 40)
    pole = cylinder(0.014, z - 0.08, 0.002, 16).moved(px, 0, 0.04)
    return head + of(body, foot.moved(px), pole, *neck)


def tower_fan(size: Size, body: Material) -> Parts:
    """A bladeless-looking upright fan."""
    d, w, h = size
    column = prism(superellipse(d * 0.66, w * 0.66, 2.4, 36), h - 0.06, 0.03).moved(z=0.05)
    foot = prism(superellipse(d, w, 2, 40), 0.03, 0.01)
    neck = cylinder(min(d, w) * 0.18, 0.05, 0.004, 20).moved(z=0.02)
    slats = [box((0.01, w * 0.3, 0.006), 0.002).moved(d * 0.327, 0, z) for z in np.linspace(0.16, 0.84, 34) * h]
    slot = box((0.014, w * 0.34, h * 0.72), 0.006, 2).moved(d * 0.318, 0, h * 0.14)
    return of(body, column, foot) + of(m.CHARCOAL, neck, slot) + of(m.GREY, *slats)


def ceiling_fan(size: Size, metal: Material, blade: Material, blades: int = 4, lamp: bool = True) -> Parts:
    """Blades about a motor on a short rod, with a lamp under it."""
    d, _, h = size
    zb = 0.42 * h
    length = d / 2
    wing = _blade(length, 0.15, 78.0, 0.16).moved(z=zb)
    irons = [
        box((0.012, 0.14, 0.008), 0.003).moved(0, 0.12, zb - 0.002).turned("z", 360 / blades * k) for k in range(blades)
    ]
    motor = lathe(
        [(0.06, zb - 0.06), (0.11, zb - 0.045), (0.125, zb), (0.115, zb + 0.06), (0.05, zb + 0.09), (0.016, zb + 0.11)],
        36,
        np.deg2rad(50),
    )
    rod_ = cylinder(0.013, h - zb - 0.08, 0.002, 14).moved(z=zb + 0.06)
    rose = lathe([(0.03, h - 0.07), (0.055, h - 0.05), (0.065, h)], 28)
    parts = of(metal, motor, rod_, rose, *irons) + of(
        blade, *(wing.turned("z", 360 / blades * k) for k in range(blades))
    )
    if lamp:
        return parts + of(m.LAMP_GLOW, lathe([(0.003, 0), (0.05, 0.006), (0.085, 0.03), (0.1, zb - 0.05)], 32, np.pi))
    return parts + of(metal, lathe([(0.003, 0), (0.04, 0.004), (0.07, zb * 0.4), (0.07, zb - 0.04)], 28, np.pi))


DESIGNS: tuple[Design, ...] = (
    design("fan", "pedestal", "white pedestal fan", (0.42, 0.44, 1.25), "modern", fan, stand="pole", body=m.WHITE, cage=m.WHITE),
    design("fan", "pedestal-black", "black pedestal fan", (0.42, 0.42, 1.18), "classic", fan, stand="pole", body=m.BLACK, cage=m.BLACK_STEEL),
    design("fan", "tripod", "copper fan on a wooden tripod", (0.60, 0.52, 1.20), "rustic", fan, stand="tripod", body=m.COPPER, cage=m.COPPER),
    design("fan", "desk", "brass desk fan", (0.30, 0.32, 0.42), "classic", fan, stand="desk", body=m.BRASS, cage=m.BRASS),
    design("fan", "drum", "steel floor fan", (0.26, 0.52, 0.55), "industrial", fan, stand="drum", body=m.STEEL, cage=m.CHROME),
    design("fan", "tower", "slim tower fan", (0.28, 0.28, 1.05), "minimal", tower_fan, body=m.WHITE),
    design("ceiling fan", "walnut", "ceiling fan with walnut blades and a lamp", (1.20, 1.20, 0.42), "classic", ceiling_fan, 4, metal=m.BRASS, blade=m.WALNUT),
    design("ceiling fan", "white", "white ceiling fan with five blades", (1.07, 1.07, 0.36), "modern", ceiling_fan, 1, metal=m.WHITE, blade=m.LIGHT_GREY, blades=5),
    design("ceiling fan", "black", "black three-bladed ceiling fan", (1.32, 1.32, 0.34), "industrial", ceiling_fan, 1, metal=m.BLACK_STEEL, blade=m.BLACK_WOOD, blades=3, lamp=False),
    design("ceiling fan", "oak", "plain ceiling fan with oak blades", (1.20, 1.20, 0.32), "minimal", ceiling_fan, 4, metal=m.STEEL, blade=m.LIGHT_OAK, lamp=False),
)  # fmt: skip
