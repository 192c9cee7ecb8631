"""Loudspeakers, record players and radios."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *

CLOTH_GRILLE = m.fabric("speaker cloth", "#6f6f70", 0.05)
PALE_GRILLE = m.fabric("pale speaker cloth", "#b7b0a4", 0.05)
PERFORATED = Material("perforated steel", "mesh", "#3a3c3e", 0.5, 0.2, 0.08)


def driver(radius: float, x: float, y: float, z: float, cone: Material = m.CHARCOAL) -> Parts:
    """A loudspeaker's cone facing +X on the plane x."""
    r = radius
    ring = lathe(
        [(0.9 * r, 0), (1.05 * r, 0.0), (1.05 * r, 0.005), (0.95 * r, 0.008), (0.88 * r, 0.004), (0.9 * r, 0)], 32
    )
    dish = lathe(
        [
            (0.9 * r, 0.001),
            (0.78 * r, 0.004),
            (0.7 * r, 0.0),
            (0.3 * r, -0.2 * r),
            (0.27 * r, -0.16 * r),
            (0.12 * r, -0.1 * r),
            (0.003, -0.08 * r),
        ],
        32,
        np.deg2rad(60),
    )
    return of(m.BLACK, ring.turned("y", 90).moved(x, y, z)) + of(cone, dish.turned("y", 90).moved(x + 0.001, y, z))


def box_speaker(
    size: Size, cabinet: Material, grille: Material | None = None, feet: bool = False, ways: int = 2
) -> Parts:
    """A cabinet with its drivers bare, or behind a cloth."""
    d, w, h = size
    low = 0.02 if feet else 0.0
    parts = of(cabinet, box((d - 0.012, w, h - low), 0.008, 2).moved(-0.006, 0, low))
    x = d / 2 - 0.012
    parts += of(m.BLACK, box((0.008, w - 0.014, h - low - 0.014), 0.003).moved(x, 0, low + 0.007))
    x += 0.004
    if grille is not None:
        parts += of(grille, box((0.012, w - 0.02, (h - low) * 0.94), 0.006, 2).moved(x, 0, low + (h - low) * 0.03))
    else:
        big = min(0.4 * w, 0.16 * h if ways > 2 else 0.3 * h)
        two = ((0.3, big), (0.78, 0.42 * big))
        three = ((0.2, big), (0.42, big), (0.62, 0.42 * big), (0.84, 0.7 * big))
        for f, r in two if ways == 2 else three:
            parts += driver(r, x, 0, low + f * (h - low))
    if feet:
        parts += of(m.BLACK, *four(cylinder(0.012, 0.022, 0.002, 12, top=0.018).moved(d * 0.38, w * 0.38)))
    return parts


def soundbar(size: Size, body: Material, grille: Material) -> Parts:
    """A long low bar."""
    d, w, h = size
    bar = prism(rounded_rectangle(d, w, d * 0.3, 6), h - 0.006, 0.012).moved(z=0.006)
    front = prism(rounded_rectangle(d * 1.0, w * 0.96, d * 0.3, 6), h * 0.7, 0.006).moved(0.001, 0, h * 0.14)
    return (
        of(body, bar) + of(grille, front) + of(m.BLACK, *four(box((0.02, 0.05, 0.008), 0.002).moved(d * 0.2, w * 0.4)))
    )


def smart_speaker(size: Size, cloth: Material, top: Material) -> Parts:
    """A cloth cylinder or ball with a glossy top."""
    d, w, h = size
    if h < 1.2 * d:
        body = lathe(
            [
                (0.6 * d / 2, 0),
                (0.82 * d / 2, 0.03 * h),
                (0.98 * d / 2, 0.35 * h),
                (d / 2, 0.55 * h),
                (0.9 * d / 2, 0.85 * h),
                (0.7 * d / 2, 0.97 * h),
            ],
            36,
            np.pi,
        )
        return of(cloth, body) + of(top, cylinder(0.36 * d, 0.012, 0.005, 32).moved(z=h - 0.012))
    return of(cloth, prism(superellipse(d, w, 2, 40), h - 0.02, 0.012)) + of(
        top, prism(superellipse(d * 0.97, w * 0.97, 2, 40), 0.026, 0.01).moved(z=h - 0.026)
    )


def radio(size: Size, wood: Material, cloth: Material) -> Parts:
    """A table radio with a dial, a cloth front and a handle."""
    d, w, h = size
    top = h * 0.88
    x = d / 2
    case = prism(rounded_rectangle(top, w, 0.035, 5), d - 0.01, 0.01).turned("y", 90).moved(-d / 2, 0, top / 2)
    front = box((0.01, w * 0.56, top * 0.74), 0.006, 2).moved(x - 0.012, w * 0.16, top * 0.13)
    dial = cylinder(0.2 * top, 0.014, 0.004, 32).turned("y", 90).moved(x - 0.016, -w * 0.3, top * 0.6)
    knobs = [
        cylinder(0.014, 0.02, 0.004, 18).turned("y", 90).moved(x - 0.016, -w * 0.3 + s * 0.045, top * 0.2)
        for s in (1, -1)
    ]
    strap = tube(
        bend(
            [
                (0, w * 0.36, top - 0.005),
                (0, w * 0.33, h - 0.006),
                (0, -w * 0.33, h - 0.006),
                (0, -w * 0.36, top - 0.005),
            ],
            5,
        ),
        0.006,
        8,
    )
    return of(wood, case) + of(cloth, front) + of(m.BRASS, dial, *knobs) + of(m.TAN_LEATHER, strap.scaled(x=1.8))


def turntable(size: Size, plinth: Material, lid: bool = False) -> Parts:
    """A record player with a record on it; an open acrylic lid if asked."""
    d, w, h = size
    low = min(0.1, h * 0.8)
    parts = of(plinth, box((d, w, low - 0.03), 0.008, 2).moved(z=0.018)) + of(
        m.BLACK, *four(cylinder(0.02, 0.02, 0.004, 16).moved(d * 0.38, w * 0.4))
    )
    z = low - 0.012
    cx, cy = 0.0, 0.1 * w
    r = 0.41 * min(d, w)
    parts += of(m.STEEL, cylinder(r * 1.0, 0.016, 0.004, 48).moved(cx, cy, z))
    grooves = [
        (0.34 * r, 0.0),
        *((f * r, 0.0012 if k % 2 else 0.0022) for k, f in enumerate(np.linspace(0.4, 0.95, 12))),
        (0.98 * r, 0.0),
    ]
    parts += of(VINYL, lathe([(0.003, 0.0015), *grooves][::-1], 44, 0.3).moved(cx, cy, z + 0.016)) + of(
        LABEL, cylinder(0.33 * r, 0.003, 0.0005, 32).moved(cx, cy, z + 0.016)
    )
    px, py = -d * 0.3, -w * 0.38
    arm = tube(
        bend(
            [
                (px - 0.03, py, z + 0.03),
                (px + 0.1, py, z + 0.032),
                (px + 0.2, py + 0.02, z + 0.03),
                (cx + 0.55 * r, cy - 0.66 * r, z + 0.024),
            ],
            5,
        ),
        0.004,
        8,
    )
    parts += of(
        m.STEEL,
        arm,
        cylinder(0.024, 0.03, 0.004, 24).moved(px, py, z),
        cylinder(0.012, 0.024, 0.003, 14).turned("y", 90).moved(px - 0.06, py, z + 0.03),
    )
    parts += of(
        m.BLACK,
        box((0.03, 0.014, 0.012), 0.003).moved(cx + 0.55 * r, cy - 0.66 * r, z + 0.016),
        cylinder(0.014, 0.01, 0.003, 18).moved(d * 0.4, -w * 0.38, z - 0.002),
    )
    if lid:
        tall = h - low
        cover = [
            box((0.004, w * 0.98, d * 0.9), 0.001),
            *(box((0.06, 0.004, d * 0.9), 0.001).moved(0.03, s * w * 0.488) for s in (1, -1)),
            box((0.06, w * 0.98, 0.004), 0.001).moved(0.03, 0, d * 0.9 - 0.004),
        ]
        lean = 16.0
        scale = tall / (d * 0.9 * np.cos(np.deg2rad(lean)))
        parts += of(
            m.GLASS, *(c.scaled(z=scale).turned("y", -lean).moved(-d / 2 + 0.012, 0, low - 0.014) for c in cover)
        )
    return parts


def gramophone(size: Size, wood: Material, horn: Material) -> Parts:
    """A wind-up gramophone with a flower horn."""
    d, w, h = size
    low = 0.3 * h
    base = [
        box((d * 0.62, w * 0.72, 0.03), 0.01, 2).moved(-0.08 * d),
        box((d * 0.54, w * 0.62, low - 0.04), 0.006, 2).moved(-0.08 * d, 0, 0.028),
        box((d * 0.6, w * 0.7, 0.02), 0.008, 2).moved(-0.08 * d, 0, low - 0.02),
    ]
    r = 0.27 * w
    disc = of(VINYL, cylinder(r, 0.006, 0.002, 44).moved(-0.08 * d, 0, low + 0.006)) + of(
        LABEL, cylinder(0.33 * r, 0.002, 0.0005, 28).moved(-0.08 * d, 0, low + 0.012)
    )
    t = np.linspace(0, 1, 12)
    bell = [(0.012 + 0.36 * w * s**2.6, 0.62 * h * s) for s in t]
    flower = lathe([*bell, *((max(r_ - 0.004, 0.004), z) for r_, z in reversed(bell))], 40, np.pi)
    angle = np.arctan2(flower.vertices[:, 1], flower.vertices[:, 0])
    flare = 1 + 0.05 * np.cos(8 * angle) * (flower.vertices[:, 2] / (0.62 * h)) ** 3

    flower = (
        replace(flower, vertices=flower.vertices * np.column_stack([flare, flare, np.ones_like(flare)]))
        .turned("y", 38)
        .moved(-0.3 * d, 0, 0.46 * h)
    )
    neck = tube(
        bend(
            [
                (0.06 * d, 0, low + 0.02),
                (-0.1 * d, 0, low + 0.05),
                (-0.42 * d, 0, low + 0.06),
                (-0.44 * d, 0, 0.4 * h),
                (-0.3 * d, 0, 0.47 * h),
            ],
            6,
        ),
        np.linspace(0.007, 0.014, 25),
        10,
    )
    crank = [
        rod((-0.08 * d, -0.3 * w, low * 0.5), (-0.08 * d, -0.42 * w, low * 0.5), 0.005),
        rod((-0.08 * d, -0.42 * w, low * 0.5), (0.0, -0.42 * w, low * 0.36), 0.005),
        rod((0.0, -0.42 * w, low * 0.36), (0.0, -0.49 * w, low * 0.36), 0.009),
    ]
    return of(wood, *base) + disc + of(horn, flower, neck) + of(m.STEEL, *crank)


def suitcase_player(size: Size, case: Material) -> Parts:
    """A portable player in a case, its lid open."""
    d, w, h = size
    low = 0.11
    body = prism(rounded_rectangle(d * 0.86, w, 0.02, 4), low, 0.008).moved(d * 0.07)
    lid = [
        p.turned("y", -14).moved(-d * 0.36, 0, low - 0.006)
        for p in of(case, box((0.05, w, h - low), 0.014, 2).moved(-0.02))
    ]
    top = box((d * 0.8, w * 0.94, 0.006), 0.002).moved(d * 0.07, 0, low - 0.002)
    r = 0.36 * min(d, w)
    rec = of(VINYL, cylinder(r, 0.006, 0.002, 44)) + of(LABEL, cylinder(0.33 * r, 0.002, 0.0005, 28).moved(z=0.006))
    arm = [
        rod((-d * 0.2, -w * 0.4, low + 0.025), (d * 0.16, -w * 0.26, low + 0.018), 0.004),
        cylinder(0.018, 0.026, 0.004, 18).moved(-d * 0.2, -w * 0.4, low),
    ]
    catches = [box((0.008, 0.03, 0.03), 0.003).moved(d / 2, s * w * 0.3, low * 0.5) for s in (1, -1)]
    return (
        of(case, body)
        + lid
        + of(m.CREAM, top)
        + shifted(rec, d * 0.07, w * 0.08, low + 0.004)
        + of(m.BRASS, *arm, *catches)
    )


VINYL = m.paint("vinyl", "#1d1d1f", 0.25)
LABEL = m.paint("record label", "#a06a4c", 0.6)

DESIGNS: tuple[Design, ...] = (
    design("speaker", "bookshelf-oak", "oak bookshelf speaker", (0.24, 0.18, 0.30), "modern", box_speaker, cabinet=m.OAK),
    design("speaker", "bookshelf-black", "black studio monitor speaker", (0.26, 0.20, 0.33), "industrial", box_speaker, cabinet=m.CHARCOAL),
    design("speaker", "bookshelf-walnut", "walnut speaker with a cloth front", (0.25, 0.19, 0.34), "classic", box_speaker, cabinet=m.WALNUT, grille=PALE_GRILLE),
    design("speaker", "tower-black", "black floor-standing speaker", (0.32, 0.22, 1.02), "modern", box_speaker, cabinet=m.BLACK_WOOD, feet=True, ways=3),
    design("speaker", "tower-walnut", "walnut floor-standing speaker", (0.34, 0.24, 0.96), "classic", box_speaker, cabinet=m.WALNUT, grille=CLOTH_GRILLE, feet=True),
    design("speaker", "soundbar", "black soundbar", (0.11, 0.90, 0.07), "minimal", soundbar, body=m.BLACK, grille=PERFORATED),
    design("speaker", "soundbar-oak", "pale soundbar with an oak front", (0.13, 0.70, 0.09), "modern", soundbar, body=m.LIGHT_GREY, grille=m.OAK),
    design("speaker", "smart", "round smart speaker", (0.15, 0.15, 0.14), "minimal", smart_speaker, 36, cloth=CLOTH_GRILLE, top=m.BLACK),
    design("speaker", "smart-tall", "cylindrical smart speaker", (0.11, 0.11, 0.18), "modern", smart_speaker, 36, cloth=PALE_GRILLE, top=m.WHITE),
    design("speaker", "radio", "wooden table radio", (0.13, 0.28, 0.20), "rustic", radio, wood=m.CHERRY, cloth=PALE_GRILLE),
    design("record player", "walnut", "walnut record player", (0.36, 0.44, 0.13), "classic", turntable, plinth=m.WALNUT),
    design("record player", "black", "black turntable with its lid up", (0.36, 0.45, 0.42), "modern", turntable, plinth=m.BLACK, lid=True),
    design("record player", "white", "white turntable", (0.35, 0.42, 0.12), "minimal", turntable, plinth=m.WHITE),
    design("record player", "case", "portable record player in a case", (0.34, 0.36, 0.34), "rustic", suitcase_player, case=m.TAN_LEATHER),
    design("record player", "gramophone", "gramophone with a brass horn", (0.55, 0.46, 0.66), "classic", gramophone, wood=m.MAHOGANY, horn=m.BRASS),
)  # fmt: skip
