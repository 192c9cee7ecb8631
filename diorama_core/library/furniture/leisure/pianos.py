"""Pianos."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *


def upright_piano(size: Size, wood: Material, legs: str = "column") -> Parts:
    """An upright piano with its lid open."""
    d, w, h = size
    depth, key_z = d * 0.56, 0.66
    x0 = -d / 2 + depth / 2
    parts = of(
        wood,
        box((depth, w - 0.06, h - 0.03), 0.006).moved(x0, 0, 0.0),
        box((depth + 0.02, w - 0.02, 0.03), 0.01, 2).moved(x0, 0, h - 0.03),
    )
    parts += of(
        wood,
        *(box((d, 0.045, 0.2), 0.014, 2).moved(0, s * (w / 2 - 0.023), key_z - 0.06) for s in (1, -1)),
        *(box((depth, 0.045, h - 0.02), 0.008).moved(x0, s * (w / 2 - 0.023)) for s in (1, -1)),
    )
    front = d / 2
    parts += of(
        wood,
        box((d - depth + 0.03, w - 0.05, 0.06), 0.008).moved(front - (d - depth) / 2 - 0.01, 0, key_z - 0.07),
        box((0.02, w - 0.06, 0.05), 0.004).moved(front - 0.012, 0, key_z - 0.04),
    )
    kx = front - 0.1
    white, black = (0.145, 0.0215, 0.02), (0.09, 0.011, 0.012)
    parts += piano_keys(-0.59, 0.0227, white, (kx, key_z - 0.01), black, (kx - 0.026, key_z + 0.008), first=0.0)
    parts += of(
        wood,
        box((0.02, w - 0.1, 0.17), 0.004).turned("y", -14).moved(-d / 2 + depth + 0.012, 0, key_z + 0.03),
        box((0.05, 0.62, 0.014), 0.004).moved(-d / 2 + depth + 0.02, 0, key_z + 0.2),
    )
    if legs == "column":
        column = lathe(
            [(0.034, 0), (0.04, 0.04), (0.026, 0.08), (0.036, 0.2), (0.028, 0.5), (0.04, 0.58), (0.04, 0.6)], 16
        )
        parts += of(
            wood,
            *both_sides(column.moved(front - 0.06, w / 2 - 0.06, 0.0)),
            *both_sides(box((d, 0.075, 0.05), 0.01, 2).moved(0, w / 2 - 0.06)),
        )
    else:
        parts += of(wood, *both_sides(box((0.055, 0.05, key_z - 0.05), 0.006).moved(front - 0.04, w / 2 - 0.03)))
    pedals = [box((0.09, 0.02, 0.012), 0.005).moved(-d / 2 + depth + 0.04, y, 0.05) for y in (-0.08, 0.0, 0.08)]
    panels = [
        box((0.008, w * 0.84, 0.44), 0.004).moved(-d / 2 + depth + 0.002, 0, 0.12),
        box((0.008, w * 0.84, h - key_z - 0.3), 0.004).moved(-d / 2 + depth + 0.002, 0, key_z + 0.22),
    ]
    return parts + of(m.BRASS, *pedals) + of(wood, *panels)


def digital_piano(size: Size, body: Material) -> Parts:
    """A digital piano on a plain stand."""
    d, w, h = size
    h -= 0.16  # the music rest reaches above the case
    z = h - 0.18
    parts = of(
        body,
        box((d, w, 0.11), 0.012, 2).moved(0, 0, z),
        box((d * 0.45, w, 0.07), 0.012, 2).moved(-d * 0.27, 0, h - 0.075),
        *both_sides(box((d * 0.8, 0.03, z), 0.005).moved(-0.02, w / 2 - 0.02)),
        box((0.02, w - 0.06, 0.26), 0.004).moved(-d * 0.3, 0, 0.26),
    )
    step = (w - 0.14) / 52
    kx = d / 2 - 0.09
    white, black = (0.14, step * 0.94, 0.016), (0.088, step * 0.5, 0.012)
    parts += piano_keys(-w / 2 + 0.07, step, white, (kx, h - 0.075), black, (kx - 0.024, h - 0.062))
    return parts + of(
        m.BLACK,
        box((0.015, 0.5, 0.17), 0.004).turned("y", -16).moved(-d * 0.24, 0, h - 0.01),
    )


def grand_piano(size: Size, lacquer: Material) -> Parts:
    """A small grand with its lid up; the keys toward +X."""
    d, w, _ = size
    z0, z1 = 0.62, 0.92
    t = np.linspace(0, 1, 25)
    half = w / 2
    # the bent side: full width at the keys, swinging in to a round tail
    side = [(d / 2 - 0.28 - (d - 0.3) * s, -half + w * 0.52 * (3 * s**2 - 2 * s**3) ** 1.1) for s in t[:-1]]
    tail = [
        (-d / 2 + 0.02 + 0.0, half * 0.26),
        (-d / 2, half * 0.42),
        (-d / 2, half * 0.72),
        (-d / 2 + 0.05, half * 0.93),
        (-d / 2 + 0.16, half),
    ]
    outline = np.array([(d / 2 - 0.28, half), *reversed(tail), *reversed(side)])
    outline[0] = (d / 2 - 0.28, half)
    rim = prism(outline, z1 - z0, 0.006).moved(z=z0)
    front = [
        box((0.3, w, 0.12), 0.008, 2).moved(d / 2 - 0.15, 0, z0),
        *both_sides(box((0.3, 0.06, 0.26), 0.012, 2).moved(d / 2 - 0.15, half - 0.03, z0)),
    ]
    fall = box((0.02, w - 0.12, 0.12), 0.004).turned("y", -10).moved(d / 2 - 0.27, 0, z0 + 0.11)
    lid = prism(outline, 0.018, 0.004)
    hinge = np.array([0.0, half, z1])
    lid = replace(lid, vertices=lid.vertices - np.array([0, half, 0])).turned("x", -32)
    lid = lid.moved(*hinge)
    prop = rod(
        (-0.02 * d, -half * 0.55, z1),
        (-0.02 * d, -half * 0.32, z1 + (half * 1.32) * np.tan(np.deg2rad(32)) * 0.86),
        0.008,
        segments=8,
    )
    legs = [
        taper((x, y, 0.03), (x, y, z0 + 0.01), 0.05, 0.09, 0.01)
        for x, y in ((d / 2 - 0.2, half - 0.12), (d / 2 - 0.2, -half + 0.12), (-d / 2 + 0.3, half * 0.5))
    ]
    casters = [
        cylinder(0.022, 0.02, 0.006, 14).turned("x", 90).moved(x, y + 0.01, 0.022)
        for x, y in ((d / 2 - 0.2, half - 0.12), (d / 2 - 0.2, -half + 0.12), (-d / 2 + 0.3, half * 0.5))
    ]
    lyre = [
        *(rod((d / 2 - 0.4, s * 0.07, z0), (d / 2 - 0.36, s * 0.09, 0.12), 0.012) for s in (1, -1)),
        box((0.09, 0.26, 0.04), 0.01, 2).moved(d / 2 - 0.36, 0, 0.09),
    ]
    pedals = [box((0.1, 0.024, 0.01), 0.004).moved(d / 2 - 0.29, y, 0.1) for y in (-0.07, 0.0, 0.07)]
    desk = box((0.014, 0.7, 0.22), 0.004).turned("y", -18).moved(d / 2 - 0.42, 0, z1 + 0.005)
    step = (w - 0.14) / 52
    white, black = (0.145, step * 0.94, 0.02), (0.09, step * 0.5, 0.014)
    keys = piano_keys(-half + 0.07, step, white, (d / 2 - 0.1, z0 + 0.115), black, (d / 2 - 0.126, z0 + 0.133))
    plate = prism(outline * 0.93, 0.004, 0.001).moved(0.0, 0.0, z1 - 0.001)
    return of(lacquer, rim, *front, fall, lid, prop, *legs, *lyre, desk) + of(m.BRASS, *casters, *pedals, plate) + keys


PIANO_BLACK = m.paint("black lacquer", "#1f1f21", 0.12)

DESIGNS: tuple[Design, ...] = (
    design("piano", "upright-black", "black upright piano", (0.60, 1.48, 1.18), "classic", upright_piano, wood=m.BLACK_WOOD),
    design("piano", "upright-walnut", "walnut upright piano", (0.58, 1.45, 1.12), "rustic", upright_piano, wood=m.WALNUT, legs="plain"),
    design("piano", "digital", "white digital piano", (0.42, 1.36, 1.00), "modern", digital_piano, body=m.WHITE),
    design("piano", "grand", "black baby grand piano", (1.55, 1.48, 1.45), "classic", grand_piano, lacquer=PIANO_BLACK),
    design("piano", "stage", "black stage piano on a stand", (0.36, 1.30, 0.95), "industrial", digital_piano, body=m.BLACK),
    design("piano", "white", "white upright piano", (0.58, 1.46, 1.15), "minimal", upright_piano, wood=m.WHITE, legs="plain"),
)  # fmt: skip
