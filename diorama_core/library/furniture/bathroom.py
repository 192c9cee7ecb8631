"""Basins, lavatories, baths and radiators."""

from __future__ import annotations

from functools import partial

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.carcass import door_front, drawer_front
from diorama_core.library.furniture.fittings import at, tap
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, of
from diorama_core.library.furniture.solids import (
    Solid,
    box,
    cylinder,
    lathe,
    loft,
    prism,
    ring_path,
    rod,
    rounded_rectangle,
    superellipse,
    taper,
)


def vessel(outline: np.ndarray, layers: list[tuple[float, float]], x_shift: float = 0.0) -> Solid:
    """A hollow ware: one outline scaled by the first number of each layer, at the height of the second."""
    return loft(
        np.array([np.column_stack([outline * s, np.full(len(outline), z)]) for s, z in layers]),
        crease_rad=np.deg2rad(60),
    ).moved(x_shift)


def basin_bowl(d: float, w: float, z: float, depth: float, square: float) -> Solid:
    """A basin with its rim at z."""
    o = superellipse(d, w, square, 48)
    return vessel(
        o,
        [
            (0.55, z - depth),
            (0.8, z - depth * 0.8),
            (0.97, z - 0.03),
            (1.0, z - 0.008),
            (0.99, z),
            (0.9, z),
            (0.87, z - 0.012),
            (0.78, z - depth * 0.6),
            (0.5, z - depth * 0.82),
            (0.06, z - depth * 0.86),
        ],
    )


def pedestal_sink(size: Size) -> Parts:
    """A basin on a ceramic column."""
    d, w, h = size
    z = h - 0.12
    column = loft(
        np.array(
            [
                ring_path(superellipse(0.24 * a, 0.22 * a, 2.6, 32), zz)
                for a, zz in ((1.05, 0), (1.0, 0.02), (0.72, 0.2 * z), (0.68, 0.6 * z), (0.95, z - 0.12))
            ]
        )
    ).moved(-d * 0.16)
    shelf = prism(rounded_rectangle(0.13, w * 0.86, 0.03), 0.07, 0.012).moved(-d / 2 + 0.065, 0, z - 0.07)
    return of(m.PORCELAIN, basin_bowl(d * 0.94, w, z, 0.2, 2.8).moved(0.03 * d), column, shelf) + at(
        tap(0.12, reach=0.12), -d / 2 + 0.075, 0, z
    )


def vanity(
    size: Size, body: Material, top: Material, bowl: str = "vessel", pull: Material = m.BRASS, drawers: bool = False
) -> Parts:
    """A basin on a cabinet; `bowl` is "vessel" (standing on top) or "slab" (a ceramic slab)."""
    d, w, h = size
    rim = h - 0.18
    z = rim - (0.13 if bowl == "vessel" else 0.03)
    parts = of(
        body,
        box((d - 0.04, w - 0.02, z - 0.2), 0.004).moved(-0.01, 0, 0.17),
        *both_sides(
            *(taper((x, w / 2 - 0.04, 0), (x, w / 2 - 0.04, 0.18), 0.03, 0.04) for x in (d / 2 - 0.07, -d / 2 + 0.04))
        ),
    )
    if drawers:
        for k in range(2):
            parts += drawer_front(
                d / 2 - 0.031, 0, 0.18 + k * (z - 0.21) / 2, w - 0.03, (z - 0.21) / 2 - 0.006, body, pull, "bar"
            )
    else:
        for s in (1, -1):
            parts += door_front(
                d / 2 - 0.031,
                s * (w - 0.02) / 4,
                0.18,
                (w - 0.02) / 2 - 0.008,
                z - 0.22,
                body,
                pull,
                "knob",
                s,
                "shaker",
            )
    if bowl == "vessel":
        parts += of(top, box((d, w, 0.03), 0.006, 2).moved(z=z - 0.03)) + of(
            m.PORCELAIN, basin_bowl(0.36, 0.42, rim, 0.132, 2.2).moved(0.03)
        )
        return parts + at(tap(0.3, reach=0.15), -d / 2 + 0.05, 0, z)
    slab_o = rounded_rectangle(d, w, 0.02, 4)
    return (
        parts
        + of(
            m.PORCELAIN,
            vessel(
                slab_o,
                [
                    (0.99, rim - 0.06),
                    (1, rim - 0.05),
                    (1, rim - 0.006),
                    (0.99, rim),
                    (0.84, rim),
                    (0.82, rim - 0.01),
                    (0.74, rim - 0.05),
                    (0.05, rim - 0.055),
                ],
            ),
        )
        + at(tap(0.17, reach=0.13), -d / 2 + 0.035, 0, rim - 0.002)
    )


def wall_sink(size: Size) -> Parts:
    """A small square basin for a wall."""
    d, w, h = size
    z = h - 0.12
    body = vessel(
        rounded_rectangle(d, w, 0.05, 6),
        [
            (0.72, z - 0.16),
            (0.95, z - 0.12),
            (1, z - 0.1),
            (1, z - 0.008),
            (0.985, z),
            (0.86, z),
            (0.84, z - 0.012),
            (0.74, z - 0.1),
            (0.06, z - 0.105),
        ],
    )
    trap = [
        cylinder(0.02, 0.12, 0.003, 16).moved(-0.04, 0, z - 0.28),
        rod((-0.04, 0, z - 0.27), (-d / 2, 0, z - 0.27), 0.016),
        cylinder(0.032, 0.1, 0.006, 18).moved(-0.04, 0, z - 0.36),
    ]
    return of(m.PORCELAIN, body) + of(m.CHROME, *trap) + at(tap(0.12, reach=0.11), -d / 2 + 0.03, 0, z - 0.002)


def toilet(size: Size, kind: str = "close", seat: Material = m.PORCELAIN) -> Parts:
    """`kind`: "close" (cistern on the bowl), "wall" (hung, no cistern in sight) or "square"."""
    d, w, h = size
    rim, square = 0.40, 3.2 if kind == "square" else 2.4
    cistern = 0.0 if kind == "wall" else 0.19
    length = d - cistern + 0.03
    x = d / 2 - length / 2
    o = superellipse(length, w * 0.96, square, 44)
    o[:, 0] += 0.04 * length * (1 - (2 * o[:, 1] / w) ** 2)
    low = 0.13 if kind == "wall" else 0.0
    body = [(0.60, low), (0.62, low + 0.02), (0.66, low + 0.1), (0.86, rim - 0.1), (0.97, rim - 0.03), (0.98, rim)]
    rings = np.array(
        [np.column_stack([o[:, 0] * s - (1 - s) * 0.28 * length, o[:, 1] * s, np.full(len(o), z)]) for s, z in body]
    )
    parts = of(m.PORCELAIN, loft(rings, crease_rad=np.deg2rad(60)).moved(x))
    parts += of(
        seat,
        prism(o * 0.99, 0.016, 0.006).moved(x, 0, rim + 0.002),
        prism(o * np.array([0.97, 0.97]), 0.02, 0.009).moved(x - 0.004, 0, rim + 0.02),
    )
    if cistern:
        parts += of(
            m.PORCELAIN,
            box((cistern, w, h - rim - 0.03), 0.03, 3).moved(-d / 2 + cistern / 2, 0, rim),
            box((cistern + 0.01, w + 0.012, 0.035), 0.012, 2).moved(-d / 2 + cistern / 2 + 0.003, 0, h - 0.04),
        )
        return parts + of(m.CHROME, cylinder(0.024, 0.012, 0.003, 20).moved(-d / 2 + cistern / 2, 0, h - 0.01))
    return (
        parts
        + of(m.WHITE, box((0.1, w + 0.08, h), 0.006, 2).moved(-d / 2 + 0.05))
        + of(m.CHROME, box((0.008, 0.22, 0.14), 0.004).moved(-d / 2 + 0.104, 0, h - 0.2))
    )


def bathtub(size: Size, kind: str = "panel", outside: Material = m.PORCELAIN) -> Parts:
    """`kind`: "panel" (boxed in), "oval" (free-standing) or "claw" (on feet). Long side along x."""
    d, w, h = size
    if kind == "panel":
        h -= 0.12  # the tap reaches above the rim
        outer, inner = rounded_rectangle(d, w, 0.02, 5), rounded_rectangle(d * 0.9, w * 0.82, 0.16, 5)
        rings = [
            (outer, 0),
            (outer, h - 0.004),
            (outer * 0.997, h),
            (inner, h),
            (inner * 0.985, h - 0.012),
            (inner * 0.9, h * 0.45),
            (inner * 0.78, 0.14),
            (inner * 0.05, 0.125),
        ]
        tub = loft(np.array([ring_path(o, z) for o, z in rings]), crease_rad=np.deg2rad(50))
        return of(m.PORCELAIN, tub) + at(tap(0.14, reach=0.14), -d / 2 + 0.04, 0, h - 0.005)
    o = superellipse(d, w, 2.5, 56)
    foot = 0.12 if kind == "claw" else 0.0
    flare = [(0.72, foot), (0.78, foot + 0.03), (0.88, h * 0.5), (0.97, h - 0.03), (1.0, h - 0.012), (0.99, h)]
    whole = vessel(
        o, [*flare, (0.93, h - 0.004), (0.90, h - 0.04), (0.80, h * 0.55), (0.68, foot + 0.12), (0.05, foot + 0.1)]
    )
    parts = of(outside, whole)
    if kind == "claw":
        parts += of(
            m.IRON,
            *(
                lathe([(0.03, 0), (0.036, 0.02), (0.018, 0.05), (0.03, 0.11), (0.02, 0.16)], 14).moved(
                    sx * d * 0.3, sy * w * 0.27
                )
                for sx in (1, -1)
                for sy in (1, -1)
            ),
        )
    post = [rod((0.0, s * 0.07, 0), (0.0, s * 0.07, h + 0.02), 0.01) for s in (1, -1)] if kind == "claw" else []
    return parts + of(m.CHROME, *(p.moved(-d * 0.46) for p in post))


def panel_radiator(size: Size, paint: Material) -> Parts:
    """A pressed-steel panel radiator."""
    d, w, h = size
    n = max(int(w / 0.055), 6)
    ribs = [
        box((0.02, w / n * 0.5, h - 0.07), 0.008, 2).moved(d / 2 - 0.012, -w / 2 + w / n * (k + 0.5), 0.035)
        for k in range(n)
    ]
    return of(
        paint,
        box((0.026, w, h - 0.02), 0.008, 2).moved(d / 2 - 0.022, 0, 0.01),
        *ribs,
        box((d - 0.02, w - 0.01, 0.012), 0.004).moved(0.004, 0, h - 0.012),
        box((0.02, w * 0.9, h * 0.84), 0.005).moved(-d / 2 + 0.03, 0, 0.08 * h),
    ) + of(m.WHITE, cylinder(0.018, 0.05, 0.004, 16).moved(d / 2 - 0.035, -w / 2 - 0.02, 0.05))


def column_radiator(size: Size, paint: Material) -> Parts:
    """A cast-iron radiator of rounded columns."""
    d, w, h = size
    n = max(round(w / 0.06), 5)
    columns: list[Solid] = []
    for k in range(n):
        y = -w / 2 + w / n * (k + 0.5)
        low = 0.0 if k in (0, n - 1) else 0.05
        columns += [rod((x, y, 0.09), (x, y, h - 0.05), 0.019, segments=10) for x in (-0.28 * d, 0.28 * d)]
        columns += [
            box((d, w / n * 0.82, 0.075), 0.024, 2).moved(0, y, h - 0.075),
            box((d, w / n * 0.82, 0.075), 0.024, 2).moved(0, y, 0.05),
        ]
        if low == 0.0:
            columns.append(box((d * 0.8, 0.03, 0.07), 0.01).moved(0, y))
    pipes = [rod((0, -w / 2, z), (0, w / 2, z), 0.017) for z in (0.087, h - 0.037)]
    return of(paint, *columns, *pipes)


def towel_radiator(size: Size, metal: Material) -> Parts:
    """A ladder of tubes."""
    d, w, h = size
    posts = [rod((0, s * (w / 2 - 0.015), 0), (0, s * (w / 2 - 0.015), h), 0.015) for s in (1, -1)]
    groups = np.concatenate([np.linspace(0.06, 0.36, 6), np.linspace(0.44, 0.68, 5), np.linspace(0.76, 0.96, 4)]) * h
    bars = [rod((0.012, -w / 2 + 0.015, z), (0.012, w / 2 - 0.015, z), 0.011, segments=10) for z in groups]
    stays = [
        rod((-d + 0.02, s * (w / 2 - 0.06), z), (0.01, s * (w / 2 - 0.06), z), 0.008)
        for s in (1, -1)
        for z in (0.2 * h, 0.82 * h)
    ]
    return of(metal, *posts, *bars, *stays)


def _d(category: str, name: str, caption: str, size: Size, style: str, build: Builder) -> Design:
    return Design(f"{category}-{name}", category, caption, size, style, build)


DESIGNS: tuple[Design, ...] = (
    _d("sink", "pedestal", "white pedestal basin", (0.48, 0.56, 0.96), "classic", pedestal_sink),
    _d(
        "sink",
        "vanity-oak",
        "basin on an oak washstand",
        (0.48, 0.70, 1.02),
        "modern",
        partial(vanity, body=m.OAK, top=m.OAK, drawers=True, pull=m.BLACK_STEEL),
    ),
    _d(
        "sink",
        "vanity-navy",
        "navy vanity unit with a ceramic basin",
        (0.46, 0.80, 1.00),
        "classic",
        partial(vanity, body=m.NAVY, top=m.MARBLE, bowl="slab"),
    ),
    _d("sink", "wall", "small wall basin", (0.38, 0.46, 0.48), "minimal", wall_sink),
    _d("toilet", "close-coupled", "white close-coupled toilet", (0.68, 0.38, 0.78), "classic", toilet),
    _d(
        "toilet",
        "wall-hung",
        "wall-hung toilet with a panel",
        (0.64, 0.38, 0.82),
        "modern",
        partial(toilet, kind="wall"),
    ),
    _d("toilet", "square", "square toilet", (0.66, 0.37, 0.80), "minimal", partial(toilet, kind="square")),
    _d("toilet", "wooden-seat", "toilet with a wooden seat", (0.70, 0.39, 0.80), "rustic", partial(toilet, seat=m.OAK)),
    _d("bathtub", "panel", "built-in white bath", (1.70, 0.75, 0.67), "minimal", bathtub),
    _d("bathtub", "oval", "free-standing oval bath", (1.68, 0.78, 0.58), "modern", partial(bathtub, kind="oval")),
    _d(
        "bathtub",
        "claw",
        "claw-foot bath",
        (1.65, 0.76, 0.62),
        "classic",
        partial(bathtub, kind="claw", outside=m.PORCELAIN),
    ),
    _d(
        "radiator",
        "panel",
        "white panel radiator",
        (0.11, 1.00, 0.60),
        "minimal",
        partial(panel_radiator, paint=m.WHITE),
    ),
    _d(
        "radiator",
        "column-white",
        "white column radiator",
        (0.14, 0.90, 0.66),
        "classic",
        partial(column_radiator, paint=m.WHITE),
    ),
    _d(
        "radiator",
        "column-grey",
        "charcoal column radiator",
        (0.14, 0.66, 0.75),
        "industrial",
        partial(column_radiator, paint=m.CHARCOAL),
    ),
    _d(
        "radiator",
        "towel",
        "chrome towel radiator",
        (0.10, 0.50, 1.10),
        "modern",
        partial(towel_radiator, metal=m.CHROME),
    ),
)
