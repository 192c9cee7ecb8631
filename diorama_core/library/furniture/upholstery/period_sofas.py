"""Sofas with a shape of their own: camel backs, curves, tuxedos, steel frames, skirts and slats."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.upholstery.cushions import arm, back_cushion, seat_cushion, tufting
from diorama_core.library.furniture.upholstery.sofas import sofa


def camel_back_sofa(size: Size, cloth: Material, wood: Material, profile: Leg) -> Parts:
    """A back that rises to a hump in the middle, rolled arms, turned legs."""
    d, w, h = size
    seat_z, thick = 0.46, 0.17
    inner = w - 2 * thick
    t = np.linspace(-1, 1, 41)
    top = h - 0.13 + 0.13 * np.cos(np.clip(t * 1.25, -1, 1) * np.pi / 2) ** 1.6 - 0.04 * np.clip(np.abs(t) - 0.8, 0, 1)
    v = np.linspace(0, 1, 7)[:, None]
    xb = -d / 2 + 0.12
    x = xb - 0.06 * v + 0.02 * np.sin(np.pi * v)
    back = slab(np.stack(np.broadcast_arrays(x, -t * w * 0.47, 0.24 + (top - 0.24) * v), axis=-1), 0.13)
    cap = tube(np.column_stack([np.full(41, xb - 0.06), t * w * 0.47, top]), 0.066, 10)
    ends = both_sides(ball(0.132, 7).moved(xb - 0.06, w * 0.47, top[-1] - 0.066))
    base = box((d - 0.1, w - 0.14, 0.16), 0.025, 2).moved(0.03, 0, 0.17)
    arms = both_sides(
        *(q.moved(0.05, w / 2 - thick / 2 - 0.005) for q in arm("rolled", d - 0.16, thick, seat_z + 0.21, 0.18))
    )
    seat = [q.moved(0.07, 0, seat_z - 0.14) for q in seat_cushion(d - 0.24, inner + 0.02, 0.14)]
    feet = [
        leg(profile, sx * (d / 2 - 0.12) + 0.03, y, 0.2, 0.055)
        for sx in (1, -1)
        for y in (-w / 2 + 0.13, 0.0, w / 2 - 0.13)
    ]
    return of(cloth, back, cap, *ends, base, *arms, *seat) + of(wood, *feet)


def curved_sofa(size: Size, cloth: Material, base: Material) -> Parts:
    """A long curve without corners: one thick seat, one low rounded back."""
    d, w, h = size
    a = np.linspace(-1, 1, 33)
    half, bow = w / 2 - 0.16, d - 0.86
    xs = -d / 2 + 0.2 + bow * a**2
    ys = -half * np.sin(a * np.pi / 2 * 0.98)
    v = np.linspace(0, 1, 5)[:, None]
    wall = slab(np.stack(np.broadcast_arrays(xs, ys, 0.08 + (h - 0.2) * v), axis=-1), 0.22)
    roll = tube(np.column_stack([xs, ys, np.full(33, h - 0.115)]), 0.114, 12)
    ends = [
        q.moved(xs[k], ys[k])
        for k in (0, -1)
        for q in (ball(0.228, 8).moved(z=h - 0.229), cylinder(0.11, h - 0.2, 0.02).moved(z=0.08))
    ]
    depth = 0.62
    u = np.linspace(0, 1, 9)[:, None]
    span = 0.93 - 0.05 * u
    top = np.stack(
        np.broadcast_arrays(
            xs[None] * 1.0 + 0.08 + (depth - 0.02) * u,
            ys[None] * span,
            0.34 + 0.05 * np.sin(np.pi * u) * np.clip(1 - a[None] ** 6, 0, 1) + 0.0 * u,
        ),
        axis=-1,
    )
    seat = slab(top[::-1], 0.16)
    plinth_top = np.stack(
        np.broadcast_arrays(xs[None] + 0.04 + (depth - 0.02) * u, ys[None] * span * 0.98, 0.17 + 0.0 * u), axis=-1
    )
    skirt = slab(plinth_top[::-1], 0.2)
    foot = np.stack(
        np.broadcast_arrays(xs[None] + 0.02 + (depth - 0.1) * u, ys[None] * span * 0.92, 0.035 + 0.0 * u), axis=-1
    )
    nose = tube(top[-1] - [0.0, 0, 0.005], 0.082, 10)
    tips = [ball(0.164, 7).moved(*(top[-1, k] - [0, 0, 0.087])) for k in (0, -1)]
    return of(cloth, wall, roll, *ends, seat, nose, *tips, skirt) + of(base, slab(foot[::-1], 0.07))


def tuxedo_sofa(size: Size, cloth: Material, legs: Material, seats: int = 2) -> Parts:
    """Arms as high as the back, both buttoned, on slim metal legs."""
    d, w, h = size
    t, seat_z = 0.1, 0.43
    feet = four(leg("taper", d / 2 - 0.07, w / 2 - 0.07, 0.16, 0.032))
    shell = [
        box((0.12, w, h - 0.15), 0.03, 2).moved(-d / 2 + 0.06, 0, 0.15),
        *both_sides(box((d, t, h - 0.15), 0.03, 2).moved(0, w / 2 - t / 2, 0.15)),
    ]
    base = box((d - 0.02, w - 0.04, 0.14), 0.02, 2).moved(0, 0, 0.15)
    inner = w - 2 * t
    pads = [
        q.moved(0.06, -inner / 2 + inner / seats * (k + 0.5), seat_z - 0.15)
        for k in range(seats)
        for q in seat_cushion(d - 0.17, inner / seats - 0.006, 0.15)
    ]
    buttons = [q.moved(0.03) for q in tufting(inner, h, seat_z, -d / 2 + 0.06)]
    return of(legs, *feet) + of(cloth, *shell, base, *pads, *buttons)


def framed_sofa(size: Size, cloth: Material, frame: Material, seats: int = 3, slats: bool = False) -> Parts:
    """Loose cushions in an open frame: square steel, or wood with a slatted back."""
    d, w, h = size
    y, x, seat_z = w / 2 - 0.025, d / 2 - 0.025, 0.43
    bar = 0.03 if frame.metallic > 0.2 else 0.045
    loop = [
        box((bar, bar, 0.58), 0.004).moved(x, y),
        beam((-x + 0.1, y, 0), (-x + 0.04, y, h - 0.1), bar, bar),
        box((2 * x - 0.03, bar * (1.0 if bar < 0.04 else 1.7), bar * 0.9), 0.006).moved(0.03, y, 0.56),
    ]
    rails = [
        beam((x, -y, 0.24), (x, y, 0.24), bar, bar * 1.3),
        beam((-x + 0.08, -y, 0.24), (-x + 0.08, y, 0.24), bar, bar * 1.3),
        *both_sides(beam((-x + 0.08, y, 0.24), (x, y, 0.24), bar, bar)),
        beam((-x + 0.045, -y, h - 0.11), (-x + 0.045, y, h - 0.11), bar, bar),
    ]
    rows = (
        [
            beam((-x + 0.075, k, 0.24), (-x + 0.045, k, h - 0.11), 0.014, 0.03)
            for k in np.linspace(-y + 0.12, y - 0.12, int(w / 0.14))
        ]
        if slats
        else []
    )
    deck = box((2 * x - 0.08, 2 * y - 0.02, 0.02), 0.003).moved(0.03, 0, 0.25)
    inner = 2 * y - 0.05
    each = inner / seats
    parts = of(frame, *both_sides(*loop), *rails, *rows) + of(frame, deck)
    for k in range(seats):
        cy = -inner / 2 + each * (k + 0.5)
        parts += of(cloth, *(q.moved(0.04, cy, seat_z - 0.16) for q in seat_cushion(d - 0.14, each - 0.006, 0.16)))
        parts += of(cloth, back_cushion(each - 0.01, h - seat_z + 0.02, 0.18, 11).moved(-x + 0.11, cy, seat_z - 0.02))
    return parts


def skirted_sofa(size: Size, cloth: Material, accent: Material, seats: int = 3) -> Parts:
    """A deep country sofa: pillow arms, loose cushions, a pleated skirt to the floor."""
    d, w, h = size
    parts = sofa((d, w, h), cloth, cloth, seats, "rolled", plinth_base=True, seat_h=0.46)
    k = 120
    t = np.arange(k) / k
    per = 2 * (d + w)
    walk = t * per
    x = np.select(
        [walk < d, walk < d + w, walk < 2 * d + w], [walk - d / 2, np.full(k, d / 2), d / 2 - (walk - d - w)], -d / 2
    )
    y = np.select(
        [walk < d, walk < d + w, walk < 2 * d + w],
        [np.full(k, -w / 2), walk - d - w / 2, np.full(k, w / 2)],
        w / 2 - (walk - 2 * d - w),
    )
    ring = np.column_stack([x, y]) * np.array([(d - 0.03) / d, (w - 0.03) / w])
    out = ring / np.linalg.norm(ring, axis=1, keepdims=True)
    rows = []
    for share in np.linspace(0, 1, 4):
        fold = 0.006 * np.sin(2 * np.pi * 30 * t) * share
        rows.append(np.column_stack([ring + out * fold[:, None], np.full(k, 0.2 * (1 - share) + 0.006 * share)]))
    grid = np.array(rows)
    grid = np.concatenate([grid, grid[:, :1]], axis=1)
    parts += of(cloth, slab(grid[:, ::-1], 0.012))
    for side in (1, -1):
        soft = pillow((0.44, 0.44, 0.16)).turned("y", -70).turned("z", -side * 18)
        parts += of(accent, soft.moved(-d / 2 + 0.42, side * (w / 2 - 0.42), 0.66))
    return parts


def bench_seat_sofa(size: Size, cloth: Material, legs: Material, rolls: Material) -> Parts:
    """One long seat cushion, a tufted back and bolsters for arms, on a slim wooden base."""
    d, w, h = size
    seat_z = 0.42
    feet = [*four(leg("splay", d / 2 - 0.11, w / 2 - 0.16, 0.2, 0.042, 0.14))]
    rail = [
        *both_sides(beam((-d / 2 + 0.06, w / 2 - 0.05, 0.22), (d / 2 - 0.05, w / 2 - 0.05, 0.22), 0.03, 0.05)),
        beam((d / 2 - 0.06, -w / 2 + 0.04, 0.22), (d / 2 - 0.06, w / 2 - 0.04, 0.22), 0.03, 0.05),
        box((d - 0.14, w - 0.1, 0.02), 0.003).moved(0, 0, 0.225),
    ]
    seat = [q.moved(0.03, 0, seat_z - 0.18) for q in seat_cushion(d - 0.06, w - 0.02, 0.18)]
    back = [
        box((0.14, w - 0.04, h - 0.28), 0.04, 3).moved(-d / 2 + 0.08, 0, 0.26),
        *(q.moved(0.055) for q in tufting(w - 0.12, h, seat_z, -d / 2 + 0.06)),
    ]
    bolster = both_sides(
        cylinder(0.095, d - 0.28, 0.03, 22).turned("y", 90).moved(-d / 2 + 0.18, w / 2 - 0.11, seat_z + 0.085)
    )
    return of(legs, *feet, *rail) + of(cloth, *seat, *back) + of(rolls, *bolster)


DESIGNS: tuple[Design, ...] = (
    design("sofa", "camel-sky", "pale blue camel-back sofa", (0.92, 2.05, 0.94), "classic", camel_back_sofa, cloth=s.SKY_FABRIC, wood=m.DARK_WALNUT, profile="turned"),
    design("sofa", "camel-leather", "oxblood leather camel-back sofa", (0.90, 1.90, 0.92), "classic", camel_back_sofa, cloth=s.OXBLOOD_LEATHER, wood=m.MAHOGANY, profile="cabriole"),
    design("sofa", "curved-boucle", "curved ivory bouclé sofa", (1.20, 2.40, 0.74), "modern", curved_sofa, cloth=s.IVORY_BOUCLE, base=m.BLACK),
    design("sofa", "curved-emerald", "curved emerald velvet sofa", (1.15, 2.15, 0.72), "modern", curved_sofa, cloth=s.EMERALD_VELVET, base=m.BRASS),
    design("sofa", "tuxedo-blush", "blush velvet tuxedo sofa on brass legs", (0.86, 1.85, 0.76), "modern", tuxedo_sofa, cloth=s.BLUSH_VELVET, legs=m.BRASS),
    design("sofa", "tuxedo-grey", "grey buttoned tuxedo sofa", (0.88, 2.10, 0.78), "classic", tuxedo_sofa, cloth=m.GREY_FABRIC, legs=m.DARK_WALNUT, seats=3),
    design("sofa", "steel-frame", "cognac leather sofa in a black steel frame", (0.88, 2.00, 0.84), "industrial", framed_sofa, cloth=s.COGNAC_LEATHER, frame=m.BLACK_STEEL),
    design("sofa", "steel-loveseat", "charcoal two-seat sofa in a steel frame", (0.84, 1.45, 0.82), "industrial", framed_sofa, cloth=m.CHARCOAL_FABRIC, frame=m.BLACK_STEEL, seats=2),
    design("sofa", "slat-pine", "pine settle sofa with oatmeal cushions", (0.86, 1.80, 0.88), "rustic", framed_sofa, cloth=m.OATMEAL, frame=m.PINE, seats=3, slats=True),
    design("sofa", "slat-birch", "birch two-seat sofa with pale cushions", (0.80, 1.40, 0.80), "minimal", framed_sofa, cloth=m.LIGHT_FABRIC, frame=m.BIRCH, seats=2, slats=True),
    design("sofa", "skirted-linen", "linen country sofa with a skirt", (1.00, 2.15, 0.90), "rustic", skirted_sofa, cloth=m.LINEN, accent=m.BLUE_FABRIC),
    design("sofa", "bench-mustard", "ochre mid-century sofa with bolsters", (0.84, 2.00, 0.82), "modern", bench_seat_sofa, cloth=m.MUSTARD_FABRIC, legs=m.WALNUT, rolls=m.MUSTARD_FABRIC),
    design("sofa", "loveseat-rose", "dusty rose loveseat", (0.88, 1.42, 0.82), "classic", sofa, cloth=m.ROSE_FABRIC, legs=m.WALNUT, seats=2, arms="rolled"),
    design("sofa", "long-cream", "long cream sofa with slim arms", (0.95, 2.55, 0.76), "minimal", sofa, cloth=m.LINEN, legs=m.BLACK_STEEL, seats=3, arms="slim", seat_h=0.41),
)  # fmt: skip
