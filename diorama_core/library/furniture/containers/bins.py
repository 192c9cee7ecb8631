"""Bins."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


def bin_(size: Size, body: Material, kind: Literal["open", "pedal", "swing", "mesh"]) -> Parts:
    """A waste bin."""
    d, w, h = size
    r = min(d, w) / 2
    if kind == "open":
        return of(body, hollow(((0.78, 0), (0.8, 0.01), (0.98, 0.97), (1.0, 0.985), (0.99, 1.0)), r, h, 0.006))
    if kind == "mesh":
        o = superellipse(2 * r, 2 * r, 2, 40)
        ribs = [rod((*(a * 0.76), 0.01), (*(a * 0.985), h - 0.01), 0.0018, segments=4) for a in o]
        hoops = [
            tube(
                ring_path(o * (0.76 + 0.225 * f), 0.006 + (h - 0.012) * f),
                0.002 if 0 < f < 1 else 0.006,
                5,
                closed=True,
            )
            for f in np.linspace(0, 1, 9)
        ]
        return of(body, *ribs, *hoops, cylinder(r * 0.75, 0.006, 0.001, 32))
    if kind == "pedal":
        can = cylinder(r * 0.96, h * 0.8, 0.006, 40).moved(z=0.03)
        dome = lathe(
            [(r * 0.98, 0.84 * h), (r, 0.86 * h), (r * 0.97, 0.92 * h), (r * 0.6, 0.985 * h), (0.005, h)],
            40,
            np.deg2rad(60),
        )
        return of(body, can, dome) + of(
            m.BLACK, cylinder(r, 0.035, 0.006, 40), box((0.06, 0.07, 0.012), 0.004).moved(r + 0.01, 0, 0.008)
        )
    o = rounded_rectangle(d, w, 0.05, 6)
    can = loft(np.array([ring_path(o * s, z) for s, z in ((0.84, 0), (0.86, 0.012), (0.97, 0.76 * h))]))
    hood = loft(
        np.array([ring_path(o * s, z) for s, z in ((1.0, 0.75 * h), (1.0, 0.8 * h), (0.86, 0.96 * h), (0.7, h))]),
        crease_rad=np.deg2rad(45),
    )
    return of(body, can, hood) + of(
        m.CHARCOAL, box((0.012, w * 0.6, 0.16 * h), 0.004).turned("y", -26).moved(d * 0.475, 0, 0.79 * h)
    )


def recycling(size: Size, body: Material, lids: tuple[Material, ...]) -> Parts:
    """Bins side by side in one case, a lid for each kind."""
    d, w, h = size
    n = len(lids)
    each = w / n
    parts = of(
        body, *(box((d, each - 0.006, h * 0.86), 0.014, 2).moved(0, -w / 2 + each * (k + 0.5)) for k in range(n))
    )
    for k, lid in enumerate(lids):
        y = -w / 2 + each * (k + 0.5)
        parts += of(
            lid,
            box((d * 1.0, each - 0.01, h * 0.12), 0.016, 2).moved(0, y, h * 0.86),
            box((0.01, each * 0.4, 0.02), 0.004).moved(d / 2, y, h * 0.78),
        )
    return parts


def touch_bin(size: Size, body: Material, top: Material) -> Parts:
    """A half-round bin with a flat sensor lid."""
    d, w, h = size
    a = np.linspace(-np.pi / 2, np.pi / 2, 17)
    outline = np.concatenate(
        [
            np.column_stack([-d / 2 + d * 0.35 + d * 0.65 * np.cos(a), w / 2 * np.sin(a)]),
            [(-d / 2, w / 2), (-d / 2, -w / 2)],
        ]
    )
    return (
        of(body, prism(outline, h * 0.9, 0.004).moved(z=0.012))
        + of(
            top, prism(outline * 0.995, h * 0.08, 0.012).moved(z=h * 0.92 - 0.002), prism(outline * 0.96, 0.014, 0.003)
        )
        + of(m.SCREEN, box((0.03, 0.05, 0.002), 0.0006).moved(d * 0.34, 0, h - 0.001))
    )


DESIGNS: tuple[Design, ...] = (
    design("trash can", "open-white", "white waste-paper bin", (0.28, 0.28, 0.32), "minimal", bin_, 36, body=m.WHITE, kind="open"),
    design("trash can", "pedal", "steel pedal bin", (0.34, 0.30, 0.62), "modern", bin_, body=m.STAINLESS, kind="pedal"),
    design("trash can", "swing", "grey swing-lid bin", (0.30, 0.38, 0.66), "classic", bin_, body=m.GREY, kind="swing"),
    design("trash can", "mesh", "black mesh waste basket", (0.29, 0.29, 0.34), "industrial", bin_, 36, body=m.BLACK_STEEL, kind="mesh"),
    design("trash can", "recycling", "recycling bins with three lids", (0.34, 0.75, 0.60), "modern", recycling, body=m.CHARCOAL, lids=(m.SAGE, m.MUSTARD_FABRIC, m.BLUE_GLAZE)),
    design("trash can", "sensor", "half-round steel sensor bin", (0.30, 0.38, 0.64), "minimal", touch_bin, body=m.STAINLESS, top=m.BLACK),
    design("trash can", "pedal-cream", "cream pedal bin", (0.30, 0.27, 0.46), "rustic", bin_, body=m.CREAM, kind="pedal"),
)  # fmt: skip
