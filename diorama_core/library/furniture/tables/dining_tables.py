"""Dining and kitchen tables."""

from __future__ import annotations

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.tables.tops import leg_table, pedestal_table


def trestle_table(size: Size, top: Material, frame: Material, kind: str = "x") -> Parts:
    """Plank top on two end frames: "x", "a" (A-frames), "slab" or "box" (steel hoops)."""
    d, w, h = size
    t, gap, n = 0.042, 0.004, 4
    each = (d - gap * (n - 1)) / n
    parts = of(top, *(box((each, w, t), 0.006).moved(-d / 2 + each / 2 + k * (each + gap), 0, h - t) for k in range(n)))
    y, x, z = w / 2 - 0.2, d / 2 - 0.08, h - t
    if kind == "x":
        ends = [
            beam((x, y, 0.02), (-x, y, z - 0.02), 0.05, 0.08),
            beam((-x, y + 0.003, 0.02), (x, y + 0.003, z - 0.02), 0.045, 0.08),
            box((2 * x + 0.06, 0.06, 0.05)).moved(0, y, z - 0.05),
        ]
        bar = beam((0, -y, z * 0.5), (0, y, z * 0.5), 0.06, 0.05)
    elif kind == "a":
        ends = [
            taper((x, y, 0), (x - 0.07, y, z), 0.06, 0.07),
            taper((-x, y, 0), (-x + 0.07, y, z), 0.06, 0.07),
            beam((-x, y, 0.3 * h), (x, y, 0.3 * h), 0.04, 0.05),
        ]
        bar = beam((0, -y, 0.3 * h), (0, y, 0.3 * h), 0.04, 0.06)
    elif kind == "slab":
        ends = [box((d - 0.1, 0.05, z), 0.008).moved(0, y)]
        bar = beam((0, -y, z - 0.1), (0, y, z - 0.1), 0.03, 0.1)
    else:
        ends = [
            beam((x, y, 0), (x, y, z), 0.05, 0.05),
            beam((-x, y, 0), (-x, y, z), 0.05, 0.05),
            box((2 * x + 0.05, 0.05, 0.05)).moved(0, y),
            box((2 * x + 0.05, 0.05, 0.05)).moved(0, y, z - 0.05),
        ]
        bar = beam((0, -y, z - 0.025), (0, y, z - 0.025), 0.05, 0.04)
    return parts + of(frame, *both_sides(*ends), bar)


DESIGNS: tuple[Design, ...] = (
    design("table", "oak-classic", "oak dining table with tapered legs", (0.85, 1.60, 0.75), "classic", leg_table, 2, top=m.OAK, legs=m.OAK),
    design("table", "walnut-splay", "walnut table with splayed legs", (0.90, 1.80, 0.74), "modern", leg_table, 2, top=m.WALNUT, legs=m.WALNUT, outline="soft", shape="splay", apron=0.0),
    design("table", "white-square", "small white kitchen table", (0.75, 0.75, 0.74), "minimal", leg_table, 4, top=m.WHITE, legs=m.BIRCH, shape="square", apron=0.06),
    design("table", "farmhouse", "farmhouse table with turned legs", (0.92, 1.75, 0.77), "rustic", leg_table, 2, top=m.PINE, legs=m.CREAM, shape="turned", apron=0.1),
    design("table", "round-tulip", "round white tulip table", (1.10, 1.10, 0.73), "modern", pedestal_table, 36, top=m.WHITE, foot=m.WHITE),
    design("table", "round-oak", "round oak table on four legs", (1.05, 1.05, 0.75), "minimal", leg_table, 4, top=m.LIGHT_OAK, legs=m.LIGHT_OAK, outline="round", shape="splay", apron=0.0),
    design("table", "round-claw", "round mahogany pedestal table", (1.20, 1.20, 0.76), "classic", pedestal_table, 4, top=m.MAHOGANY, foot=m.MAHOGANY, kind="claw"),
    design("table", "round-bistro", "round marble bistro table", (0.70, 0.70, 0.74), "industrial", pedestal_table, 36, top=m.MARBLE, foot=m.BLACK_STEEL, kind="disc"),
    design("table", "trestle-x", "plank table on crossed trestles", (0.90, 1.80, 0.76), "rustic", trestle_table, 2, top=m.RECLAIMED, frame=m.RECLAIMED),
    design("table", "steel-hoop", "oak table on black steel hoops", (0.95, 2.00, 0.75), "industrial", trestle_table, 2, top=m.OAK, frame=m.BLACK_STEEL, kind="box"),
    design("table", "oval-walnut", "oval walnut dining table", (1.00, 1.90, 0.74), "modern", leg_table, 2, top=m.WALNUT, legs=m.BLACK_WOOD, outline="oval", shape="splay", apron=0.0),
    design("table", "conference", "long light oak conference table", (1.10, 2.60, 0.74), "minimal", trestle_table, 2, top=m.LIGHT_OAK, frame=m.WHITE, kind="a"),
)  # fmt: skip
