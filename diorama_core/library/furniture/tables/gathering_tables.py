"""Dining tables that extend, fold, stand on two columns or on cast iron."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.tables.dining_tables import trestle_table
from diorama_core.library.furniture.tables.tops import leg_table, pedestal_table, table_top


def extending_table(
    size: Size, top: Material, frame: Material, profile: Leg, leaves: int = 1, oval: bool = False
) -> Parts:
    """A top parted by leaves, seams showing, over an apron on four legs."""
    d, w, h = size
    t, seam, leaf = 0.03, 0.003, 0.45
    ends = (w - leaves * leaf) / 2 - seam
    parts: Parts = []
    for k in range(leaves):
        y = -leaves * leaf / 2 + leaf * (k + 0.5)
        parts += of(top, box((d, leaf - seam, t), 0.004, 2).moved(0, y, h - t))
    for f in (1, -1):
        if oval:
            a = np.linspace(-np.pi / 2, np.pi / 2, 25) if f > 0 else np.linspace(np.pi / 2, 3 * np.pi / 2, 25)
            outline = (
                np.column_stack([d / 2 * np.sin(a) * -1, np.cos(a) * ends])
                if f > 0
                else np.column_stack([-d / 2 * np.sin(a), np.cos(a) * ends])
            )
            parts += of(top, prism(outline, t, 0.007).moved(0, f * leaves * leaf / 2, h - t))
        else:
            parts += of(top, box((d, ends, t), 0.006, 2).moved(0, f * (w / 2 - ends / 2), h - t))
    inset_x, inset_y = (0.26 * d if oval else 0.06), (0.22 * w if oval else 0.07)
    x, y = d / 2 - inset_x, w / 2 - inset_y
    parts += of(frame, *four(leg(profile, x, y, h - t, 0.07, 0.05)))
    z = h - t - 0.045
    return parts + of(
        frame,
        *(beam((f * x, -y, z), (f * x, y, z), 0.022, 0.09) for f in (1, -1)),
        *both_sides(beam((-x, y, z), (x, y, z), 0.022, 0.09)),
    )


def drop_leaf_table(size: Size, wood: Material, open_leaf: bool = True) -> Parts:
    """A gate-leg table: a narrow middle, one leaf up on its gate, the other hanging."""
    d, w, h = size
    t = 0.022
    middle = 0.4 * w
    leaf = (w - middle) if open_leaf else 0.0
    y0 = -w / 2
    parts = of(wood, box((d, middle, t), 0.005, 2).moved(0, y0 + middle / 2 + 0.012, h - t))
    if open_leaf:
        a = np.linspace(-np.pi / 2, np.pi / 2, 25)
        half = np.column_stack([-np.sin(a) * d / 2, np.cos(a) ** 0.8 * leaf * 0.98])
        parts += of(wood, prism(half, t, 0.005).moved(0, y0 + middle + 0.016, h - t))
    drop = rounded_rectangle(0.42, d, 0.12, 6)
    parts += of(wood, prism(drop, 0.02, 0.005).turned("y", 90).turned("z", 90).moved(0, y0 + 0.02, h - t - 0.215))
    x, ya, yb = d / 2 - 0.09, y0 + 0.08, y0 + middle - 0.04
    turned = [leg("turned", sx * x, y, h - t, 0.05) for sx in (1, -1) for y in (ya, yb)]
    rails = [
        beam((sx * x, ya, z), (sx * x, yb, z), 0.022, tall)
        for sx in (1, -1)
        for z, tall in ((h - t - 0.05, 0.09), (0.09, 0.035))
    ]
    rails += [
        beam((-x, y, z), (x, y, z), 0.022, tall) for y in (ya, yb) for z, tall in ((h - t - 0.05, 0.09), (0.09, 0.035))
    ]
    if open_leaf:
        gy = y0 + middle + leaf * 0.55
        turned.append(leg("turned", 0.0001, gy, h - t, 0.045))
        rails += [beam((-x * 0.6, yb, z), (0, gy, z), 0.022, 0.035) for z in (0.1, h - t - 0.05)]
    return parts + of(wood, *turned, *rails)


def double_pedestal_table(size: Size, wood: Material, outline: str = "soft") -> Parts:
    """A long table on two columns, each on three bowed feet."""
    d, w, h = size
    t = 0.034
    z = h - t
    y = 0.27 * w
    column = lathe(
        [(0.05, 0.2), (0.07, 0.24), (0.045, 0.3), (0.05, 0.36), (0.072, 0.46), (0.05, 0.56), (0.045, 0.6), (0.085, z)],
        24,
    )
    path = bend([(0.03, 0, 0.3), (0.2 * d, 0, 0.22), (0.36 * d, 0, 0.06), (0.44 * d, 0, 0.02)], 5)
    foot = tube(path, np.linspace(0.036, 0.022, len(path)), 10)
    one = [
        column,
        foot,
        foot.turned("z", 180),
        foot.scaled(x=0.8).turned("z", 90),
        box((0.6 * d, 0.09, 0.03), 0.006).moved(z=z - 0.03),
    ]
    apron = [
        beam((sx * 0.36 * d, -0.4 * w, z - 0.03), (sx * 0.36 * d, 0.4 * w, z - 0.03), 0.02, 0.05) for sx in (1, -1)
    ]
    return of(wood, table_top(d, w, t, outline).moved(z=z), *both_sides(*(q.moved(0, y) for q in one)), *apron)


def cast_base_table(size: Size, top: Material, iron: Material, outline: str = "round") -> Parts:
    """A café table: a ribbed iron column on a spread foot."""
    d, w, h = size
    t = 0.028
    z = h - t
    r = 0.36 * min(d, w)
    feet = [
        tube(
            bend([(0.035, 0, 0.16), (0.4 * r, 0, 0.1), (0.9 * r, 0, 0.03), (1.05 * r, 0, 0.012)], 5),
            np.linspace(0.026, 0.012, 16),
            8,
        ).turned("z", 45 + 90 * k)
        for k in range(4)
    ]
    column = lathe(
        [
            (0.05, 0.1),
            (0.06, 0.14),
            (0.034, 0.2),
            (0.028, 0.5 * z),
            (0.034, 0.85 * z),
            (0.06, z - 0.03),
            (0.1, z - 0.006),
            (0.1, z),
        ],
        24,
    )
    band = [cylinder(0.04, 0.02, 0.006, 20).moved(z=k) for k in (0.24, 0.55 * z)]
    cross = [
        box((0.5 * d, 0.04, 0.008), 0.002).moved(z=z - 0.008),
        box((0.04, 0.5 * w, 0.008), 0.002).moved(z=z - 0.008),
    ]
    edge = tube(
        np.column_stack(
            [superellipse(d - 0.008, w - 0.008, 2.0 if outline == "round" else 12, 48), np.full(48, z + t / 2)]
        ),
        0.009,
        6,
        closed=True,
    )
    return of(top, table_top(d - 0.01, w - 0.01, t, outline).moved(z=z)) + of(iron, *feet, column, *band, *cross, edge)


def sawhorse_table(size: Size, top: Material, legs: Material) -> Parts:
    """A plain board on two sawhorses."""
    d, w, h = size
    t, y, x = 0.032, w / 2 - 0.28, d / 2 - 0.06
    z = h - t
    one = [
        *(
            rod((f * x, y + g * 0.16, 0), (f * (x - 0.03), y + g * 0.03, z - 0.03), 0.018, 0.02)
            for f in (1, -1)
            for g in (1, -1)
        ),
        beam((-x - 0.02, y, z - 0.03), (x + 0.02, y, z - 0.03), 0.05, 0.06),
        *(rod((-x, y + g * 0.11, 0.26), (x, y + g * 0.11, 0.26), 0.012) for g in (1, -1)),
    ]
    return of(top, table_top(d, w, t, "square").moved(z=z)) + of(legs, *both_sides(*one))


def plinth_table(size: Size, top: Material, base: Material, outline: str = "oval") -> Parts:
    """A thick top on two fluted half-columns."""
    d, w, h = size
    t = 0.036
    n = 72
    a = np.arange(n) * 2 * np.pi / n
    flute = 1 + 0.02 * np.abs(np.sin(18 * a))
    ring = np.column_stack([np.cos(a) * 0.26 * d * flute, np.sin(a) * 0.15 * w * flute])
    drum = prism(ring, h - t, 0.006)
    return of(top, table_top(d, w, t, outline).moved(z=h - t)) + of(base, *both_sides(drum.moved(0, 0.22 * w)))


DESIGNS: tuple[Design, ...] = (
    design("table", "extending-oak", "extending oak dining table with one leaf", (0.90, 1.75, 0.76), "modern", extending_table, 2, top=m.OAK, frame=m.OAK, profile="taper"),
    design("table", "extending-mahogany", "oval extending mahogany table", (1.05, 2.10, 0.77), "classic", extending_table, 2, top=m.MAHOGANY, frame=m.MAHOGANY, profile="turned", leaves=2, oval=True),
    design("table", "extending-white", "white extending table on birch legs", (0.85, 1.60, 0.74), "minimal", extending_table, 2, top=m.WHITE, frame=m.BIRCH, profile="slim"),
    design("table", "gate-leg", "oak gate-leg table with one leaf up", (0.85, 1.05, 0.75), "rustic", drop_leaf_table, wood=m.OAK),
    design("table", "double-pedestal", "mahogany dining table on two pedestals", (1.05, 2.30, 0.77), "classic", double_pedestal_table, 2, wood=m.MAHOGANY),
    design("table", "double-walnut", "oval walnut dining table on two pedestals", (1.10, 2.00, 0.76), "classic", double_pedestal_table, 2, wood=m.WALNUT, outline="oval"),
    design("table", "cafe-marble", "round marble café table on cast iron", (0.70, 0.70, 0.74), "classic", cast_base_table, 4, top=m.MARBLE, iron=m.IRON),
    design("table", "cafe-reclaimed", "square reclaimed-wood table on cast iron", (0.75, 0.75, 0.75), "industrial", cast_base_table, 4, top=m.RECLAIMED, iron=m.BLACK_STEEL, outline="square"),
    design("table", "sawhorse-pine", "pine table on sawhorses", (0.80, 1.70, 0.73), "rustic", sawhorse_table, 2, top=m.PINE, legs=m.PINE),
    design("table", "sawhorse-white", "white table top on birch sawhorses", (0.75, 1.50, 0.74), "minimal", sawhorse_table, 2, top=m.WHITE, legs=m.BIRCH),
    design("table", "fluted-oak", "oval smoked-oak table on fluted columns", (1.00, 2.20, 0.75), "modern", plinth_table, 2, top=s.SMOKED_OAK, base=s.SMOKED_OAK),
    design("table", "factory-long", "long reclaimed-wood table on steel hoops", (0.95, 2.40, 0.77), "industrial", trestle_table, 2, top=m.RECLAIMED, frame=m.BLACK_STEEL, kind="box"),
    design("table", "farm-whitewash", "farmhouse table with whitewashed legs", (0.90, 1.90, 0.78), "rustic", leg_table, 2, top=m.OAK, legs=m.WHITEWASH, shape="turned", apron=0.1),
    design("table", "bar-round", "high round walnut table on cast iron", (0.70, 0.70, 1.05), "industrial", cast_base_table, 4, top=m.WALNUT, iron=m.BLACK_STEEL),
    design("table", "counter-birch", "counter-height birch table", (0.75, 1.40, 0.90), "minimal", leg_table, 2, top=m.BIRCH, legs=m.BIRCH, shape="square", apron=0.07),
    design("table", "child-pine", "low pine table for children", (0.55, 0.75, 0.50), "rustic", leg_table, 2, top=m.PINE, legs=m.PINE, shape="taper", apron=0.06),
    design("table", "round-smoked", "round smoked-oak table on a drum", (1.30, 1.30, 0.75), "modern", pedestal_table, 4, top=s.SMOKED_OAK, foot=s.SMOKED_OAK, kind="drum"),
)  # fmt: skip
