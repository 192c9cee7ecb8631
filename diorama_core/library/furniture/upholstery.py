"""Sofas, armchairs, ottomans and office chairs: what is soft."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, four, of, turned
from diorama_core.library.furniture.solids import (
    Solid,
    ball,
    beam,
    bend,
    box,
    cushion,
    cylinder,
    lathe,
    loft,
    pillow,
    ring_path,
    rod,
    slab,
    superellipse,
    taper,
    tube,
)
from diorama_core.library.record import SymmetryFold

ArmKind = Literal["track", "rolled", "slim", "pillow", "wood", "none"]


def seat_cushion(d: float, w: float, t: float) -> list[Solid]:
    """A boxed seat cushion with piping round its upper and lower edge, standing on z = 0."""
    pad = cushion((d, w, t), 9, 4.5, 10)
    crown = cushion((d * 0.93, w * 0.93, 0.05), 5, 2.4, 7).moved(z=t - 0.032)
    piping = tube(ring_path(superellipse(d * 0.965, w * 0.965, 9, 36), t * 0.87), 0.005, 4, closed=True)
    return [pad, crown, piping]


def back_cushion(w: float, h: float, t: float, lean_deg: float = 12.0) -> Solid:
    """A loose back cushion leaning back, its foot at the origin, plump toward +X."""
    pad = cushion((h, w, t), 5.5, 2.7, 10).turned("y", -90)
    return pad.moved(x=t, z=h / 2).turned("y", -lean_deg)


def arm(kind: ArmKind, d: float, thick: float, h: float, z0: float) -> list[Solid]:
    """An arm rest along x, centred on y = 0, from `z0` up to `h`."""
    if kind == "rolled":
        r = thick * 0.52
        roll = cylinder(r, d, 0.02, 24).turned("y", 90).moved(-d / 2, 0.02, h - r)
        face = cylinder(r * 0.55, 0.01, 0.004, 20).turned("y", 90).moved(d / 2 - 0.003, 0.02, h - r)
        return [roll, face, box((d - 0.03, thick * 0.72, h - r - z0), 0.02, 2).moved(-0.01, -0.01, z0)]
    if kind == "pillow":
        body = box((d, thick, h - z0 - 0.06), 0.03, 2).moved(z=z0)
        return [body, cushion((d * 0.99, thick * 1.04, 0.12), 8, 3).moved(z=h - 0.12)]
    return [box((d, thick, h - z0), 0.035 if kind == "track" else 0.02, 3).moved(z=z0)]


def sofa(
    size: Size,
    cloth: Material,
    legs: Material,
    seats: int = 3,
    arms: ArmKind = "track",
    tufted: bool = False,
    plinth_base: bool = False,
    seat_h: float = 0.44,
    pillows: tuple[Material, ...] = (),
) -> Parts:
    """A sofa or, with one seat, an armchair: base, seat and back cushions, arms."""
    d, w, h = size
    thick = {"track": 0.15, "rolled": 0.19, "slim": 0.085, "pillow": 0.2, "wood": 0.05, "none": 0.0}[arms]
    leg_h = 0.03 if plinth_base else 0.13
    cush = 0.15
    inner, back_t = w - 2 * thick, 0.17
    arm_h = min(seat_h + (0.17 if arms != "rolled" else 0.2), h - 0.05)
    base_h = seat_h - cush + 0.01
    parts = of(cloth, box((d - 0.02, w - (0 if arms == "none" else 0.03), base_h - leg_h), 0.02, 2).moved(0, 0, leg_h))
    frame_h = h - (0.02 if tufted else 0.07)
    parts += of(
        cloth,
        box((back_t, w - 2 * thick * 0.9 if arms != "none" else w, frame_h - leg_h), 0.05, 3).moved(
            -d / 2 + back_t / 2 + 0.005, 0, leg_h
        ),
    )
    parts += of(cloth, *_seats_and_backs(d, inner, h, seats, seat_h, cush, back_t, tufted))
    if arms == "wood":
        parts += _wooden_arms(d, w, arm_h, legs)
    elif arms != "none":
        parts += of(cloth, *both_sides(*(s.moved(0, w / 2 - thick / 2) for s in arm(arms, d, thick, arm_h, leg_h))))
    foot = (
        box((0.06, 0.06, leg_h + 0.01), 0.004)
        if plinth_base
        else taper((0.012, 0.012, 0), (0, 0, leg_h + 0.01), 0.026, 0.044)
    )
    if arms != "wood":
        parts += of(legs, *four(foot.moved(d / 2 - 0.07, w / 2 - 0.08)))
    for k, material in enumerate(pillows):
        side = 1 if k % 2 == 0 else -1
        lying = turned(of(material, pillow((0.42, 0.42, 0.16))), "y", -72)
        parts += [
            p.turned("z", -side * 14).moved(-d / 2 + back_t + 0.24, side * (inner / 2 - 0.25), seat_h + 0.19)
            for p in lying
        ]
    return parts


def _seats_and_backs(
    d: float, inner: float, h: float, seats: int, seat_h: float, cush: float, back_t: float, tufted: bool
) -> list[Solid]:
    each = inner / seats
    seat_d = d - back_t + 0.01
    solids: list[Solid] = []
    for k in range(seats):
        y = -inner / 2 + each * (k + 0.5)
        solids += [s.moved(d / 2 - seat_d / 2, y, seat_h - cush) for s in seat_cushion(seat_d, each - 0.006, cush)]
        if not tufted:
            solids.append(
                back_cushion(each - 0.008, h - seat_h + 0.03, 0.2).moved(-d / 2 + back_t - 0.03, y, seat_h - 0.03)
            )
    return solids + (_tufting(inner, h, seat_h, -d / 2 + back_t) if tufted else [])


def _tufting(inner: float, h: float, seat_h: float, x: float) -> list[Solid]:
    """A buttoned back: one surface with dimples."""
    rows, cols = 25, 57
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, cols), indexing="ij")
    z, y = seat_h - 0.04 + v * (h - seat_h - 0.01), -(u - 0.5) * inner
    pitch = 0.155
    gy, gz = np.cos(2 * np.pi * y / pitch), np.cos(2 * np.pi * (z - seat_h) / pitch)
    dimple = (
        np.clip(gy * gz, 0, 1) ** 2
        + np.clip(np.sin(2 * np.pi * y / pitch) * np.sin(2 * np.pi * (z - seat_h) / pitch), 0, 1) ** 2 * 0
    )
    edge = (1 - (2 * u - 1) ** 8) * (1 - (2 * v - 1) ** 8)
    surface = np.stack([x + (0.065 - 0.035 * dimple) * edge**0.6 - 0.05 * v, y, z], axis=-1)
    return [slab(surface, 0.02)]


def _wooden_arms(d: float, w: float, arm_h: float, wood: Material) -> Parts:
    y = w / 2 - 0.025
    rest = bend([(-d / 2 + 0.03, y, arm_h - 0.04), (0, y, arm_h - 0.01), (d / 2 - 0.05, y, arm_h - 0.012)], 5)
    flat = tube(rest, 0.02, 10).scaled(y=1.0)
    posts = [
        taper((d / 2 - 0.05, y, 0), (d / 2 - 0.09, y, arm_h), 0.03, 0.04),
        taper((-d / 2 + 0.02, y, 0), (-d / 2 + 0.1, y, arm_h + 0.06), 0.03, 0.044),
    ]
    rail = beam((-d / 2 + 0.06, y, 0.24), (d / 2 - 0.07, y, 0.24), 0.03, 0.06)
    return of(wood, *both_sides(flat, *posts, rail))


def corner_sofa(size: Size, cloth: Material, legs: Material) -> Parts:
    """An L-shaped sofa: a chaise at its left."""
    d, w, h = size
    body = 0.95
    chaise = 0.85
    main = sofa((body, w, h), cloth, legs, 3, "slim")
    parts = [p.moved(-d / 2 + body / 2) for p in main]
    y = w / 2 - chaise / 2
    length = d - body + 0.12
    pad = [s.moved(d / 2 - length / 2, y - 0.02, 0.29) for s in seat_cushion(length, chaise - 0.05, 0.15)]
    base = box((length + 0.04, chaise, 0.17), 0.02, 2).moved(d / 2 - length / 2 - 0.02, y, 0.13)
    feet = [
        taper(
            (d / 2 - 0.07, y + s * (chaise / 2 - 0.07), 0),
            (d / 2 - 0.07, y + s * (chaise / 2 - 0.07), 0.14),
            0.026,
            0.044,
        )
        for s in (1, -1)
    ]
    return parts + of(cloth, *pad, base) + of(legs, *feet)


def wing_chair(size: Size, cloth: Material, legs: Material) -> Parts:
    """A tall armchair with wings."""
    d, w, h = size
    parts = sofa((d, w, h * 0.80), cloth, legs, 1, "rolled", seat_h=0.46)
    back = box((0.14, w - 0.2, h - 0.46), 0.06, 3).turned("y", -7).moved(-d / 2 + 0.13, 0, 0.44)
    wing = cushion((0.34, 0.075, h - 0.62), 4.5, 4.0, 12).moved(-d / 2 + 0.22, w / 2 - 0.10, 0.6)
    pad = back_cushion(w - 0.26, h - 0.52, 0.15, 8).moved(-d / 2 + 0.14, 0, 0.46)
    return parts + of(cloth, back, *both_sides(wing), pad)


def barrel_chair(size: Size, cloth: Material, base: Material) -> Parts:
    """A round tub chair with a wrap-around back."""
    d, w, h = size
    t = np.linspace(-2.35, 2.35, 41)
    v = np.linspace(0, 1, 7)
    rise = 0.44 + (h - 0.44) * np.clip(np.cos(t / 2.35 * np.pi / 2), 0, 1) ** 0.7 * 0.85 + (h - 0.44) * 0.15
    a = np.pi - t
    r = 0.43
    x = (r * d * 1.03 * np.cos(a))[None, :] * (1 + 0.06 * v[:, None])
    y = (r * w * np.sin(a))[None, :] * (1 + 0.06 * v[:, None])
    z = 0.06 + (rise - 0.06)[None, :] * v[:, None]
    wall = slab(np.stack([x, y, z], axis=-1)[:, ::-1], 0.11)
    rolled = tube(np.stack([x[-1], y[-1], z[-1]], axis=1), 0.056, 10)
    ends = [ball(0.112).moved(x[-1, k], y[-1, k], z[-1, k] - 0.056) for k in (0, -1)]
    seat = [s.moved(0.05, 0, 0.3) for s in (cushion((d * 0.82, w * 0.80, 0.15), 2.6, 4, 14),)]
    drum = lathe([(r * 0.9 * d, 0.05), (r * 0.93 * d, 0.06), (r * 0.93 * d, 0.32), (r * 0.9 * d, 0.33)], 36)
    return of(cloth, wall, rolled, *ends, *seat, drum) + of(base, cylinder(0.36 * d, 0.055, 0.004, 36))


def lounge_chair(size: Size, cloth: Material, wood: Material) -> Parts:
    """An open wooden frame with a loose seat and back cushion."""
    d, w, h = size
    y = w / 2 - 0.03
    front, rear = d / 2 - 0.06, -d / 2 + 0.12
    legs = [
        taper((front + 0.03, y, 0), (front - 0.04, y, 0.56), 0.026, 0.042),
        taper((rear - 0.06, y, 0), (rear + 0.03, y, 0.58), 0.026, 0.042),
    ]
    rest = tube(
        bend([(rear - 0.06, y, 0.565), (0, y, 0.595), (front + 0.03, y, 0.57)], 6),
        [*np.linspace(0.016, 0.026, 7), *np.linspace(0.026, 0.016, 6)],
        10,
    )
    rails = [beam((front - 0.03, y, 0.33), (rear, y, 0.27), 0.024, 0.06)]
    cross = [
        beam((front - 0.04, -y, 0.32), (front - 0.04, y, 0.32), 0.03, 0.06),
        beam((rear + 0.02, -y, 0.27), (rear + 0.02, y, 0.27), 0.03, 0.05),
    ]
    slats = [
        rod((rear + 0.05, s, 0.34), (-d / 2 + 0.02, s, h - 0.02), 0.009, segments=8)
        for s in np.linspace(-0.6 * y, 0.6 * y, 5)
    ]
    top = beam((-d / 2 + 0.02, -0.72 * y, h - 0.03), (-d / 2 + 0.02, 0.72 * y, h - 0.03), 0.02, 0.05)
    post = both_sides(beam((rear + 0.06, 0.7 * y, 0.28), (-d / 2 + 0.02, 0.7 * y, h - 0.02), 0.03, 0.03))
    seat = turned(of(cloth, *seat_cushion(d * 0.76, 2 * y - 0.06, 0.13)), "y", -5)
    seat = [p.moved(0.06, 0, 0.33) for p in seat]
    back = back_cushion(2 * y - 0.09, h - 0.36, 0.14, 20).moved(-d / 2 + 0.18, 0, 0.39)
    return of(wood, *both_sides(*legs, rest, *rails), *cross, *slats, top, *post) + seat + of(cloth, back)


def rocking_chair(size: Size, wood: Material, cloth: Material) -> Parts:
    """A spindle-backed rocking chair."""
    d, w, h = size
    y = w / 2 - 0.05
    t = np.linspace(-1, 1, 15)
    runner = np.stack([0.49 * d * t, np.full(15, y), 0.016 + 0.085 * t**2], axis=1)
    seat_z = 0.43
    sides = [
        tube(runner, 0.018, 8),
        rod((0.26 * d, y, 0.04), (0.2 * d, y - 0.02, 0.64), 0.016),
        rod((-0.22 * d, y, 0.04), (-0.2 * d, y - 0.03, seat_z), 0.018),
        tube(bend([(0.26 * d, y - 0.01, 0.645), (0, y + 0.005, 0.655), (-0.30 * d, y - 0.04, 0.66)], 5), 0.017, 8),
        rod((-0.2 * d, y - 0.03, seat_z), (-0.40 * d, y - 0.04, h - 0.02), 0.018, 0.013),
    ]
    spindles = [
        rod((-0.2 * d, s * 0.85, seat_z), (-0.385 * d, s, h - 0.06), 0.007, segments=7)
        for s in np.linspace(-y + 0.1, y - 0.1, 7)
    ]
    top = beam((-0.39 * d, -y + 0.02, h - 0.05), (-0.39 * d, y - 0.02, h - 0.05), 0.024, 0.09, 0.01)
    seat = box((0.5 * d, 2 * y, 0.035), 0.012, 2).moved(0.02, 0, seat_z - 0.035)
    return of(wood, *both_sides(*sides), *spindles, top, seat) + of(
        cloth, cushion((0.46 * d, 2 * y - 0.04, 0.06), 6, 2.4).moved(0.02, 0, seat_z - 0.01)
    )


def square_ottoman(size: Size, cloth: Material, legs: Material) -> Parts:
    """An upholstered footstool with piping."""
    d, w, h = size
    piping = [
        tube(ring_path(superellipse(d * 0.975, w * 0.975, 10, 56), z), 0.005, 5, closed=True) for z in (h - 0.13,)
    ]
    return of(
        legs, *four(taper((d / 2 - 0.05, w / 2 - 0.05, 0), (d / 2 - 0.065, w / 2 - 0.065, 0.12), 0.024, 0.04))
    ) + of(
        cloth,
        box((d - 0.02, w - 0.02, h - 0.2), 0.02, 2).moved(z=0.1),
        cushion((d, w, 0.15), 10, 4, 12).moved(z=h - 0.15),
        *piping,
    )


def round_pouf(size: Size, cloth: Material, ribs: int = 0) -> Parts:
    """A floor pouf; ribbed like a knitted or leather one when `ribs` is given."""
    d, _, h = size
    n, rows = max(8 * ribs, 40), 13
    a = np.arange(n) * 2 * np.pi / n
    groove = 1 - 0.035 * np.abs(np.cos(ribs * a / 2)) ** 6 if ribs else np.ones(n)
    t = np.linspace(-1, 1, rows)
    r = (1 - np.abs(t) ** 3.2) ** (1 / 2.4)
    r[0] = r[-1] = 0.03
    rings = np.stack(
        [
            np.stack([np.cos(a) * groove * rr, np.sin(a) * groove * rr, np.full(n, tt)], axis=1)
            for rr, tt in zip(r, t, strict=True)
        ]
    )
    rings *= np.array([d / 2, d / 2, h / 2])
    rings[:, :, 2] += h / 2
    return of(cloth, loft(rings, crease_rad=np.pi), cylinder(0.022, 0.008, 0.003, 16).moved(z=h - 0.006))


def office_chair(
    size: Size, cloth: Material, frame: Material, back: Literal["mesh", "padded", "high"], arms: bool = True
) -> Parts:
    """A swivel chair on a five-star base with castors."""
    d, w, h = size
    seat_z, r = 0.47, 0.5 * min(d, w) * 0.96
    star: list[Solid] = []
    for k in range(5):
        spoke = tube([(0.03, 0, 0.105), (r * 0.6, 0, 0.085), (r - 0.02, 0, 0.07)], [0.026, 0.02, 0.015], 8)
        wheel = cylinder(0.028, 0.02, 0.006, 16).turned("x", 90)
        star += [
            s.turned("z", 72 * k)
            for s in (
                spoke,
                wheel.moved(r - 0.028, 0.026, 0.028),
                wheel.moved(r - 0.028, -0.006, 0.028),
                rod((r - 0.025, 0, 0.03), (r - 0.025, 0, 0.08), 0.01),
            )
        ]
    lift = [
        cylinder(0.03, 0.2, 0.004, 16).moved(z=0.09),
        cylinder(0.02, 0.22, 0.003, 16).moved(z=0.22),
        box((0.22, 0.16, 0.04), 0.012).moved(-0.02, 0, seat_z - 0.1),
    ]
    seat = cushion((0.47, min(0.5, 0.82 * w), 0.09), 5, 3.2, 12).moved(0.03, 0, seat_z - 0.07)
    parts = of(frame, *star, *lift) + of(cloth, seat)
    bx, bh = -0.22, h - seat_z - 0.06
    width = 0.72 * w if back != "high" else 0.78 * w
    stem = tube(
        bend(
            [
                (-0.1, 0, seat_z - 0.08),
                (-0.25, 0, seat_z - 0.04),
                (bx - 0.065, 0, seat_z + 0.14),
                (bx - 0.075, 0, seat_z + 0.3),
            ],
            5,
        ),
        0.02,
        8,
    )
    v, u = np.meshgrid(np.linspace(0, 1, 11), np.linspace(-1, 1, 15), indexing="ij")
    half = width / 2 * (1 - 0.16 * np.abs(2 * v - 0.9) ** 3) * 1.0
    x = bx + 0.06 * u**2 - 0.09 * v**2 + 0.03 * np.sin(np.pi * v)
    z = seat_z + 0.06 + bh * (0.5 + (v - 0.5) * (1 - 0.10 * np.abs(u) ** 5))
    panel = np.stack([x, -half * u, z], axis=-1)
    thick = {"mesh": 0.014, "padded": 0.05, "high": 0.085}[back]
    rim = np.concatenate([panel[0], panel[1:, -1], panel[-1, -2::-1], panel[-2:0:-1, 0]])
    parts += of(cloth, slab(panel, thick)) + of(frame, stem)
    parts += of(frame if back == "mesh" else cloth, tube(rim, max(0.012, thick / 2), 7, closed=True))
    if arms:
        y = 0.46 * w
        post = tube(
            bend(
                [
                    (-0.05, 0.2, seat_z - 0.07),
                    (-0.03, y * 0.98, seat_z - 0.05),
                    (-0.02, y, seat_z + 0.05),
                    (0.0, y, seat_z + 0.18),
                ],
                4,
            ),
            0.014,
            8,
        )
        parts += of(frame, *both_sides(post, box((0.25, 0.075, 0.03), 0.013, 2).moved(0.0, y, seat_z + 0.175)))
    return parts


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 1
) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d(
        "sofa",
        "grey-three",
        "grey three-seat sofa with track arms",
        (0.95, 2.10, 0.84),
        "modern",
        partial(sofa, cloth=m.GREY_FABRIC, legs=m.OAK),
    ),
    _d(
        "sofa",
        "blue-two",
        "slate blue two-seat sofa",
        (0.90, 1.60, 0.82),
        "modern",
        partial(sofa, cloth=m.BLUE_FABRIC, legs=m.WALNUT, seats=2, arms="slim"),
    ),
    _d(
        "sofa",
        "linen-rolled",
        "linen sofa with rolled arms",
        (0.98, 2.05, 0.88),
        "classic",
        partial(sofa, cloth=m.LINEN, legs=m.DARK_WALNUT, seats=3, arms="rolled", plinth_base=True),
    ),
    _d(
        "sofa",
        "leather-tan",
        "tan leather sofa",
        (0.92, 1.95, 0.80),
        "industrial",
        partial(sofa, cloth=m.TAN_LEATHER, legs=m.BLACK_STEEL, seats=2, arms="slim"),
    ),
    _d(
        "sofa",
        "chesterfield",
        "brown leather chesterfield sofa",
        (0.92, 2.05, 0.76),
        "classic",
        partial(sofa, cloth=m.BROWN_LEATHER, legs=m.DARK_WALNUT, seats=3, arms="rolled", tufted=True),
    ),
    _d(
        "sofa",
        "green-plush",
        "forest green sofa with pillow arms",
        (1.00, 2.20, 0.82),
        "modern",
        partial(sofa, cloth=m.GREEN_FABRIC, legs=m.BLACK, seats=2, arms="pillow", plinth_base=True),
    ),
    _d(
        "sofa",
        "oatmeal-low",
        "low oatmeal three-seat sofa",
        (1.02, 2.40, 0.74),
        "minimal",
        partial(sofa, cloth=m.OATMEAL, legs=m.BLACK, arms="track", plinth_base=True, seat_h=0.4),
    ),
    _d(
        "sofa",
        "wood-arm",
        "sofa with a wooden frame and rust cushions",
        (0.85, 1.75, 0.82),
        "rustic",
        partial(sofa, cloth=m.RUST_FABRIC, legs=m.OAK, seats=3, arms="wood"),
    ),
    _d(
        "sofa",
        "corner",
        "light grey corner sofa with a chaise",
        (1.60, 2.50, 0.82),
        "modern",
        partial(corner_sofa, cloth=m.LIGHT_FABRIC, legs=m.BLACK),
    ),
    _d(
        "sofa",
        "daybed",
        "armless charcoal daybed",
        (0.88, 1.90, 0.78),
        "minimal",
        partial(sofa, cloth=m.CHARCOAL_FABRIC, legs=m.OAK, seats=2, arms="none"),
    ),
    _d(
        "armchair",
        "track-beige",
        "beige armchair with track arms",
        (0.86, 0.84, 0.84),
        "modern",
        partial(sofa, cloth=m.BEIGE_FABRIC, legs=m.WALNUT, seats=1),
    ),
    _d(
        "armchair",
        "club-leather",
        "brown leather club chair",
        (0.88, 0.90, 0.80),
        "classic",
        partial(sofa, cloth=m.BROWN_LEATHER, legs=m.DARK_WALNUT, seats=1, arms="rolled"),
    ),
    _d(
        "armchair",
        "wing-blue",
        "navy wing chair",
        (0.84, 0.78, 1.08),
        "classic",
        partial(wing_chair, cloth=m.NAVY_FABRIC, legs=m.DARK_WALNUT),
    ),
    _d(
        "armchair",
        "tub-rose",
        "dusty rose tub chair",
        (0.76, 0.78, 0.74),
        "modern",
        partial(barrel_chair, cloth=m.ROSE_FABRIC, base=m.DARK_WALNUT),
    ),
    _d(
        "armchair",
        "tub-cream",
        "cream tub chair",
        (0.80, 0.84, 0.78),
        "minimal",
        partial(barrel_chair, cloth=m.LINEN, base=m.BLACK),
    ),
    _d(
        "armchair",
        "lounge-oak",
        "oak lounge chair with grey cushions",
        (0.80, 0.72, 0.84),
        "modern",
        partial(lounge_chair, cloth=m.GREY_FABRIC, wood=m.OAK),
    ),
    _d(
        "armchair",
        "lounge-walnut",
        "walnut lounge chair with olive cushions",
        (0.82, 0.74, 0.86),
        "modern",
        partial(lounge_chair, cloth=m.OLIVE_FABRIC, wood=m.WALNUT),
    ),
    _d(
        "armchair",
        "rocking",
        "rocking chair with spindles",
        (0.88, 0.64, 1.04),
        "rustic",
        partial(rocking_chair, wood=m.OAK, cloth=m.LINEN),
    ),
    _d(
        "armchair",
        "recliner",
        "black leather armchair with padded arms",
        (0.95, 0.98, 0.98),
        "modern",
        partial(sofa, cloth=m.BLACK_LEATHER, legs=m.BLACK, seats=1, arms="pillow", plinth_base=True, seat_h=0.47),
    ),
    _d(
        "ottoman",
        "square-grey",
        "square grey footstool",
        (0.55, 0.60, 0.42),
        "modern",
        partial(square_ottoman, cloth=m.GREY_FABRIC, legs=m.OAK),
        2,
    ),
    _d(
        "ottoman",
        "wide-leather",
        "wide brown leather ottoman",
        (0.60, 0.90, 0.43),
        "classic",
        partial(square_ottoman, cloth=m.BROWN_LEATHER, legs=m.DARK_WALNUT),
        2,
    ),
    _d(
        "ottoman",
        "pouf-oatmeal",
        "ribbed oatmeal pouf",
        (0.55, 0.55, 0.38),
        "rustic",
        partial(round_pouf, cloth=m.OATMEAL, ribs=16),
        36,
    ),
    _d(
        "ottoman",
        "pouf-leather",
        "tan leather pouf",
        (0.52, 0.52, 0.36),
        "modern",
        partial(round_pouf, cloth=m.TAN_LEATHER, ribs=10),
        36,
    ),
    _d(
        "ottoman",
        "pouf-ochre",
        "smooth ochre pouf",
        (0.58, 0.58, 0.40),
        "modern",
        partial(round_pouf, cloth=m.MUSTARD_FABRIC),
        36,
    ),
    _d(
        "office chair",
        "mesh-black",
        "black mesh office chair",
        (0.64, 0.64, 1.00),
        "modern",
        partial(office_chair, cloth=m.CHARCOAL_FABRIC, frame=m.BLACK, back="mesh"),
    ),
    _d(
        "office chair",
        "task-blue",
        "blue task chair without arms",
        (0.60, 0.60, 0.92),
        "minimal",
        partial(office_chair, cloth=m.BLUE_FABRIC, frame=m.CHARCOAL, back="padded", arms=False),
    ),
    _d(
        "office chair",
        "executive",
        "black leather executive chair",
        (0.68, 0.68, 1.16),
        "classic",
        partial(office_chair, cloth=m.BLACK_LEATHER, frame=m.BLACK, back="high"),
    ),
    _d(
        "office chair",
        "task-grey",
        "grey padded office chair with arms",
        (0.63, 0.64, 0.96),
        "modern",
        partial(office_chair, cloth=m.GREY_FABRIC, frame=m.STEEL, back="padded"),
    ),
    _d(
        "office chair",
        "tan",
        "tan leather desk chair",
        (0.62, 0.62, 0.94),
        "industrial",
        partial(office_chair, cloth=m.TAN_LEATHER, frame=m.BLACK_STEEL, back="padded"),
    ),
)
