"""Coat racks, hall stands, clothes rails and folding screens."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from diorama_core.library.furniture.kit import *


def hook(reach: float = 0.07, rise: float = 0.05, r: float = 0.006) -> Solid:
    """A coat hook on the plane x = 0, turned up."""
    return tube(bend([(0, 0, 0), (reach * 0.6, 0, -0.012), (reach, 0, 0.01), (reach * 0.98, 0, rise)], 4), r, 7)


def coat_tree(size: Size, wood: Material, metal: Material, kind: str) -> Parts:
    """A column with arms: "bentwood" scrolls, "dowel" tripod, "steel" column on a disc."""
    d, _, h = size
    r = d / 2 * {"bentwood": 1.38, "dowel": 1.2, "steel": 1.35}[kind]
    if kind == "dowel":
        legs = [rod((0.92 * r, 0, 0), (-0.24 * r, 0, h * 0.93), 0.016, 0.014).turned("z", 120 * k) for k in range(3)]
        pegs = [
            rod((0.0, 0, z), (0.62 * r, 0, z + 0.09), 0.011, 0.009).turned("z", 60 + 120 * k)
            for k in range(3)
            for z in (0.72 * h, 0.9 * h)
        ]
        return of(
            wood,
            *legs,
            *pegs,
            cylinder(0.02, 0.09, 0.006).moved(z=h - 0.09),
            cylinder(0.018, 0.3 * h, 0.004).moved(z=0.66 * h),
        )
    if kind == "steel":
        foot = lathe([(0.72 * r, 0), (0.74 * r, 0.006), (0.7 * r, 0.016), (0.05, 0.028)], 36)
        arms = [
            hook(0.55 * r, 0.07, 0.008).turned("z", 90 * k + (45 if z < 0.85 * h else 0)).moved(z=z)
            for z in (0.78 * h, 0.95 * h)
            for k in range(4)
        ]
        tips = [
            ball(0.024, 4).moved(0.55 * r, 0, 0.062).turned("z", 90 * k + (45 if z < 0.85 * h else 0)).moved(z=z)
            for z in (0.78 * h, 0.95 * h)
            for k in range(4)
        ]
        return of(metal, foot, cylinder(0.016, h - 0.012, 0.004).moved(z=0.012), *arms) + of(wood, *tips)
    column = lathe(
        [
            (0.024, 0.3),
            (0.032, 0.34),
            (0.022, 0.4),
            (0.024, 0.9),
            (0.032, 0.95),
            (0.02, 1.0),
            (0.02, h - 0.14),
            (0.03, h - 0.1),
            (0.02, h - 0.06),
            (0.026, h - 0.03),
            (0.006, h),
        ],
        16,
    )
    feet = [
        tube(
            bend([(0.02, 0, 0.42), (0.45 * r, 0, 0.38), (0.62 * r, 0, 0.16), (0.92 * r, 0, 0.02)], 5), 0.014, 8
        ).turned("z", 45 + 90 * k)
        for k in range(4)
    ]
    hooks = [
        tube(
            bend(
                [
                    (0.015, 0, h - 0.36),
                    (0.42 * r, 0, h - 0.3),
                    (0.58 * r, 0, h - 0.14),
                    (0.42 * r, 0, h - 0.06),
                    (0.72 * r, 0, h - 0.01),
                ],
                5,
            ),
            0.011,
            7,
        ).turned("z", 45 + 90 * k)
        for k in range(4)
    ]
    ring = tube(ring_path(superellipse(0.9 * r, 0.9 * r, 2, 28), 0.5), 0.008, 6, closed=True)
    return of(wood, column, *feet, *hooks) + of(metal, ring)


def clothes_rail(size: Size, metal: Material, shelf: Material, castors: bool = False) -> Parts:
    """A rail on two end frames with a shoe shelf below."""
    d, w, h = size
    y, x = w / 2 - 0.02, d / 2 - 0.02
    r = 0.014
    ends = [
        rod((x, y, 0.03), (0, y, h - 0.02), r),
        rod((-x, y, 0.03), (0, y, h - 0.02), r),
        rod((x * 0.86, y, 0.2), (-x * 0.86, y, 0.2), r),
    ]
    bars = [
        rod((0, -y, h - 0.022), (0, y, h - 0.022), 0.016),
        *(rod((f * x * 0.86, -y, 0.2), (f * x * 0.86, y, 0.2), 0.011) for f in (1, -1)),
    ]
    feet = four((ball(0.045, 5) if castors else cylinder(0.018, 0.035, 0.004, 12)).moved(x, y))
    deck = box((2 * x * 0.84, 2 * y - 0.02, 0.018), 0.004).moved(0, 0, 0.208)
    return of(metal, *both_sides(*ends), *bars) + of(m.BLACK, *feet) + of(shelf, deck)


def hall_tree(size: Size, wood: Material, metal: Material, cloth: Material | None, planks: bool) -> Parts:
    """A bench with a panelled back, hooks and a hat shelf."""
    d, w, h = size
    seat_h, t = 0.46, 0.026
    xb = -d / 2 + 0.012
    parts = of(
        wood,
        *both_sides(box((d - 0.02, 0.03, seat_h - 0.03), 0.004).moved(0, w / 2 - 0.03)),
        box((d, w, 0.03), 0.008, 2).moved(z=seat_h - 0.03),
        box((d - 0.04, w - 0.06, 0.018), 0.003).moved(0, 0, 0.12),
    )
    n = max(round(w / 0.16), 3)
    each = w / n
    if planks:
        parts += of(
            wood,
            *(
                box((0.018, each - 0.004, h - seat_h - 0.02), 0.004).moved(xb, -w / 2 + each * (k + 0.5), seat_h)
                for k in range(n)
            ),
        )
    else:
        parts += of(
            wood,
            *both_sides(box((0.026, 0.05, h - seat_h), 0.005).moved(xb, w / 2 - 0.025, seat_h)),
            *(box((0.022, w - 0.08, 0.1), 0.005).moved(xb, 0, z) for z in (seat_h + 0.35, h - 0.3)),
        )
    shelf_z = h - 0.1
    parts += of(
        wood,
        box((d * 0.62, w + 0.01, t), 0.007, 2).moved(-d / 2 + d * 0.31, 0, shelf_z),
        box((0.03, w + 0.01, 0.05), 0.01, 2).moved(xb + 0.006, 0, h - 0.05),
    )
    parts += of(
        wood, *both_sides(box((d * 0.4, 0.024, 0.06), 0.006).moved(-d / 2 + d * 0.22, w / 2 - 0.05, shelf_z - 0.055))
    )
    k = max(round(w / 0.2), 3)
    z = h - 0.25
    parts += of(
        metal,
        *(
            q.moved(xb + 0.01, y, z)
            for y in np.linspace(-w / 2 + 0.1, w / 2 - 0.1, k)
            for q in (hook(), box((0.006, 0.024, 0.07), 0.002).moved(0.0, 0, -0.02))
        ),
    )
    if cloth is not None:
        parts += of(cloth, cushion((d - 0.02, w - 0.03, 0.055), 10, 3.4, 10).moved(0.005, 0, seat_h - 0.004))
    return parts


def folding_screen(size: Size, frame: Material, fill: Material, kind: str, panels: int = 3) -> Parts:
    """Hinged panels standing in a zigzag: "sheet" of cloth, paper or cane, "slats", "grid" or "panelled".

    The wider the depth asked, the more it is folded.
    """
    d, w, h = size
    t, bar = 0.026, 0.042
    span = w / panels
    slope = np.arctan2(d - t, span)
    length = float(np.hypot(d - t, span)) + t * 0.6
    parts: Parts = []
    for k in range(panels):
        one: Parts = of(
            frame, *(box((t, bar, h - 0.02), 0.004).moved(0, f * (length / 2 - bar / 2), 0.02) for f in (1, -1))
        )
        one += of(frame, *(box((t, length - 0.01, bar), 0.004).moved(0, 0, z) for z in (0.08, h - bar)))
        inner, z0, z1 = length - 2 * bar, 0.08 + bar, h - bar
        if kind == "slats":
            one += of(
                fill,
                *(
                    box((0.008, inner + 0.01, 0.05), 0.002).turned("y", 24).moved(0, 0, z)
                    for z in np.arange(z0, z1 - 0.02, 0.046)
                ),
            )
        elif kind == "panelled":
            thirds = np.linspace(z0, z1, 4)
            one += of(frame, *(box((t, inner + 0.01, bar), 0.004).moved(0, 0, z - bar / 2) for z in thirds[1:3]))
            one += of(fill, *(box((0.012, inner + 0.01, b - a), 0.003).moved(0, 0, a) for a, b in pairwise(thirds)))
        else:
            one += of(fill, box((0.006, inner + 0.01, z1 - z0 + 0.01), 0.001).moved(0, 0, z0 - 0.005))
            if kind == "grid":
                one += of(
                    frame,
                    *(box((t * 0.6, inner, 0.014), 0.002).moved(0, 0, z) for z in np.linspace(z0, z1, 6)[1:-1]),
                    box((t * 0.6, 0.014, z1 - z0), 0.002).moved(0, 0, z0),
                )
        turn = np.rad2deg(slope) * (1 if k % 2 else -1)
        parts += [p.turned("z", turn).moved(0, -w / 2 + span * (k + 0.5)) for p in one]
    return parts


DESIGNS: tuple[Design, ...] = (
    design("coat rack", "bentwood", "bentwood hat and coat stand", (0.50, 0.50, 1.88), "classic", coat_tree, wood=m.DARK_WALNUT, metal=m.BRASS, kind="bentwood"),
    design("coat rack", "dowel-oak", "oak tripod coat stand", (0.46, 0.46, 1.74), "modern", coat_tree, wood=m.OAK, metal=m.BRASS, kind="dowel"),
    design("coat rack", "steel-column", "sand steel coat stand with birch tips", (0.38, 0.38, 1.76), "minimal", coat_tree, wood=m.BIRCH, metal=m.metal("sand steel", "#b5a792", 0.5, 0.1), kind="steel"),
    design("coat rack", "rail-steel", "black steel clothes rail with a reclaimed shelf", (0.45, 1.10, 1.62), "industrial", clothes_rail, 2, metal=m.BLACK_STEEL, shelf=m.RECLAIMED),
    design("coat rack", "rail-chrome", "chrome clothes rail on castors", (0.46, 1.20, 1.58), "minimal", clothes_rail, 2, metal=m.CHROME, shelf=m.WHITE, castors=True),
    design("coat rack", "hall-pine", "pine hall stand with a bench and hooks", (0.42, 0.90, 1.85), "rustic", hall_tree, wood=m.PINE, metal=m.IRON, cloth=None, planks=True),
    design("coat rack", "hall-cream", "cream hall tree with a linen seat", (0.44, 1.00, 1.92), "classic", hall_tree, wood=m.CREAM, metal=m.BRASS, cloth=m.LINEN, planks=True),
    design("coat rack", "hall-walnut", "walnut hall stand with an open back", (0.40, 0.80, 1.80), "modern", hall_tree, wood=m.WALNUT, metal=m.BLACK_STEEL, cloth=m.GREY_FABRIC, planks=False),
    design("room divider", "cane", "light oak folding screen with cane", (0.30, 1.35, 1.72), "modern", folding_screen, 2, frame=m.LIGHT_OAK, fill=m.RATTAN, kind="sheet"),
    design("room divider", "shoji", "black folding screen with paper panes", (0.32, 1.60, 1.78), "minimal", folding_screen, 1, frame=m.BLACK_WOOD, fill=m.WHITE_COTTON, kind="grid", panels=4),
    design("room divider", "louvred", "pine folding screen with louvres", (0.34, 1.30, 1.70), "rustic", folding_screen, 2, frame=m.PINE, fill=m.PINE, kind="slats"),
    design("room divider", "panelled", "mahogany panelled dressing screen", (0.32, 1.45, 1.80), "classic", folding_screen, 2, frame=m.MAHOGANY, fill=s.SKY_FABRIC, kind="panelled"),
    design("room divider", "steel-glass", "black steel screen with glass panes", (0.26, 1.50, 1.85), "industrial", folding_screen, 2, frame=m.BLACK_STEEL, fill=m.GLASS, kind="grid"),
)  # fmt: skip
