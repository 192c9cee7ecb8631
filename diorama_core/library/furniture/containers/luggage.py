"""Suitcases, rucksacks, handbags and umbrella stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *


def suitcase(size: Size, case: Material, trim: Material) -> Parts:
    """An upright suitcase on wheels."""
    d, w, h = size
    body = box((d, w, h - 0.16), 0.045, 3).moved(z=0.05)
    ribs = [box((d + 0.008, 0.012, h - 0.3), 0.004).moved(0, y, 0.12) for y in np.linspace(-0.34 * w, 0.34 * w, 6)]
    wheels = four(cylinder(0.026, 0.022, 0.005, 14).turned("x", 90).moved(d / 2 - 0.045, w / 2 - 0.06, 0.026))
    rods = both_sides(rod((-d * 0.3, w * 0.2, h - 0.12), (-d * 0.3, w * 0.2, h - 0.012), 0.007))
    return of(case, body, *ribs) + of(
        trim,
        *wheels,
        *rods,
        rod((-d * 0.3, -w * 0.22, h - 0.014), (-d * 0.3, w * 0.22, h - 0.014), 0.013),
        box((0.03, 0.13, 0.02), 0.006).moved(0.02, 0, h - 0.11),
    )


def old_suitcase(size: Size, hide: Material, metal: Material) -> Parts:
    """A flat leather case with straps and corners, lying."""
    d, w, h = size
    d0 = d * 0.94
    body = prism(rounded_rectangle(d0, w, 0.04, 5), h, 0.014).moved(-d * 0.03)
    seam = prism(rounded_rectangle(d0 + 0.006, w + 0.006, 0.04, 5), 0.008, 0.003).moved(-d * 0.03, 0, h * 0.5)
    straps = [box((d0 + 0.008, 0.035, h + 0.006), 0.008, 2).moved(-d * 0.03, s * w * 0.3, -0.003) for s in (1, -1)]
    x = -d * 0.03 + d0 / 2
    handle = tube(
        bend(
            [(x, 0.07, h * 0.5), (x + d * 0.05, 0.05, h * 0.5), (x + d * 0.05, -0.05, h * 0.5), (x, -0.07, h * 0.5)], 4
        ),
        0.009,
        8,
    )
    locks = [box((0.012, 0.04, 0.03), 0.004).moved(x + 0.004, s * w * 0.18, h * 0.44) for s in (1, -1)]
    buckles = [box((0.008, 0.045, 0.034), 0.004).moved(x + 0.006, s * w * 0.3, h * 0.42) for s in (1, -1)]
    corners = [
        ball(0.07, 6).scaled(z=h / 0.075).moved(-d * 0.03 + sx * (d0 / 2 - 0.03), sy * (w / 2 - 0.03), -0.002)
        for sx in (1, -1)
        for sy in (1, -1)
    ]
    return of(hide, body) + of(m.BROWN_LEATHER, seam, *straps, handle, *corners) + of(metal, *locks, *buckles)


def duffel(size: Size, cloth: Material, trim: Material) -> Parts:
    """A soft holdall along y with two handles."""
    d, w, h = size
    top = h * 0.76
    t = np.linspace(-1, 1, 13)
    rows = np.array(
        [
            np.column_stack(
                [
                    superellipse(d * (1 - 0.16 * abs(s) ** 5), top * (1 - 0.12 * abs(s) ** 5), 2.6, 28)[:, 0],
                    np.full(28, s * w / 2),
                    superellipse(d, top * (1 - 0.12 * abs(s) ** 5), 2.6, 28)[:, 1] + top / 2,
                ]
            )
            for s in t
        ]
    )
    body = loft(rows[:, ::-1], crease_rad=np.pi)
    straps = [
        tube(
            bend(
                [
                    (s * d * 0.34, 0.22 * w, top * 0.72),
                    (s * d * 0.2, 0.2 * w, top * 0.96),
                    (s * d * 0.08, 0.08 * w, h - 0.012),
                    (s * d * 0.08, -0.08 * w, h - 0.012),
                    (s * d * 0.2, -0.2 * w, top * 0.96),
                    (s * d * 0.34, -0.22 * w, top * 0.72),
                ],
                4,
            ),
            0.008,
            7,
        )
        for s in (1, -1)
    ]
    bands = [
        tube(
            np.column_stack(
                [
                    superellipse(d * 1.0, top * 1.0, 2.6, 28)[:, 0],
                    np.full(28, y * w),
                    superellipse(d, top, 2.6, 28)[:, 1] + top / 2,
                ]
            ),
            0.009,
            6,
            closed=True,
        )
        for y in (-0.2, 0.2)
    ]
    zip_ = rod((0, -w * 0.42, top - 0.002), (0, w * 0.42, top - 0.002), 0.005)
    sunk = [seated(p.moved(z=-0.012)) for p in (body, *bands)]
    return of(cloth, sunk[0]) + of(trim, *straps, *sunk[1:]) + of(m.STEEL, zip_.moved(z=-0.012))


def rucksack(size: Size, cloth: Material, trim: Material, flap: bool = False) -> Parts:
    """A rucksack standing, its front toward +X."""
    d, w, h = size
    main = cushion((d * 0.74, w * 0.94, h * 0.95), 3.4, 3.6, 12).moved(-d * 0.06)
    pocket = cushion((d * 0.42, w * 0.72, h * 0.42), 3.6, 3.4, 9).moved(d * 0.24, 0, 0.03 * h)
    sides = both_sides(cushion((d * 0.5, w * 0.16, h * 0.3), 3, 3, 6).moved(-d * 0.04, w * 0.44, 0.04 * h))
    loop_ = tube(
        bend(
            [
                (-d * 0.24, 0.05, h * 0.92),
                (-d * 0.26, 0.035, h - 0.006),
                (-d * 0.26, -0.035, h - 0.006),
                (-d * 0.24, -0.05, h * 0.92),
            ],
            4,
        ),
        0.007,
        7,
    )
    straps = both_sides(
        tube(
            bend(
                [
                    (-d * 0.36, 0.2 * w, h * 0.88),
                    (-d * 0.49, 0.26 * w, h * 0.7),
                    (-d * 0.48, 0.3 * w, h * 0.3),
                    (-d * 0.34, 0.34 * w, h * 0.1),
                ],
                5,
            ),
            0.012,
            8,
        )
    )
    parts = of(cloth, main, pocket, *sides) + of(trim, loop_, *straps)
    if flap:
        lid = cushion((d * 0.86, w * 0.98, h * 0.3), 3.6, 3.0, 10).moved(-d * 0.03, 0, h * 0.68)
        belts = [
            box((0.008, 0.026, h * 0.32), 0.003).turned("y", -8).moved(d * 0.38, s * w * 0.2, h * 0.38) for s in (1, -1)
        ]
        return (
            parts
            + of(cloth, lid)
            + of(trim, *belts)
            + of(m.BRASS, *(box((0.012, 0.034, 0.026), 0.003).moved(d * 0.42, s * w * 0.2, h * 0.42) for s in (1, -1)))
        )
    arc = np.linspace(0.1 * np.pi, 0.9 * np.pi, 13)
    zip_ = tube(
        np.stack([d * 0.31 - 0.06 * d * np.sin(arc), w * 0.4 * np.cos(arc), h * (0.52 + 0.36 * np.sin(arc))], axis=1),
        0.004,
        5,
    )
    return parts + of(
        trim,
        zip_,
        tube(
            bend([(d * 0.41, w * 0.26, h * 0.38), (d * 0.445, 0, h * 0.4), (d * 0.41, -w * 0.26, h * 0.38)], 5),
            0.004,
            5,
        ),
    )


def handbag(size: Size, hide: Material, metal: Material, kind: str = "frame") -> Parts:
    """A handbag: "frame" (structured, two handles), "bucket" or "tote"."""
    d, w, h = size
    body_h = h * (0.66 if kind == "frame" else 0.7)
    if kind == "bucket":
        o = superellipse(d, w, 2.6, 36)
        rows = [
            (0.9, 0.0),
            (0.94, 0.01),
            (1.0, 0.3 * body_h),
            (0.92, 0.8 * body_h),
            (0.78, body_h),
            (0.72, body_h),
            (0.8, 0.5 * body_h),
            (0.06, 0.3 * body_h),
        ]
        bag = loft(np.array([ring_path(o * s, z) for s, z in rows]), crease_rad=np.deg2rad(60))
        strap = tube(
            bend(
                [
                    (0, 0.38 * w, body_h * 0.88),
                    (0, 0.34 * w, h * 0.94),
                    (0, 0, h - 0.008),
                    (0, -0.34 * w, h * 0.94),
                    (0, -0.38 * w, body_h * 0.88),
                ],
                5,
            ),
            0.008,
            8,
        )
        return of(hide, bag, strap.scaled(x=1.6)) + of(
            metal, *both_sides(ball(0.022, 5).moved(0, 0.385 * w, body_h * 0.84))
        )
    top = 0.74 if kind == "frame" else 1.08
    mouth = (0.4, 0.94) if kind == "frame" else (0.7, 1.04)
    wide = 0.92 if kind == "tote" else 1.0
    outlines = ((1.0, 1.0, 0.0), (1.0, 1.0, 0.012), (0.86, 0.985, 0.5 * body_h), (*mouth, body_h))
    rings = [ring_path(rounded_rectangle(d * a, w * b * wide, 0.018, 4), z) for a, b, z in outlines]
    bag = loft(np.array(rings), crease_rad=np.deg2rad(50))
    x = d * 0.2 * top
    grips = [
        tube(
            bend(
                [
                    (s * x, 0.24 * w, body_h * 0.9),
                    (s * x * 0.8, 0.22 * w, h * 0.9),
                    (s * x * 0.6, 0, h - 0.008),
                    (s * x * 0.8, -0.22 * w, h * 0.9),
                    (s * x, -0.24 * w, body_h * 0.9),
                ],
                5,
            ),
            0.006,
            8,
        )
        for s in (1, -1)
    ]
    details = [box((0.01, 0.04, 0.03), 0.004).moved(d * 0.26, 0, body_h * 0.84)] if kind == "frame" else []
    rivets = [ball(0.014, 4).moved(s * x * 1.06, y * 0.24 * w, body_h * 0.88) for s in (1, -1) for y in (1, -1)]
    return of(hide, bag, *grips) + of(metal, *details, *rivets)


def umbrella_stand(size: Size, body: Material, tone: Material, kind: str = "solid") -> Parts:
    """A stand with two umbrellas: "solid" (a pot) or "open" (rods)."""
    d, w, h = size
    tall = 0.6 * h
    r = min(d, w) / 2
    if kind == "solid":
        parts = of(
            body, hollow(((0.94, 0), (1.0, 0.01), (0.97, 0.5), (1.0, 0.99), (0.98, 1.0)), r, tall, 0.008, 0.014, 36)
        )
    else:
        rings = [
            tube(ring_path(superellipse(2 * r - 0.014, 2 * r - 0.014, 2, 36), z), 0.006, 6, closed=True)
            for z in (0.02, 0.5 * tall, tall)
        ]
        posts = [
            rod(
                (r * 0.96 * np.cos(a), r * 0.96 * np.sin(a), 0.01),
                (r * 0.96 * np.cos(a), r * 0.96 * np.sin(a), tall),
                0.004,
                segments=6,
            )
            for a in np.arange(10) * 0.628
        ]
        parts = of(body, *rings, *posts, cylinder(r * 0.98, 0.014, 0.004, 36))
    for k, (colour, lean, heading) in enumerate(((tone, 7, 40), (m.CHARCOAL_FABRIC, 9, 215))):
        shaft = [cylinder(0.004, 0.86 * h, 0.001, 8)]
        folded = lathe(
            [
                (0.004, 0.1 * h),
                (0.016, 0.16 * h),
                (0.034, 0.45 * h),
                (0.026, 0.66 * h),
                (0.012, 0.7 * h),
                (0.004, 0.71 * h),
            ],
            16,
            np.pi,
        )
        pleat = 1 + 0.16 * np.cos(8 * np.arctan2(folded.vertices[:, 1], folded.vertices[:, 0]))
        folded = replace(folded, vertices=folded.vertices * np.column_stack([pleat, pleat, np.ones_like(pleat)]))
        crook = tube(
            bend(
                [(0, 0, 0.8 * h), (0, 0, 0.93 * h), (0.03, 0, 0.985 * h), (0.062, 0, 0.94 * h), (0.062, 0, 0.9 * h)], 5
            ),
            0.0085,
            8,
        )
        for material, solids in ((m.STEEL, shaft), (colour, [folded]), (m.WALNUT, [crook])):
            parts += of(
                material, *(s.turned("y", lean).turned("z", heading).moved(-0.02 * (-1) ** k, 0, 0.02) for s in solids)
            )
    return parts


CANVAS_CLOTH = m.fabric("waxed canvas", "#6b6a4f", 0.1)
GREY_CANVAS = m.fabric("grey canvas", "#70757a", 0.1)
TEAL_CLOTH = m.fabric("teal nylon", "#4d6f74", 0.06)


DESIGNS: tuple[Design, ...] = (
    design("suitcase", "suitcase", "upright navy suitcase", (0.26, 0.44, 0.68), "modern", suitcase, id="box-suitcase", case=m.NAVY, trim=m.BLACK),
    design("suitcase", "cabin-grey", "grey cabin suitcase", (0.22, 0.38, 0.55), "minimal", suitcase, case=m.LIGHT_GREY, trim=m.CHARCOAL),
    design("suitcase", "large-sage", "large sage suitcase", (0.30, 0.50, 0.76), "modern", suitcase, case=m.SAGE, trim=m.BLACK),
    design("suitcase", "leather", "old leather suitcase with straps", (0.48, 0.68, 0.20), "classic", old_suitcase, hide=m.TAN_LEATHER, metal=m.BRASS),
    design("suitcase", "leather-brown", "small brown leather case", (0.36, 0.50, 0.15), "rustic", old_suitcase, hide=m.BROWN_LEATHER, metal=m.BRASS),
    design("suitcase", "duffel", "canvas holdall", (0.30, 0.58, 0.40), "industrial", duffel, 2, cloth=CANVAS_CLOTH, trim=m.BROWN_LEATHER),
    design("backpack", "grey", "grey rucksack", (0.26, 0.31, 0.46), "modern", rucksack, cloth=GREY_CANVAS, trim=m.BLACK),
    design("backpack", "canvas", "canvas rucksack with leather straps", (0.27, 0.32, 0.46), "rustic", rucksack, cloth=CANVAS_CLOTH, trim=m.TAN_LEATHER, flap=True),
    design("backpack", "teal", "teal school rucksack", (0.24, 0.29, 0.42), "classic", rucksack, cloth=TEAL_CLOTH, trim=m.CHARCOAL_FABRIC),
    design("backpack", "leather", "black leather rucksack", (0.22, 0.30, 0.42), "minimal", rucksack, cloth=m.BLACK_LEATHER, trim=m.BLACK_LEATHER, flap=True),
    design("handbag", "tan", "tan leather handbag", (0.15, 0.32, 0.36), "classic", handbag, hide=m.TAN_LEATHER, metal=m.BRASS),
    design("handbag", "black", "black structured handbag", (0.14, 0.30, 0.33), "modern", handbag, hide=m.BLACK_LEATHER, metal=m.CHROME),
    design("handbag", "tote", "canvas tote bag", (0.12, 0.38, 0.56), "minimal", handbag, hide=m.LINEN, metal=m.LINEN, kind="tote"),
    design("handbag", "bucket", "brown bucket bag", (0.20, 0.26, 0.42), "rustic", handbag, hide=m.BROWN_LEATHER, metal=m.BRASS, kind="bucket"),
    design("umbrella stand", "ceramic", "blue ceramic umbrella stand", (0.24, 0.24, 0.84), "classic", umbrella_stand, body=m.BLUE_GLAZE, tone=m.OLIVE_FABRIC),
    design("umbrella stand", "steel", "black steel umbrella stand", (0.24, 0.24, 0.84), "industrial", umbrella_stand, body=m.BLACK_STEEL, tone=m.NAVY_FABRIC, kind="open"),
    design("umbrella stand", "wicker", "wicker umbrella stand", (0.25, 0.25, 0.82), "rustic", umbrella_stand, body=m.WICKER, tone=m.RUST_FABRIC),
    design("umbrella stand", "white", "white umbrella stand", (0.22, 0.22, 0.82), "minimal", umbrella_stand, body=m.WHITE, tone=m.GREY_FABRIC),
)  # fmt: skip
