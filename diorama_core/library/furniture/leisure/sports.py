"""Exercise machines, mats, weights and bicycles."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

RUBBER = m.paint("rubber", "#2a2a2b", 0.85)
MAT_BLUE = m.paint("blue foam", "#63808f", 0.9)
MAT_ROSE = m.paint("rose foam", "#b08f8c", 0.9)
MAT_GREY = m.paint("grey foam", "#7c8082", 0.9)


def wheel(radius: float, tyre: float, spokes: int, rim: Material = m.STEEL) -> Parts:
    """A wheel in the plane x-z about the origin."""
    o = superellipse(2 * radius - tyre, 2 * radius - tyre, 2, 40)
    ring = tube(np.column_stack([o[:, 0], np.zeros(40), o[:, 1]]), tyre / 2, 8, closed=True)
    inner = tube(np.column_stack([o[:, 0] * 0.94, np.zeros(40), o[:, 1] * 0.94]), tyre * 0.3, 6, closed=True)
    wire = rod((0, 0.012, 0.02), (0, 0, radius * 0.92), 0.0012, segments=4)
    wires = [wire.turned("y", 360 / spokes * k) for k in range(spokes)]
    return of(RUBBER, ring) + of(rim, inner, *wires, cylinder(0.018, 0.06, 0.004, 14).turned("x", 90).moved(0, 0.03))


def bicycle(size: Size, paint: Material, saddle: Material, step: bool = False, basket: bool = False) -> Parts:
    """A bicycle, riding toward +X."""
    d, w, h = size
    r = d * 0.19
    xr, xf = -d / 2 + r, d / 2 - r
    bb = (xr + 0.26 * d, 0.0, r * 0.86)
    seat = (xr + 0.17 * d, 0.0, h * 0.86)
    head_low, head_high = (xf - 0.07 * d, 0.0, r * 2.05), (xf - 0.1 * d, 0.0, h * 0.82)
    seat_low = (xr + 0.2 * d, 0.0, h * 0.62)
    frame = [rod(bb, seat, 0.015), rod(bb, head_low, 0.018), rod(head_low, head_high, 0.017)]
    frame.append(
        rod((bb[0] - 0.02 * d, 0, h * 0.42), head_low, 0.014)
        if step
        else rod(seat_low, (head_high[0], 0, head_high[2] - 0.04), 0.015)
    )
    stays = [rod(bb, (xr, s * 0.04, r), 0.009) for s in (1, -1)] + [
        rod(seat_low, (xr, s * 0.04, r), 0.008) for s in (1, -1)
    ]
    fork = [
        tube(
            bend([(head_low[0], s * 0.02, head_low[2]), (xf - 0.04 * d, s * 0.045, r * 1.4), (xf, s * 0.045, r)], 5),
            0.009,
            8,
        )
        for s in (1, -1)
    ]
    stem = rod(head_high, (head_high[0] - 0.005, 0, h - 0.05), 0.012)
    bar = tube(
        bend(
            [
                (head_high[0] - 0.12 * d, w / 2 - 0.02, h - 0.03),
                (head_high[0] - 0.03 * d, w * 0.4, h - 0.012),
                (head_high[0] + 0.02, 0.1 * w, h - 0.03),
                (head_high[0] + 0.02, -0.1 * w, h - 0.03),
                (head_high[0] - 0.03 * d, -w * 0.4, h - 0.012),
                (head_high[0] - 0.12 * d, -w / 2 + 0.02, h - 0.03),
            ],
            5,
        ),
        0.011,
        8,
    )
    grips = [
        rod(
            (head_high[0] - 0.12 * d, s * (w / 2 - 0.018), h - 0.03),
            (head_high[0] - 0.06 * d, s * (w * 0.46), h - 0.02),
            0.016,
        )
        for s in (1, -1)
    ]
    perch = cushion((0.15 * d, 0.16, 0.06), 2.4, 2.4, 8).moved(seat[0], 0, seat[2] - 0.005)
    chain = [
        lathe([(0.03, -0.003), (0.095, -0.003), (0.095, 0.003), (0.03, 0.003), (0.03, -0.003)], 30)
        .turned("x", 90)
        .moved(bb[0], -0.05, bb[2]),
        cylinder(0.035, 0.008, 0.002, 20).turned("x", 90).moved(xr, -0.046, r),
    ]
    runs = [
        rod((bb[0], -0.05, bb[2] + 0.09), (xr, -0.05, r + 0.032), 0.004, segments=5),
        rod((bb[0], -0.05, bb[2] - 0.09), (xr, -0.05, r - 0.032), 0.004, segments=5),
    ]
    cranks = [rod((bb[0], s * 0.07, bb[2]), (bb[0] + s * 0.12, s * 0.075, bb[2] - s * 0.1), 0.009) for s in (1, -1)]
    pedals = [
        box((0.09, 0.08, 0.022), 0.005).moved(bb[0] + s * 0.12, s * 0.12, bb[2] - s * 0.1 - 0.011) for s in (1, -1)
    ]
    stand = rod((xr + 0.06 * d, 0.03, r * 0.8), (xr + 0.1 * d, 0.16, 0.004), 0.008)
    guards = [
        tube(
            np.array([(x + (r + 0.018) * np.cos(a), 0, r + (r + 0.018) * np.sin(a)) for a in np.linspace(a0, a1, 13)]),
            0.014,
            6,
        ).scaled(y=1.5)
        for x, a0, a1 in ((xr, 0.1, 2.8), (xf, 0.7, 2.7))
    ]
    parts = (
        of(paint, *frame, *stays, *fork, *guards)
        + of(m.STEEL, stem, bar, *chain, *runs, *cranks, stand)
        + of(m.BLACK, *pedals)
        + of(saddle, perch, *grips)
    )
    parts += shifted(wheel(r, 0.036, 20), xr, 0, r) + shifted(wheel(r, 0.036, 20), xf, 0, r)
    if basket:
        o = rounded_rectangle(0.24, 0.32, 0.05, 5)
        rows = [(0.8, 0.0), (0.82, 0.01), (1.0, 0.2), (0.97, 0.2), (0.8, 0.02), (0.05, 0.015)]
        parts += shifted(
            of(m.WICKER, loft(np.array([ring_path(o * s, z) for s, z in rows]), crease_rad=np.deg2rad(50))),
            xf - 0.01 * d,
            0,
            h * 0.68,
        )
    return parts


def exercise_bike(size: Size, body: Material) -> Parts:
    """A stationary bicycle, its rider facing +X."""
    d, w, h = size
    feet = [cylinder(0.028, w, 0.01, 16).turned("x", 90).moved(x, w / 2, 0.03) for x in (d / 2 - 0.05, -d / 2 + 0.05)]
    beam_ = box((d - 0.1, 0.07, 0.05), 0.012, 2).moved(0, 0, 0.03)
    case = prism(superellipse(0.46, 0.5, 2.2, 40), 0.09, 0.016).turned("x", 90).moved(d * 0.16, 0.045, 0.36)
    seat_post = rod((-0.12 * d, 0, 0.07), (-0.2 * d, 0, 0.72 * h), 0.024)
    mast = rod((0.2 * d, 0, 0.4), (0.27 * d, 0, 0.88 * h), 0.024)
    perch = cushion((0.28, 0.24, 0.08), 2.4, 2.4, 8).moved(-0.2 * d, 0, 0.71 * h)
    bars = [
        tube(
            bend(
                [
                    (0.26 * d, 0.0, 0.87 * h),
                    (0.27 * d, s * 0.16, 0.9 * h),
                    (0.14 * d, s * 0.22, 0.96 * h),
                    (0.05 * d, s * 0.2, 0.95 * h),
                ],
                5,
            ),
            0.014,
            8,
        )
        for s in (1, -1)
    ]
    screen = box((0.03, 0.2, 0.14), 0.01, 2).turned("y", -28).moved(0.3 * d, 0, h - 0.13)
    cranks = [rod((0.1 * d, s * 0.05, 0.34), (0.1 * d + s * 0.12, s * 0.08, 0.34 - s * 0.09), 0.012) for s in (1, -1)]
    pedals = [box((0.11, 0.08, 0.03), 0.008).moved(0.1 * d + s * 0.12, s * 0.13, 0.32 - s * 0.09) for s in (1, -1)]
    return (
        of(body, case, beam_, screen)
        + of(m.CHARCOAL, *feet, seat_post, mast, *bars, *cranks)
        + of(m.BLACK, perch, *pedals)
        + of(m.SCREEN, box((0.004, 0.15, 0.09), 0.001).turned("y", -28).moved(0.286 * d, 0, h - 0.1))
    )


def treadmill(size: Size, body: Material) -> Parts:
    """A treadmill, its runner facing +X."""
    d, w, h = size
    deck = box((d * 0.96, w, 0.12), 0.03, 3).moved(-0.02 * d, 0, 0.03)
    belt = box((d * 0.8, w * 0.66, 0.012), 0.004).moved(-0.06 * d, 0, 0.144)
    hood = cushion((0.24 * d, w * 0.96, 0.2), 4, 3, 9).moved(d * 0.36, 0, 0.06)
    posts = both_sides(box((0.07, 0.05, h * 0.82), 0.016, 2).turned("y", 8).moved(d * 0.3, w * 0.44, 0.1))
    panel = box((0.1, w * 0.96, 0.26), 0.024, 3).turned("y", -30).moved(d * 0.4, 0, h - 0.27)
    rails = both_sides(
        tube(
            bend([(d * 0.4, w * 0.45, h * 0.8), (d * 0.26, w * 0.46, h * 0.76), (d * 0.12, w * 0.46, h * 0.75)], 4),
            0.018,
            8,
        )
    )
    return (
        of(body, deck, hood, *posts)
        + of(m.BLACK, belt, panel, *rails)
        + of(m.SCREEN, box((0.004, w * 0.5, 0.15), 0.001).turned("y", -30).moved(d * 0.37, 0, h - 0.22))
        + of(m.GREY, *both_sides(box((d * 0.8, w * 0.13, 0.008), 0.003).moved(-0.06 * d, w * 0.41, 0.146)))
    )


def rower(size: Size, body: Material, wood: Material) -> Parts:
    """A rowing machine with a sliding seat."""
    d, w, h = size
    rail = [box((d * 0.72, 0.03, 0.06), 0.008, 2).moved(-0.12 * d, s * 0.06, 0.3) for s in (1, -1)]
    tank = cylinder(0.26, 0.14, 0.02, 40).moved(d / 2 - 0.28, 0, 0.16)
    arch = [
        tube(
            bend(
                [
                    (d / 2 - 0.04, s * w * 0.4, 0.02),
                    (d / 2 - 0.1, s * w * 0.3, 0.34),
                    (d / 2 - 0.3, s * 0.08, h - 0.16),
                ],
                5,
            ),
            0.02,
            8,
        )
        for s in (1, -1)
    ]
    legs = [
        box((0.05, w * 0.7, 0.04), 0.008, 2).moved(-d / 2 + 0.06, 0, 0.0),
        box((0.04, 0.16, 0.32), 0.008).moved(-d / 2 + 0.06, 0, 0.0),
        box((0.05, w * 0.9, 0.04), 0.008, 2).moved(d / 2 - 0.06),
    ]
    perch = cushion((0.24, 0.3, 0.07), 3, 2.6, 8).moved(-0.2 * d, 0, 0.36)
    plates = both_sides(box((0.03, 0.12, 0.3), 0.008, 2).turned("y", 38).moved(d * 0.14, 0.12, 0.28))
    pull = [
        cylinder(0.014, 0.4, 0.005, 14).turned("x", 90).moved(d * 0.16, 0.2, 0.58),
        rod((d * 0.16, 0, 0.58), (d / 2 - 0.3, 0, 0.4), 0.006),
    ]
    show = box((0.03, 0.16, 0.11), 0.01, 2).turned("y", -30).moved(d / 2 - 0.32, 0, h - 0.12)
    return of(wood, *rail, *legs, *arch) + of(body, tank, *plates, show) + of(m.BLACK, perch, *pull)


def yoga_mat(size: Size, foam: Material, unrolled: bool) -> Parts:
    """A mat lying flat with one end rolled, or rolled up with a strap."""
    d, w, h = size
    if not unrolled:
        r = h / 2
        t = np.linspace(0, 6 * np.pi, 52)
        spiral = 0.25 * r + 0.72 * r * t / t[-1]
        swirl = [
            tube(np.stack([spiral * np.cos(t), np.full_like(t, s * w / 2), spiral * np.sin(t) + r], axis=1), 0.0025, 4)
            for s in (1, -1)
        ]
        bands = [
            lathe(
                [
                    (r - 0.002, z - 0.012),
                    (r + 0.002, z - 0.01),
                    (r + 0.002, z + 0.01),
                    (r - 0.002, z + 0.012),
                    (r - 0.002, z - 0.012),
                ],
                32,
            )
            .turned("x", 90)
            .moved(0, 0, r)
            for z in (-0.28 * w, 0.28 * w)
        ]
        return of(
            foam,
            lathe(
                [
                    (0.2 * r, -w / 2),
                    (0.98 * r, -w / 2),
                    (r, -w / 2 + 0.006),
                    (r, w / 2 - 0.006),
                    (0.98 * r, w / 2),
                    (0.2 * r, w / 2),
                    (0.2 * r, -w / 2),
                ],
                36,
            )
            .turned("x", 90)
            .moved(0, 0, r),
            *swirl,
        ) + of(m.CHARCOAL_FABRIC, *bands)
    r = h / 2
    flat = box((d - 1.2 * r, w, 0.006), 0.002).moved(r * 0.6)
    roll = cylinder(r, w, 0.004, 32).turned("x", 90).moved(-d / 2 + r, w / 2, r)
    return of(foam, flat, roll)


def dumbbell(length: float, radius: float, weight: Material, grip: Material) -> Parts:
    """One dumb-bell along y, its middle above the origin."""
    heads = both_sides(
        cylinder(radius, 0.27 * length, 0.3 * radius, 24).turned("x", -90).moved(0, 0.23 * length, radius)
    )
    return of(weight, *heads) + of(
        grip, rod((0, -0.3 * length, radius), (0, 0.3 * length, radius), 0.36 * radius, segments=14)
    )


def dumbbells(size: Size, weight: Material, grip: Material) -> Parts:
    """A pair of dumb-bells."""
    d, w, h = size
    r = h / 2
    return shifted(dumbbell(w * 0.94, r, weight, grip), d / 2 - r) + [
        p.turned("z", 8) for p in shifted(dumbbell(w * 0.94, r, weight, grip), -d / 2 + r)
    ]


def weight_rack(size: Size, frame: Material, weight: Material) -> Parts:
    """Dumb-bells on a two-tier rack."""
    d, w, h = size
    sides = both_sides(
        box((d * 0.9, 0.04, 0.04), 0.006, 2).moved(0, w / 2 - 0.02),
        box((0.05, 0.04, h - 0.02), 0.006, 2).moved(-d * 0.2, w / 2 - 0.02),
    )
    parts = of(frame, *sides)
    for z, x, r in ((0.3 * h, 0.1 * d, 0.075), (0.78 * h, -0.06 * d, 0.06)):
        parts += of(frame, *(box((0.03, w - 0.04, 0.012), 0.003).moved(x + s * 0.07, 0, z) for s in (1, -1)))
        n = int((w - 0.12) / (2.5 * r))
        for k in range(n):
            y = (k - (n - 1) / 2) * (w - 0.16) / n
            parts += [p.turned("z", 90).moved(x, y, z + 0.01) for p in dumbbell(0.3, r, weight, m.STEEL)]
    return parts


def kettlebells(size: Size, iron: Material) -> Parts:
    """Three kettlebells in a row."""
    _, w, h = size
    parts: Parts = []
    for y, s in ((0.33 * w, 1.0), (-0.01 * w, 0.85), (-0.32 * w, 0.7)):
        r = 0.36 * h * s
        loop_ = tube(
            bend(
                [
                    (0, 0.62 * r, 1.5 * r),
                    (0, 0.78 * r, 2.1 * r),
                    (0, 0.4 * r, 2.66 * r),
                    (0, -0.4 * r, 2.66 * r),
                    (0, -0.78 * r, 2.1 * r),
                    (0, -0.62 * r, 1.5 * r),
                ],
                4,
            ),
            0.15 * r,
            9,
        )
        parts += shifted(of(iron, ball(2 * r, 9).scaled(z=0.96), loop_, cylinder(0.6 * r, 0.1 * r, 0.01, 24)), 0, y)
    return parts


def gym_ball(size: Size, rubber: Material) -> Parts:
    """A large exercise ball with fine ribs."""
    d = size[0]
    ribs = [
        tube(ring_path(superellipse(d * c * 1.001, d * c * 1.001, 2, 44), d / 2 + d / 2 * s), 0.004, 5, closed=True)
        for a in np.deg2rad((-34, -24, -14, 14, 24, 34))
        for c, s in ((np.cos(a), np.sin(a)),)
    ]
    return of(rubber, ball(d, 14), *ribs)


DESIGNS: tuple[Design, ...] = (
    design("bicycle", "black", "black city bicycle", (1.75, 0.58, 1.05), "classic", bicycle, paint=m.BLACK, saddle=m.BROWN_LEATHER),
    design("bicycle", "sage", "sage step-through bicycle with a basket", (1.72, 0.60, 1.06), "rustic", bicycle, paint=m.SAGE, saddle=m.TAN_LEATHER, step=True, basket=True),
    design("bicycle", "grey", "grey bicycle", (1.70, 0.52, 1.00), "industrial", bicycle, paint=m.GREY, saddle=m.BLACK_LEATHER),
    design("exercise machine", "bike", "exercise bike", (1.10, 0.52, 1.25), "modern", exercise_bike, body=m.WHITE),
    design("exercise machine", "bike-black", "black exercise bike", (1.05, 0.50, 1.20), "industrial", exercise_bike, body=m.CHARCOAL),
    design("exercise machine", "treadmill", "treadmill", (1.65, 0.76, 1.35), "modern", treadmill, body=m.LIGHT_GREY),
    design("exercise machine", "rower", "wooden rowing machine", (2.10, 0.56, 0.82), "rustic", rower, body=m.BLACK, wood=m.OAK),
    design("yoga mat", "blue", "blue yoga mat, one end rolled", (1.75, 0.61, 0.09), "modern", yoga_mat, foam=MAT_BLUE, unrolled=True),
    design("yoga mat", "rolled-rose", "rolled rose yoga mat", (0.13, 0.62, 0.13), "minimal", yoga_mat, foam=MAT_ROSE, unrolled=False),
    design("yoga mat", "grey", "grey exercise mat", (1.80, 0.65, 0.10), "industrial", yoga_mat, foam=MAT_GREY, unrolled=True),
    design("dumbbells", "black", "pair of black dumb-bells", (0.26, 0.30, 0.12), "modern", dumbbells, weight=RUBBER, grip=m.CHROME),
    design("dumbbells", "blue", "pair of small blue dumb-bells", (0.16, 0.20, 0.07), "minimal", dumbbells, weight=MAT_BLUE, grip=MAT_BLUE),
    design("dumbbells", "rack", "dumb-bells on a rack", (0.50, 1.00, 0.70), "industrial", weight_rack, frame=m.BLACK_STEEL, weight=RUBBER),
    design("dumbbells", "kettlebells", "three kettlebells", (0.20, 0.60, 0.28), "rustic", kettlebells, iron=m.IRON),
    design("exercise ball", "grey", "grey exercise ball", (0.65, 0.65, 0.65), "modern", gym_ball, 36, rubber=MAT_GREY),
    design("exercise ball", "blue", "blue exercise ball", (0.55, 0.55, 0.55), "classic", gym_ball, 36, rubber=MAT_BLUE),
    design("exercise ball", "rose", "rose exercise ball", (0.60, 0.60, 0.60), "minimal", gym_ball, 36, rubber=MAT_ROSE),
)  # fmt: skip
