"""Coffee, side and console tables in more shapes and styles."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.legs import Leg
from diorama_core.library.furniture.storage.chests import trunk
from diorama_core.library.furniture.tables.tops import frame_table, table_top


def nesting_tables(size: Size, tops: tuple[Material, ...], legs: Material, outline: str = "round") -> Parts:
    """A large low table with a smaller, lower one half under it."""
    d, w, h = size
    big, small = 0.70 * w, 0.52 * w
    parts: Parts = []
    for k, (width, tall, x, y) in enumerate(
        ((big, h, -(d - min(big, d)) / 2, (w - big) / 2), (small, h * 0.78, (d - min(small, d)) / 2, -(w - small) / 2))
    ):
        deep = min(width, d) if outline == "round" else width * d / w
        sticks = [
            rod((0.42 * deep * c, 0.42 * width * sn, 0), (0.32 * deep * c, 0.32 * width * sn, tall - 0.02), 0.009)
            for c, sn in ((np.cos(a), np.sin(a)) for a in np.deg2rad([60, 180, 300]))
        ]
        hoop = tube(
            np.column_stack([superellipse(0.66 * deep, 0.66 * width, 2, 32), np.full(32, tall - 0.03)]),
            0.008,
            6,
            closed=True,
        )
        parts += shifted(
            of(tops[k % len(tops)], table_top(deep, width, 0.022, outline).moved(z=tall - 0.022))
            + of(legs, *sticks, hoop),
            x,
            y,
        )
    return parts


def drawer_coffee_table(size: Size, style: Style, drawers: int = 1, shelf: bool = True) -> Parts:
    """A low table in any style: apron with drawers, shelf between the legs."""
    d, w, h = size
    t, apron = 0.03, 0.11 if drawers else 0.06
    thick = 0.05
    lean = 0.1 if h < 0.6 else 0.04
    inset = lean * (h - t) if style.leg == "splay" else 0.0
    x, y = d / 2 - 0.045 - inset, w / 2 - 0.05 - inset
    parts = of(style.top or style.wood, box((d, w, t), style.edge_m, 2).moved(z=h - t))
    parts += of(style.frame, *four(leg(style.leg, x, y, h - t, thick, lean)))
    parts += of(style.wood, box((2 * x + 0.01, 2 * y + 0.01, apron), 0.004).moved(z=h - t - apron))
    for k in range(drawers):
        each = (2 * y - 0.06) / drawers
        parts += drawer_front(
            x + 0.002,
            -y + 0.03 + each * (k + 0.5),
            h - t - apron + 0.008,
            each - 0.01,
            apron - 0.016,
            style.wood,
            style.fitting,
            "knob" if style.handle == "none" else style.handle,
        )
    if shelf:
        planks = 4
        each_x = (2 * x - 0.02) / planks
        parts += of(
            style.wood,
            *(
                box((each_x - 0.006, 2 * y - 0.01, 0.02), 0.004).moved(-x + 0.01 + each_x * (k + 0.5), 0, 0.13)
                for k in range(planks)
            ),
        )
    return parts


def waterfall_table(size: Size, wood: Material, shelf: bool = False) -> Parts:
    """One thick board bent down at both ends; a shelf between them when asked."""
    d, w, h = size
    t = 0.035
    parts = of(
        wood,
        box((d, w, t), 0.012, 3).moved(z=h - t),
        *both_sides(box((d, t, h - 0.005), 0.012, 3).moved(0, w / 2 - t / 2)),
    )
    return parts + (of(wood, box((d - 0.02, w - 2 * t + 0.004, 0.022), 0.004).moved(z=0.32 * h)) if shelf else [])


def c_table(size: Size, top: Material, steel: Material) -> Parts:
    """A top on one side only, its foot to slide under a sofa."""
    d, w, h = size
    bar = 0.024
    post = [box((bar, bar, h - 0.02), 0.003).moved(-d / 2 + bar / 2, f * (w / 2 - bar / 2)) for f in (1, -1)]
    foot = [box((d, bar, bar), 0.003).moved(0, f * (w / 2 - bar / 2)) for f in (1, -1)]
    rails = [box((bar, w, bar), 0.003).moved(-d / 2 + bar / 2, 0, z) for z in (0, h - 0.02 - bar)]
    arms = [box((d - 0.03, bar, bar), 0.003).moved(0, f * (w / 2 - bar / 2), h - 0.02 - bar) for f in (1, -1)]
    return of(top, box((d, w, 0.022), 0.006, 2).moved(z=h - 0.022)) + of(steel, *post, *foot, *rails, *arms)


def pie_crust_table(size: Size, wood: Material) -> Parts:
    """A wine table: scalloped rim, turned column, three bowed feet."""
    d, _, h = size
    a = np.arange(64) * 2 * np.pi / 64
    ring = np.column_stack([np.cos(a), np.sin(a)]) * (d / 2 * (1 - 0.03 * np.abs(np.sin(6 * a))))[:, None]
    rim = tube(np.column_stack([ring * 0.98, np.full(64, h - 0.008)]), 0.008, 6, closed=True)
    column = lathe(
        [
            (0.026, 0.17),
            (0.04, 0.2),
            (0.022, 0.26),
            (0.03, 0.36),
            (0.038, 0.42),
            (0.022, 0.5),
            (0.02, h - 0.06),
            (0.06, h - 0.024),
        ],
        20,
    )
    feet = [
        tube(
            bend([(0.02, 0, 0.23), (0.2 * d, 0, 0.19), (0.36 * d, 0, 0.05), (0.46 * d, 0, 0.014)], 5),
            np.linspace(0.024, 0.013, 16),
            8,
        ).turned("z", 60 + 120 * k)
        for k in range(3)
    ]
    return of(wood, prism(ring, 0.018, 0.005).moved(z=h - 0.024), rim, column, *feet)


def drum_table(size: Size, side: Material, top: Material, ribs: int = 0, band: Material | None = None) -> Parts:
    """A round drum; fluted when `ribs` is given, with metal bands when `band` is."""
    d, _, h = size
    n = 96
    a = np.arange(n) * 2 * np.pi / n
    r = d / 2 * (1 - (0.02 * np.abs(np.sin(ribs * a / 2)) if ribs else 0.0))
    ring = np.column_stack([np.cos(a) * r, np.sin(a) * r])
    parts = of(side, prism(ring * 0.97, h - 0.02, 0.004)) + of(
        top, prism(superellipse(d, d, 2, 56), 0.024, 0.008).moved(z=h - 0.024)
    )
    if band is not None:
        parts += of(
            band,
            *(
                lathe(
                    [
                        (d * 0.485, z),
                        (d * 0.489, z + 0.003),
                        (d * 0.489, z + 0.027),
                        (d * 0.485, z + 0.03),
                        (d * 0.48, z + 0.015),
                    ],
                    48,
                )
                for z in (0.06 * h, h - 0.024 - 0.1 * h)
            ),
        )
    return parts


def sculpted_glass_table(size: Size, wood: Material) -> Parts:
    """A free-form glass top on two leaning wooden fins."""
    d, w, h = size
    a = np.arange(64) * 2 * np.pi / 64
    wobble = 1 + 0.07 * np.cos(3 * a + 0.7)
    reach = (np.abs(np.cos(a)) ** 2.6 + np.abs(np.sin(a)) ** 2.6) ** (-1 / 2.6)
    ring = np.column_stack([np.cos(a) * reach * wobble * d / 2.1, np.sin(a) * reach * wobble * w / 2.1])
    path = bend(
        [(-0.3 * d, -0.26 * w, 0.05), (-0.1 * d, -0.2 * w, 0.05), (0.15 * d, 0, 0.12), (0.24 * d, 0.16 * w, h - 0.03)],
        7,
    )
    fin = tube(path, np.interp(np.linspace(0, 1, len(path)), [0, 0.2, 0.6, 1], [0.03, 0.05, 0.045, 0.022]), 12)
    return of(m.GLASS, prism(ring, 0.014, 0.004).moved(z=h - 0.014)) + of(wood, fin, fin.turned("z", 180))


def pillow_table(size: Size, stone: Material) -> Parts:
    """A top and three fat legs of one stone."""
    d, w, h = size
    legs = [
        cylinder(0.11 * min(d, w) + 0.02, h - 0.03, 0.01, 32).moved(0.28 * d * np.cos(a), 0.30 * w * np.sin(a))
        for a in np.deg2rad([90, 210, 330])
    ]
    return of(stone, table_top(d, w, 0.045, "oval").moved(z=h - 0.045), *legs)


def tray_ottoman_table(size: Size, cloth: Material, tray: Material, wood: Material) -> Parts:
    """A low upholstered bench with a wooden tray across it."""
    d, w, h = size
    pad_h = h - 0.03
    return (
        of(wood, *four(leg("bun", d / 2 - 0.09, w / 2 - 0.1, 0.1, 0.07)))
        + of(
            cloth,
            box((d - 0.01, w - 0.01, pad_h - 0.14), 0.03, 2).moved(z=0.09),
            cushion((d, w, 0.13), 11, 4, 12).moved(z=pad_h - 0.13),
        )
        + of(
            tray,
            box((0.86 * d, 0.46 * w, 0.016), 0.004).moved(z=h - 0.04),
            *both_sides(box((0.86 * d, 0.014, 0.05), 0.005).moved(0, 0.23 * w, h - 0.045)),
            *(box((0.014, 0.46 * w, 0.04), 0.005).moved(f * 0.43 * d, 0, h - 0.045) for f in (1, -1)),
        )
    )


def demilune_table(size: Size, wood: Material, profile: Leg, drawer: bool = False, metal: Material = m.BRASS) -> Parts:
    """A half-round console against a wall."""
    d, w, h = size
    t = 0.024
    a = np.linspace(-np.pi / 2, np.pi / 2, 33)
    half = np.column_stack([np.cos(a) * d - d / 2, np.sin(a) * w / 2])
    inner = np.column_stack([np.cos(a) * (d - 0.035) - d / 2, np.sin(a) * (w / 2 - 0.035)])
    spots = [
        (-d / 2 + 0.04, 0.44 * w),
        (-d / 2 + 0.04, -0.44 * w),
        (-d / 2 + 0.78 * d, 0.2 * w),
        (-d / 2 + 0.78 * d, -0.2 * w),
    ]
    legs = [leg(profile, x, y, h - t - 0.02, 0.036) for x, y in spots]
    parts = of(wood, prism(half, t, 0.008).moved(z=h - t), prism(inner, 0.09, 0.003).moved(z=h - t - 0.09), *legs)
    if drawer:
        knob = cylinder(0.012, 0.024, 0.004, 14).turned("y", 90).moved(d / 2 - 0.036, 0, h - t - 0.045)
        parts += of(metal, knob)
    return parts


def styled_console(size: Size, style: Style, drawers: int = 2, shelf: bool = True) -> Parts:
    """A console table in any style."""
    return drawer_coffee_table(size, style, drawers, shelf)


DESIGNS: tuple[Design, ...] = (
    design("coffee table", "nesting-marble", "pair of round marble tables on brass", (0.80, 1.10, 0.44), "modern", nesting_tables, tops=(m.MARBLE, m.MARBLE), legs=m.BRASS),
    design("coffee table", "nesting-oak", "pair of round oak and black tables", (0.82, 1.15, 0.42), "minimal", nesting_tables, tops=(m.LIGHT_OAK, m.BLACK_WOOD), legs=m.BLACK_STEEL),
    design("coffee table", "drawer-mahogany", "mahogany coffee table with drawers", (0.65, 1.15, 0.46), CLASSIC, drawer_coffee_table, 1, drawers=2),
    design("coffee table", "drawer-pine", "pine coffee table with a slatted shelf", (0.65, 1.10, 0.45), RUSTIC, drawer_coffee_table, 1, drawers=1),
    design("coffee table", "steel-shelf", "reclaimed-wood coffee table on steel", (0.65, 1.20, 0.42), INDUSTRIAL, drawer_coffee_table, 2, drawers=0),
    design("coffee table", "waterfall-walnut", "walnut waterfall coffee table", (0.60, 1.20, 0.38), "modern", waterfall_table, 2, wood=m.WALNUT, shelf=True),
    design("coffee table", "sculpted-glass", "sculpted walnut coffee table with a glass top", (0.90, 1.25, 0.41), "modern", sculpted_glass_table, 1, wood=m.WALNUT),
    design("coffee table", "travertine", "oval stone coffee table on three legs", (0.75, 1.20, 0.36), "minimal", pillow_table, 1, stone=m.Material("travertine", "clay", "#cfc0a8", 0.6, 0.0, 0.6)),
    design("coffee table", "trunk", "leather trunk as a coffee table", (0.62, 1.05, 0.44), "industrial", trunk, hide=s.COGNAC_LEATHER, straps=m.DARK_WALNUT, metal=m.IRON),
    design("coffee table", "tray-linen", "linen coffee-table ottoman with an oak tray", (0.75, 1.15, 0.45), "classic", tray_ottoman_table, 2, cloth=m.LINEN, tray=m.OAK, wood=m.DARK_WALNUT),
    design("side table", "c-walnut", "walnut C-shaped side table", (0.32, 0.48, 0.62), "modern", c_table, top=m.WALNUT, steel=m.BRASS),
    design("side table", "c-reclaimed", "reclaimed-wood sofa table on a steel C", (0.34, 0.50, 0.60), "industrial", c_table, top=m.RECLAIMED, steel=m.BLACK_STEEL),
    design("side table", "pie-crust", "mahogany wine table with a scalloped rim", (0.42, 0.42, 0.60), "classic", pie_crust_table, 3, wood=m.MAHOGANY),
    design("side table", "fluted-white", "white fluted drum side table", (0.42, 0.42, 0.50), "modern", drum_table, 36, side=m.WHITE, top=m.WHITE, ribs=40),
    design("side table", "barrel-oak", "oak barrel side table with iron bands", (0.44, 0.44, 0.55), "rustic", drum_table, 36, side=m.OAK, top=m.OAK, band=m.IRON),
    design("side table", "concrete-drum", "concrete drum side table", (0.40, 0.40, 0.46), "industrial", drum_table, 36, side=m.CONCRETE, top=m.CONCRETE),
    design("side table", "drawer-cherry", "cherry side table with a drawer", (0.42, 0.46, 0.62), CLASSIC.but(wood=m.CHERRY, frame=m.CHERRY, top=m.CHERRY), drawer_coffee_table, 1, drawers=1),
    design("side table", "drawer-oak", "oak end table with a shelf", (0.45, 0.50, 0.56), RUSTIC.but(wood=m.OAK, frame=m.OAK), drawer_coffee_table, 1, drawers=0),
    design("side table", "waterfall-birch", "birch waterfall side table", (0.36, 0.45, 0.48), "minimal", waterfall_table, 2, wood=m.BIRCH),
    design("console table", "demilune", "half-round mahogany hall table", (0.36, 0.95, 0.78), "classic", demilune_table, 1, wood=m.MAHOGANY, profile="taper", drawer=True),
    design("console table", "demilune-white", "half-round whitewashed console with bowed legs", (0.38, 1.00, 0.80), "classic", demilune_table, 1, wood=m.WHITEWASH, profile="cabriole"),
    design("console table", "pine-drawers", "pine console table with two drawers", (0.36, 1.10, 0.80), RUSTIC, styled_console, 1),
    design("console table", "reclaimed-steel", "reclaimed-wood console on steel", (0.36, 1.25, 0.78), INDUSTRIAL, styled_console, 2, drawers=0),
    design("console table", "walnut-splay", "walnut console table on splayed legs", (0.38, 1.20, 0.76), MODERN, styled_console, 1, drawers=2, shelf=False),
    design("console table", "birch-slim", "slim birch console table", (0.30, 1.00, 0.76), MINIMAL, styled_console, 2, drawers=0, shelf=False),
    design("console table", "waterfall-oak", "oak waterfall console", (0.34, 1.20, 0.76), "modern", waterfall_table, 2, wood=m.OAK),
    design("console table", "glass-brass", "brass console table with a glass top", (0.34, 1.15, 0.77), "modern", frame_table, 2, top=m.GLASS, frame=m.BRASS, shelf=m.GLASS),
)  # fmt: skip
