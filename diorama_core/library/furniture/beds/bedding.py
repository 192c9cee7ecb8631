"""Mattresses, duvets, pillows and throws."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def bedding(d: float, w: float, z: float, thick: float, duvet: Material, pillows: int, throw: Material | None) -> Parts:
    """A mattress with its top at `z`, duvet folded back, pillows at the head (-X), a throw across the foot."""
    parts = of(m.WHITE_COTTON, prism(rounded_rectangle(d, w, 0.07, 5), thick, 0.035).moved(z=z - thick))
    parts += of(duvet, _cover(-0.18 * d, d / 2 + 0.012, w + 0.03, z, 0.06, thick * 0.72, thick * 0.6))
    parts += of(m.WHITE_COTTON, _cover(-0.25 * d, -0.155 * d, w + 0.034, z + 0.026, 0.05, thick * 0.6))
    if throw is not None:
        parts += of(throw, _cover(0.15 * d, 0.38 * d, w + 0.05, z + 0.062, 0.035, thick * 0.9))
    each = w / pillows
    for k in range(pillows):
        y = -w / 2 + each * (k + 0.5)
        plump = pillow((0.46, min(each - 0.05, 0.72), 0.2), 12, 0.03).turned("y", -24)
        parts += of(m.WHITE_COTTON, plump.moved(-d / 2 + 0.25, y, z + 0.06))
    return parts


def _cover(x0: float, x1: float, w: float, z: float, loft_m: float, drop: float, foot_drop: float = 0.0) -> Solid:
    """A blanket over the mattress from x0 to x1, hanging `drop` at both sides and `foot_drop` over the foot end."""
    u = np.linspace(-1, 1, 31)
    v = np.linspace(0, 1, 19)
    half = w / 2
    across = u * (half + drop)
    along = v * (x1 - x0 + foot_drop)
    y, fall_y = np.clip(across, -half, half), np.clip(np.abs(across) - half, 0, None)
    x, fall_x = np.minimum(along, x1 - x0), np.clip(along - (x1 - x0), 0, None)
    gy, gx = np.meshgrid(y, x)
    fy, fx = np.meshgrid(fall_y, fall_x)
    inner = np.clip(1 - (gy / half) ** 4, 0, 1) * np.clip(1 - (2 * gx / (x1 - x0) - 1) ** 6, 0, 1)
    ripple = 0.010 * np.sin(7 * gx + 4 * gy) * np.sin(3.3 * gy - 2 * gx) + 0.005 * np.sin(15 * gx - 9 * gy)
    fold = 0.010 * np.sin(26 * (gx + gy)) + 0.006 * np.sin(41 * (gx - gy))
    side = (fy > 0) * (0.014 + fold * np.clip(fy / max(drop, 1e-6), 0, 1))
    end = (fx > 0) * (0.014 + fold * np.clip(fx / max(foot_drop, 1e-6), 0, 1))
    height = z + loft_m * 0.35 + (0.75 * loft_m + ripple) * inner - np.maximum(fy, fx)
    return slab(np.stack([x0 + gx + end, gy + np.sign(gy) * side, height], axis=-1), 0.024)
