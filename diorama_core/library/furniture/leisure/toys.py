"""Toys."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def teddy(size: Size, fur: Material, muzzle: Material) -> Parts:
    """A sitting teddy bear."""
    d, w, h = size
    body = seated(cushion((0.55 * d, 0.52 * w, 0.56 * h), 2, 2.2, 10).moved(-0.1 * d, 0, -0.02))
    head = cushion((0.5 * d, 0.5 * w, 0.42 * h), 2, 2.1, 10).moved(-0.05 * d, 0, 0.5 * h)
    nose = cushion((0.2 * d, 0.22 * w, 0.15 * h), 2, 2, 6).moved(0.19 * d, 0, 0.56 * h)
    ears = both_sides(cushion((0.12 * d, 0.2 * w, 0.17 * h), 2, 2, 6).moved(-0.06 * d, 0.2 * w, 0.82 * h))
    arms = both_sides(
        cushion((0.22 * d, 0.2 * w, 0.36 * h), 2, 2.2, 8).turned("x", 28).moved(0.06 * d, 0.33 * w, 0.2 * h)
    )
    legs = both_sides(cushion((0.6 * d, 0.24 * w, 0.22 * h), 2.2, 2.2, 8).turned("z", 16).moved(0.2 * d, 0.27 * w, 0.0))
    soles = both_sides(cushion((0.05 * d, 0.16 * w, 0.15 * h), 2, 2, 5).moved(0.475 * d, 0.345 * w, 0.035 * h))
    eyes = both_sides(ball(0.036 * h, 4).moved(0.172 * d, 0.1 * w, 0.735 * h))
    return (
        of(fur, body, head, *ears, *arms, *legs)
        + of(muzzle, nose, *soles)
        + of(m.BLACK, *eyes, cushion((0.05 * d, 0.09 * w, 0.05 * h), 2, 2, 4).moved(0.275 * d, 0, 0.645 * h))
    )


def toy_blocks(size: Size) -> Parts:
    """A little tower of wooden blocks."""
    d, w, h = size
    b = h / 3
    tones = (m.RUST_FABRIC.colour, m.BLUE_GLAZE.colour, m.MUSTARD_FABRIC.colour, m.SAGE.colour)
    paints = [m.paint(f"block {c}", c) for c in tones]
    spots = [(0.2, -0.25, 0, 8), (-0.1, 0.25, 0, -14), (0.02, 0.0, 1, 20), (0.0, 0.03, 2, -6)]
    return [
        p
        for k, (x, y, z, turn) in enumerate(spots)
        for p in (
            q.moved(x * d, y * w, z * b)
            for q in turned(of(m.BIRCH if k == 1 else paints[k % 4], box((b, b, b), 0.006, 2)), "z", turn)
        )
    ]


def toy_car(size: Size, paint: Material, wheel: Material) -> Parts:
    """A wooden car, driving toward +X."""
    d, w, h = size
    body = box((d, w * 0.78, h * 0.4), 0.02, 3).moved(z=h * 0.18)
    cabin = box((d * 0.5, w * 0.7, h * 0.48), 0.03, 3).moved(-0.06 * d, 0, h * 0.52)
    wheels = four(cylinder(h * 0.22, w * 0.16, 0.006, 24).turned("x", 90).moved(0.29 * d, w / 2, h * 0.22))
    panes = [
        box((d * 0.36, w * 0.71, h * 0.2), 0.01).moved(-0.06 * d, 0, h * 0.68),
        box((d * 0.51, w * 0.5, h * 0.2), 0.01).moved(-0.06 * d, 0, h * 0.68),
    ]
    return of(paint, body, cabin) + of(wheel, *wheels) + of(m.DARK_GLASS, *panes)


def toy_ball(size: Size, a: Material, b: Material) -> Parts:
    """A ball with a band."""
    d = size[0]
    band = lathe(
        [(d * 0.488, d * 0.38), (d * 0.503, d * 0.42), (d * 0.503, d * 0.58), (d * 0.488, d * 0.62)], 40, np.pi
    )
    return of(a, ball(d, 12)) + of(b, band)


BROWN_FUR = m.fabric("brown plush", "#96744f", 0.05)


PALE_FUR = m.fabric("pale plush", "#d5c4a5", 0.05)


def train(size: Size, paint: Material, second: Material) -> Parts:
    """A wooden engine with two wagons, driving toward +Y."""
    d, w, h = size
    each = w / 3.1
    parts: Parts = []
    for k, tone in enumerate((paint, second, m.BIRCH)):
        y = w / 2 - each * (k + 0.5) - 0.02 * w * k
        parts += of(m.OAK, box((d * 0.8, each * 0.94, h * 0.16), 0.005, 2).moved(0, y, h * 0.2))
        parts += of(
            m.BLACK,
            *(
                cylinder(h * 0.17, d * 0.12, 0.004, 20)
                .turned("y", 90)
                .moved(sx * d * 0.44 - d * 0.06, y + sy * each * 0.28, h * 0.17)
                for sx in (1, -1)
                for sy in (1, -1)
            ),
        )
        if k == 0:
            parts += of(
                tone,
                cylinder(d * 0.3, each * 0.58, 0.006, 28)
                .turned("x", -90)
                .moved(0, y - each * 0.12, h * 0.36 + d * 0.28),
                box((d * 0.72, each * 0.34, h * 0.5), 0.006, 2).moved(0, y - each * 0.28, h * 0.34),
            )
            parts += of(
                second,
                lathe([(0.05 * h, 0), (0.06 * h, 0.16 * h), (0.11 * h, 0.22 * h), (0.1 * h, 0.26 * h)], 18).moved(
                    0, y + each * 0.28, h * 0.72
                ),
                box((d * 0.86, each * 0.42, h * 0.06), 0.006, 2).moved(0, y - each * 0.28, h * 0.84),
            )
        else:
            parts += of(tone, box((d * 0.72, each * 0.86, h * 0.34), 0.008, 2).moved(0, y, h * 0.35))
    return parts


def rocking_horse(size: Size, wood: Material, hair: Material, saddle: Material) -> Parts:
    """A wooden horse on rockers, its head toward +X."""
    d, w, h = size
    t = np.linspace(-0.5, 0.5, 13)
    rockers = both_sides(tube(np.stack([d * t, np.full(13, 0.42 * w), 0.02 + 0.5 * h * t**2 * 1.1], axis=1), 0.018, 8))
    body = cushion((0.5 * d, 0.5 * w, 0.24 * h), 2.6, 2.4, 10).moved(-0.02 * d, 0, 0.42 * h)
    legs = [
        rod((sx * 0.17 * d, sy * 0.16 * w, 0.5 * h), (sx * 0.3 * d, sy * 0.4 * w, 0.07 * h), 0.026, 0.018, 10)
        for sx in (1, -1)
        for sy in (1, -1)
    ]
    neck = tube(
        bend([(0.14 * d, 0, 0.52 * h), (0.26 * d, 0, 0.72 * h), (0.29 * d, 0, 0.86 * h)], 5),
        np.linspace(0.1 * h, 0.065 * h, 11),
        12,
    )
    head = cushion((0.26 * d, 0.26 * w, 0.13 * h), 2.2, 2.3, 8).turned("y", 30).moved(0.34 * d, 0, 0.79 * h)
    ears = both_sides(cushion((0.03 * d, 0.06 * w, 0.07 * h), 2, 2, 4).moved(0.27 * d, 0.06 * w, 0.92 * h))
    mane = [ball(0.05 * h, 5).moved(0.2 * d + 0.045 * d * k / 3, 0, 0.6 * h + 0.055 * h * k) for k in range(6)]
    tail = tube(
        bend([(-0.26 * d, 0, 0.56 * h), (-0.34 * d, 0, 0.5 * h), (-0.36 * d, 0, 0.3 * h)], 5),
        np.linspace(0.02, 0.008, 11),
        8,
    )
    seat = cushion((0.2 * d, 0.54 * w, 0.06 * h), 3, 2.6, 7).moved(-0.04 * d, 0, 0.625 * h)
    bars = [rod((sx * 0.24 * d, -0.42 * w, 0.06 * h), (sx * 0.24 * d, 0.42 * w, 0.06 * h), 0.012) for sx in (1, -1)]
    grip = rod((0.24 * d, -0.3 * w, 0.74 * h), (0.24 * d, 0.3 * w, 0.74 * h), 0.012)
    return of(wood, *rockers, body, *legs, neck, head, *ears, *bars, grip) + of(hair, *mane, tail) + of(saddle, seat)


def rabbit(size: Size, fur: Material, inner: Material) -> Parts:
    """A sitting cloth rabbit with long ears."""
    d, w, h = size
    body = seated(cushion((0.6 * d, 0.62 * w, 0.49 * h), 2, 2.2, 10).moved(-0.06 * d, 0, -0.02))
    head = cushion((0.52 * d, 0.52 * w, 0.3 * h), 2, 2.1, 10).moved(-0.02 * d, 0, 0.4 * h)
    ears = both_sides(
        cushion((0.1 * d, 0.2 * w, 0.36 * h), 2, 2.2, 7).turned("x", -8).moved(-0.06 * d, 0.13 * w, 0.635 * h)
    )
    lining = both_sides(
        cushion((0.04 * d, 0.11 * w, 0.26 * h), 2, 2.2, 6).turned("x", -8).moved(-0.005 * d, 0.135 * w, 0.68 * h)
    )
    arms = both_sides(
        cushion((0.2 * d, 0.18 * w, 0.28 * h), 2, 2.2, 7).turned("x", 24).moved(0.1 * d, 0.3 * w, 0.16 * h)
    )
    legs = both_sides(
        cushion((0.56 * d, 0.26 * w, 0.16 * h), 2.2, 2.2, 8).turned("z", 14).moved(0.2 * d, 0.25 * w, 0.0)
    )
    eyes = both_sides(ball(0.03 * h, 4).moved(0.21 * d, 0.1 * w, 0.54 * h))
    return (
        of(fur, body, head, *ears, *arms, *legs)
        + of(inner, *lining, ball(0.05 * h, 5).moved(0.235 * d, 0, 0.485 * h))
        + of(m.BLACK, *eyes)
    )


def doll_house(size: Size, wall: Material, roof: Material) -> Parts:
    """An open house of four rooms, seen from +X."""
    d, w, h = size
    t, eaves = 0.012, 0.66 * h
    boards = [box((d, w * 0.94, t), 0.002).moved(z=z) for z in (0.0, eaves / 2, eaves - t)]
    uprights = [box((d, t, eaves), 0.002).moved(0, y) for y in (w * 0.464, -w * 0.464, 0.0)]
    back = box((t, w * 0.94, eaves), 0.002).moved(-d / 2 + t / 2)
    gable = loft(
        np.array(
            [[(x, -w * 0.47, eaves), (x, w * 0.47, eaves), (x, 0.0, h - 0.03)] for x in (-d / 2 + 0.001, -d / 2 + t)]
        )
    )
    slope = float(np.rad2deg(np.arctan2(h - eaves - 0.02, w * 0.5)))
    run = float(np.hypot(h - eaves, w * 0.5))
    halves = [
        box((d + 0.02, run, 0.014), 0.004).moved(0, s * run / 2).turned("x", -s * slope).moved(0, 0, h - 0.02)
        for s in (1, -1)
    ]
    panes = [
        box((0.004, w * 0.13, eaves * 0.2), 0.001).moved(-d / 2 + t + 0.002, y * w, z * eaves)
        for y in (-0.24, 0.24)
        for z in (0.18, 0.66)
    ]
    return (
        of(wall, *boards, *uprights, back, gable)
        + of(roof, *halves, box((0.04, 0.05, 0.1), 0.004).moved(-0.1 * d, 0.22 * w, h - 0.14))
        + of(m.PANE, *panes)
    )


def ring_stack(size: Size) -> Parts:
    """Wooden rings on a peg, largest below."""
    d, _, h = size
    tones = (m.BLUE_GLAZE, m.SAGE, m.MUSTARD_FABRIC, m.RUST_FABRIC, m.BIRCH)
    parts = of(
        m.OAK,
        lathe([(0.5 * d, 0), (0.5 * d, 0.08 * h), (0.46 * d, 0.1 * h), (0.003, 0.1 * h)], 32),
        ball(0.16 * d, 6).moved(z=h - 0.16 * d),
        cylinder(0.03 * d, h * 0.84, 0.002, 12).moved(z=0.06 * h),
    )
    each = (0.74 * h) / 5
    for k, tone in enumerate(tones):
        r = d * (0.46 - 0.055 * k)
        paint_ = m.paint(f"ring {tone.colour}", tone.colour)
        ring = lathe(
            [
                (0.05 * d, 0),
                (r - 0.3 * each, 0),
                (r, 0.3 * each),
                (r, 0.7 * each),
                (r - 0.3 * each, 0.98 * each),
                (0.05 * d, 0.98 * each),
                (0.05 * d, 0),
            ],
            30,
            np.deg2rad(60),
        )
        parts += of(paint_, ring.moved(z=0.1 * h + each * k))
    return parts


GREY_PLUSH = m.fabric("grey plush", "#a9a7a3", 0.05)

DESIGNS: tuple[Design, ...] = (
    design("toy", "teddy", "brown teddy bear", (0.26, 0.28, 0.34), "classic", teddy, fur=BROWN_FUR, muzzle=PALE_FUR),
    design("toy", "teddy-pale", "small cream teddy bear", (0.20, 0.22, 0.26), "modern", teddy, fur=PALE_FUR, muzzle=BROWN_FUR),
    design("toy", "blocks", "wooden toy blocks", (0.15, 0.20, 0.21), "minimal", toy_blocks),
    design("toy", "car", "wooden toy car", (0.24, 0.13, 0.12), "rustic", toy_car, paint=m.SAGE, wheel=m.OAK),
    design("toy", "ball", "striped ball", (0.22, 0.22, 0.22), "modern", toy_ball, 36, a=m.CREAM, b=m.NAVY),
    design("toy", "train", "wooden toy train", (0.09, 0.42, 0.13), "classic", train, paint=m.SAGE, second=m.NAVY),
    design("toy", "rocking-horse", "wooden rocking horse", (0.85, 0.34, 0.72), "rustic", rocking_horse, wood=m.BIRCH, hair=m.OATMEAL, saddle=m.BROWN_LEATHER),
    design("toy", "rabbit", "grey cloth rabbit", (0.22, 0.22, 0.40), "minimal", rabbit, fur=GREY_PLUSH, inner=m.ROSE_FABRIC),
    design("toy", "doll-house", "doll's house", (0.30, 0.60, 0.66), "classic", doll_house, wall=m.WHITE, roof=m.TERRACOTTA),
    design("toy", "rings", "stacking rings", (0.14, 0.14, 0.20), "modern", ring_stack, 36),
    design("toy", "car-navy", "navy toy car", (0.26, 0.14, 0.13), "industrial", toy_car, paint=m.NAVY, wheel=m.BLACK),
)  # fmt: skip
