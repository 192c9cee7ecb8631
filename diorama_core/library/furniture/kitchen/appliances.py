"""Built-in ovens, dishwashers, dryers, hoods, and machines in more styles."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.kitchen.cookers import burners, stove
from diorama_core.library.furniture.kitchen.laundry import washing_machine
from diorama_core.library.furniture.kitchen.microwaves import microwave
from diorama_core.library.furniture.kitchen.refrigerators import refrigerator

RED_ENAMEL = m.paint("red enamel", "#8a3b35", 0.25)
CREAM_ENAMEL = m.paint("cream enamel", "#e5dcc6", 0.25)
BLUE_ENAMEL = m.paint("duck egg enamel", "#a9c2c1", 0.25)
BLACK_ENAMEL = m.paint("black enamel", "#26272a", 0.22)


def wall_oven(size: Size, front: Material, cavities: int, knobs: bool = True, trim: Material = m.STEEL) -> Parts:
    """An oven to build into a tall unit: control strip, glass doors, long handles."""
    d, w, h = size
    face = 0.03
    parts = Cavity((d - 0.05, w - 0.03, h - 0.02), (-0.025, 0, 0.008), wall=0.03).body(m.GREY, 0.003)
    strip = 0.11
    x = d / 2 - face - 0.018
    parts += of(front, box((face, w, strip - 0.006), 0.006, 2).moved(x + face / 2, 0, h - strip))
    parts += of(m.SCREEN, box((0.003, 0.11, 0.04), 0.001).moved(x + face, 0, h - strip / 2 - 0.022))
    if knobs:
        for y in (-0.34 * w, -0.22 * w, 0.22 * w, 0.34 * w):
            parts += at(knob(0.017), x + face, y, h - strip / 2)
    else:
        parts += of(
            trim,
            *(
                cylinder(0.009, 0.004, 0.001, 14).turned("y", 90).moved(x + face - 0.001, y, h - strip / 2)
                for y in np.linspace(0.16 * w, 0.38 * w, 4)
            ),
        )
    tall = (h - strip - 0.006) / cavities
    for k in range(cavities):
        z = 0.003 + tall * k
        leaf = of(front, box((face, w, tall - 0.006), 0.006, 2).moved(x + face / 2, 0, z))
        leaf += of(m.DARK_GLASS, box((0.004, w - 0.11, tall - 0.17), 0.002).moved(x + face, 0, z + 0.045))
        leaf += at(bar_handle(w * 0.8, False, trim), x + face - 0.004, 0, z + tall - 0.06)
        parts += drop_front(x + face, z, leaf)
    return parts


def dishwasher(size: Size, front: Material, trim: Material, panelled: bool = False, hidden: bool = False) -> Parts:
    """A dishwasher; its door panelled like a cupboard's, or with the controls hidden in the door's edge."""
    d, w, h = size
    x = d / 2 - 0.05
    parts = Cavity((d - 0.06, w - 0.006, h - 0.1), (-0.025, 0, 0.085), wall=0.02).body(m.LIGHT_GREY)
    parts += of(m.LIGHT_GREY, box((d - 0.05, w, 0.018), 0.004, 2).moved(-0.02, 0, h - 0.018))
    parts += of(
        m.BLACK,
        box((d - 0.14, w - 0.03, 0.09), 0.002).moved(-0.02),
        *four(cylinder(0.02, 0.02, 0.003, 12).moved(d / 2 - 0.12, w / 2 - 0.06)),
    )
    if panelled:
        leaf = door_front(x, 0, 0.095, w - 0.006, h - 0.12, front, trim, "none", 1, "shaker")
        return parts + drop_front(
            x + 0.018, 0.095, leaf + at(bar_handle(w * 0.45, False, trim), x + 0.016, 0, h - 0.07)
        )
    z1 = h - 0.024
    if hidden:
        leaf = of(front, box((0.03, w - 0.006, z1 - 0.095), 0.006, 2).moved(x + 0.015, 0, 0.095))
        return parts + drop_front(x + 0.03, 0.095, leaf + at(bar_handle(w * 0.8, False, trim), x + 0.026, 0, z1 - 0.06))
    leaf = of(
        front,
        box((0.03, w - 0.006, z1 - 0.225), 0.006, 2).moved(x + 0.015, 0, 0.095),
        box((0.034, w - 0.006, 0.115), 0.006, 2).moved(x + 0.014, 0, z1 - 0.118),
    )
    leaf += of(m.SCREEN, box((0.003, 0.1, 0.03), 0.001).moved(x + 0.031, 0.0, z1 - 0.075)) + of(
        trim,
        *(
            cylinder(0.008, 0.005, 0.001, 12).turned("y", 90).moved(x + 0.03, y, z1 - 0.06)
            for y in np.linspace(-0.4 * w, -0.22 * w, 4)
        ),
    )
    leaf += of(m.SHADOW, box((0.02, w * 0.4, 0.02), 0.004).moved(x + 0.026, 0, z1 - 0.13))
    return parts + drop_front(x + 0.031, 0.095, leaf)


def dryer(size: Size, body: Material, trim: Material, square: bool = False) -> Parts:
    """A tumble dryer: a solid door, round or square, a vent grille at the foot."""
    d, w, h = size
    x, zc = d / 2 - 0.038, 0.47 * h
    drum = Cavity((d - 0.04, w, h - 0.045), (-0.018, 0, 0.02), hole=(-0.21, 0.21, zc - 0.21, zc + 0.21))
    parts = drum.body(body, 0.01, 2) + of(body, box((d - 0.02, w, 0.025), 0.008, 2).moved(-0.008, 0, h - 0.025))
    parts += of(m.BLACK, *four(cylinder(0.022, 0.025, 0.003, 12).moved(d / 2 - 0.1, w / 2 - 0.06)))
    parts += of(body, box((0.016, w - 0.012, 0.12), 0.006, 2).moved(x + 0.006, 0, h - 0.15))
    if square:
        leaf = of(trim, box((0.03, 0.4, 0.4), 0.03, 3).moved(x + 0.006, 0, zc - 0.2)) + of(
            body, box((0.018, 0.34, 0.34), 0.02, 2).moved(x + 0.016, 0, zc - 0.17)
        )
        leaf += of(m.SHADOW, box((0.006, 0.03, 0.11), 0.003).moved(x + 0.026, -0.145, zc - 0.055))
    else:
        r = 0.2
        door = (
            lathe(
                [
                    (0.01, 0.032),
                    (0.6 * r, 0.03),
                    (0.78 * r, 0.02),
                    (0.82 * r, 0.016),
                    (0.9 * r, 0.024),
                    (r, 0.014),
                    (r, 0.0),
                    (0.01, -0.002),
                ][::-1],
                44,
            )
            .turned("y", 90)
            .moved(x, 0, zc)
        )
        leaf = of(trim, door) + of(m.SHADOW, box((0.01, 0.03, 0.1), 0.004).moved(x + 0.018, -0.175, zc - 0.05))
    parts += jointed(door_hinge(x + 0.03, 0.205, 1), leaf)
    slots = [box((0.004, 0.2, 0.006), 0.001).moved(x + 0.004, 0.0, z) for z in np.linspace(0.06, 0.11, 5)]
    parts += of(m.SHADOW, *slots) + of(m.SCREEN, box((0.003, 0.1, 0.04), 0.001).moved(x + 0.014, -0.15, h - 0.11))
    return parts + at(knob(0.03), x + 0.014, 0.06, h - 0.09)


def chimney_hood(size: Size, steel: Material, glass: bool = False, duct_w: float = 0.26) -> Parts:
    """A pyramid hood, or a glass blade, under a duct; its back is the wall's."""
    d, w, h = size
    xb = -d / 2
    lip = 0.045
    duct_d = 0.24
    skirt = 0.0 if glass else min(0.24, 0.4 * h)

    def ring(x0: float, x1: float, half: float, z: float) -> list[tuple[float, float, float]]:
        return [(x1, -half, z), (x1, half, z), (x0, half, z), (x0, -half, z)]

    parts = of(
        steel, box((duct_d, duct_w, h - skirt - lip + 0.01), 0.004).moved(xb + duct_d / 2, 0, skirt + lip - 0.01)
    )
    if glass:
        u = np.linspace(-1, 1, 17)
        t = np.linspace(0, 1, 5)[:, None]
        bow = 0.03 * u**2
        sheet = np.stack(
            np.broadcast_arrays(xb + 0.01 + (d - 0.02) * t * (1 - 0.12 * u**2), u * w / 2, 0.03 - bow * 0.6 + 0.0 * t),
            axis=-1,
        )
        parts += of(m.GLASS, slab(sheet[::-1], 0.008)) + of(
            steel, box((duct_d + 0.06, duct_w + 0.16, 0.06), 0.006, 2).moved(xb + duct_d / 2 + 0.03, 0, 0.03)
        )
    else:
        rings = np.array(
            [
                ring(xb, d / 2, w / 2, lip),
                ring(xb, xb + 0.75 * d, 0.36 * w, lip + 0.4 * skirt),
                ring(xb, xb + duct_d + 0.02, duct_w / 2 + 0.02, lip + skirt),
            ]
        )
        parts += of(steel, loft(rings, crease_rad=0.5), box((d, w, lip), 0.006, 2))
    x, lamp = d / 2 - 0.002, 0.0 if not glass else 0.04
    parts += of(
        m.BLACK,
        *(
            cylinder(0.007, 0.004, 0.001, 12)
            .turned("y", 90)
            .moved((x if not glass else xb + duct_d + 0.055), y, (lip / 2 if not glass else 0.06))
            for y in np.linspace(-0.05, 0.05, 4)
        ),
    )
    parts += of(
        m.LAMP_GLOW,
        *both_sides(
            cylinder(0.03, 0.006, 0.002, 18).moved(
                xb + 0.5 * d if not glass else xb + 0.15, 0.22 * w if not glass else 0.1, -0.002 + lamp * 0.7
            )
        ),
    )
    if not glass:
        parts += of(m.GREY, *both_sides(box((0.62 * d, 0.4 * w, 0.006), 0.002).moved(0, 0.22 * w, -0.003)))
    return parts


def canopy_hood(size: Size, body: Material, trim: Material) -> Parts:
    """A plastered country hood that swells out over a wooden or metal ledge."""
    d, w, h = size
    xb = -d / 2
    v = np.linspace(0, 1, 11)
    rings = []
    for t in v:
        ease = (1 - t) ** 1.8
        x1 = xb + 0.3 + (d - 0.34) * ease
        half = (0.30 + 0.18 * ease) * w
        z = 0.09 + (h - 0.09) * t
        r = 0.03
        rings.append(
            [
                (x1, -half + r, z),
                (x1, half - r, z),
                (x1 - r, half, z),
                (xb, half, z),
                (xb, -half, z),
                (x1 - r, -half, z),
            ]
        )
    return of(body, loft(np.array(rings), crease_rad=0.7)) + of(
        trim, box((d, w, 0.1), 0.012, 2), box((d - 0.012, w - 0.02, 0.03), 0.006).moved(z=0.085)
    )


def under_hood(size: Size, body: Material) -> Parts:
    """A flat hood to hang under a cupboard: visor, slider, filters."""
    d, w, h = size
    return (
        of(
            body,
            box((d - 0.05, w, h), 0.008, 2).moved(-0.025),
            box((0.06, w, 0.05), 0.012, 2).moved(d / 2 - 0.03, 0, 0.01),
        )
        + of(m.GREY, *both_sides(box((0.7 * d, 0.42 * w, 0.008), 0.002).moved(-0.03, 0.24 * w, -0.004)))
        + of(
            m.BLACK,
            *(box((0.004, 0.02, 0.012), 0.001).moved(d / 2 - 0.0, y, 0.03) for y in np.linspace(-0.06, 0.06, 4)),
        )
    )


def pipe_hood(size: Size, steel: Material, band: Material) -> Parts:
    """A workshop hood: a truncated cone of sheet steel with riveted bands and a round duct."""
    d, w, h = size
    n = 40
    a = np.arange(n) * 2 * np.pi / n
    square = 6.0
    reach = (np.abs(np.cos(a)) ** square + np.abs(np.sin(a)) ** square) ** (-1 / square)
    low = np.column_stack([np.cos(a) * reach * d / 2, np.sin(a) * reach * w / 2])
    r = 0.11
    high = np.column_stack([np.cos(a) * r - d / 2 + 0.13, np.sin(a) * r])
    rows = [(low, 0.0), (low, 0.07), (low * 0.3 + high * 0.7, 0.30 * h), (high, 0.38 * h), (high, h)]
    rings = np.array([np.column_stack([xy, np.full(n, z)]) for xy, z in rows])
    bands = [
        tube(np.column_stack([low * 1.0, np.full(n, 0.07)]), 0.007, 6, closed=True),
        *(
            tube(
                np.column_stack([np.cos(a) * (r + 0.003) - d / 2 + 0.13, np.sin(a) * (r + 0.003), np.full(n, z)]),
                0.006,
                6,
                closed=True,
            )
            for z in (0.4 * h, 0.7 * h)
        ),
    ]
    rivets = [
        rod((d / 2 - 0.004, y, 0.035), (d / 2 + 0.003, y, 0.035), 0.006, segments=7)
        for y in np.linspace(-0.36 * w, 0.36 * w, 7)
    ]
    return of(steel, loft(rings, crease_rad=0.5)) + of(band, *bands, *rivets)


def range_cooker(size: Size, enamel: Material, trim: Material, doors: int = 3) -> Parts:
    """A country range: several oven doors under a rail, hot plates with domed lids or gas rings."""
    d, w, h = size
    top = h - 0.09
    parts = of(enamel, box((d - 0.05, w, top - 0.1), 0.008, 2).moved(-0.025, 0, 0.07)) + of(
        m.BLACK,
        box((d - 0.12, w - 0.06, 0.08), 0.003).moved(-0.03),
        box((d - 0.01, w + 0.004, 0.03), 0.008, 2).moved(-0.005, 0, top - 0.03),
    )
    x = d / 2 - 0.05
    cols = 2
    rows = (doors + 1) // 2
    strip = 0.11
    each_w, each_h = (w - 0.04) / cols, (top - 0.16 - strip) / rows
    for k in range(cols * rows):
        y = -w / 2 + 0.02 + each_w * (k % cols + 0.5)
        z = 0.1 + each_h * (k // cols)
        parts += of(enamel, box((0.03, each_w - 0.016, each_h - 0.016), 0.016, 3).moved(x + 0.012, y, z))
        side = 1 if k % 2 == 0 else -1
        parts += of(
            trim,
            rod(
                (x + 0.05, y + side * (each_w / 2 - 0.05), z + each_h * 0.5),
                (x + 0.05, y + side * (each_w / 2 - 0.16), z + each_h * 0.5),
                0.008,
            ),
            rod(
                (x + 0.02, y + side * (each_w / 2 - 0.06), z + each_h * 0.5),
                (x + 0.05, y + side * (each_w / 2 - 0.06), z + each_h * 0.5),
                0.007,
            ),
        )
    for y in np.linspace(-0.4 * w, 0.4 * w, 6):
        parts += at(knob(0.018), x + 0.004, float(y), top - 0.09)
    parts += of(
        trim,
        rod((x + 0.045, -0.47 * w, top - 0.035), (x + 0.045, 0.47 * w, top - 0.035), 0.011),
        *both_sides(rod((x, 0.45 * w, top - 0.035), (x + 0.045, 0.45 * w, top - 0.035), 0.009)),
    )
    parts += of(enamel, box((0.03, w, 0.1), 0.01, 2).moved(-d / 2 + 0.015, 0, top - 0.012))
    return parts + burners(d, w, top, "gas")


DESIGNS: tuple[Design, ...] = (
    design("refrigerator", "retro-cream", "cream refrigerator with rounded corners", (0.70, 0.60, 1.52), "classic", refrigerator, body=CREAM_ENAMEL, layout="single", round_edge=0.028),
    design("refrigerator", "retro-blue", "duck egg fridge freezer with rounded corners", (0.70, 0.62, 1.72), "rustic", refrigerator, body=BLUE_ENAMEL, layout="top", round_edge=0.028),
    design("refrigerator", "black-steel", "black steel fridge freezer", (0.70, 0.70, 1.85), "industrial", refrigerator, body=m.CHARCOAL, layout="bottom", round_edge=0.006),
    design("stove", "range-cream", "cream country range", (0.66, 1.00, 0.98), "rustic", range_cooker, enamel=CREAM_ENAMEL, trim=m.CHROME, doors=4),
    design("stove", "range-red", "red range cooker", (0.64, 0.90, 0.98), "classic", range_cooker, enamel=RED_ENAMEL, trim=m.BRASS, doors=2),
    design("stove", "range-steel", "professional steel range", (0.70, 0.92, 1.00), "industrial", stove, body=m.STAINLESS, hob="gas"),
    design("stove", "plain-white", "plain white cooker with a glass hob", (0.60, 0.60, 0.90), "minimal", stove, body=m.WHITE, hob="glass"),
    design("microwave", "professional", "steel microwave with a drop handle", (0.42, 0.54, 0.33), "industrial", microwave, body=m.CHARCOAL),
    design("microwave", "cream-oven", "cream countertop oven with knobs", (0.36, 0.46, 0.28), "rustic", microwave, body=CREAM_ENAMEL, kind="oven"),
    design("wall oven", "steel-single", "stainless-steel built-in oven", (0.56, 0.595, 0.595), "modern", wall_oven, front=m.STAINLESS, cavities=1),
    design("wall oven", "black-double", "black glass double oven", (0.57, 0.595, 0.89), "minimal", wall_oven, front=BLACK_ENAMEL, cavities=2, knobs=False),
    design("wall oven", "cream-single", "cream built-in oven with brass handle", (0.56, 0.595, 0.60), "classic", wall_oven, front=CREAM_ENAMEL, cavities=1, trim=m.BRASS),
    design("wall oven", "steel-double", "stainless-steel double oven", (0.57, 0.60, 1.05), "industrial", wall_oven, front=m.STAINLESS, cavities=2),
    design("wall oven", "duck-egg", "duck egg built-in oven", (0.56, 0.595, 0.62), "rustic", wall_oven, front=BLUE_ENAMEL, cavities=1, trim=m.STEEL),
    design("dishwasher", "white", "white dishwasher", (0.60, 0.60, 0.85), "minimal", dishwasher, front=m.WHITE, trim=m.GREY),
    design("dishwasher", "slim-steel", "slimline steel dishwasher", (0.58, 0.45, 0.84), "industrial", dishwasher, front=m.STAINLESS, trim=m.STEEL, hidden=True),
    design("dishwasher", "panelled-sage", "dishwasher behind a panelled sage door", (0.59, 0.60, 0.86), "classic", dishwasher, front=m.SAGE, trim=m.BRASS, panelled=True),
    design("dishwasher", "panelled-cream", "dishwasher behind a cream country door", (0.59, 0.60, 0.86), "rustic", dishwasher, front=m.CREAM, trim=m.IRON, panelled=True),
    design("washing machine", "slim-black", "slim black washing machine", (0.48, 0.60, 0.85), "industrial", washing_machine, body=m.CHARCOAL, trim=m.STEEL),
    design("washing machine", "duck-egg", "duck egg washing machine", (0.58, 0.60, 0.86), "rustic", washing_machine, body=BLUE_ENAMEL, trim=m.CHROME),
    design("washing machine", "cream", "cream washing machine", (0.58, 0.60, 0.86), "classic", washing_machine, body=CREAM_ENAMEL, trim=m.CHROME),
    design("dryer", "white", "white tumble dryer", (0.60, 0.60, 0.85), "minimal", dryer, body=m.WHITE, trim=m.LIGHT_GREY),
    design("dryer", "graphite", "graphite tumble dryer", (0.62, 0.60, 0.85), "modern", dryer, body=m.CHARCOAL, trim=m.BLACK),
    design("dryer", "square-door", "white clothes dryer with a square door", (0.66, 0.68, 0.94), "classic", dryer, body=m.WHITE, trim=m.WHITE, square=True),
    design("dryer", "cream", "cream tumble dryer", (0.60, 0.60, 0.86), "rustic", dryer, body=CREAM_ENAMEL, trim=m.CHROME),
    design("dryer", "steel", "stainless-steel tumble dryer", (0.64, 0.60, 0.86), "industrial", dryer, body=m.STAINLESS, trim=m.GREY),
    design("range hood", "chimney-steel", "stainless-steel chimney hood", (0.50, 0.90, 0.82), "modern", chimney_hood, steel=m.STAINLESS),
    design("range hood", "glass", "cooker hood with a curved glass blade", (0.48, 0.80, 0.78), "minimal", chimney_hood, steel=m.STAINLESS, glass=True),
    design("range hood", "chimney-black", "black chimney hood", (0.48, 0.60, 0.80), "industrial", chimney_hood, steel=m.BLACK_STEEL, duct_w=0.22),
    design("range hood", "plaster", "plastered country hood with an oak ledge", (0.55, 1.10, 0.90), "rustic", canopy_hood, body=m.paint("lime plaster", "#ded6c6", 0.95), trim=m.OAK),
    design("range hood", "duck-egg", "duck egg canopy hood with a brass ledge", (0.52, 0.95, 0.85), "classic", canopy_hood, body=s.DUCK_EGG, trim=m.BRASS),
    design("range hood", "under-cabinet", "flat white cooker hood", (0.48, 0.60, 0.14), "minimal", under_hood, body=m.WHITE),
    design("range hood", "under-cabinet-steel", "wide stainless-steel hood under a cupboard", (0.50, 0.90, 0.13), "modern", under_hood, body=m.STAINLESS),
    design("range hood", "workshop", "iron hood with a round duct", (0.52, 0.85, 0.88), "industrial", pipe_hood, steel=m.IRON, band=m.BLACK_STEEL),
)  # fmt: skip
