"""Televisions, computers and a piano."""

from __future__ import annotations

from functools import partial

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, four, of, turned
from diorama_core.library.furniture.solids import box, cylinder, lathe, prism, rod, rounded_rectangle, slab, taper


def panel(w: float, h: float, t: float, bezel: float, body: Material, chin: float = 0.0) -> Parts:
    """A flat screen standing on z = 0, its glass on the plane x = 0, facing +X."""
    glass = box((0.004, w - 2 * bezel, h - 2 * bezel - chin), 0.001).pictured().moved(-0.0015, 0, bezel + chin)
    shell = box((t, w, h), 0.005, 2).moved(-t / 2 - 0.001)
    hump = box((t, w * 0.62, h * 0.5), 0.012, 2).moved(-1.3 * t, 0, h * 0.12)
    return of(body, shell, hump) + of(m.SCREEN, glass)


def television(size: Size, body: Material, stand: str) -> Parts:
    """`stand`: "feet", "plate", or "wall" (none)."""
    d, w, h = size
    if stand == "wall":
        return panel(w, h, d * 0.5, 0.01, body)
    lift = 0.07 if stand == "feet" else 0.09
    parts = [p.moved(0.02, 0, lift) for p in panel(w, h - lift, 0.035, 0.01, body, 0.01)]
    if stand == "feet":
        foot = [
            rod((d / 2 - 0.008, w * 0.37, 0.008), (0.0, w * 0.35, lift + 0.015), 0.008),
            rod((-d / 2 + 0.008, w * 0.37, 0.008), (-0.0, w * 0.35, lift + 0.015), 0.008),
        ]
        return parts + of(body, *both_sides(*foot))
    plate = prism(rounded_rectangle(d, w * 0.42, 0.03), 0.012, 0.004)
    return parts + of(body, plate, box((0.03, w * 0.1, lift + 0.1), 0.006).moved(-0.015, 0, 0.008))


def tube_television(size: Size, body: Material) -> Parts:
    """An old deep television with a bulging screen and knobs."""
    d, w, h = size
    case = taper((0, 0, 0), (0, 0, d - 0.05), 0.62, 1.0, 0.05).scaled(h, w, 1.0).turned("y", 90).moved(-d / 2, 0, h / 2)
    front = box((0.06, w, h), 0.02, 2).moved(d / 2 - 0.04)
    gw, gh, gy = w * 0.72, h * 0.8, w * 0.1
    v, u = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9), indexing="ij")
    bulge = np.stack([0.03 * (1 - (u**2 + v**2) / 2) + d / 2 - 0.018, -u * gw / 2 + gy, v * gh / 2 + h / 2], axis=-1)
    glass = slab(bulge, 0.012).pictured()
    knobs = [
        cylinder(0.022, 0.02, 0.004, 18).turned("y", 90).moved(d / 2 - 0.012, -w * 0.39, h * f) for f in (0.78, 0.62)
    ]
    grille = [
        box((0.008, w * 0.13, 0.006), 0.002).moved(d / 2 - 0.009, -w * 0.39, h * f) for f in np.linspace(0.14, 0.46, 9)
    ]
    return of(body, case, front) + of(m.SCREEN, glass) + of(m.BLACK, *knobs, *grille)


def monitor(size: Size, body: Material, stand: str = "arm", curved: bool = False) -> Parts:
    """`stand`: "arm" (a neck on a plate) or "ring"."""
    d, w, h = size
    z0 = 0.13
    parts = [p.moved(0.03, 0, z0) for p in panel(w, h - z0, 0.022, 0.009, body, 0.008 if curved else 0.016)]
    neck = box((0.022, 0.075, h * 0.55), 0.008, 2).turned("y", 5).moved(-0.055, 0, 0.006)
    if stand == "ring":
        return parts + of(
            m.STEEL,
            box((d * 0.9, 0.2, 0.009), 0.003, 2),
            box((0.012, 0.16, h * 0.6), 0.004).turned("y", 6).moved(-0.07, 0, 0.004),
        )
    foot = prism(rounded_rectangle(d * 0.96, min(0.26, w * 0.5), 0.04), 0.012, 0.004)
    return parts + of(body, neck, foot, box((0.04, 0.09, 0.09), 0.01).moved(-0.03, 0, h * 0.5))


def keys_of(d: float, w: float, rows: int, columns: int, z: float, height: float, material: Material) -> Parts:
    """A field of key caps; the top row is toward -X."""
    pitch_x, pitch_y = d / rows, w / columns
    solids = []
    for r in range(rows):
        x = d / 2 - pitch_x * (r + 0.5)
        if r == 0:
            solids += [box((pitch_x * 0.84, pitch_y * 5.6, height), 0.0015).moved(x, 0, z)]
            solids += [
                box((pitch_x * 0.84, pitch_y * 1.3, height), 0.0015).moved(x, s * (w / 2 - pitch_y * f), z)
                for s in (1, -1)
                for f in (0.75, 2.3)
            ]
            continue
        solids += [
            box((pitch_x * 0.84, pitch_y * 0.86, height), 0.0015).moved(x, -w / 2 + pitch_y * (c + 0.5), z)
            for c in range(columns)
        ]
    return of(material, *solids)


def laptop(size: Size, body: Material, keys: Material, angle: float = 112.0) -> Parts:
    """An open laptop; the screen faces +X."""
    d, w, h = size
    lid = h / np.sin(np.deg2rad(angle))
    lean = lid * np.cos(np.deg2rad(180 - angle))
    base_d = d - lean
    x0 = d / 2 - base_d
    parts = of(body, prism(rounded_rectangle(base_d, w, 0.012), 0.014, 0.004).moved(d / 2 - base_d / 2))
    parts += [p.moved(x0 + base_d * 0.42, 0, 0) for p in keys_of(base_d * 0.46, w * 0.88, 5, 13, 0.0135, 0.0025, keys)]
    parts += of(m.GREY, box((base_d * 0.3, w * 0.34, 0.001), 0.0004).moved(d / 2 - base_d * 0.19, 0, 0.0138))
    screen = of(body, box((0.006, w, lid), 0.003, 2).moved(-0.003)) + of(
        m.SCREEN, box((0.002, w - 0.016, lid - 0.022), 0.0005).pictured().moved(0.0, 0, 0.014)
    )
    return parts + [p.moved(x0 + 0.008, 0, 0.01) for p in turned(screen, "y", -(angle - 90))]


def keyboard(size: Size, body: Material, keys: Material, columns: int = 17) -> Parts:
    """A keyboard, typist at +X."""
    d, w, h = size
    parts = of(body, prism(rounded_rectangle(d, w, 0.012), h * 0.62, 0.003))
    return parts + keys_of(d - 0.016, w - 0.016, 6, columns, h * 0.55, h * 0.45, keys)


def tower(size: Size, body: Material, glass: bool = False) -> Parts:
    """A computer tower."""
    d, w, h = size
    parts = of(body, box((d - 0.012, w, h - 0.012), 0.006, 2).moved(-0.006, 0, 0.012)) + of(
        m.BLACK, *four(box((0.05, 0.022, 0.014), 0.003).moved(d / 2 - 0.07, w / 2 - 0.03))
    )
    x = d / 2 - 0.012
    if glass:
        parts += of(m.DARK_GLASS, box((d * 0.86, 0.004, h * 0.84), 0.001).moved(0, w / 2, h * 0.1))
        rings = [
            lathe([(0.045, 0), (0.055, 0.003), (0.055, 0.008), (0.045, 0.008), (0.045, 0)], 28)
            .turned("y", 90)
            .moved(x - 0.002, 0, z * h)
            for z in (0.25, 0.5, 0.75)
        ]
        return parts + of(m.STEEL, *rings)
    slots = [box((0.006, w * 0.78, 0.004), 0.001).moved(x, 0, z) for z in np.linspace(0.06, 0.4 * h, 12)]
    parts += of(m.BLACK, *slots) + of(
        m.GREY, *(box((0.008, w * 0.8, 0.042), 0.003).moved(x - 0.001, 0, h - z) for z in (0.07, 0.12))
    )
    return parts + of(m.STEEL, cylinder(0.01, 0.006, 0.001, 16).turned("y", 90).moved(x, 0, h - 0.16))


def printer(size: Size, body: Material) -> Parts:
    """A desktop printer with a paper tray."""
    d, w, h = size
    parts = of(
        body,
        box((d * 0.82, w, h * 0.78), 0.02, 3).moved(-d * 0.07, 0, 0.0),
        box((d * 0.8, w * 0.98, 0.03), 0.012, 2).moved(-d * 0.07, 0, h * 0.78),
    )
    parts += of(
        m.CHARCOAL,
        box((0.02, w * 0.72, h * 0.2), 0.006).moved(d * 0.335, 0, h * 0.26),
        box((d * 0.26, w * 0.62, 0.012), 0.004).moved(d * 0.37, 0, h * 0.24),
    )
    parts += of(m.PAPER, box((d * 0.22, w * 0.5, 0.006), 0.001).moved(d * 0.36, 0, h * 0.29)) + of(
        m.SCREEN, box((0.006, 0.075, 0.04), 0.001).moved(d * 0.342, w * 0.36, h * 0.58)
    )
    feed = box((0.012, w * 0.6, h * 0.3), 0.004).turned("y", -20).moved(-d * 0.4, 0, h * 0.74)
    return parts + of(m.CHARCOAL, feed)


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
    parts += of(
        m.WHITE,
        *(box((0.145, 0.0215, 0.02), 0.002).moved(kx, -0.59 * 1.0 + 0.0227 * k, key_z - 0.01) for k in range(52)),
    )
    black = [k for k in range(51) if k % 7 in (0, 1, 3, 4, 5)]
    parts += of(
        m.BLACK,
        *(box((0.09, 0.011, 0.012), 0.002).moved(kx - 0.026, -0.59 + 0.0227 * (k + 0.5), key_z + 0.008) for k in black),
    )
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
    parts += of(
        m.WHITE,
        *(
            box((0.14, step * 0.94, 0.016), 0.002).moved(kx, -w / 2 + 0.07 + step * (k + 0.5), h - 0.075)
            for k in range(52)
        ),
    )
    black = [k for k in range(51) if k % 7 in (0, 1, 3, 4, 5)]
    return parts + of(
        m.BLACK,
        *(
            box((0.088, step * 0.5, 0.012), 0.002).moved(kx - 0.024, -w / 2 + 0.07 + step * (k + 1), h - 0.062)
            for k in black
        ),
        box((0.015, 0.5, 0.17), 0.004).turned("y", -16).moved(-d * 0.24, 0, h - 0.01),
    )


def _d(category: str, name: str, caption: str, size: Size, style: str, build: Builder) -> Design:
    return Design(f"{category}-{name}", category, caption, size, style, build)


DESIGNS: tuple[Design, ...] = (
    _d(
        "television",
        "feet",
        "flat television on two feet",
        (0.24, 1.23, 0.77),
        "modern",
        partial(television, body=m.BLACK, stand="feet"),
    ),
    _d(
        "television",
        "plate",
        "small flat television on a plate",
        (0.22, 0.74, 0.50),
        "minimal",
        partial(television, body=m.BLACK, stand="plate"),
    ),
    _d(
        "television",
        "large",
        "large wall-mounted television",
        (0.06, 1.45, 0.83),
        "modern",
        partial(television, body=m.BLACK, stand="wall"),
    ),
    _d(
        "television",
        "silver",
        "silver-framed television on a plate",
        (0.26, 0.96, 0.64),
        "minimal",
        partial(television, body=m.STEEL, stand="plate"),
    ),
    _d(
        "television",
        "tube",
        "old television in a walnut case",
        (0.44, 0.62, 0.48),
        "classic",
        partial(tube_television, body=m.WALNUT),
    ),
    _d("monitor", "black", "black computer monitor", (0.20, 0.54, 0.45), "modern", partial(monitor, body=m.BLACK)),
    _d(
        "monitor",
        "white",
        "white all-in-one monitor",
        (0.19, 0.55, 0.46),
        "minimal",
        partial(monitor, body=m.WHITE, stand="ring"),
    ),
    _d(
        "monitor",
        "wide",
        "wide computer monitor",
        (0.24, 0.81, 0.46),
        "modern",
        partial(monitor, body=m.CHARCOAL, curved=True),
    ),
    _d("monitor", "small", "small square monitor", (0.19, 0.38, 0.40), "classic", partial(monitor, body=m.GREY)),
    _d("laptop", "silver", "silver laptop", (0.28, 0.32, 0.21), "modern", partial(laptop, body=m.STEEL, keys=m.BLACK)),
    _d(
        "laptop",
        "black",
        "black laptop",
        (0.30, 0.36, 0.23),
        "industrial",
        partial(laptop, body=m.CHARCOAL, keys=m.BLACK),
    ),
    _d(
        "laptop",
        "white",
        "small white laptop",
        (0.26, 0.30, 0.19),
        "minimal",
        partial(laptop, body=m.WHITE, keys=m.LIGHT_GREY, angle=106.0),
    ),
    _d(
        "computer", "tower-black", "black computer tower", (0.44, 0.20, 0.43), "modern", partial(tower, body=m.CHARCOAL)
    ),
    _d(
        "computer",
        "tower-glass",
        "computer tower with a glass side",
        (0.46, 0.22, 0.46),
        "modern",
        partial(tower, body=m.BLACK, glass=True),
    ),
    _d(
        "computer",
        "tower-beige",
        "old beige computer tower",
        (0.42, 0.19, 0.40),
        "classic",
        partial(tower, body=m.CREAM),
    ),
    _d("computer", "printer", "white desktop printer", (0.44, 0.46, 0.24), "minimal", partial(printer, body=m.WHITE)),
    _d(
        "keyboard",
        "black",
        "black keyboard",
        (0.15, 0.44, 0.03),
        "modern",
        partial(keyboard, body=m.CHARCOAL, keys=m.BLACK),
    ),
    _d(
        "keyboard",
        "white",
        "slim white keyboard",
        (0.12, 0.42, 0.018),
        "minimal",
        partial(keyboard, body=m.STEEL, keys=m.WHITE),
    ),
    _d(
        "keyboard",
        "compact",
        "compact grey keyboard",
        (0.13, 0.32, 0.028),
        "modern",
        partial(keyboard, body=m.GREY, keys=m.LIGHT_GREY, columns=13),
    ),
    _d(
        "piano",
        "upright-black",
        "black upright piano",
        (0.60, 1.48, 1.18),
        "classic",
        partial(upright_piano, wood=m.BLACK_WOOD),
    ),
    _d(
        "piano",
        "upright-walnut",
        "walnut upright piano",
        (0.58, 1.45, 1.12),
        "rustic",
        partial(upright_piano, wood=m.WALNUT, legs="plain"),
    ),
    _d("piano", "digital", "white digital piano", (0.42, 1.36, 1.00), "modern", partial(digital_piano, body=m.WHITE)),
)
