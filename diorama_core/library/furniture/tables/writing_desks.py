"""Desks to write, draw, stand and dress at, and carts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.tables.desks import standing_desk


def styled_desk(size: Size, style: Style, drawers: int = 3, gallery: bool = False) -> Parts:
    """A writing table in any style: shallow drawers in a row, legs, a row of pigeon holes when `gallery`."""
    d, w, h = size
    t, box_h = 0.026, 0.105
    desk_h = h - (0.22 if gallery else 0.0)
    x, y = d / 2 - 0.05, w / 2 - 0.055
    parts = of(style.top or style.wood, box((d, w, t), style.edge_m, 2).moved(z=desk_h - t))
    parts += of(style.frame, *four(leg(style.leg, x, y, desk_h - t, 0.055, 0.05)))
    each = (2 * y - 0.06) / max(drawers, 1)
    between = tuple(-y + 0.03 + each * k for k in range(1, drawers))
    cavity = Cavity((2 * x + 0.01, 2 * y + 0.01, box_h), (0, 0, desk_h - t - box_h), wall=0.01, dividers=between)
    parts += cavity.body(style.wood)
    for k in range(drawers):
        place = (-y + 0.03 + each * (k + 0.5), desk_h - t - box_h + 0.008, each - 0.01, box_h - 0.016)
        handle = "knob" if style.handle in ("none", "bar") else style.handle
        parts += drawer_front(x + 0.002, *place, style.wood, style.fitting, handle, cavity.behind(*place))
    if gallery:
        depth, xb = 0.22, -d / 2
        parts += of(
            style.wood,
            box((depth, w - 0.02, 0.016), 0.003).moved(xb + depth / 2, 0, h - 0.016),
            *(
                box((depth, 0.016, 0.21), 0.003).moved(xb + depth / 2, yy, desk_h)
                for yy in np.linspace(-w / 2 + 0.02, w / 2 - 0.02, 5)
            ),
            box((0.008, w - 0.03, 0.2), 0.001).moved(xb + 0.006, 0, desk_h),
        )
    return parts


def secretary(size: Size, style: Style, open_flap: bool = True) -> Parts:
    """A slope-front bureau: drawers below, a fall front let down as the writing surface."""
    d, w, h = size
    low, t = 0.74, 0.022
    body = d * 0.56 if open_flap else d - 0.03
    xb = -d / 2 + body / 2
    cavity = Cavity((body, w, low - 0.1), (xb, 0, 0.1))
    parts = cavity.body(style.wood) + of(
        style.wood,
        *(
            q.moved(xb)
            for q in four(leg("bun" if style.leg == "turned" else "taper", body / 2 - 0.04, w / 2 - 0.05, 0.11, 0.05))
        ),
    )
    n, x = 3, -d / 2 + body
    each = (low - 0.14) / n
    for k in range(n):
        place = (0.0, 0.115 + each * k, w - 0.03, each - 0.008)
        handle = "knob" if style.handle in ("none", "bar") else style.handle
        parts += drawer_front(x - 0.01, *place, style.wood, style.fitting, handle, cavity.behind(*place))
    side = [
        (-d / 2, 0.0),
        (-d / 2 + body, 0.0),
        (-d / 2 + body, 0.03),
        (-d / 2 + 0.45 * body, h - low - t),
        (-d / 2, h - low - t),
    ]
    ends = both_sides(prism([(px, pz) for px, pz in side], t, 0.003).turned("x", 90).moved(0, w / 2, low))
    parts += of(
        style.wood,
        *ends,
        box((0.46 * body, w, t), 0.005, 2).moved(-d / 2 + 0.23 * body, 0, h - t),
        box((0.012, w - 0.03, h - low - 0.02), 0.002).moved(-d / 2 + 0.008, 0, low),
        box((body, w, t), 0.004).moved(xb, 0, low - t),
    )
    depth = 0.4 * body
    shelf_z = low + 0.14
    parts += of(
        style.wood,
        box((depth, w - 0.05, 0.012), 0.002).moved(-d / 2 + depth / 2, 0, shelf_z),
        *(
            box((depth, 0.012, h - low - 0.04), 0.002).moved(-d / 2 + depth / 2, yy, low)
            for yy in np.linspace(-0.25 * w, 0.25 * w, 3)
        ),
    )
    if open_flap:
        flap = d - body
        parts += of(style.wood, box((flap, w - 0.02, 0.02), 0.005, 2).moved(d / 2 - flap / 2, 0, low - 0.02)) + of(
            style.fitting,
            *both_sides(
                rod((-d / 2 + body - 0.02, w / 2 - 0.05, low - 0.05), (d / 2 - 0.1, w / 2 - 0.05, low - 0.03), 0.007)
            ),
        )
    return parts


def corner_desk(size: Size, top: Material, frame: Material) -> Parts:
    """An L of two tops on steel legs."""
    d, w, h = size
    deep, t, bar = 0.6, 0.026, 0.03
    main = box((deep, w, t), 0.005, 2).moved(-d / 2 + deep / 2, 0, h - t)
    wing = box((d - deep, deep, t), 0.005, 2).moved(deep / 2, w / 2 - deep / 2, h - t)
    spots = [
        (-d / 2, -w / 2),
        (-d / 2, w / 2),
        (-d / 2 + deep, -w / 2),
        (d / 2, w / 2),
        (d / 2, w / 2 - deep),
        (-d / 2 + deep, w / 2 - deep),
    ]
    legs = [box((bar, bar, h - t), 0.003).moved(x - np.sign(x + 1e-9) * bar, y - np.sign(y) * bar) for x, y in spots]
    rails = [
        beam((-d / 2 + bar, -w / 2 + bar, h - t - 0.02), (-d / 2 + bar, w / 2 - bar, h - t - 0.02), bar, bar),
        beam((-d / 2 + bar, w / 2 - bar, h - t - 0.02), (d / 2 - bar, w / 2 - bar, h - t - 0.02), bar, bar),
        beam((-d / 2 + deep - bar, -w / 2 + bar, h - t - 0.02), (-d / 2 + bar, -w / 2 + bar, h - t - 0.02), bar, bar),
        beam((d / 2 - bar, w / 2 - deep + bar, h - t - 0.02), (d / 2 - bar, w / 2 - bar, h - t - 0.02), bar, bar),
    ]
    return of(top, main, wing) + of(frame, *legs, *rails)


def shelf_desk(
    size: Size, top: Material, frame: Material, levels: int = 3, left: bool = True, side: float = 0.36
) -> Parts:
    """A desk with shelves up its left or right side, `side` wide, in an open frame."""
    d, w, h = size
    desk_h, bar = 0.75, 0.026
    x, y = d / 2 - bar / 2, w / 2 - bar / 2
    ys = y - side
    posts = [box((bar, bar, h), 0.003).moved(f * x, yy) for f in (1, -1) for yy in (y, ys)] + [
        box((bar, bar, desk_h - 0.02), 0.003).moved(f * x, -y) for f in (1, -1)
    ]
    rails = [beam((f * x, -y, desk_h - 0.035), (f * x, y, desk_h - 0.035), bar, bar) for f in (1, -1)] + [
        beam((-x, -y, z), (x, -y, z), bar, bar) for z in (desk_h - 0.035, 0.1)
    ]
    rails += [beam((-x, yy, h - 0.02), (x, yy, h - 0.02), bar, bar) for yy in (y, ys)]
    boards = [box((d - 0.01, w, 0.026), 0.004, 2).moved(z=desk_h - 0.026)]
    boards += [
        box((d - 0.02, side, 0.02), 0.003).moved(0, (y + ys) / 2, z)
        for z in (0.2, 0.45, *np.linspace(desk_h + 0.28, h - 0.03, levels - 1))
    ]
    parts = of(top, *boards) + of(frame, *posts, *rails)
    return parts if left else [replace(p, solid=p.solid.mirrored()) for p in parts]


DESIGNS: tuple[Design, ...] = (
    design("desk", "writing-mahogany", "mahogany writing table with turned legs", (0.65, 1.30, 0.77), CLASSIC, styled_desk),
    design("desk", "writing-pine", "pine writing desk", (0.60, 1.15, 0.76), RUSTIC, styled_desk, drawers=2),
    design("desk", "gallery-walnut", "walnut desk with pigeon holes", (0.62, 1.20, 0.98), MODERN, styled_desk, drawers=2, gallery=True),
    design("desk", "reclaimed-drawers", "reclaimed-wood desk with drawers on steel legs", (0.62, 1.40, 0.76), INDUSTRIAL, styled_desk),
    design("desk", "birch-slim", "slim birch desk", (0.55, 1.10, 0.74), MINIMAL, styled_desk, drawers=2),
    design("desk", "secretary-cherry", "cherry bureau with its front let down", (0.78, 0.90, 1.05), CLASSIC.but(wood=m.CHERRY, frame=m.CHERRY), secretary),
    design("desk", "secretary-oak", "oak bureau with its front let down", (0.76, 0.85, 1.02), RUSTIC.but(wood=m.OAK, frame=m.OAK), secretary),
    design("desk", "corner-oak", "L-shaped oak desk on black steel", (1.30, 1.50, 0.74), "modern", corner_desk, top=m.OAK, frame=m.BLACK_STEEL),
    design("desk", "corner-white", "L-shaped white desk", (1.20, 1.60, 0.73), "minimal", corner_desk, top=m.WHITE, frame=m.STEEL),
    design("desk", "shelves-reclaimed", "reclaimed-wood desk with shelves at its side", (0.55, 1.30, 1.45), "industrial", shelf_desk, top=m.RECLAIMED, frame=m.BLACK_STEEL),
    design("desk", "shelves-birch", "birch desk with open shelves at its right", (0.50, 1.20, 1.20), "minimal", shelf_desk, top=m.BIRCH, frame=m.WHITE, levels=2, left=False, side=0.30),
    design("desk", "standing-raised", "oak standing desk, raised", (0.75, 1.50, 1.08), "modern", standing_desk, 2, top=m.OAK, frame=m.BLACK_STEEL),
    design("desk", "standing-birch", "white and birch standing desk", (0.70, 1.30, 1.02), "minimal", standing_desk, 2, top=m.BIRCH, frame=m.metal("white steel", "#dedcd6", 0.5, 0.1)),
)  # fmt: skip
