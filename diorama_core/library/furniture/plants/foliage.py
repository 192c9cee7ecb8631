"""Leaves and pots: what plants are made of."""

from __future__ import annotations

from functools import cache

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.solids import cross, length


def pot(diameter: float, height: float, material: Material, shape: str = "taper") -> Parts:
    """A filled pot on z = 0; `shape` is "taper", "bowl", "cylinder" or "stand" (on wooden legs)."""
    r = diameter / 2
    rim = {
        "taper": [(0.72, 0), (0.74, 0.01), (0.96, 0.84), (1.0, 0.85), (1.0, 1.0)],
        "bowl": [(0.5, 0), (0.56, 0.02), (0.96, 0.5), (1.0, 0.8), (0.92, 1.0)],
        "cylinder": [(0.97, 0), (1.0, 0.02), (1.0, 1.0)],
        "stand": [(0.94, 0.35), (1.0, 0.38), (1.0, 1.0)],
    }[shape]
    wall = [(a * r, b * height) for a, b in rim]
    top = wall[-1][0]
    parts = of(material, lathe([*wall, (top - 0.012, height), (top - 0.014, height - 0.025)], 32)) + of(
        m.SOIL, cylinder(top - 0.012, 0.012, 0.002, 24).moved(z=height - 0.036)
    )
    if shape == "stand":
        parts += of(
            m.OAK,
            *(rod((r * 0.86, 0, 0), (r * 0.86, 0, 0.72 * height), 0.012).turned("z", 45 + 90 * k) for k in range(4)),
            *(
                rod((-r * 0.86, 0, 0.33 * height), (r * 0.86, 0, 0.33 * height), 0.01).turned("z", 45 + 90 * k)
                for k in range(2)
            ),
        )
    return parts


def leaf(spine: np.ndarray, width: float, side: np.ndarray, fold: float = 0.25, tip: float = 0.5) -> Solid:
    """A thin closed leaf along a spine, folded along its middle; widest at the share `tip` of its length."""
    s = np.linspace(0, 1, len(spine))
    shape = (s / tip) ** 0.7 * (s < tip) + ((1 - s) / (1 - tip)) ** 0.75 * (s >= tip)
    half = width / 2 * shape[:, None]
    half[0] = half[-1] = 0.0
    along = unit(np.gradient(spine, axis=0))
    across = unit(side - along * (along @ side)[:, None])
    up = cross(along, across)
    left, right = spine + half * (across + fold * up), spine - half * (across - fold * up)
    lift = 0.0009 * up * (half > 0)
    vertices = np.concatenate([left, spine + lift, right, left, spine - lift, right])
    normals = np.concatenate([unit(up - fold * across), up, unit(up + fold * across)])
    reach = np.concatenate([[0.0], np.cumsum(length(np.diff(spine, axis=0)))])
    uv = np.column_stack([np.tile(reach, 6), np.concatenate([half[:, 0], 0 * s, -half[:, 0]] * 2)])
    return Solid(vertices, _leaf_faces(len(spine)), np.concatenate([normals, -normals]), uv)


@cache
def _leaf_faces(n: int) -> np.ndarray:
    """Upper and lower face of a leaf of n points along: left, spine and right rows of each."""
    i = np.arange(n - 1)
    quads = []
    for first, second in ((0, 1), (1, 2)):
        a, b = first * n + i, second * n + i
        upper = np.stack([a, b, b + 1, a + 1], axis=1)
        quads += [upper, upper[:, ::-1] + 3 * n]
    q = np.concatenate(quads)
    return np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])


def arching_leaf(
    base: np.ndarray,
    heading: float,
    length: float,
    width: float,
    rise: float,
    droop: float,
    tip: float = 0.5,
    points: int = 7,
) -> Solid:
    """A leaf that rises from `base` and droops toward `heading` (radians)."""
    s = np.linspace(0, 1, points)
    out = np.array([np.cos(heading), np.sin(heading), 0.0])
    z = rise * s - droop * s**2
    r = length * (s * 0.85 + 0.15 * s**2)
    spine = base + r[:, None] * out + z[:, None] * np.array([0, 0, 1.0])
    return leaf(spine, width, np.array([-out[1], out[0], 0.0]), 0.22, tip)
