"""Desks."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.tables.dining_tables import trestle_table
from diorama_core.library.furniture.tables.tops import table_top


def pedestal_desk(size: Size, wood: Material, body: Material, pull: Material, sides: tuple[int, ...] = (1,)) -> Parts:
    """A desk with drawer pedestals at its left (1) or right (-1); front is where one sits."""
    d, w, h = size
    t, pw = 0.028, 0.42 if w > 1.2 else 0.36
    parts = of(wood, box((d, w, t), 0.006, 2).moved(z=h - t))
    for side in (1, -1):
        y = side * (w / 2 - pw / 2 - 0.02)
        if side in sides:
            cavity = Cavity((d - 0.06, pw, h - t - 0.05), (-0.005, y, 0.05))
            parts += cavity.body(body) + of(body, box((d - 0.12, pw - 0.06, 0.05), 0.002).moved(0, y))
            for z, fh in ((0.06, 0.30), (0.37, 0.155), (0.535, h - t - 0.545)):
                space = cavity.behind(y, z, pw - 0.012, fh)
                parts += drawer_front(d / 2 - 0.037, y, z, pw - 0.012, fh, body, pull, "bar", space)
        else:
            parts += of(
                body,
                *(
                    box((0.045, 0.045, h - t), 0.004).moved(x, side * (w / 2 - 0.05))
                    for x in (d / 2 - 0.06, -d / 2 + 0.06)
                ),
            )
    return parts + of(body, box((0.018, w - 0.1, 0.32), 0.003).moved(-d / 2 + 0.06, 0, h - t - 0.32))


def drawer_desk(size: Size, wood: Material, legs: Material, pull: Material, splay: bool = True) -> Parts:
    """A writing desk: shallow drawers under the top, slim legs."""
    d, w, h = size
    t, case = 0.022, 0.1
    n = 3 if w > 1.25 else 2
    each = (w - 0.09) / n
    between = tuple(-w / 2 + 0.045 + each * k for k in range(1, n))
    cavity = Cavity((d - 0.04, w - 0.06, case), (0, 0, h - t - case), wall=0.01, dividers=between)
    parts = of(wood, box((d, w, t), 0.006, 2).moved(z=h - t)) + cavity.body(wood)
    x, y = d / 2 - 0.07, w / 2 - 0.08
    leg = (
        rod((x + 0.03, y + 0.035, 0), (x - 0.01, y - 0.01, h - t - case + 0.01), 0.012, 0.021, 14)
        if splay
        else taper((x + 0.02, y + 0.02, 0), (x + 0.02, y + 0.02, h - t - case + 0.01), 0.026, 0.04)
    )
    parts += of(legs, *four(leg))
    for k in range(n):
        y, z, wide, tall = -w / 2 + 0.045 + each * (k + 0.5), h - t - case + 0.008, each - 0.008, case - 0.016
        space = cavity.behind(y, z, wide, tall)
        parts += drawer_front(d / 2 - 0.021, y, z, wide, tall, wood, pull, "knob", space)
    return parts


def standing_desk(size: Size, top: Material, frame: Material) -> Parts:
    """A plain top on two telescopic columns."""
    d, w, h = size
    y, t = w / 2 - 0.25, 0.027
    feet = both_sides(
        box((d - 0.06, 0.075, 0.03), 0.01, 2).moved(0, y),
        box((0.09, 0.06, h - 0.42), 0.006).moved(0, y, 0.03),
        box((0.07, 0.045, h - t - 0.04), 0.006).moved(0, y, 0.03),
        box((d - 0.16, 0.05, 0.03)).moved(0, y, h - t - 0.03),
    )
    return of(top, table_top(d, w, t, "square").moved(z=h - t)) + of(
        frame, *feet, box((0.06, 2 * y, 0.04)).moved(0, 0, h - t - 0.05)
    )


DESIGNS: tuple[Design, ...] = (
    design("desk", "writing-oak", "oak writing desk with drawers", (0.65, 1.30, 0.76), "modern", drawer_desk, wood=m.OAK, legs=m.OAK, pull=m.BLACK_STEEL),
    design("desk", "writing-white", "white writing desk", (0.60, 1.10, 0.75), "minimal", drawer_desk, wood=m.WHITE, legs=m.BIRCH, pull=m.BRASS, splay=False),
    design("desk", "pedestal-walnut", "walnut desk with a drawer pedestal", (0.70, 1.45, 0.75), "classic", pedestal_desk, wood=m.WALNUT, body=m.WALNUT, pull=m.BRASS),
    design("desk", "pedestal-double", "mahogany partner's desk with two pedestals", (0.80, 1.60, 0.77), "classic", pedestal_desk, wood=m.MAHOGANY, body=m.MAHOGANY, pull=m.BRASS, sides=(1, -1)),
    design("desk", "office-grey", "grey office desk with drawers", (0.75, 1.50, 0.74), "minimal", pedestal_desk, wood=m.LIGHT_OAK, body=m.LIGHT_GREY, pull=m.STEEL, sides=(-1,)),
    design("desk", "standing", "height-adjustable desk with an oak top", (0.75, 1.50, 0.78), "modern", standing_desk, 2, top=m.OAK, frame=m.BLACK_STEEL),
    design("desk", "trestle", "reclaimed-wood desk on A-frames", (0.70, 1.40, 0.75), "industrial", trestle_table, 2, top=m.RECLAIMED, frame=m.BLACK_STEEL, kind="a"),
)  # fmt: skip
