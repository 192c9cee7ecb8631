"""Chairs, stools and benches."""

from __future__ import annotations

from functools import partial
from itertools import pairwise

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, four, of
from diorama_core.library.furniture.solids import (
    Solid,
    beam,
    bend,
    box,
    cushion,
    cylinder,
    lathe,
    prism,
    ring_path,
    rod,
    slab,
    superellipse,
    taper,
    tube,
)
from diorama_core.library.record import SymmetryFold


def curved_back(
    width: float, height: float, sag: float, thickness: float, lean: float = 0.0, grow: float = 1.0
) -> Solid:
    """A back rest bent round the sitter, its foot at z = 0, middle at x = 0, ends `sag` further forward."""
    v, u = np.meshgrid(np.linspace(0, 1, 7), np.linspace(-1, 1, 13), indexing="ij")
    round_off = np.sqrt(np.clip(1 - np.abs(u) ** 6, 0, 1)) * 0.5 + 0.5
    half = width / 2 * (1 + (grow - 1) * v)
    y, z = -u * half, 0.5 * height + (v - 0.5) * height * round_off
    x = sag * u**2 - lean * v
    return slab(np.stack([x, y, z], axis=-1), thickness)


def dining_chair(size: Size, wood: Material, seat: Material | None, back: str, splay: float = 0.02) -> Parts:
    """A wooden four-legged chair; `back` is "slats", "ladder", "panel" or "cross"."""
    d, w, h = size
    seat_z, t = 0.45, 0.026
    lean = 0.07
    x_back, half = -d / 2 + lean + 0.02, w / 2 - 0.025
    legs = both_sides(
        taper(
            (d / 2 - 0.025 + splay * 0.3, half + splay * 0.2, 0), (d / 2 - 0.045, half - 0.01, seat_z - t), 0.026, 0.038
        ),
        taper((x_back - splay * 1.5, half, 0), (x_back, half - 0.01, seat_z), 0.027, 0.038),
        taper((x_back, half - 0.01, seat_z - 0.01), (x_back - lean, half - 0.012, h), 0.036, 0.024),
    )
    rails = (
        beam((d / 2 - 0.05, -half, seat_z - 0.055), (d / 2 - 0.05, half, seat_z - 0.055), 0.02, 0.055),
        beam((x_back, -half, seat_z - 0.055), (x_back, half, seat_z - 0.055), 0.02, 0.055),
        *both_sides(
            beam((x_back, half - 0.01, seat_z - 0.055), (d / 2 - 0.05, half - 0.01, seat_z - 0.055), 0.02, 0.055)
        ),
    )
    outline = superellipse(d / 2 - x_back + 0.005, w, 7, 32)
    middle = (d / 2 + x_back) / 2
    parts = of(wood, *legs, *rails, prism(outline, t, 0.008).moved(middle, 0, seat_z - t))
    if seat is not None:
        parts += of(
            seat, cushion((d / 2 - x_back - 0.03, w - 0.06, 0.055), 7, 2.4).moved(middle + 0.01, 0, seat_z - 0.015)
        )
    return parts + of(wood, *_chair_back(back, x_back, lean, half, seat_z, h))


def _chair_back(kind: str, x: float, lean: float, half: float, seat_z: float, h: float) -> list[Solid]:
    """What fills the space between the two back posts."""

    def at(z: float) -> float:
        return x - lean * (z - seat_z) / (h - seat_z)

    width = 2 * half
    top = curved_back(width + 0.01, 0.085, 0.0, 0.02, 0.012).moved(at(h - 0.085) - 0.004, 0, h - 0.088)
    if kind == "slats":
        low = beam((at(seat_z + 0.12), -half, seat_z + 0.12), (at(seat_z + 0.12), half, seat_z + 0.12), 0.018, 0.03)
        ys = np.linspace(-half, half, 7)[1:-1]
        return [
            top,
            low,
            *(beam((at(seat_z + 0.12), y, seat_z + 0.12), (at(h - 0.06), y, h - 0.06), 0.026, 0.011) for y in ys),
        ]
    if kind == "ladder":
        zs = np.linspace(seat_z + 0.13, h - 0.22, 3)
        return [top, *(curved_back(width, 0.055, 0.0, 0.014, 0.01).moved(at(z), 0, z) for z in zs)]
    if kind == "cross":
        z0, z1 = seat_z + 0.06, h - 0.07
        bars = both_sides(beam((at(z0), half - 0.01, z0), (at(z1), -half + 0.01, z1), 0.024, 0.014))
        return [top, *bars]
    z = seat_z + 0.16
    return [curved_back(width, h - z - 0.005, 0.0, 0.018, 0.05).moved(at(z), 0, z)]


def windsor_chair(size: Size, wood: Material) -> Parts:
    """A Windsor: saddle seat, turned legs, bow and spindles."""
    d, w, h = size
    seat_z = 0.45
    parts = [prism(superellipse(d * 0.9, w * 0.94, 3.4, 36), 0.034, 0.012).moved(d * 0.03, 0, seat_z - 0.034)]
    top, foot = (d * 0.30, w * 0.30), (d * 0.46, w * 0.46)
    for sx in (1, -1):
        for sy in (1, -1):
            leg = bend(
                [
                    (sx * foot[0], sy * foot[1], 0),
                    (sx * 0.36 * d, sy * 0.37 * w, seat_z * 0.55),
                    (sx * top[0], sy * top[1], seat_z - 0.02),
                ],
                5,
            )
            parts.append(
                tube(
                    leg,
                    np.interp(
                        np.linspace(0, 1, len(leg)), [0, 0.25, 0.55, 0.8, 1], [0.011, 0.017, 0.021, 0.016, 0.012]
                    ),
                )
            )
    parts += both_sides(rod((0.4 * d, 0.4 * w, seat_z * 0.4), (-0.4 * d, 0.4 * w, seat_z * 0.4), 0.009))
    parts.append(rod((0, 0.4 * w, seat_z * 0.4), (0, -0.4 * w, seat_z * 0.4), 0.009))
    t = np.linspace(-np.pi / 2, np.pi / 2, 25)
    lean = 0.16 * d
    rise = (np.cos(t)) ** 0.55
    bow = np.stack(
        [
            -0.32 * d - lean * rise,
            0.43 * w * np.sign(t) * np.abs(np.sin(t)) ** 0.8 * (0.78 + 0.22 * rise**0.5),
            seat_z + (h - seat_z - 0.012) * rise,
        ],
        axis=1,
    )
    parts.append(tube(bow, 0.012))
    for k in np.linspace(-0.78, 0.78, 7):
        edge = bow[np.abs(bow[:, 1] - k * 0.44 * w).argmin()]
        parts.append(rod((-0.31 * d, k * 0.34 * w, seat_z - 0.01), edge, 0.008, 0.006, 7))
    return of(wood, *parts)


def shell_chair(size: Size, shell: Material, legs: Material, base: str) -> Parts:
    """A moulded one-piece shell on wooden dowels or steel tube."""
    d, w, h = size
    path = bend(
        [
            (0.48 * d, 0, 0.435),
            (0.40 * d, 0, 0.450),
            (0.1 * d, 0, 0.442),
            (-0.22 * d, 0, 0.441),
            (-0.36 * d, 0, 0.53),
            (-0.42 * d, 0, 0.66),
            (-0.49 * d, 0, h),
        ],
        4,
    )
    s = np.linspace(0, 1, len(path))[:, None]
    u = np.linspace(-1, 1, 15)[None, :]
    half = w / 2 * np.interp(s, [0, 0.12, 0.45, 0.72, 0.92, 1], [0.78, 0.94, 1.0, 0.94, 0.84, 0.62])
    curl = np.interp(s, [0, 0.1, 0.5, 0.8, 1], [0.0, 0.03, 0.085, 0.05, 0.015])
    x = path[:, :1] + curl * np.interp(s, [0, 0.4, 0.7, 1], [0, 0.3, 1, 1]) * u**2 * 0.9
    z = path[:, 2:] + curl * np.interp(s, [0, 0.4, 0.7, 1], [0.6, 0.4, 0.0, 0.0]) * u**2
    surface = np.stack([x, half * u, z], axis=-1)
    parts = of(shell, slab(surface, 0.012))
    hub = 0.405 if base == "wood" else 0.375
    if base == "wood":
        leg = rod((0.38 * d, 0.40 * w, 0), (0.16 * d, 0.2 * w, hub), 0.011, 0.017)
        braces = [
            rod((sx * 0.29 * d, 0.31 * w * sy, 0.17), (-sx * 0.21 * d, 0.25 * w * sy, 0.33), 0.004)
            for sx in (1, -1)
            for sy in (1, -1)
        ]
        cross = [rod((sx * 0.29 * d, 0.31 * w, 0.17), (sx * 0.21 * d, -0.25 * w, 0.33), 0.004) for sx in (1, -1)]
        return (
            parts
            + of(legs, *four(leg))
            + of(m.BLACK_STEEL, *braces, *cross, box((0.36 * d, 0.44 * w, 0.02)).moved(0, 0, hub - 0.012))
        )
    side = bend(
        [
            (0.4 * d, 0.44 * w, 0.012),
            (0.28 * d, 0.36 * w, hub),
            (-0.24 * d, 0.36 * w, hub),
            (-0.42 * d, 0.44 * w, 0.012),
        ],
        6,
    )
    return parts + of(
        legs,
        *both_sides(tube(side, 0.010)),
        *(rod((x, 0.36 * w, hub), (x, -0.36 * w, hub), 0.009) for x in (0.2 * d, -0.18 * d)),
    )


def padded_chair(size: Size, cloth: Material, legs: Material, arms: bool = False) -> Parts:
    """An upholstered dining chair on tapered legs."""
    d, w, h = size
    seat_z, back_t = 0.47, 0.075
    parts = of(legs, *four(taper((d * 0.44, w * 0.42, 0), (d * 0.36, w * 0.38, seat_z - 0.09), 0.024, 0.036)))
    parts += of(cloth, box((d * 0.92, w * 0.96, 0.05), 0.02, 2).moved(0.02, 0, seat_z - 0.105))
    parts += of(cloth, cushion((d * 0.94, w, 0.085), 8, 3.4, 12).moved(0.02, 0, seat_z - 0.065))
    back = (
        cushion((h - seat_z + 0.05, w * 0.98, back_t), 6, 3.2, 12)
        .turned("y", -97)
        .moved(-d * 0.36, 0, seat_z + (h - seat_z) / 2)
    )
    parts += of(cloth, back)
    if arms:
        arm = bend(
            [
                (0.3 * d, 0.47 * w, seat_z - 0.05),
                (0.3 * d, 0.5 * w, seat_z + 0.17),
                (0.1 * d, 0.5 * w, seat_z + 0.2),
                (-0.38 * d, 0.47 * w, seat_z + 0.22),
            ],
            6,
        )
        parts += of(legs, *both_sides(tube(arm, 0.014)))
    return parts


def metal_cafe_chair(size: Size, colour: Material, seat: Material | None) -> Parts:
    """A pressed-steel café chair with a bent tube back."""
    d, w, h = size
    seat_z = 0.45
    parts = of(colour, prism(superellipse(d * 0.74, w * 0.82, 6, 32), 0.022, 0.008).moved(0.04, 0, seat_z - 0.022))
    if seat is not None:
        parts += of(seat, prism(superellipse(d * 0.74, w * 0.84, 6, 32), 0.02, 0.007).moved(0.04, 0, seat_z))
    parts += of(colour, *both_sides(taper((d * 0.47, w * 0.46, 0), (d * 0.36, w * 0.34, seat_z - 0.01), 0.022, 0.044)))
    parts += of(
        colour, *both_sides(taper((-d * 0.44, w * 0.46, 0), (-d * 0.27, w * 0.34, seat_z - 0.01), 0.022, 0.044))
    )
    hoop = bend(
        [
            (-0.26 * d, 0.36 * w, seat_z - 0.02),
            (-0.36 * d, 0.41 * w, seat_z + 0.22),
            (-0.42 * d, 0.36 * w, h - 0.07),
            (-0.44 * d, 0.2 * w, h - 0.012),
            (-0.44 * d, 0, h - 0.01),
            (-0.44 * d, -0.2 * w, h - 0.012),
            (-0.42 * d, -0.36 * w, h - 0.07),
            (-0.36 * d, -0.41 * w, seat_z + 0.22),
            (-0.26 * d, -0.36 * w, seat_z - 0.02),
        ],
        5,
    )
    splat = curved_back(0.13, h - seat_z - 0.02, 0.0, 0.006, 0.17 * d).moved(-0.27 * d, 0, seat_z - 0.005)
    rails = both_sides(rod((0.4 * d, 0.40 * w, 0.2), (-0.36 * d, 0.40 * w, 0.2), 0.007))
    return parts + of(colour, tube(hoop, 0.012), splat, *rails)


def folding_chair(size: Size, wood: Material, frame: Material) -> Parts:
    """Crossed legs, slatted seat and back."""
    d, w, h = size
    seat_z, half = 0.45, w / 2 - 0.015
    long_leg = beam((0.46 * d, half, 0.0), (-0.42 * d, half, h - 0.02), 0.02, 0.03)
    short_leg = beam((-0.47 * d, half - 0.03, 0.0), (0.38 * d, half - 0.03, seat_z - 0.01), 0.02, 0.03)
    slats = [box((0.052, w - 0.03, 0.016), 0.005).moved(x, 0, seat_z) for x in np.linspace(-0.28 * d, 0.42 * d, 6)]
    backs = [
        curved_back(w, 0.06, 0.0, 0.014, 0.012).moved(-0.42 * d * (z / h) - 0.005, 0, z) for z in (h - 0.2, h - 0.1)
    ]
    rung = rod((0.3 * d, half, 0.15), (0.3 * d, -half, 0.15), 0.009)
    rung_back = rod((-0.33 * d, half - 0.03, 0.09), (-0.33 * d, -half + 0.03, 0.09), 0.009)
    return of(frame, *both_sides(long_leg, short_leg), rung, rung_back) + of(wood, *slats, *backs)


def cantilever_chair(size: Size, frame: Material, web: Material) -> Parts:
    """Bent steel tube with a cane or leather seat and back."""
    d, w, h = size
    half, seat_z = w / 2 - 0.014, 0.445
    path = [
        (-0.46 * d, half, 0.013),
        (0.38 * d, half, 0.013),
        (0.475 * d, half, 0.06),
        (0.475 * d, half, seat_z - 0.06),
        (0.40 * d, half, seat_z),
        (-0.28 * d, half, seat_z - 0.012),
        (-0.36 * d, half, seat_z + 0.06),
        (-0.47 * d, half, h - 0.01),
    ]
    dense = np.concatenate([np.linspace(a, b, 5, endpoint=False) for a, b in pairwise(path)] + [np.array([path[-1]])])
    seat = box((0.62 * d, w - 0.05, 0.026), 0.011, 2).moved(0.04 * d, 0, seat_z - 0.014)
    back = curved_back(w - 0.02, 0.24, 0.0, 0.024, 0.05).moved(-0.41 * d, 0, h - 0.245)
    base = rod((-0.46 * d, half, 0.013), (-0.46 * d, -half, 0.013), 0.012)
    return of(frame, *both_sides(tube(bend(dense, 2), 0.0125)), base) + of(web, seat, back)


def round_stool(size: Size, wood: Material, seat: Material, foot_ring: Material | None = None) -> Parts:
    """A round seat on splayed turned legs."""
    d, _, h = size
    r = d / 2
    legs = []
    for k in range(4):
        a = np.deg2rad(45 + 90 * k)
        c, s = np.cos(a), np.sin(a)
        legs.append(rod((c * r * 0.98, s * r * 0.98, 0), (c * r * 0.6, s * r * 0.6, h - 0.035), 0.012, 0.019))
    ring_z = 0.34 * h
    ring_r = r * (0.98 - 0.38 * 0.34)
    parts = of(wood, *legs)
    parts += of(foot_ring or wood, tube(ring_path(superellipse(2 * ring_r, 2 * ring_r), ring_z), 0.009, closed=True))
    return parts + of(
        seat,
        lathe(
            [
                (r * 0.84, h - 0.038),
                (r * 0.92, h - 0.03),
                (r * 0.92, h - 0.012),
                (r * 0.86, h - 0.002),
                (r * 0.5, h - 0.006),
                (0.02, h - 0.008),
            ],
            32,
        ),
    )


def pad_stool(size: Size, cloth: Material, frame: Material) -> Parts:
    """A bar stool: upholstered pad on a square steel frame."""
    d, w, h = size
    leg = taper((d / 2 - 0.012, w / 2 - 0.012, 0), (d / 2 - 0.03, w / 2 - 0.03, h - 0.07), 0.022, 0.022, 0.003)
    z = 0.32 * h
    rails = [beam((x, -w / 2 + 0.02, z), (x, w / 2 - 0.02, z), 0.018, 0.018) for x in (d / 2 - 0.018, -d / 2 + 0.018)]
    sides = both_sides(beam((-d / 2 + 0.02, w / 2 - 0.018, z), (d / 2 - 0.02, w / 2 - 0.018, z), 0.018, 0.018))
    top = box((d - 0.03, w - 0.03, 0.018), 0.004).moved(0, 0, h - 0.082)
    return of(frame, *four(leg), *rails, *sides, top) + of(cloth, cushion((d, w, 0.075), 7, 3.0).moved(0, 0, h - 0.075))


def swivel_stool(size: Size, seat: Material, steel: Material) -> Parts:
    """A round pad on a column over a disc foot."""
    d, _, h = size
    r = d / 2
    foot = lathe([(r * 0.98, 0), (r, 0.006), (r * 0.9, 0.014), (r * 0.2, 0.03), (0.032, 0.05)], 36)
    column = cylinder(0.025, h - 0.1).moved(z=0.03)
    ring_z = 0.36 * h
    ring = tube(ring_path(superellipse(d * 0.72, d * 0.72), ring_z), 0.009, closed=True)
    spoke = rod((-0.36 * d, 0, ring_z), (0.36 * d, 0, ring_z), 0.008)
    return of(steel, foot, column, ring, spoke) + of(
        seat, cushion((d * 0.95, d * 0.95, 0.085), 2, 3.4, 12).moved(z=h - 0.085)
    )


def step_stool(size: Size, wood: Material) -> Parts:
    """A farmhouse stool: plank top, slanted board ends."""
    d, w, h = size
    top = box((d, w, 0.03), 0.007).moved(z=h - 0.03)
    end = taper((0, 0, 0), (0, 0, h - 0.03), 0.024, 0.024)
    board = both_sides(end.scaled(x=d * 0.82 / 0.024).moved(y=w * 0.36))
    return of(wood, top, *board, beam((0, -w * 0.36, h * 0.35), (0, w * 0.36, h * 0.35), 0.022, 0.06))


def wooden_bench(size: Size, wood: Material, legs: Material, planks: int = 2) -> Parts:
    """Planks on two trestles."""
    d, w, h = size
    gap = 0.008
    each = (d - gap * (planks - 1)) / planks
    tops = [
        box((each, w, 0.034), 0.006).moved(-d / 2 + each / 2 + k * (each + gap), 0, h - 0.034) for k in range(planks)
    ]
    leg = taper((d * 0.42, w / 2 - 0.09, 0), (d * 0.38, w / 2 - 0.13, h - 0.034), 0.042, 0.056)
    ties = both_sides(beam((-d * 0.42, w / 2 - 0.125, h - 0.07), (d * 0.42, w / 2 - 0.125, h - 0.07), 0.03, 0.07))
    return of(wood, *tops) + of(
        legs, *four(leg), *ties, beam((0, -w / 2 + 0.12, h * 0.72), (0, w / 2 - 0.12, h * 0.72), 0.03, 0.05)
    )


def padded_bench(size: Size, cloth: Material, legs: Material) -> Parts:
    """An upholstered hall or bed-end bench."""
    d, w, h = size
    leg = taper((d / 2 - 0.04, w / 2 - 0.07, 0), (d / 2 - 0.06, w / 2 - 0.1, h - 0.13), 0.024, 0.04)
    frame = box((d - 0.04, w - 0.04, 0.045), 0.006).moved(z=h - 0.15)
    pad = cushion((d, w, 0.12), 12, 3.6, 14).moved(z=h - 0.12)
    piping = tube(ring_path(superellipse(d * 0.985, w * 0.99, 11, 64), h - 0.06), 0.004, 6, closed=True)
    return of(legs, *four(leg), frame) + of(cloth, pad, piping)


def hairpin_bench(size: Size, wood: Material, steel: Material) -> Parts:
    """A thick plank on bent steel rod."""
    d, w, h = size
    pin = bend(
        [
            (d * 0.44, w / 2 - 0.1, h - 0.04),
            (d * 0.40, w / 2 - 0.07, 0.02),
            (d * 0.385, w / 2 - 0.075, 0.007),
            (d * 0.36, w / 2 - 0.09, 0.02),
            (d * 0.3, w / 2 - 0.19, h - 0.04),
        ],
        5,
    )
    return of(wood, box((d, w, 0.045), 0.009).moved(z=h - 0.045)) + of(steel, *four(tube(pin, 0.006)))


def _chair(name: str, caption: str, size: Size, style: str, build: Builder) -> Design:
    return Design(f"chair-{name}", "chair", caption, size, style, build)


def _stool(name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold) -> Design:
    return Design(f"stool-{name}", "stool", caption, size, style, build, symmetry)


def _bench(name: str, caption: str, size: Size, style: str, build: Builder) -> Design:
    return Design(f"bench-{name}", "bench", caption, size, style, build, 2)


DESIGNS: tuple[Design, ...] = (
    _chair(
        "slat-oak",
        "oak dining chair with a slatted back",
        (0.53, 0.46, 0.88),
        "classic",
        partial(dining_chair, wood=m.OAK, seat=None, back="slats"),
    ),
    _chair(
        "ladder-walnut",
        "walnut ladder-back chair with a linen seat",
        (0.52, 0.47, 0.98),
        "rustic",
        partial(dining_chair, wood=m.WALNUT, seat=m.LINEN, back="ladder"),
    ),
    _chair(
        "panel-birch",
        "birch chair with a plain panel back",
        (0.51, 0.46, 0.80),
        "minimal",
        partial(dining_chair, wood=m.BIRCH, seat=None, back="panel"),
    ),
    _chair(
        "cross-black",
        "black cross-back chair with a cane seat",
        (0.52, 0.48, 0.89),
        "rustic",
        partial(dining_chair, wood=m.BLACK_WOOD, seat=m.RATTAN, back="cross"),
    ),
    _chair(
        "slat-mahogany",
        "mahogany dining chair with a leather seat",
        (0.55, 0.50, 1.02),
        "classic",
        partial(dining_chair, wood=m.MAHOGANY, seat=m.BROWN_LEATHER, back="slats"),
    ),
    _chair(
        "windsor-oak",
        "oak Windsor chair with a hooped spindle back",
        (0.54, 0.50, 0.93),
        "classic",
        partial(windsor_chair, wood=m.OAK),
    ),
    _chair(
        "windsor-black", "black Windsor chair", (0.52, 0.48, 0.86), "rustic", partial(windsor_chair, wood=m.BLACK_WOOD)
    ),
    _chair(
        "shell-white",
        "white shell chair on beech dowels",
        (0.53, 0.47, 0.82),
        "modern",
        partial(shell_chair, shell=m.WHITE, legs=m.BIRCH, base="wood"),
    ),
    _chair(
        "shell-sage",
        "sage moulded chair on steel tube",
        (0.54, 0.48, 0.80),
        "modern",
        partial(shell_chair, shell=m.SAGE, legs=m.BLACK_STEEL, base="steel"),
    ),
    _chair(
        "padded-grey",
        "grey upholstered dining chair",
        (0.58, 0.49, 0.87),
        "modern",
        partial(padded_chair, cloth=m.GREY_FABRIC, legs=m.OAK),
    ),
    _chair(
        "padded-blue",
        "slate blue upholstered chair with arms",
        (0.59, 0.56, 0.84),
        "modern",
        partial(padded_chair, cloth=m.BLUE_FABRIC, legs=m.BLACK_STEEL, arms=True),
    ),
    _chair(
        "padded-tan",
        "tan leather dining chair",
        (0.60, 0.48, 0.95),
        "classic",
        partial(padded_chair, cloth=m.TAN_LEATHER, legs=m.DARK_WALNUT),
    ),
    _chair(
        "cafe-steel",
        "pressed-steel café chair",
        (0.49, 0.45, 0.85),
        "industrial",
        partial(metal_cafe_chair, colour=m.BLACK_STEEL, seat=None),
    ),
    _chair(
        "cafe-wood-seat",
        "steel café chair with an oak seat",
        (0.50, 0.46, 0.84),
        "industrial",
        partial(metal_cafe_chair, colour=m.IRON, seat=m.OAK),
    ),
    _chair(
        "folding-pine",
        "slatted pine folding chair",
        (0.50, 0.45, 0.79),
        "minimal",
        partial(folding_chair, wood=m.PINE, frame=m.PINE),
    ),
    _chair(
        "folding-black",
        "folding chair with a black frame and oak slats",
        (0.48, 0.43, 0.80),
        "industrial",
        partial(folding_chair, wood=m.OAK, frame=m.BLACK_STEEL),
    ),
    _chair(
        "cantilever-cane",
        "chrome cantilever chair with cane seat and back",
        (0.57, 0.47, 0.82),
        "modern",
        partial(cantilever_chair, frame=m.CHROME, web=m.RATTAN),
    ),
    _chair(
        "cantilever-black",
        "cantilever chair in black leather",
        (0.58, 0.50, 0.86),
        "modern",
        partial(cantilever_chair, frame=m.CHROME, web=m.BLACK_LEATHER),
    ),
    _stool(
        "round-oak",
        "low round oak stool",
        (0.36, 0.36, 0.45),
        "minimal",
        partial(round_stool, wood=m.OAK, seat=m.OAK),
        4,
    ),
    _stool(
        "bar-walnut",
        "walnut bar stool with a brass foot ring",
        (0.40, 0.40, 0.75),
        "modern",
        partial(round_stool, wood=m.WALNUT, seat=m.WALNUT, foot_ring=m.BRASS),
        4,
    ),
    _stool(
        "bar-pad",
        "bar stool with a grey pad on a steel frame",
        (0.40, 0.42, 0.68),
        "industrial",
        partial(pad_stool, cloth=m.GREY_FABRIC, frame=m.BLACK_STEEL),
        2,
    ),
    _stool(
        "bar-leather",
        "tan leather bar stool",
        (0.38, 0.40, 0.76),
        "industrial",
        partial(pad_stool, cloth=m.TAN_LEATHER, frame=m.IRON),
        2,
    ),
    _stool(
        "swivel",
        "swivel stool with a black leather seat",
        (0.40, 0.40, 0.72),
        "modern",
        partial(swivel_stool, seat=m.BLACK_LEATHER, steel=m.CHROME),
        36,
    ),
    _stool(
        "farm-pine", "small pine farmhouse stool", (0.26, 0.40, 0.34), "rustic", partial(step_stool, wood=m.PINE), 2
    ),
    _bench("plank-oak", "oak plank bench", (0.36, 1.30, 0.45), "rustic", partial(wooden_bench, wood=m.OAK, legs=m.OAK)),
    _bench(
        "plank-reclaimed",
        "reclaimed-wood bench with black legs",
        (0.38, 1.50, 0.46),
        "industrial",
        partial(wooden_bench, wood=m.RECLAIMED, legs=m.BLACK_WOOD, planks=3),
    ),
    _bench(
        "padded-linen",
        "linen upholstered bench",
        (0.42, 1.20, 0.48),
        "classic",
        partial(padded_bench, cloth=m.LINEN, legs=m.WALNUT),
    ),
    _bench(
        "padded-green",
        "forest green upholstered bench",
        (0.44, 1.05, 0.46),
        "modern",
        partial(padded_bench, cloth=m.GREEN_FABRIC, legs=m.BRASS),
    ),
    _bench(
        "hairpin",
        "walnut bench on hairpin legs",
        (0.36, 1.10, 0.45),
        "industrial",
        partial(hairpin_bench, wood=m.WALNUT, steel=m.BLACK_STEEL),
    ),
)
