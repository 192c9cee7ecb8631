"""Headboards."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *

Head = Literal["none", "panel", "slats", "padded", "channels", "spindles"]


def headboard(kind: Head, w: float, h: float, z0: float, material: Material, legs: Material) -> Parts:
    """A headboard with its front on the plane x = 0, from z0 to h."""
    if kind == "padded":
        return of(
            material,
            box((0.09, w, h - z0), 0.035, 3).moved(-0.045, 0, z0),
            cushion((h - z0 - 0.12, w - 0.1, 0.06), 9, 3, 12).turned("y", 90).moved(-0.03, 0, (h + z0) / 2),
        )
    if kind == "channels":
        n = max(int(w / 0.16), 5)
        return of(
            material,
            box((0.05, w, h - z0), 0.02, 2).moved(-0.065, 0, z0),
            *(
                cushion((h - z0 - 0.01, w / n - 0.002, 0.075), 8, 2.6, 8)
                .turned("y", 90)
                .moved(-0.055, -w / 2 + w / n * (k + 0.5), (h + z0) / 2)
                for k in range(n)
            ),
        )
    if kind == "panel":
        return of(
            material,
            box((0.036, w, h - z0), 0.008, 2).moved(-0.03, 0, z0),
            box((0.05, w + 0.02, 0.04), 0.01, 2).moved(-0.03, 0, h - 0.04),
        )
    posts = both_sides(box((0.055, 0.055, h - 0.02), 0.008, 2).moved(-0.03, w / 2 - 0.028))
    rails = [beam((-0.03, -w / 2 + 0.03, z), (-0.03, w / 2 - 0.03, z), 0.03, 0.07, 0.01) for z in (z0 + 0.04, h - 0.05)]
    if kind == "slats":
        n = max(int(w / 0.13), 6)
        bars = [
            box((0.016, 0.06, h - z0 - 0.08), 0.004).moved(-0.03, y, z0 + 0.04)
            for y in np.linspace(-w / 2 + 0.12, w / 2 - 0.12, n)
        ]
        return of(material, *posts, *rails, *bars)
    n = max(int(w / 0.12), 6)
    bars = [
        rod((-0.03, y, z0 + 0.04), (-0.03, y, h - 0.05), 0.009, segments=8)
        for y in np.linspace(-w / 2 + 0.1, w / 2 - 0.1, n)
    ]
    posts_round = both_sides(
        cylinder(0.02, h - 0.02, 0.004, 14).moved(-0.03, w / 2 - 0.028),
        lathe([(0.02, 0), (0.034, 0.02), (0.03, 0.045), (0.01, 0.06)], 14).moved(-0.03, w / 2 - 0.028, h - 0.06),
    )
    hoops = [
        rod((-0.03, -w / 2 + 0.03, z), (-0.03, w / 2 - 0.03, z), 0.014, segments=10) for z in (z0 + 0.04, h - 0.05)
    ]
    return of(legs, *posts_round, *hoops, *bars)
