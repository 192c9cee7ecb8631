"""Chairs with a moulded one-piece shell."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator

from diorama_core.library.furniture.kit import *


def eased(v: Float[np.ndarray, "m 1"], at: Sequence[float], values: Sequence[float]) -> Float[np.ndarray, "m 1"]:
    """A smooth curve through points that never overshoots them."""
    return np.asarray(PchipInterpolator(at, values)(v))


def shell_chair(size: Size, shell: Material, legs: Material, base: str) -> Parts:
    """A moulded one-piece shell on wooden dowels, steel tube or a round pedestal."""
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
        5,
    )
    s = np.linspace(0, 1, len(path))[:, None]
    u = np.linspace(-1, 1, 15)[None, :]
    half = w / 2 * eased(s, [0, 0.04, 0.12, 0.45, 0.72, 0.9, 0.97, 1], [0.62, 0.8, 0.93, 1.0, 0.94, 0.82, 0.62, 0.34])
    curl = eased(s, [0, 0.1, 0.5, 0.8, 1], [0.0, 0.03, 0.085, 0.05, 0.015])
    x = path[:, :1] + curl * np.interp(s, [0, 0.4, 0.7, 1], [0, 0.3, 1, 1]) * u**2 * 0.9
    z = path[:, 2:] + curl * np.interp(s, [0, 0.4, 0.7, 1], [0.6, 0.4, 0.0, 0.0]) * u**2
    surface = np.stack([x, half * u, z], axis=-1)
    parts = of(shell, slab(surface, 0.012))
    if base == "pedestal":
        return parts + of(legs, trumpet(0.438, 0.46 * w, 0.024))
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


DESIGNS: tuple[Design, ...] = (
    design("chair", "shell-white", "white shell chair on beech dowels", (0.53, 0.47, 0.82), "modern", shell_chair, shell=m.WHITE, legs=m.BIRCH, base="wood"),
    design("chair", "shell-sage", "sage moulded chair on steel tube", (0.54, 0.48, 0.80), "modern", shell_chair, shell=m.SAGE, legs=m.BLACK_STEEL, base="steel"),
    design("chair", "shell-tulip-white", "white tulip chair on a round pedestal", (0.53, 0.50, 0.81), "modern", shell_chair, shell=m.WHITE, legs=m.WHITE, base="pedestal"),
)  # fmt: skip
