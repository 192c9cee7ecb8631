"""Fireplaces and stoves; the back, -X, is the wall's."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

RED_BRICK = Material("red brick", "brick", "#8a5a48", 0.9, 0.0, 0.62)
WHITE_BRICK = Material("painted brick", "brick", "#d9d4ca", 0.85, 0.0, 0.62)
SOOT = Material("sooty brick", "brick", "#4b4541", 0.95, 0.0, 0.62)
SLATE = Material("slate", "clay", "#4a4d50", 0.7, 0.0, 0.6)
EMBER = m.lit("embers", "#b8744c", 0.6)
FLAME = m.lit("flames", "#d69a68", 0.7)


def logs(w: float, x: float, z: float) -> Parts:
    """Burning logs on a grate."""
    bars = [
        rod((x - 0.11, y, z + 0.05), (x + 0.11, y, z + 0.05), 0.007, segments=6) for y in np.linspace(-w / 2, w / 2, 7)
    ]
    feet = [rod((x + s * 0.09, -w / 2, z + 0.045), (x + s * 0.09, w / 2, z + 0.045), 0.008) for s in (1, -1)]
    stubs = four(cylinder(0.009, 0.05, 0.002, 8).moved(0.09, w / 2 - 0.01))
    wood = [
        cylinder(0.045, w * f, 0.008, 14)
        .turned("x", 90)
        .moved(0, w * f / 2)
        .turned("z", a)
        .moved(x + dx, dy, z + 0.1 + dz)
        for f, a, dx, dy, dz in ((0.95, 4, -0.05, 0, 0), (0.9, -6, 0.05, 0.02, 0), (0.8, 17, 0.0, 0, 0.075))
    ]
    flames = [
        lathe([(0.012, 0), (0.03, 0.03), (0.022, 0.09), (0.004, 0.16 + 0.05 * (k % 2))], 10, np.pi)
        .scaled(1, 1.15, 1)
        .moved(x - 0.01 + 0.02 * (k % 2), y, z + 0.13)
        for k, y in enumerate(np.linspace(-0.3 * w, 0.3 * w, 4))
    ]
    glow = box((0.18, w * 0.8, 0.03), 0.012, 2).moved(x, 0, z + 0.055)
    return (
        of(m.IRON, *bars, *feet, *(s.moved(x, 0, z) for s in stubs))
        + of(m.BARK, *wood)
        + of(EMBER, glow)
        + of(FLAME, *flames)
    )


def hearth(d: float, w: float, h: float, depth: float, lining: Material, z: float) -> Parts:
    """The lining of an opening of `w` x `h` whose front is at x = d/2 - depth ... and its back near the wall."""
    back = -d / 2
    return of(
        lining,
        box((0.02, w + 0.02, h + 0.02), 0.002).moved(back + 0.012, 0, z),
        *both_sides(box((depth, 0.02, h + 0.02), 0.002).turned("z", 8).moved(back + depth / 2, w / 2 - 0.01, z)),
        box((depth, w + 0.02, 0.02), 0.002).moved(back + depth / 2, 0, z + h - 0.01),
    )


def mantel(
    size: Size,
    stone: Material,
    lining: Material,
    shelf: Material | None = None,
    fluted: bool = False,
    slab: Material = SLATE,
) -> Parts:
    """A surround with pilasters, a frieze and a moulded shelf over an open hearth."""
    d, w, h = size
    z, body = 0.04, d * 0.66
    x = -d / 2 + body / 2
    leg, frieze = 0.17 * w, 0.19 * h
    top = h - 0.045
    opening_w, opening_h = w * 0.92 - 2 * leg, top - z - frieze
    pillars = both_sides(box((body, leg, opening_h + 0.01), 0.006).moved(x, w * 0.46 - leg / 2, z))
    plinths = both_sides(box((body + 0.03, leg + 0.03, 0.1), 0.008, 2).moved(x + 0.01, w * 0.46 - leg / 2, z))
    caps = both_sides(
        box((body + 0.03, leg + 0.03, 0.045), 0.012, 2).moved(x + 0.01, w * 0.46 - leg / 2, z + opening_h - 0.05)
    )
    lintel = box((body, w * 0.92, frieze), 0.005).moved(x, 0, z + opening_h)
    panel = box((0.014, opening_w * 0.86, frieze * 0.5), 0.005).moved(-d / 2 + body, 0, z + opening_h + frieze * 0.24)
    mould = [
        box((body + 0.05 * k, w * 0.92 + 0.05 * k, 0.022), 0.007, 2).moved(x + 0.02 * k, 0, top - 0.026 * (3 - k))
        for k in (1, 2)
    ]
    parts = of(stone, *pillars, *plinths, *caps, lintel, panel, *mould)
    if fluted:
        ys = np.linspace(-0.3, 0.3, 4) * leg
        flutes = [
            box((0.012, leg * 0.1, opening_h - 0.22), 0.005).moved(-d / 2 + body, w * 0.46 - leg / 2 + y, z + 0.13)
            for y in ys
        ]
        parts += of(stone, *both_sides(*flutes))
    else:
        field = box((0.012, leg * 0.56, opening_h - 0.24), 0.005).moved(-d / 2 + body, w * 0.46 - leg / 2, z + 0.14)
        parts += of(stone, *both_sides(field))
    parts += of(shelf or stone, box((d * 0.84, w, 0.045), 0.012, 2).moved(-d * 0.08, 0, top))
    parts += of(slab, box((d, w * 0.96, z), 0.006, 2))
    parts += hearth(d, opening_w, opening_h, body, lining, z)
    return parts + logs(opening_w * 0.55, -d / 2 + 0.14, z)


def chimney_breast(size: Size, brick: Material, beam: Material) -> Parts:
    """A brick breast with a timber beam over the opening."""
    d, w, h = size
    z, body = 0.06, d * 0.72
    x = -d / 2 + body / 2
    opening_w, opening_h = 0.5 * w, 0.52 * h
    side = (w * 0.94 - opening_w) / 2
    parts = of(
        brick,
        *both_sides(box((body, side, opening_h + 0.01), 0.004).moved(x, opening_w / 2 + side / 2, z)),
        box((body, w * 0.94, h - z - opening_h - 0.02), 0.004).moved(x, 0, z + opening_h),
    )
    parts += of(beam, box((d * 0.82, w, 0.11), 0.016, 2).moved(-d * 0.09, 0, z + opening_h + 0.12))
    corbels = both_sides(box((d * 0.3, 0.08, 0.12), 0.014, 2).moved(-d * 0.02 + 0.02, w * 0.4, z + opening_h))
    parts += of(beam, *corbels)
    parts += of(SLATE, box((d, w * 0.98, z), 0.008, 2), box((body * 0.98, w * 0.96, 0.03), 0.004).moved(x, 0, h - 0.03))
    return parts + hearth(d, opening_w, opening_h, body, SOOT, z) + logs(opening_w * 0.6, -d / 2 + 0.16, z)


def inset(size: Size, face: Material, trim: Material, bench: Material) -> Parts:
    """A flat panel with a long gas fire behind glass, over a low ledge."""
    d, w, h = size
    z, body = 0.12 * h, d * 0.6
    x = -d / 2 + body / 2
    ow, oh, oz = 0.66 * w, 0.26 * h, 0.26 * h
    parts = of(
        face,
        *both_sides(box((body, (w - ow) / 2, h - z), 0.004).moved(x, ow / 2 + (w - ow) / 4, z)),
        box((body, ow + 0.01, h - oz - oh), 0.003).moved(x, 0, oz + oh),
        box((body, ow + 0.01, oz - z), 0.003).moved(x, 0, z),
    )
    front = -d / 2 + body
    rim = [box((0.014, ow, 0.016), 0.003).moved(front, 0, zz) for zz in (oz, oz + oh - 0.016)]
    parts += of(trim, *rim, *both_sides(box((0.014, 0.016, oh), 0.003).moved(front, ow / 2 - 0.008, oz)))
    parts += of(
        m.SHADOW,
        box((0.01, ow, oh), 0.001).moved(-d / 2 + 0.01, 0, oz),
        box((body, ow, 0.02), 0.002).moved(x, 0, oz + 0.001),
    )
    parts += of(bench, box((d, w * 1.0, z), 0.008, 2))
    rng = np.random.default_rng(3)
    ys = np.linspace(-0.45, 0.45, 17) * ow
    flames = [
        lathe([(0.012, 0), (0.026, 0.02), (0.016, 0.06), (0.003, float(rng.uniform(0.1, 0.17)))], 8, np.pi).moved(
            x, float(y), oz + 0.035
        )
        for y in ys
    ]
    pebbles = [
        cylinder(0.035, 0.03, 0.014, 10).moved(x + 0.03 * (-1) ** k, float(y), oz + 0.015) for k, y in enumerate(ys)
    ]
    return parts + of(FLAME, *flames) + of(m.WHITE, *pebbles)


def wood_stove(size: Size, iron: Material, legs: str, pipe: bool = True) -> Parts:
    """An iron stove with a glazed door, its flue rising at the back; `legs` is "feet" or "stand"."""
    d, w, h = size
    body_h = 0.62 if pipe else h - 0.02
    low = 0.14 if legs == "feet" else 0.26
    bd = d * 0.86
    x = 0.0
    if legs == "round":
        low = 0.05
    outline = rounded_rectangle(bd, w, bd * 0.499 if legs == "round" else 0.03, 8)
    shellbox = prism(outline, body_h - low, 0.012).moved(x, 0, low)
    lid = prism(outline * 1.04, 0.028, 0.01).moved(x, 0, body_h - 0.004)
    solids: list[Solid] = [shellbox, lid]
    front = x + bd / 2
    dw, dh = w * 0.7, (body_h - low) * 0.62
    dz = low + (body_h - low) * 0.26
    if legs == "round":
        front, dw = front - 0.004, w * 0.42
    door = [box((0.03, dw, 0.035), 0.008, 2).moved(front, 0, zz) for zz in (dz, dz + dh - 0.035)] + [
        box((0.03, 0.035, dh), 0.008, 2).moved(front, s * (dw / 2 - 0.017), dz) for s in (1, -1)
    ]
    drawer = box((0.02, dw * 0.9, 0.05), 0.008, 2).moved(front, 0, dz - 0.075)
    solids += [*door, drawer]
    if legs == "feet":
        solids += list(
            four(taper((bd / 2 - 0.035, w / 2 - 0.035, 0), (bd / 2 - 0.06, w / 2 - 0.06, low + 0.02), 0.05, 0.035))
        )
    elif legs == "stand":
        solids += [box((bd * 0.8, w * 0.16, low), 0.008).moved(x), box((bd * 0.94, w * 0.9, 0.016), 0.006)]
    else:
        solids += [prism(outline * 0.9, low + 0.01, 0.004)]
    if pipe:
        solids += [
            cylinder(0.07, h - body_h, 0.002, 28).moved(x - 0.12 * bd, 0, body_h),
            cylinder(0.085, 0.03, 0.006, 28).moved(x - 0.12 * bd, 0, body_h + 0.02),
        ]
    glow = box((0.012, dw - 0.05, dh - 0.05), 0.002).moved(front - 0.003, 0, dz + 0.025)
    grip = rod((front + 0.035, -dw / 2 + 0.03, dz + dh * 0.4), (front + 0.035, -dw / 2 + 0.03, dz + dh * 0.75), 0.008)
    pins = [
        rod((front, -dw / 2 + 0.03, dz + dh * f), (front + 0.035, -dw / 2 + 0.03, dz + dh * f), 0.006)
        for f in (0.42, 0.73)
    ]
    tongues = [
        lathe([(0.015, 0), (0.035, 0.03), (0.02, 0.1), (0.004, 0.16)], 8, np.pi)
        .scaled(0.2, 1, 1)
        .moved(front + 0.003, y, dz + 0.04)
        for y in (-0.07, 0.0, 0.08)
    ]
    return of(iron, *solids) + of(m.DARK_GLASS, glow) + of(FLAME, *tongues) + of(m.STEEL, grip, *pins)


def electric_fire(size: Size, body: Material) -> Parts:
    """A free-standing electric stove: a small cast box on curved feet with a lit window."""
    d, w, h = size
    low = 0.06
    case = prism(rounded_rectangle(d * 0.9, w * 0.94, 0.02, 3), h - low - 0.03, 0.008).moved(z=low)
    top = prism(rounded_rectangle(d, w, 0.03, 4), 0.03, 0.01).moved(z=h - 0.03)
    feet = four(taper((d * 0.42, w * 0.42, 0), (d * 0.36, w * 0.38, low + 0.02), 0.04, 0.05, 0.012))
    x = d * 0.45
    bars = [box((0.018, 0.018, h * 0.55), 0.006).moved(x, y, low + h * 0.12) for y in (-w * 0.36, 0.0, w * 0.36)]
    rails = [box((0.018, w * 0.74, 0.02), 0.006).moved(x, 0, low + h * f) for f in (0.12, 0.65)]
    pane = box((0.008, w * 0.72, h * 0.54), 0.002).moved(x + 0.002, 0, low + h * 0.13)
    flames = [
        lathe([(0.015, 0), (0.032, 0.03), (0.016, 0.08), (0.003, 0.15)], 8, np.pi)
        .scaled(0.18, 1, 1)
        .moved(x + 0.008, y, low + h * 0.16)
        for y in np.linspace(-0.27, 0.27, 5) * w
    ]
    return of(body, case, top, *feet, *bars, *rails) + of(m.DARK_GLASS, pane) + of(FLAME, *flames)


DESIGNS: tuple[Design, ...] = (
    design("fireplace", "marble", "white marble fireplace", (0.40, 1.42, 1.16), "classic", mantel, stone=m.MARBLE, lining=SOOT, fluted=True),
    design("fireplace", "oak-mantel", "painted fireplace with an oak shelf", (0.38, 1.36, 1.12), "modern", mantel, stone=m.WHITE, lining=RED_BRICK, shelf=m.OAK, slab=m.GRANITE),
    design("fireplace", "brick", "brick fireplace with a timber beam", (0.50, 1.70, 1.40), "rustic", chimney_breast, brick=RED_BRICK, beam=m.RECLAIMED),
    design("fireplace", "white-brick", "white brick fireplace", (0.48, 1.55, 1.30), "rustic", chimney_breast, brick=WHITE_BRICK, beam=m.LIGHT_OAK),
    design("fireplace", "inset", "long gas fire in a plain panel", (0.40, 1.60, 1.10), "minimal", inset, face=m.WHITE, trim=m.BLACK_STEEL, bench=m.OAK),
    design("fireplace", "inset-concrete", "gas fire in a concrete panel", (0.42, 1.80, 1.20), "industrial", inset, face=m.CONCRETE, trim=m.BLACK_STEEL, bench=SLATE),
    design("fireplace", "stove", "cast-iron wood stove with a flue", (0.42, 0.55, 1.50), "classic", wood_stove, iron=m.IRON, legs="feet"),
    design("fireplace", "stove-stand", "black wood stove on a stand", (0.42, 0.48, 1.70), "industrial", wood_stove, iron=m.BLACK_STEEL, legs="stand"),
    design("fireplace", "stove-round", "round wood stove", (0.46, 0.46, 1.60), "minimal", wood_stove, iron=m.CHARCOAL, legs="round"),
    design("fireplace", "electric", "small electric fire", (0.30, 0.50, 0.56), "modern", electric_fire, body=m.CREAM),
)  # fmt: skip
