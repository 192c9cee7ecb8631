"""Shelves hung on a wall, empty."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


def wall_shelf(
    size: Size,
    wood: Material,
    kind: Literal["board", "bracket", "box", "stack", "rail"],
    metal: Material = m.BLACK_STEEL,
) -> Parts:
    """Shelves hung on a wall (the back, -X, is the wall's)."""
    d, w, h = size
    if kind == "board":
        return of(wood, box((d, w, h), 0.006, 2))
    if kind == "box":
        return open_case(size, wood, [h / 2 + 0.009], 0.018)
    if kind == "bracket":
        x, y = -d / 2, w / 2 - 0.14
        arm = [
            box((0.006, 0.03, h - 0.025), 0.002).moved(x + 0.003, y),
            box((d * 0.9, 0.03, 0.006), 0.002).moved(x + 0.45 * d, y, h - 0.031),
            rod((x + 0.004, y, 0.02), (x + d * 0.75, y, h - 0.032), 0.005, segments=8),
        ]
        return of(wood, box((d, w, 0.026), 0.005, 2).moved(z=h - 0.026)) + of(metal, *both_sides(*arm))
    n = max(round(h / 0.28), 2)
    zs = np.linspace(0.02, h - 0.045, n)
    boards = [box((d - 0.004, w, 0.024), 0.005).moved(0.002, 0, z) for z in zs]
    if kind == "rail":
        posts = both_sides(box((0.018, 0.026, h), 0.003).moved(-d / 2 + 0.009, w / 2 - 0.15))
        hooks = [
            b
            for z in zs
            for b in both_sides(box((d * 0.8, 0.012, 0.02), 0.002).moved(-0.08 * d, w / 2 - 0.15, z - 0.02))
        ]
        return of(wood, *boards) + of(metal, *posts, *hooks)
    sides = both_sides(box((d, 0.02, h), 0.005).moved(0, w / 2 - 0.03))
    return of(wood, *boards, *sides)


def pipe_shelf(size: Size, wood: Material, steel: Material) -> Parts:
    """Planks on plumber's pipe."""
    d, w, h = size
    y = w / 2 - 0.16
    zs = np.linspace(0.05, h - 0.1, 2 if h < 0.7 else 3)
    flanges = [cylinder(0.035, 0.01, 0.002, 16).turned("y", 90).moved(-d / 2, y, z) for z in (0.02 + 0.02, h - 0.04)]
    pipes = [
        rod((-d / 2 + 0.02, y, 0.0), (-d / 2 + 0.02, y, h), 0.013),
        *(rod((-d / 2, y, z - 0.012), (d / 2 - 0.02, y, z - 0.012), 0.012) for z in zs),
    ]
    return of(wood, *(box((d - 0.01, w, 0.034), 0.005).moved(0.005, 0, z) for z in zs)) + of(
        steel, *both_sides(*flanges, *pipes)
    )


DESIGNS: tuple[Design, ...] = (
    design("shelves", "floating-oak", "floating oak shelf", (0.22, 0.90, 0.045), "minimal", wall_shelf, wood=m.OAK, kind="board"),
    design("shelves", "floating-white", "floating white shelf", (0.24, 1.10, 0.05), "minimal", wall_shelf, wood=m.WHITE, kind="board"),
    design("shelves", "bracket", "walnut shelf on steel brackets", (0.24, 1.00, 0.22), "industrial", wall_shelf, wood=m.WALNUT, kind="bracket"),
    design("shelves", "box", "oak wall box shelf", (0.24, 0.80, 0.50), "modern", wall_shelf, wood=m.OAK, kind="box"),
    design("shelves", "stack", "three-tier wall shelf", (0.22, 0.90, 0.75), "classic", wall_shelf, wood=m.CHERRY, kind="stack"),
    design("shelves", "rail", "wall-rail shelving with birch boards", (0.26, 1.10, 1.00), "modern", wall_shelf, wood=m.BIRCH, kind="rail", metal=m.WHITE),
    design("shelves", "pipe", "plank shelves on pipe brackets", (0.26, 1.10, 0.60), "industrial", pipe_shelf, wood=m.RECLAIMED, steel=m.BLACK_STEEL),
)  # fmt: skip
