"""Bookcases and standing shelves, empty."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def bookcase(
    size: Size,
    wood: Material,
    levels: int,
    base: Base = "plinth",
    back: Material | None = None,
    columns: int = 1,
    crown: bool = False,
) -> Parts:
    """An open bookcase with equal shelves."""
    d, w, h = size
    t, z0 = 0.022, 0.07 if base == "plinth" else 0.14 if base in ("legs", "splay") else 0.0
    top = h - (0.03 if crown else 0.0)
    pitch = (top - z0 - t) / levels
    parts = open_case(
        (d - 0.02 if crown else d, w - 0.03 if crown else w, top),
        wood,
        [z0 + t + pitch * k for k in range(1, levels)],
        t,
        back,
        z0,
    )
    parts += feet(base, d, w, z0, wood)
    for k in range(1, columns):
        parts += of(
            wood, box((d - 0.006, t, top - z0 - 0.01), 0.002).moved(-0.001, -w / 2 + w * k / columns, z0 + 0.005)
        )
    if crown:
        parts += of(wood, box((d, w, 0.034), 0.01, 2).moved(z=h - 0.034))
    return parts


def frame_shelf(size: Size, boards: Material, frame: Material, levels: int, braces: bool = True) -> Parts:
    """Boards on an open steel or wooden frame."""
    d, w, h = size
    s = 0.028
    x, y = d / 2 - s / 2, w / 2 - s / 2
    zs = np.linspace(0.12, h - 0.03, levels)
    parts = of(frame, *four(box((s, s, h), 0.003).moved(x, y)))
    parts += of(boards, *(box((d - 0.012, w - 2 * s - 0.002, 0.026), 0.004).moved(0, 0, z) for z in zs))
    parts += of(frame, *(b for z in zs for b in both_sides(box((d, s * 0.9, 0.024), 0.003).moved(0, y, z + 0.001))))
    if braces:
        z0, z1 = zs[0] + 0.02, zs[-1]
        parts += of(frame, *(rod((-x, f * y, z0), (-x, -f * y, z1), 0.005, segments=6) for f in (1, -1)))
    return parts


def ladder_shelf(size: Size, wood: Material, frame: Material, levels: int = 5) -> Parts:
    """A leaning ladder: shelves grow deeper downward."""
    d, w, h = size
    front, rear = d / 2 - 0.01, -d / 2 + 0.02
    sides = both_sides(
        lowered(beam((front, w / 2 - 0.014, 0), (rear, w / 2 - 0.014, h), 0.026, 0.045)),
        box((0.024, 0.026, h * 0.98), 0.003).moved(rear - 0.006, w / 2 - 0.014),
    )
    parts = of(frame, *sides)
    for z in np.linspace(0.14, h - 0.12, levels):
        reach = front + (rear - front) * z / h
        depth = max(reach - rear, 0.02) + 0.02
        parts += of(wood, box((depth, w - 0.05, 0.022), 0.005).moved((reach + rear) / 2, 0, z))
        parts += of(wood, box((0.012, w - 0.05, 0.05), 0.003).moved(rear, 0, z))
    return parts


def cube_shelf(size: Size, wood: Material, rows: int, columns: int) -> Parts:
    """A grid of open cubes."""
    d, w, h = size
    t = 0.03
    boards = [box((d, w, t), 0.004).moved(z=z) for z in (0.0, h - t)]
    boards += [box((d, t, h - 0.004), 0.004).moved(0, s * (w - t) / 2, 0.002) for s in (1, -1)]
    thin = 0.016
    boards += [
        box((d - 0.01, w - t, thin), 0.002).moved(-0.004, 0, t + (h - 2 * t) * k / rows - thin / 2)
        for k in range(1, rows)
    ]
    boards += [
        box((d - 0.005, thin, h - t), 0.002).moved(-0.001, -w / 2 + t + (w - 2 * t) * k / columns, t / 2)
        for k in range(1, columns)
    ]
    return of(wood, *boards, box((0.006, w - 0.02, h - 0.02), 0.001).moved(-d / 2 + 0.005, 0, 0.01))


DESIGNS: tuple[Design, ...] = (
    design("bookshelf", "oak-four", "oak bookcase with four shelves", (0.32, 0.90, 1.60), "classic", bookcase, wood=m.OAK, levels=4),
    design("bookshelf", "white-five", "tall white bookcase", (0.30, 0.80, 2.02), "minimal", bookcase, wood=m.WHITE, levels=6, base="none"),
    design("bookshelf", "walnut-crown", "walnut bookcase with a cornice", (0.36, 1.05, 1.95), "classic", bookcase, wood=m.WALNUT, levels=5, crown=True),
    design("bookshelf", "low-oak", "low oak bookcase on splayed legs", (0.32, 1.10, 0.85), "modern", bookcase, wood=m.LIGHT_OAK, levels=2, base="splay"),
    design("bookshelf", "steel-frame", "industrial shelving with reclaimed boards", (0.36, 1.05, 1.80), "industrial", frame_shelf, boards=m.RECLAIMED, frame=m.BLACK_STEEL, levels=5),
    design("bookshelf", "metal-rack", "grey metal storage rack", (0.42, 0.95, 1.70), "industrial", frame_shelf, boards=m.LIGHT_GREY, frame=m.STEEL, levels=5),
    design("bookshelf", "ladder", "leaning ladder shelf", (0.42, 0.65, 1.85), "modern", ladder_shelf, wood=m.OAK, frame=m.BLACK_STEEL),
    design("bookshelf", "cubes", "white cube shelving", (0.39, 1.12, 1.12), "minimal", cube_shelf, wood=m.WHITE, rows=3, columns=3),
    design("bookshelf", "cubes-tall", "tall birch cube shelving", (0.39, 0.77, 1.47), "minimal", cube_shelf, wood=m.BIRCH, rows=4, columns=2),
    design("bookshelf", "wide", "wide bookcase with two columns", (0.32, 1.50, 1.85), "rustic", bookcase, wood=m.PINE, levels=5, columns=2),
)  # fmt: skip
