"""Globes for desks and floors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *

SEA = Material("globe sea", "map", "#8ea6b0", 0.4, 0.0, 1.0)


OLD_SEA = Material("antique globe", "map", "#b9a988", 0.5, 0.0, 1.0)


def globe(size: Size, sea: Material, stand: Material, legs: bool = False) -> Parts:
    """A globe in its meridian, on a foot or in a floor stand."""
    d, w, h = size
    r = 0.43 * min(d, w)
    z = h - 1.09 * r
    sphere = ball(2 * r, 14).moved(z=-r)
    v = sphere.vertices
    uv = np.column_stack([np.arctan2(v[:, 1], v[:, 0]) / np.pi, np.arcsin(np.clip(v[:, 2] / r, -1, 1)) / np.pi + 0.5])
    tilted = of(sea, replace(sphere, uv=_whole_turns(uv, sphere.faces)))
    t = np.linspace(-np.pi / 2, np.pi / 2, 25)
    bow = tube(np.stack([0 * t, -1.06 * r * np.cos(t), 1.06 * r * np.sin(t)], axis=1), 0.028 * r, 8)
    pins = [cylinder(0.03 * r, 0.1 * r, 0.002, 10).moved(z=s) for s in (0.98 * r, -1.08 * r)]
    head = [p.turned("x", 23) for p in tilted + of(m.BRASS, bow, *pins)]
    if legs:
        ring = lathe([(1.1 * r, -0.02), (1.22 * r, -0.02), (1.22 * r, 0.012), (1.1 * r, 0.012), (1.1 * r, -0.02)], 44)
        posts = [
            lathe(
                [(0.016, 0), (0.022, 0.03), (0.014, 0.08), (0.02, 0.4 * z), (0.014, 0.6 * z), (0.024, z - 0.02)], 14
            ).moved(1.14 * r * np.cos(a), 1.14 * r * np.sin(a))
            for a in np.deg2rad((45, 135, 225, 315))
        ]
        rail = tube(
            np.column_stack([superellipse(2.2 * r, 2.2 * r, 2, 40), np.full(40, 0.3 * z)]), 0.01, 6, closed=True
        )
        return shifted(head, z=z) + of(stand, ring.moved(z=z), *posts, rail)
    foot = lathe(
        [(0.62 * r, 0), (0.64 * r, 0.01), (0.5 * r, 0.04 * h), (0.14 * r, 0.09 * h), (0.09 * r, z - 1.05 * r)], 32
    )
    return shifted(head, z=z) + of(stand, foot)


def _whole_turns(uv: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Texture coordinates whose first runs on past the seam instead of back over the whole picture."""
    out = uv.copy()
    corners = uv[faces, 0]
    wide = np.ptp(corners, axis=1) > 1.0
    low = faces[wide][corners[wide] < 0]
    out[low, 0] += 2.0
    return out


DESIGNS: tuple[Design, ...] = (
    design("globe", "desk", "desk globe", (0.28, 0.28, 0.38), "classic", globe, sea=SEA, stand=m.WALNUT),
    design("globe", "antique", "antique desk globe", (0.24, 0.24, 0.34), "rustic", globe, sea=OLD_SEA, stand=m.BRASS),
    design("globe", "floor", "floor globe in a mahogany stand", (0.50, 0.50, 0.95), "classic", globe, sea=OLD_SEA, stand=m.MAHOGANY, legs=True),
    design("globe", "modern", "globe on a black foot", (0.26, 0.26, 0.35), "modern", globe, sea=SEA, stand=m.BLACK_STEEL),
)  # fmt: skip
