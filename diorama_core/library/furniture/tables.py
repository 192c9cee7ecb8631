"""Tables of every height, and desks."""

from __future__ import annotations

from functools import partial

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.carcass import drawer_front
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, four, joined, of
from diorama_core.library.furniture.solids import (
    Solid,
    beam,
    bend,
    box,
    cylinder,
    lathe,
    prism,
    rod,
    rounded_rectangle,
    superellipse,
    taper,
    tube,
)
from diorama_core.library.record import SymmetryFold

Outline = str
"""Shape of a top: "square", "soft", "round" or "oval"."""


def table_top(d: float, w: float, thickness: float, outline: Outline) -> Solid:
    """A top standing on z = 0."""
    if outline == "square":
        return box((d, w, thickness), min(0.006, thickness / 3), 2)
    if outline == "soft":
        return prism(rounded_rectangle(d, w, 0.12 * min(d, w), 8), thickness, min(0.008, thickness / 3))
    return prism(superellipse(d, w, 2.0 if outline == "round" else 2.6, 56), thickness, min(0.009, thickness / 3))


def leg_table(
    size: Size,
    top: Material,
    legs: Material,
    outline: Outline = "square",
    shape: str = "taper",
    apron: float = 0.08,
    shelf: Material | None = None,
) -> Parts:
    """Four legs at the corners under an apron; `shape` is "taper", "square", "splay" or "turned"."""
    d, w, h = size
    t = float(np.clip(0.03 * max(d, w), 0.018, 0.036))
    thick = float(np.clip(0.055 * (h + 0.3), 0.03, 0.075))
    inset = thick * 0.9 if outline in ("square", "soft") else 0.19 * min(d, w)
    x, y = d / 2 - inset, w / 2 - inset
    parts = of(top, table_top(d, w, t, outline).moved(z=h - t))
    parts += of(legs, *four(_leg(shape, x, y, h - t, thick)))
    if apron:
        z, ax, ay = h - t - apron / 2, x - thick * 0.1, y - thick * 0.1
        parts += of(
            legs,
            *(beam((s * ax, -ay, z), (s * ax, ay, z), 0.02, apron) for s in (1, -1)),
            *both_sides(beam((-ax, ay, z), (ax, ay, z), 0.02, apron)),
        )
    if shelf is not None:
        parts += of(shelf, box((2 * x - 0.01, 2 * y - 0.01, 0.018), 0.004).moved(z=0.24 * h))
    return parts


def _leg(shape: str, x: float, y: float, h: float, thick: float) -> Solid:
    if shape == "square":
        return box((thick, thick, h), 0.005).moved(x, y)
    if shape == "splay":
        return rod((x + 0.06 * h, y + 0.06 * h, 0), (x - 0.06 * h, y - 0.06 * h, h), thick * 0.24, thick * 0.42, 14)
    if shape == "turned":
        r = thick / 2
        profile = [
            (0.45, 0),
            (0.62, 0.015),
            (0.5, 0.05),
            (0.72, 0.09),
            (0.55, 0.12),
            (0.68, 0.2),
            (0.98, 0.52),
            (0.8, 0.68),
            (1.0, 0.72),
            (0.7, 0.75),
            (1.0, 0.8),
        ]
        return joined(
            [lathe([(r * a, h * b) for a, b in profile], 18), box((thick, thick, h * 0.22), 0.004).moved(z=h * 0.78)]
        ).moved(x, y)
    return taper((x, y, 0), (x, y, h), thick * 0.55, thick, 0.005)


def pedestal_table(size: Size, top: Material, foot: Material, outline: Outline = "round", kind: str = "tulip") -> Parts:
    """One column in the middle; `kind` is "tulip", "claw", "disc" or "drum"."""
    d, w, h = size
    t = float(np.clip(0.028 * max(d, w), 0.016, 0.034))
    r = min(d, w) / 2
    parts = of(top, table_top(d, w, t, outline).moved(z=h - t))
    z = h - t
    if kind == "tulip":
        profile = [
            (0.62 * r, 0),
            (0.63 * r, 0.008),
            (0.5 * r, 0.02),
            (0.24 * r, 0.07 * z + 0.02),
            (0.10 * r, 0.25 * z),
            (0.075 * r, 0.5 * z),
            (0.10 * r, 0.75 * z),
            (0.22 * r, 0.93 * z),
            (0.42 * r, z),
        ]
        return parts + of(foot, lathe(profile, 36, np.pi / 2))
    if kind == "drum":
        return parts + of(
            foot, cylinder(0.62 * r, z - 0.012, 0.008, 40).moved(z=0.012), cylinder(0.55 * r, 0.02, 0.002, 32)
        )
    if kind == "disc":
        return parts + of(
            foot,
            lathe([(0.56 * r, 0), (0.57 * r, 0.006), (0.55 * r, 0.016), (0.06, 0.026)], 36),
            cylinder(0.032, z).moved(z=0.01),
            cylinder(0.2 * r, 0.012).moved(z=z - 0.012),
        )
    legs = []
    for k in range(4):
        path = bend([(0.03, 0, 0.36 * z), (0.3 * r, 0, 0.26 * z), (0.6 * r, 0, 0.06 * z), (0.78 * r, 0, 0.02)], 5)
        legs.append(tube(path, np.linspace(0.036, 0.02, len(path)), 10).turned("z", 45 + 90 * k))
    column = lathe(
        [
            (0.04, 0.24 * z),
            (0.062, 0.3 * z),
            (0.045, 0.4 * z),
            (0.06, 0.55 * z),
            (0.04, 0.7 * z),
            (0.07, 0.9 * z),
            (0.11, z),
        ],
        24,
    )
    return parts + of(foot, column, *legs)


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


def hairpin_table(size: Size, top: Material, steel: Material, outline: Outline = "square") -> Parts:
    """A top on four bent-rod legs."""
    d, w, h = size
    t, e = 0.03, 0.07 if outline == "square" else 0.2 * min(d, w)
    x, y = d / 2 - e, w / 2 - e
    pin = bend(
        [
            (x, y - 0.09, h - t),
            (x + 0.028, y + 0.012, 0.03),
            (x + 0.032, y + 0.032, 0.007),
            (x + 0.012, y + 0.028, 0.03),
            (x - 0.09, y, h - t),
        ],
        5,
    )
    return of(top, table_top(d, w, t, outline).moved(z=h - t)) + of(
        steel, *four(tube(pin, 0.006)), *four(box((0.1, 0.1, 0.005), 0.002).moved(x - 0.04, y - 0.04, h - t - 0.005))
    )


def frame_table(
    size: Size, top: Material, frame: Material, shelf: Material | None = None, outline: Outline = "square"
) -> Parts:
    """A square-section steel frame with a top, and a lower shelf if asked."""
    d, w, h = size
    t, s = 0.025, 0.024
    x, y, z = d / 2 - s / 2, w / 2 - s / 2, h - t
    legs = four(box((s, s, z), 0.003).moved(x, y))
    levels = [z - s] + ([0.16 * h] if shelf is not None else [0.0])
    rails = [box((s, w, s), 0.003).moved(sx * x, 0, zz) for sx in (1, -1) for zz in levels]
    rails += [box((d, s, s), 0.003).moved(0, sy * y, zz) for sy in (1, -1) for zz in levels]
    parts = of(frame, *legs, *rails) + of(top, table_top(d, w, t, outline).moved(z=h - t))
    return parts + (of(shelf, box((d - 2 * s, w - 2 * s, 0.016), 0.003).moved(z=0.16 * h + s - 0.016)) if shelf else [])


def tripod_table(size: Size, top: Material, legs: Material) -> Parts:
    """A small round top on three splayed legs."""
    d, _, h = size
    r, t = d / 2, 0.022
    sticks = [rod((0.92 * r, 0, 0), (0.42 * r, 0, h - t), 0.011, 0.018).turned("z", 60 + 120 * k) for k in range(3)]
    return of(top, prism(superellipse(d, d, 2, 48), t, 0.007).moved(z=h - t)) + of(legs, *sticks)


def tray_table(size: Size, tray: Material, legs: Material) -> Parts:
    """A rimmed metal tray on a crossed stand."""
    d, _, h = size
    r = d / 2
    rim = lathe(
        [
            (r * 0.9, h - 0.042),
            (r, h - 0.03),
            (r, h),
            (r - 0.006, h),
            (r - 0.008, h - 0.026),
            (r * 0.5, h - 0.03),
            (0.01, h - 0.03),
        ],
        44,
    )
    hoops = []
    for a in (45, 135):
        hoop = bend([(0.78 * r, 0, 0.008), (0.62 * r, 0, h * 0.5), (0.7 * r, 0, h - 0.04)], 6)
        hoops += [
            tube(hoop, 0.007).turned("z", a),
            tube(hoop, 0.007).turned("z", a + 180),
            rod((-0.78 * r, 0, 0.008), (0.78 * r, 0, 0.008), 0.007).turned("z", a),
        ]
    return of(tray, rim) + of(legs, *hoops)


def box_table(size: Size, wood: Material, top: Material, drawers: int, pull: Material) -> Parts:
    """A coffee or console table with drawers in a box on short legs."""
    d, w, h = size
    case = 0.15
    parts = of(
        wood,
        box((d - 0.02, w - 0.02, case), 0.005).moved(z=h - case - 0.022),
        *four(taper((d / 2 - 0.045, w / 2 - 0.045, 0), (d / 2 - 0.045, w / 2 - 0.045, h - case), 0.03, 0.05)),
    )
    parts += of(top, box((d, w, 0.024), 0.006, 2).moved(z=h - 0.024))
    each = (w - 0.05) / drawers
    for k in range(drawers):
        y = -w / 2 + 0.025 + each * (k + 0.5)
        parts += drawer_front(d / 2 - 0.012, y, h - case - 0.012, each - 0.008, case - 0.02, wood, pull, "knob")
    return parts


def block_table(size: Size, wood: Material, groove: Material) -> Parts:
    """A solid low block, as a plinth or a stump."""
    d, w, h = size
    return of(wood, prism(rounded_rectangle(d, w, 0.06, 6), h - 0.02, 0.012).moved(z=0.02)) + of(
        groove, prism(rounded_rectangle(d * 0.92, w * 0.92, 0.05, 6), 0.03, 0.002)
    )


def stump_table(size: Size, bark: Material, core: Material) -> Parts:
    """A length of tree trunk."""
    d, w, h = size
    a = np.arange(44) * 2 * np.pi / 44
    wobble = 1 + 0.035 * np.sin(3 * a + 0.4) + 0.02 * np.sin(7 * a)
    outline = np.stack([np.cos(a) * wobble * d / 2.1, np.sin(a) * wobble * w / 2.1], axis=1)
    return of(bark, prism(outline, h - 0.012, 0.01)) + of(core, prism(outline * 0.965, 0.02, 0.006).moved(z=h - 0.02))


def shell_pouf_table(size: Size, wicker: Material, top: Material) -> Parts:
    """A woven drum with a wooden lid."""
    d, _, h = size
    r = d / 2
    drum = lathe([(r * 0.8, 0), (r * 0.86, 0.01), (r * 0.98, h * 0.45), (r * 0.88, h - 0.03)], 40, np.pi / 2)
    return of(wicker, drum) + of(top, prism(superellipse(d * 0.94, d * 0.94, 2, 44), 0.028, 0.008).moved(z=h - 0.028))


def pedestal_desk(size: Size, wood: Material, body: Material, pull: Material, sides: tuple[int, ...] = (1,)) -> Parts:
    """A desk with drawer pedestals at its left (1) or right (-1); front is where one sits."""
    d, w, h = size
    t, pw = 0.028, 0.42 if w > 1.2 else 0.36
    parts = of(wood, box((d, w, t), 0.006, 2).moved(z=h - t))
    for side in (1, -1):
        y = side * (w / 2 - pw / 2 - 0.02)
        if side in sides:
            parts += of(
                body,
                box((d - 0.06, pw, h - t - 0.05), 0.004).moved(-0.005, y, 0.05),
                box((d - 0.12, pw - 0.06, 0.05), 0.002).moved(0, y),
            )
            for z, fh in ((0.06, 0.30), (0.37, 0.155), (0.535, h - t - 0.545)):
                parts += drawer_front(d / 2 - 0.037, y, z, pw - 0.012, fh, body, pull, "bar")
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
    parts = of(
        wood, box((d, w, t), 0.006, 2).moved(z=h - t), box((d - 0.04, w - 0.06, case), 0.004).moved(z=h - t - case)
    )
    x, y = d / 2 - 0.07, w / 2 - 0.08
    leg = (
        rod((x + 0.03, y + 0.035, 0), (x - 0.01, y - 0.01, h - t - case + 0.01), 0.012, 0.021, 14)
        if splay
        else taper((x + 0.02, y + 0.02, 0), (x + 0.02, y + 0.02, h - t - case + 0.01), 0.026, 0.04)
    )
    parts += of(legs, *four(leg))
    n = 3 if w > 1.25 else 2
    each = (w - 0.09) / n
    for k in range(n):
        parts += drawer_front(
            d / 2 - 0.021,
            -w / 2 + 0.045 + each * (k + 0.5),
            h - t - case + 0.008,
            each - 0.008,
            case - 0.016,
            wood,
            pull,
            "knob",
        )
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


def glass_table(size: Size, frame: Material, outline: Outline = "soft") -> Parts:
    """A glass top on a frame of bent tube."""
    d, w, h = size
    x, y = d / 2 - 0.06, w / 2 - 0.12
    hoop = np.array(
        [
            (x, y, h - 0.022),
            (x, y, 0.03),
            (x - 0.02, y, 0.012),
            (-x + 0.02, y, 0.012),
            (-x, y, 0.03),
            (-x, y, h - 0.022),
        ]
    )
    ties = [rod((s * x, -y, h - 0.024), (s * x, y, h - 0.024), 0.01) for s in (1, -1)]
    return of(m.GLASS, table_top(d, w, 0.012, outline).moved(z=h - 0.012)) + of(
        frame, *both_sides(tube(hoop, 0.012, 10)), *ties
    )


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 2
) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d(
        "table",
        "oak-classic",
        "oak dining table with tapered legs",
        (0.85, 1.60, 0.75),
        "classic",
        partial(leg_table, top=m.OAK, legs=m.OAK),
    ),
    _d(
        "table",
        "walnut-splay",
        "walnut table with splayed legs",
        (0.90, 1.80, 0.74),
        "modern",
        partial(leg_table, top=m.WALNUT, legs=m.WALNUT, outline="soft", shape="splay", apron=0.0),
    ),
    _d(
        "table",
        "white-square",
        "small white kitchen table",
        (0.75, 0.75, 0.74),
        "minimal",
        partial(leg_table, top=m.WHITE, legs=m.BIRCH, shape="square", apron=0.06),
        4,
    ),
    _d(
        "table",
        "farmhouse",
        "farmhouse table with turned legs",
        (0.92, 1.75, 0.77),
        "rustic",
        partial(leg_table, top=m.PINE, legs=m.CREAM, shape="turned", apron=0.1),
    ),
    _d(
        "table",
        "round-tulip",
        "round white tulip table",
        (1.10, 1.10, 0.73),
        "modern",
        partial(pedestal_table, top=m.WHITE, foot=m.WHITE),
        36,
    ),
    _d(
        "table",
        "round-oak",
        "round oak table on four legs",
        (1.05, 1.05, 0.75),
        "minimal",
        partial(leg_table, top=m.LIGHT_OAK, legs=m.LIGHT_OAK, outline="round", shape="splay", apron=0.0),
        4,
    ),
    _d(
        "table",
        "round-claw",
        "round mahogany pedestal table",
        (1.20, 1.20, 0.76),
        "classic",
        partial(pedestal_table, top=m.MAHOGANY, foot=m.MAHOGANY, kind="claw"),
        4,
    ),
    _d(
        "table",
        "round-bistro",
        "round marble bistro table",
        (0.70, 0.70, 0.74),
        "industrial",
        partial(pedestal_table, top=m.MARBLE, foot=m.BLACK_STEEL, kind="disc"),
        36,
    ),
    _d(
        "table",
        "trestle-x",
        "plank table on crossed trestles",
        (0.90, 1.80, 0.76),
        "rustic",
        partial(trestle_table, top=m.RECLAIMED, frame=m.RECLAIMED),
    ),
    _d(
        "table",
        "steel-hoop",
        "oak table on black steel hoops",
        (0.95, 2.00, 0.75),
        "industrial",
        partial(trestle_table, top=m.OAK, frame=m.BLACK_STEEL, kind="box"),
    ),
    _d(
        "table",
        "oval-walnut",
        "oval walnut dining table",
        (1.00, 1.90, 0.74),
        "modern",
        partial(leg_table, top=m.WALNUT, legs=m.BLACK_WOOD, outline="oval", shape="splay", apron=0.0),
    ),
    _d(
        "table",
        "conference",
        "long light oak conference table",
        (1.10, 2.60, 0.74),
        "minimal",
        partial(trestle_table, top=m.LIGHT_OAK, frame=m.WHITE, kind="a"),
    ),
    _d(
        "coffee table",
        "oak-shelf",
        "oak coffee table with a lower shelf",
        (0.60, 1.10, 0.45),
        "classic",
        partial(leg_table, top=m.OAK, legs=m.OAK, shape="square", apron=0.06, shelf=m.OAK),
    ),
    _d(
        "coffee table",
        "walnut-oval",
        "oval walnut coffee table",
        (0.65, 1.20, 0.40),
        "modern",
        partial(leg_table, top=m.WALNUT, legs=m.WALNUT, outline="oval", shape="splay", apron=0.0),
    ),
    _d(
        "coffee table",
        "glass",
        "glass coffee table with a brass frame",
        (0.65, 1.10, 0.42),
        "modern",
        partial(glass_table, frame=m.BRASS),
    ),
    _d(
        "coffee table",
        "steel-reclaimed",
        "reclaimed-wood coffee table in a steel frame",
        (0.65, 1.15, 0.43),
        "industrial",
        partial(frame_table, top=m.RECLAIMED, frame=m.BLACK_STEEL, shelf=m.RECLAIMED),
    ),
    _d(
        "coffee table",
        "round-drum",
        "round oak drum coffee table",
        (0.80, 0.80, 0.36),
        "minimal",
        partial(pedestal_table, top=m.LIGHT_OAK, foot=m.LIGHT_OAK, kind="drum"),
        36,
    ),
    _d(
        "coffee table",
        "marble-round",
        "round marble coffee table on black legs",
        (0.85, 0.85, 0.42),
        "modern",
        partial(hairpin_table, top=m.MARBLE, steel=m.BLACK_STEEL, outline="round"),
        4,
    ),
    _d(
        "coffee table",
        "drawers",
        "walnut coffee table with two drawers",
        (0.62, 1.15, 0.46),
        "classic",
        partial(box_table, wood=m.CHERRY, top=m.CHERRY, drawers=2, pull=m.BRASS),
        1,
    ),
    _d(
        "coffee table",
        "block",
        "low rounded wooden block table",
        (0.75, 0.95, 0.32),
        "minimal",
        partial(block_table, wood=m.DARK_WALNUT, groove=m.BLACK),
    ),
    _d(
        "side table",
        "tripod-oak",
        "round oak tripod side table",
        (0.45, 0.45, 0.52),
        "minimal",
        partial(tripod_table, top=m.OAK, legs=m.OAK),
        1,
    ),
    _d(
        "side table",
        "tulip",
        "white tulip side table with a marble top",
        (0.45, 0.45, 0.53),
        "modern",
        partial(pedestal_table, top=m.MARBLE, foot=m.WHITE),
        36,
    ),
    _d(
        "side table",
        "tray",
        "brass tray table",
        (0.46, 0.46, 0.55),
        "modern",
        partial(tray_table, tray=m.BRASS, legs=m.BLACK_STEEL),
        4,
    ),
    _d(
        "side table",
        "stump",
        "tree-stump side table",
        (0.38, 0.40, 0.46),
        "rustic",
        partial(stump_table, bark=m.BARK, core=m.PINE),
        1,
    ),
    _d(
        "side table",
        "frame",
        "steel-framed side table with a walnut top",
        (0.40, 0.45, 0.58),
        "industrial",
        partial(frame_table, top=m.WALNUT, frame=m.BLACK_STEEL, shelf=m.WALNUT),
        2,
    ),
    _d(
        "side table",
        "classic-shelf",
        "cherry side table with a shelf",
        (0.45, 0.50, 0.60),
        "classic",
        partial(leg_table, top=m.CHERRY, legs=m.CHERRY, shelf=m.CHERRY),
        2,
    ),
    _d(
        "side table",
        "wicker",
        "wicker drum side table",
        (0.45, 0.45, 0.48),
        "rustic",
        partial(shell_pouf_table, wicker=m.WICKER, top=m.OAK),
        36,
    ),
    _d(
        "desk",
        "writing-oak",
        "oak writing desk with drawers",
        (0.65, 1.30, 0.76),
        "modern",
        partial(drawer_desk, wood=m.OAK, legs=m.OAK, pull=m.BLACK_STEEL),
        1,
    ),
    _d(
        "desk",
        "writing-white",
        "white writing desk",
        (0.60, 1.10, 0.75),
        "minimal",
        partial(drawer_desk, wood=m.WHITE, legs=m.BIRCH, pull=m.BRASS, splay=False),
        1,
    ),
    _d(
        "desk",
        "pedestal-walnut",
        "walnut desk with a drawer pedestal",
        (0.70, 1.45, 0.75),
        "classic",
        partial(pedestal_desk, wood=m.WALNUT, body=m.WALNUT, pull=m.BRASS),
        1,
    ),
    _d(
        "desk",
        "pedestal-double",
        "mahogany partner's desk with two pedestals",
        (0.80, 1.60, 0.77),
        "classic",
        partial(pedestal_desk, wood=m.MAHOGANY, body=m.MAHOGANY, pull=m.BRASS, sides=(1, -1)),
        1,
    ),
    _d(
        "desk",
        "office-grey",
        "grey office desk with drawers",
        (0.75, 1.50, 0.74),
        "minimal",
        partial(pedestal_desk, wood=m.LIGHT_OAK, body=m.LIGHT_GREY, pull=m.STEEL, sides=(-1,)),
        1,
    ),
    _d(
        "desk",
        "standing",
        "height-adjustable desk with an oak top",
        (0.75, 1.50, 0.78),
        "modern",
        partial(standing_desk, top=m.OAK, frame=m.BLACK_STEEL),
        2,
    ),
    _d(
        "desk",
        "trestle",
        "reclaimed-wood desk on A-frames",
        (0.70, 1.40, 0.75),
        "industrial",
        partial(trestle_table, top=m.RECLAIMED, frame=m.BLACK_STEEL, kind="a"),
        2,
    ),
    _d(
        "console table",
        "slim-oak",
        "slim oak console table",
        (0.34, 1.10, 0.80),
        "minimal",
        partial(leg_table, top=m.OAK, legs=m.OAK, shape="square", apron=0.07),
        2,
    ),
    _d(
        "console table",
        "steel",
        "steel console table with a shelf",
        (0.35, 1.20, 0.78),
        "industrial",
        partial(frame_table, top=m.RECLAIMED, frame=m.BLACK_STEEL, shelf=m.RECLAIMED),
        2,
    ),
    _d(
        "console table",
        "drawers",
        "painted console table with drawers",
        (0.38, 1.05, 0.79),
        "classic",
        partial(box_table, wood=m.SAGE, top=m.OAK, drawers=3, pull=m.BRASS),
        1,
    ),
    _d(
        "console table",
        "marble-brass",
        "marble console table on brass legs",
        (0.36, 1.15, 0.77),
        "modern",
        partial(frame_table, top=m.MARBLE, frame=m.BRASS),
        2,
    ),
)
