"""Lavatories and baths."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.bathroom.basins import vessel
from diorama_core.library.furniture.kit import *


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


DESIGNS: tuple[Design, ...] = (
    design("toilet", "close-coupled", "white close-coupled toilet", (0.68, 0.38, 0.78), "classic", toilet),
    design("toilet", "wall-hung", "wall-hung toilet with a panel", (0.64, 0.38, 0.82), "modern", toilet, kind="wall"),
    design("toilet", "square", "square toilet", (0.66, 0.37, 0.80), "minimal", toilet, kind="square"),
    design("toilet", "wooden-seat", "toilet with a wooden seat", (0.70, 0.39, 0.80), "rustic", toilet, seat=m.OAK),
    design("bathtub", "panel", "built-in white bath", (1.70, 0.75, 0.67), "minimal", bathtub),
    design("bathtub", "oval", "free-standing oval bath", (1.68, 0.78, 0.58), "modern", bathtub, kind="oval"),
    design("bathtub", "claw", "claw-foot bath", (1.65, 0.76, 0.62), "classic", bathtub, kind="claw", outside=m.PORCELAIN),
    design("toilet", "square-oak", "square lavatory with an oak seat", (0.66, 0.38, 0.80), "rustic", toilet, kind="square", seat=m.OAK),
    design("toilet", "black-seat", "lavatory with a black seat", (0.68, 0.37, 0.79), "industrial", toilet, kind="close", seat=m.BLACK),
    design("bathtub", "oval-black", "free-standing bath, black outside", (1.70, 0.78, 0.58), "modern", bathtub, kind="oval", outside=m.CHARCOAL),
    design("bathtub", "claw-navy", "claw-foot bath, navy outside", (1.68, 0.76, 0.62), "rustic", bathtub, kind="claw", outside=m.NAVY),
)  # fmt: skip
