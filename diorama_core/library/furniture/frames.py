"""Frames and upright plates: what pictures, mirrors, clocks and windows are set in."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.solids import Solid, loft, superellipse


def frame(d: float, w: float, h: float, bar: float, radius: float = 0.004) -> list[Solid]:
    """A rectangular frame with mitred corners, its back on x = -d/2, standing on z = 0."""
    r = min(radius, bar / 3, d / 3)
    profile = [
        (-d / 2, 0.0),
        (d / 2 - r, 0.0),
        (d / 2, r),
        (d / 2 - r * 0.4, bar * 0.8),
        (d / 2 - d * 0.25, bar),
        (-d / 2, bar),
    ]
    corners = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    rings = np.array(
        [[(x, sy * (w / 2 - inset), h / 2 + sz * (h / 2 - inset)) for x, inset in profile] for sy, sz in corners]
    )
    return [loft(np.array([rings[k], rings[(k + 1) % 4]])[:, ::-1]) for k in range(4)]


def wall_outline(kind: str, w: float, h: float) -> np.ndarray:
    """Points (y, z) round the middle, counter-clockwise seen from +X."""
    if kind == "arch":
        r = w / 2
        t = np.linspace(0, np.pi, 25)
        top = np.column_stack([r * np.cos(t), h / 2 - r + r * np.sin(t)])
        return np.concatenate([top, [(-r, -h / 2 + 0.02), (-r + 0.02, -h / 2), (r - 0.02, -h / 2), (r, -h / 2 + 0.02)]])
    return superellipse(w, h, 2.0, 48)


def stand_up(outline: np.ndarray, thickness: float) -> Solid:
    """A plate of a (y, z) outline, from x = 0 to `thickness`."""
    near, far = (np.column_stack([np.full(len(outline), x), outline]) for x in (0.0, thickness))
    return loft(np.array([near, far]))
