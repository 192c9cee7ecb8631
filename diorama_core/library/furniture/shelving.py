"""Bookcases, wall shelves and wardrobes. All of it empty."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.carcass import door_front, drawer_front, open_case, plinth
from diorama_core.library.furniture.cases import Base, feet
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, four, of
from diorama_core.library.furniture.solids import beam, box, cylinder, rod
from diorama_core.library.record import SymmetryFold


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
            wood, box((d - 0.014, t, top - z0 - 0.01), 0.002).moved(-0.004, -w / 2 + w * k / columns, z0 + 0.005)
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
        beam((front, w / 2 - 0.014, 0), (rear, w / 2 - 0.014, h), 0.026, 0.045),
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
        box((d - 0.01, thin, h - t), 0.002).moved(-0.004, -w / 2 + t + (w - 2 * t) * k / columns, t / 2)
        for k in range(1, columns)
    ]
    return of(wood, *boards, box((0.006, w - 0.02, h - 0.02), 0.001).moved(-d / 2 + 0.005, 0, 0.01))


def wardrobe(
    size: Size,
    body: Material,
    doors: int,
    front: Material | None = None,
    pull: Material = m.STEEL,
    panel: str = "flat",
    drawers: bool = False,
    crown: bool = False,
    mirror: int | None = None,
) -> Parts:
    """A tall closet with hinged doors."""
    d, w, h = size
    base = 0.08
    low = 0.26 if drawers else 0.0
    cap = 0.06 if crown else 0.0
    parts = of(
        body, box((d - 0.03, w - (0.04 if crown else 0), h - base - cap), 0.004).moved(-0.012, 0, base)
    ) + plinth(d - 0.02, w - 0.02, base, body)
    if crown:
        parts += of(
            body,
            box((d, w, 0.04), 0.012, 2).moved(z=h - 0.04),
            box((d - 0.02, w - 0.025, 0.03), 0.006).moved(z=h - 0.065),
        )
    span = w - (0.05 if crown else 0.008)
    each = span / doors
    x = d / 2 - 0.027
    for k in range(doors):
        y = -span / 2 + each * (k + 0.5)
        parts += door_front(
            x,
            y,
            base + low + 0.005,
            each - 0.005,
            h - base - low - cap - 0.012,
            front or body,
            pull,
            "tall",
            1 if k % 2 else -1,
            panel,
        )
        if mirror == k:
            parts += of(
                m.MIRROR, box((0.004, each - 0.08, h - base - 0.16), 0.001).pictured().moved(x + 0.0185, y, base + 0.07)
            )
    if drawers:
        n = max(doors // 2, 1)
        for k in range(n):
            parts += drawer_front(
                x,
                -span / 2 + span / n * (k + 0.5),
                base + 0.006,
                span / n - 0.006,
                low - 0.012,
                front or body,
                pull,
                "bar",
            )
    return parts


def sliding_wardrobe(size: Size, body: Material, front: Material, doors: int) -> Parts:
    """A wardrobe with sliding doors in aluminium frames."""
    d, w, h = size
    parts = of(
        body,
        box((d - 0.04, w, h), 0.004).moved(-0.02),
        box((d, w, 0.03), 0.003),
        box((d, w, 0.03), 0.003).moved(z=h - 0.03),
    )
    each = w / doors
    for k in range(doors):
        x = d / 2 - (0.028 if k % 2 else 0.012)
        y = -w / 2 + each * (k + 0.5)
        parts += of(front, box((0.012, each - 0.02, h - 0.07), 0.002).moved(x - 0.003, y, 0.035))
        parts += of(
            m.STEEL,
            *(box((0.018, 0.024, h - 0.06), 0.003).moved(x, y + s * (each / 2 - 0.012), 0.03) for s in (1, -1)),
            *(box((0.015, each - 0.02, 0.022), 0.003).moved(x, y, z) for z in (0.032, h - 0.054)),
        )
    return parts


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


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 1
) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d(
        "bookshelf",
        "oak-four",
        "oak bookcase with four shelves",
        (0.32, 0.90, 1.60),
        "classic",
        partial(bookcase, wood=m.OAK, levels=4),
    ),
    _d(
        "bookshelf",
        "white-five",
        "tall white bookcase",
        (0.30, 0.80, 2.02),
        "minimal",
        partial(bookcase, wood=m.WHITE, levels=6, base="none"),
    ),
    _d(
        "bookshelf",
        "walnut-crown",
        "walnut bookcase with a cornice",
        (0.36, 1.05, 1.95),
        "classic",
        partial(bookcase, wood=m.WALNUT, levels=5, crown=True),
    ),
    _d(
        "bookshelf",
        "low-oak",
        "low oak bookcase on splayed legs",
        (0.32, 1.10, 0.85),
        "modern",
        partial(bookcase, wood=m.LIGHT_OAK, levels=2, base="splay"),
    ),
    _d(
        "bookshelf",
        "steel-frame",
        "industrial shelving with reclaimed boards",
        (0.36, 1.05, 1.80),
        "industrial",
        partial(frame_shelf, boards=m.RECLAIMED, frame=m.BLACK_STEEL, levels=5),
    ),
    _d(
        "bookshelf",
        "metal-rack",
        "grey metal storage rack",
        (0.42, 0.95, 1.70),
        "industrial",
        partial(frame_shelf, boards=m.LIGHT_GREY, frame=m.STEEL, levels=5),
    ),
    _d(
        "bookshelf",
        "ladder",
        "leaning ladder shelf",
        (0.42, 0.65, 1.85),
        "modern",
        partial(ladder_shelf, wood=m.OAK, frame=m.BLACK_STEEL),
    ),
    _d(
        "bookshelf",
        "cubes",
        "white cube shelving",
        (0.39, 1.12, 1.12),
        "minimal",
        partial(cube_shelf, wood=m.WHITE, rows=3, columns=3),
    ),
    _d(
        "bookshelf",
        "cubes-tall",
        "tall birch cube shelving",
        (0.39, 0.77, 1.47),
        "minimal",
        partial(cube_shelf, wood=m.BIRCH, rows=4, columns=2),
    ),
    _d(
        "bookshelf",
        "wide",
        "wide bookcase with two columns",
        (0.32, 1.50, 1.85),
        "rustic",
        partial(bookcase, wood=m.PINE, levels=5, columns=2),
    ),
    _d(
        "wardrobe",
        "white-two",
        "white two-door wardrobe",
        (0.58, 1.00, 2.00),
        "minimal",
        partial(wardrobe, body=m.WHITE, doors=2),
    ),
    _d(
        "wardrobe",
        "oak-three",
        "oak three-door wardrobe with drawers",
        (0.60, 1.45, 2.02),
        "modern",
        partial(wardrobe, body=m.OAK, doors=3, drawers=True, pull=m.BLACK_STEEL),
    ),
    _d(
        "wardrobe",
        "armoire",
        "walnut armoire with a cornice",
        (0.62, 1.20, 2.08),
        "classic",
        partial(wardrobe, body=m.WALNUT, doors=2, panel="shaker", drawers=True, crown=True, pull=m.BRASS),
    ),
    _d(
        "wardrobe",
        "sliding",
        "sliding-door wardrobe in light oak",
        (0.65, 1.80, 2.10),
        "modern",
        partial(sliding_wardrobe, body=m.WHITE, front=m.LIGHT_OAK, doors=2),
    ),
    _d(
        "wardrobe",
        "mirror",
        "white wardrobe with a mirror door",
        (0.58, 1.50, 2.10),
        "modern",
        partial(wardrobe, body=m.WHITE, doors=3, mirror=1),
    ),
    _d(
        "wardrobe",
        "rustic",
        "cream painted rustic wardrobe",
        (0.58, 1.10, 1.95),
        "rustic",
        partial(wardrobe, body=m.CREAM, doors=2, panel="shaker", crown=True, pull=m.IRON),
    ),
    _d(
        "shelves",
        "floating-oak",
        "floating oak shelf",
        (0.22, 0.90, 0.045),
        "minimal",
        partial(wall_shelf, wood=m.OAK, kind="board"),
    ),
    _d(
        "shelves",
        "floating-white",
        "floating white shelf",
        (0.24, 1.10, 0.05),
        "minimal",
        partial(wall_shelf, wood=m.WHITE, kind="board"),
    ),
    _d(
        "shelves",
        "bracket",
        "walnut shelf on steel brackets",
        (0.24, 1.00, 0.22),
        "industrial",
        partial(wall_shelf, wood=m.WALNUT, kind="bracket"),
    ),
    _d(
        "shelves",
        "box",
        "oak wall box shelf",
        (0.24, 0.80, 0.50),
        "modern",
        partial(wall_shelf, wood=m.OAK, kind="box"),
    ),
    _d(
        "shelves",
        "stack",
        "three-tier wall shelf",
        (0.22, 0.90, 0.75),
        "classic",
        partial(wall_shelf, wood=m.CHERRY, kind="stack"),
    ),
    _d(
        "shelves",
        "rail",
        "wall-rail shelving with birch boards",
        (0.26, 1.10, 1.00),
        "modern",
        partial(wall_shelf, wood=m.BIRCH, kind="rail", metal=m.WHITE),
    ),
    _d(
        "shelves",
        "pipe",
        "plank shelves on pipe brackets",
        (0.26, 1.10, 0.60),
        "industrial",
        partial(pipe_shelf, wood=m.RECLAIMED, steel=m.BLACK_STEEL),
    ),
)
