"""Cushions, arms and buttoned backs: what sofas and armchairs are made of."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *

ArmKind = Literal["track", "rolled", "slim", "pillow", "wood", "none"]


def seat_cushion(d: float, w: float, t: float) -> list[Solid]:
    """A boxed seat cushion with piping round its upper and lower edge, standing on z = 0."""
    pad = cushion((d, w, t), 9, 4.5, 8)
    crown = cushion((d * 0.93, w * 0.93, 0.05), 5, 2.4, 6).moved(z=t - 0.032)
    piping = tube(ring_path(superellipse(d * 0.965, w * 0.965, 9, 32), t * 0.87), 0.005, 3, closed=True)
    return [pad, crown, piping]


def back_cushion(w: float, h: float, t: float, lean_deg: float = 12.0) -> Solid:
    """A loose back cushion leaning back, its foot at the origin, plump toward +X."""
    pad = cushion((h, w, t), 5.5, 2.7, 10).turned("y", -90)
    return pad.moved(x=t, z=h / 2).turned("y", -lean_deg)


def arm(kind: ArmKind, d: float, thick: float, h: float, z0: float) -> list[Solid]:
    """An arm rest along x, centred on y = 0, from `z0` up to `h`."""
    if kind == "rolled":
        r = thick * 0.52
        roll = cylinder(r, d, 0.02, 24).turned("y", 90).moved(-d / 2, 0.02, h - r)
        face = cylinder(r * 0.55, 0.01, 0.004, 20).turned("y", 90).moved(d / 2 - 0.003, 0.02, h - r)
        return [roll, face, box((d - 0.03, thick * 0.72, h - r - z0), 0.02, 2).moved(-0.01, -0.01, z0)]
    if kind == "pillow":
        body = box((d, thick, h - z0 - 0.06), 0.03, 2).moved(z=z0)
        return [body, cushion((d * 0.99, thick * 1.04, 0.12), 8, 3).moved(z=h - 0.12)]
    return [box((d, thick, h - z0), 0.035 if kind == "track" else 0.02, 3).moved(z=z0)]


def tufting(inner: float, h: float, seat_h: float, x: float) -> list[Solid]:
    """A buttoned back: one surface with dimples."""
    rows, cols = 25, 57
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, cols), indexing="ij")
    z, y = seat_h - 0.04 + v * (h - seat_h - 0.01), -(u - 0.5) * inner
    pitch = 0.155
    gy, gz = np.cos(2 * np.pi * y / pitch), np.cos(2 * np.pi * (z - seat_h) / pitch)
    dimple = (
        np.clip(gy * gz, 0, 1) ** 2
        + np.clip(np.sin(2 * np.pi * y / pitch) * np.sin(2 * np.pi * (z - seat_h) / pitch), 0, 1) ** 2 * 0
    )
    edge = (1 - (2 * u - 1) ** 8) * (1 - (2 * v - 1) ** 8)
    surface = np.stack([x + (0.065 - 0.035 * dimple) * edge**0.6 - 0.05 * v, y, z], axis=-1)
    return [slab(surface, 0.02)]
