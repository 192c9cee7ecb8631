"""Bookcases, wall shelves, wine racks and open wardrobes in more shapes. All of it empty."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from diorama_core.library.furniture.kit import *
from diorama_core.library.furniture.shelving.bookcases import bookcase, cube_shelf, frame_shelf, ladder_shelf
from diorama_core.library.furniture.shelving.wall_shelves import wall_shelf
from diorama_core.library.furniture.shelving.wardrobes import sliding_wardrobe, wardrobe
from diorama_core.library.furniture.storage.styled import styled_case


def dresser_bookcase(
    size: Size, style: Style, levels: int, low: float = 0.36, bays: tuple[str, ...] = ("pair",)
) -> Parts:
    """Open shelves over a closed cupboard."""
    d, w, h = size
    base = styled_case(
        (d, w, low * h),
        style,
        list(bays),
        top=style.wood,
        base="plinth" if style.base != "steel" else "steel",
        base_h=0.08,
    )
    upper, z0 = d - 0.1, low * h
    cap = 0.035 if style.name in ("classic", "rustic") else 0.0
    pitch = (h - cap - z0) / levels
    shelves = open_case(
        (upper, w - 0.02, h - cap), style.wood, [z0 + pitch * k for k in range(1, levels)], 0.022, base=z0 - 0.002
    )
    parts = base + shifted(shelves, -0.045)
    if cap:
        parts += of(style.wood, box((upper + 0.04, w + 0.02, cap), 0.012, 2).moved(-0.035, 0, h - cap))
    return parts


def stepped_shelf(size: Size, wood: Material, columns: int) -> Parts:
    """Compartments that step up like a stair."""
    d, w, h = size
    t = 0.022
    each_w, each_h = (w - t) / columns, (h - t) / columns
    boards = []
    for c in range(columns):
        y = w / 2 - t / 2 - each_w * c
        boards.append(box((d, t, h - each_h * max(c - 1, 0)), 0.003).moved(0, y))
        for r in range(columns - c):
            boards.append(
                box((d - 0.004, each_w + t * 0.5, t), 0.003).moved(0, y - each_w / 2, each_h * (columns - c - r))
            )
        boards.append(box((d - 0.004, each_w + t * 0.5, t), 0.003).moved(0, y - each_w / 2, 0))
    boards.append(box((d, t, each_h + t), 0.003).moved(0, -w / 2 + t / 2))
    return of(wood, *boards)


def asymmetric_shelf(size: Size, boards: Material, frame: Material, levels: int) -> Parts:
    """Boards on thin uprights that jump from side to side."""
    d, w, h = size
    t = 0.022
    zs = np.linspace(0.06, h - t, levels + 1)
    parts = of(boards, *(box((d, w, t), 0.004).moved(0, 0, z) for z in zs))
    spots = [(-0.38, 0.12), (-0.1, 0.40), (-0.42, 0.02), (-0.18, 0.34), (-0.36, 0.2), (-0.08, 0.42)]
    for k, (low, high) in enumerate(pairwise(zs)):
        for share in (*spots[k % len(spots)], -0.49 if k % 2 else 0.49):
            parts += of(
                frame,
                box((d - 0.01, 0.016, high - low - t + 0.004), 0.002).moved(0, share * (w - 0.02), low + t - 0.002),
            )
    return parts + of(frame, *four(leg("slim", d / 2 - 0.03, w / 2 - 0.05, 0.065, 0.04)))


def open_wardrobe(size: Size, wood: Material, steel: Material, drawers: int) -> Parts:
    """A steel frame with a clothes rail, shelves at one side and drawers below."""
    d, w, h = size
    bar = 0.025
    x, y = d / 2 - bar / 2, w / 2 - bar / 2
    parts = of(
        steel,
        *four(box((bar, bar, h), 0.003).moved(x, y)),
        *both_sides(*(box((d, bar, bar), 0.003).moved(0, y, z) for z in (0.1, h - bar))),
        *(box((bar, w, bar), 0.003).moved(f * x, 0, z) for f in (1, -1) for z in (0.1, h - bar)),
    )
    split = 0.18 * w
    parts += of(
        steel,
        *(box((bar, bar, h - 0.1), 0.003).moved(f * x, split, 0.1) for f in (1, -1)),
        rod((0, -y, h - 0.14), (0, split, h - 0.14), 0.014),
    )
    parts += of(
        wood,
        box((d - 0.01, w - 0.01, 0.024), 0.004).moved(0, 0, h - 0.024),
        box((d - 0.01, w - 0.01, 0.022), 0.004).moved(0, 0, 0.12),
    )
    side_w = y - split
    for z in np.linspace(0.45 + 0.2 * drawers * 0.5, h - 0.42, 3):
        parts += of(wood, box((d - 0.02, side_w - 0.01, 0.02), 0.003).moved(0, (y + split) / 2, z))
    if drawers:
        tall = 0.17
        parts += of(wood, box((d - 0.06, w - 0.06, tall * drawers), 0.003).moved(-0.015, 0, 0.142))
        for k in range(drawers):
            for f in (1, -1):
                parts += drawer_front(
                    d / 2 - 0.045,
                    f * (w - 0.06) / 4,
                    0.146 + tall * k,
                    (w - 0.06) / 2 - 0.006,
                    tall - 0.008,
                    wood,
                    steel,
                    "strap",
                )
    return parts


def lattice_wine_rack(size: Size, wood: Material, pitch: float = 0.115) -> Parts:
    """Crossed boards in a case: every diamond holds a bottle."""
    d, w, h = size
    t = 0.02
    parts = open_case((d, w, h), wood, [], t)
    inner_w, inner_h = w - 2 * t, h - 2 * t
    boards = []
    for sign in (1, -1):
        for c in np.arange(-inner_w - inner_h, inner_w + inner_h, pitch * 1.5):
            pts = []
            for yy in (-inner_w / 2, inner_w / 2):
                zz = sign * yy + c
                if 0 <= zz <= inner_h:
                    pts.append((yy, zz))
            for zz in (0.0, inner_h):
                yy = sign * (zz - c)
                if -inner_w / 2 < yy < inner_w / 2:
                    pts.append((yy, zz))
            if len(pts) == 2 and np.hypot(pts[0][0] - pts[1][0], pts[0][1] - pts[1][1]) > 0.06:
                boards.append(beam((0, pts[0][0], pts[0][1] + t), (0, pts[1][0], pts[1][1] + t), d - 0.02, 0.01, 0.002))
    return parts + of(wood, *boards)


def rail_wine_rack(size: Size, frame: Material, rails: Material, rows: int, columns: int) -> Parts:
    """Rows of scalloped rails, front and back, in an open frame."""
    d, w, h = size
    metal = frame.metallic > 0.2
    bar = 0.016 if metal else 0.032
    x, y = d / 2 - bar / 2, w / 2 - bar / 2
    parts = of(
        frame,
        *four(box((bar, bar, h - 0.02), 0.003).moved(x, y)),
        *both_sides(*(box((d, bar, bar), 0.003).moved(0, y, z) for z in (0.08, h - 0.04))),
    )
    pitch = (h - 0.16) / rows
    for k in range(rows):
        z = 0.1 + pitch * k
        t = np.linspace(-1, 1, 8 * columns + 1)
        wave = (
            z + 0.02 - 0.018 * np.abs(np.cos(t * np.pi * columns / 2))
            if columns % 2
            else z + 0.02 - 0.018 * np.abs(np.sin(t * np.pi * columns / 2))
        )
        for px in (x, -x):
            path = np.column_stack([np.full(len(t), px), t * (y - 0.002), wave])
            parts += of(rails, tube(path, 0.007 if metal else 0.011, 6))
    if not metal:
        parts += of(frame, box((d + 0.01, w + 0.02, 0.024), 0.006, 2).moved(z=h - 0.024))
    return parts


OAK = MODERN.but(wood=m.OAK)
CREAM = RUSTIC.but(wood=m.CREAM)
DUCK = CLASSIC.but(wood=s.DUCK_EGG)

DESIGNS: tuple[Design, ...] = (
    design("bookshelf", "cupboard-mahogany", "mahogany bookcase over a cupboard", (0.42, 1.00, 2.05), CLASSIC, dresser_bookcase, levels=4),
    design("bookshelf", "cupboard-pine", "pine dresser bookcase", (0.44, 1.10, 1.95), RUSTIC, dresser_bookcase, levels=3, bays=("door", "2", "door")),
    design("bookshelf", "cupboard-smoked", "smoked-oak bookcase with drawers below", (0.40, 1.00, 1.90), MODERN.but(wood=s.SMOKED_OAK, handle="none"), dresser_bookcase, levels=4, bays=("2", "2")),
    design("bookshelf", "cupboard-white", "white bookcase over plain doors", (0.38, 0.80, 2.00), MINIMAL.but(wood=m.WHITE), dresser_bookcase, levels=4),
    design("bookshelf", "stepped-birch", "birch stepped bookshelf", (0.30, 1.20, 1.20), "minimal", stepped_shelf, wood=m.BIRCH, columns=3),
    design("bookshelf", "stepped-walnut", "walnut stepped shelf of four steps", (0.32, 1.40, 1.40), "modern", stepped_shelf, wood=m.WALNUT, columns=4),
    design("bookshelf", "asymmetric-oak", "oak bookshelf with staggered uprights", (0.32, 1.20, 1.75), "modern", asymmetric_shelf, boards=m.OAK, frame=m.BLACK_STEEL, levels=5),
    design("bookshelf", "factory", "tall reclaimed-wood shelves on a steel frame", (0.38, 1.10, 2.00), "industrial", frame_shelf, boards=m.RECLAIMED, frame=m.BLACK_STEEL, levels=5),
    design("bookshelf", "pine-open", "open pine shelving", (0.34, 0.85, 1.70), "rustic", frame_shelf, boards=m.PINE, frame=m.PINE, levels=5, braces=False),
    design("bookshelf", "cherry-low", "low cherry bookcase", (0.32, 1.10, 0.95), "classic", bookcase, wood=m.CHERRY, levels=2, crown=True),
    design("bookshelf", "ladder-black", "black ladder shelf with oak boards", (0.42, 0.70, 1.85), "industrial", ladder_shelf, wood=m.OAK, frame=m.BLACK_STEEL, levels=5),
    design("bookshelf", "cubes-oak", "oak grid of six cubes", (0.36, 1.12, 0.76), "modern", cube_shelf, wood=m.OAK, rows=2, columns=3),
    design("wardrobe", "open-steel", "open reclaimed-wood wardrobe on steel", (0.52, 1.30, 1.90), "industrial", open_wardrobe, wood=m.RECLAIMED, steel=m.BLACK_STEEL, drawers=1),
    design("wardrobe", "open-white", "open white wardrobe frame", (0.50, 1.10, 1.85), "minimal", open_wardrobe, wood=m.WHITE, steel=m.STEEL, drawers=0),
    design("wardrobe", "pine-panelled", "pine wardrobe with panelled doors and a drawer", (0.58, 1.05, 1.98), "rustic", wardrobe, body=m.PINE, doors=2, pull=m.IRON, panel="shaker", drawers=True, crown=True),
    design("wardrobe", "duck-egg", "duck egg armoire", (0.60, 1.20, 2.10), "classic", wardrobe, body=s.DUCK_EGG, doors=2, pull=m.BRASS, panel="shaker", crown=True),
    design("wardrobe", "smoked-sliding", "smoked-oak wardrobe with sliding doors", (0.64, 1.80, 2.10), "modern", sliding_wardrobe, body=s.SMOKED_OAK, front=s.SMOKED_OAK, doors=2),
    design("wardrobe", "charcoal-steel", "charcoal steel cupboard with two doors", (0.52, 0.92, 1.90), "industrial", wardrobe, body=m.CHARCOAL, doors=2, pull=m.STEEL),
    design("wardrobe", "oak-louvred", "oak wardrobe with louvred doors", (0.58, 1.40, 2.00), "rustic", wardrobe, body=m.OAK, doors=3, pull=m.IRON, panel="slats"),
    design("shelves", "pine-bracket", "pine shelf on iron brackets", (0.22, 0.90, 0.24), "rustic", wall_shelf, wood=m.PINE, kind="bracket", metal=m.IRON),
    design("shelves", "mahogany-stack", "mahogany wall shelves", (0.20, 0.70, 0.85), "classic", wall_shelf, wood=m.MAHOGANY, kind="stack"),
    design("shelves", "cherry-bracket", "cherry shelf on brass brackets", (0.24, 1.10, 0.26), "classic", wall_shelf, wood=m.CHERRY, kind="bracket", metal=m.BRASS),
    design("shelves", "smoked-board", "smoked-oak floating shelf", (0.25, 1.20, 0.045), "modern", wall_shelf, 1, wood=s.SMOKED_OAK, kind="board"),
    design("shelves", "reclaimed-rail", "reclaimed-wood shelves on steel rails", (0.26, 1.20, 1.05), "industrial", wall_shelf, wood=m.RECLAIMED, kind="rail"),
    design("shelves", "birch-box", "birch box shelf", (0.22, 0.90, 0.50), "minimal", wall_shelf, wood=m.BIRCH, kind="box"),
    design("wine rack", "lattice-oak", "oak wine rack of crossed boards", (0.32, 0.70, 0.95), "rustic", lattice_wine_rack, wood=m.OAK),
    design("wine rack", "lattice-mahogany", "mahogany wine cabinet lattice", (0.34, 0.60, 1.20), "classic", lattice_wine_rack, wood=m.MAHOGANY),
    design("wine rack", "wire", "black wire wine rack", (0.24, 0.46, 0.90), "industrial", rail_wine_rack, frame=m.BLACK_STEEL, rails=m.BLACK_STEEL, rows=6, columns=4),
    design("wine rack", "birch-scallop", "birch wine rack with scalloped rails", (0.28, 0.62, 0.72), "minimal", rail_wine_rack, frame=m.BIRCH, rails=m.BIRCH, rows=4, columns=5),
    design("wine rack", "walnut-brass", "walnut wine stand with brass rails", (0.30, 0.55, 0.86), "modern", rail_wine_rack, frame=m.WALNUT, rails=m.BRASS, rows=5, columns=4),
)  # fmt: skip
