"""Washbasins."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


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


def trough(size: Size, body: Material, metal: Material) -> Parts:
    """A long shallow trough on a steel frame with two taps."""
    d, w, h = size
    z = h - 0.16
    o = rounded_rectangle(d, w, 0.03, 4)
    bowl = vessel(
        o,
        [
            (0.96, z - 0.17),
            (0.98, z - 0.15),
            (1, z - 0.008),
            (0.99, z),
            (0.9, z),
            (0.89, z - 0.01),
            (0.86, z - 0.12),
            (0.04, z - 0.13),
        ],
    )
    legs = [
        rod((sx * (d / 2 - 0.04), sy * (w / 2 - 0.05), 0), (sx * (d / 2 - 0.04), sy * (w / 2 - 0.05), z - 0.16), 0.014)
        for sx in (1, -1)
        for sy in (1, -1)
    ]
    rails = [
        rod((sx * (d / 2 - 0.04), -w / 2 + 0.05, 0.24), (sx * (d / 2 - 0.04), w / 2 - 0.05, 0.24), 0.01)
        for sx in (1, -1)
    ]
    slats = [
        box((d - 0.06, 0.05, 0.014), 0.004).moved(0, float(y), 0.245) for y in np.linspace(-w / 2 + 0.1, w / 2 - 0.1, 9)
    ]
    taps = at(tap(0.15, reach=0.12), -d / 2 + 0.03, w * 0.24, z) + at(
        tap(0.15, reach=0.12), -d / 2 + 0.03, -w * 0.24, z
    )
    return of(body, bowl) + of(metal, *legs, *rails) + of(m.OAK, *slats) + taps


def console_sink(size: Size, metal: Material) -> Parts:
    """A ceramic slab basin on brass legs with a towel rail."""
    d, w, h = size
    z = h - 0.14
    o = rounded_rectangle(d, w, 0.04, 5)
    slab_ = vessel(
        o,
        [
            (0.97, z - 0.09),
            (1, z - 0.075),
            (1, z - 0.008),
            (0.985, z),
            (0.78, z),
            (0.76, z - 0.012),
            (0.66, z - 0.07),
            (0.05, z - 0.078),
        ],
    )
    legs = both_sides(
        *(taper((x, w / 2 - 0.05, 0), (x, w / 2 - 0.05, z - 0.085), 0.02, 0.034) for x in (d / 2 - 0.04, 0.04 - d / 2)),
        rod((-d / 2 + 0.03, w / 2 - 0.05, z - 0.12), (d / 2 - 0.04, w / 2 - 0.05, z - 0.12), 0.009),
    )
    rail = rod((d / 2 - 0.04, -w / 2 + 0.05, z - 0.2), (d / 2 - 0.04, w / 2 - 0.05, z - 0.2), 0.009)
    trap = [cylinder(0.018, 0.14, 0.003, 16).moved(0, 0, z - 0.24), rod((0, 0, z - 0.23), (-d / 2, 0, z - 0.23), 0.015)]
    return of(m.PORCELAIN, slab_) + of(metal, *legs, rail, *trap) + at(tap(0.14, reach=0.12), -d / 2 + 0.06, 0, z)


DESIGNS: tuple[Design, ...] = (
    design("sink", "pedestal", "white pedestal basin", (0.48, 0.56, 0.96), "classic", pedestal_sink),
    design("sink", "vanity-oak", "basin on an oak washstand", (0.48, 0.70, 1.02), "modern", vanity, body=m.OAK, top=m.OAK, drawers=True, pull=m.BLACK_STEEL),
    design("sink", "vanity-navy", "navy vanity unit with a ceramic basin", (0.46, 0.80, 1.00), "classic", vanity, body=m.NAVY, top=m.MARBLE, bowl="slab"),
    design("sink", "wall", "small wall basin", (0.38, 0.46, 0.48), "minimal", wall_sink),
    design("sink", "trough", "stone trough basin on a steel stand", (0.46, 1.20, 1.02), "industrial", trough, body=m.CONCRETE, metal=m.BLACK_STEEL),
    design("sink", "console", "ceramic basin on brass legs", (0.48, 0.78, 0.98), "classic", console_sink, metal=m.BRASS),
    design("sink", "vanity-walnut", "walnut vanity with two drawers", (0.48, 0.90, 1.00), "modern", vanity, body=m.WALNUT, top=m.MARBLE, pull=m.BLACK_STEEL, drawers=True),
    design("sink", "vanity-sage", "sage vanity with a ceramic slab", (0.46, 0.62, 0.98), "rustic", vanity, body=m.SAGE, top=m.PORCELAIN, bowl="slab"),
)  # fmt: skip
