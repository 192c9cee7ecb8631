"""Books: stacked, in rows, open."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

COVERS = tuple(
    m.Material(f"book cover {k}", "leather", c, 0.7, 0.0, 0.3)
    for k, c in enumerate(
        ("#7a4a3f", "#3f5566", "#8c8467", "#4d5a4a", "#a58a5c", "#5a4a52", "#b9ab96", "#40434a", "#93705a", "#6f7f86")
    )
)


def book(d: float, w: float, t: float, cover: Material) -> Parts:
    """A closed book lying flat on z = 0, its spine toward +X, `d` from spine to fore-edge."""
    board = 0.003
    covers = [box((d, w, board), 0.001).moved(z=z) for z in (0.0, t - board)]
    spine = (
        prism(superellipse(t, 0.02, 3, 16), w, 0.001).turned("x", 90).turned("y", 90).moved(d / 2 - 0.006, w / 2, t / 2)
    )
    bands = [
        box((0.003, 0.004, t * 0.94), 0.001).moved(d / 2 + 0.003, f * w, t * 0.03) for f in (-0.36, -0.3, 0.3, 0.36)
    ]
    return (
        of(cover, *covers, spine)
        + of(m.PAPER, box((d - 0.012, w - 0.01, t - 2 * board), 0.001).moved(-0.003, 0, board))
        + of(m.BRASS, *bands)
    )


def book_stack(size: Size, count: int, seed: int) -> Parts:
    """Books lying on each other, a little askew."""
    d, w, h = size
    rng = np.random.default_rng(seed)
    share = rng.uniform(0.7, 1.4, count)
    heights = share / share.sum() * h
    parts: Parts = []
    z = 0.0
    for k, t in enumerate(heights):
        f = 1.0 - 0.16 * k / count * rng.uniform(0.6, 1.4)
        one = book(d * 0.93 * f, w * 0.93 * f, float(t) - 0.0004, COVERS[(seed * 3 + k * 7) % len(COVERS)])
        parts += [p.moved(0, 0, z) for p in turned(one, "z", float(rng.uniform(-6, 6)) if k else 0.0)]
        z += float(t)
    return parts


def book_row(size: Size, seed: int, leaning: bool = True) -> Parts:
    """Books standing in a row along y, spines toward +X."""
    d, w, h = size
    rng = np.random.default_rng(seed)
    parts: Parts = []
    y, k = -w / 2, 0
    stop = w / 2 - (0.055 if leaning else 0.0)
    while y < stop - 0.012:
        t = min(float(rng.uniform(0.016, 0.042)), stop - y)
        hh = h * float(rng.uniform(0.78, 1.0)) if k else h
        dd = d * float(rng.uniform(0.84, 1.0)) if k != 1 else d
        parts += _standing(dd, hh, t, COVERS[(seed + k * 3) % len(COVERS)], d / 2 - dd / 2, y + t / 2)
        y, k = y + t + 0.0008, k + 1
    if leaning:
        last = [
            p.turned("x", 11)
            for p in _standing(d * 0.9, h * 0.84, 0.02, COVERS[(seed + 5) % len(COVERS)], d * 0.04, 0.0)
        ]
        parts += [p.moved(0, w / 2 - 0.013, 0.0) for p in last]
    return parts


def _standing(d: float, h: float, t: float, cover: Material, x: float, y: float) -> Parts:
    lying = book(d, h, t, cover)
    return [p.moved(0, 0, -t / 2).turned("x", 90).moved(x, y, h / 2) for p in lying]


def open_book(size: Size, cover: Material) -> Parts:
    """An open book, read from +X."""
    d, w, h = size
    half = w / 2
    u = np.linspace(0, 1, 9)
    rise = h * (0.35 + 0.65 * np.sin(np.pi * np.clip(u * 1.05, 0, 1)) ** 0.8) * np.where(u < 0.1, 0.6 + 4 * u, 1)
    grid = np.stack([np.stack([np.full(9, x), half * u, rise], axis=1) for x in (d / 2 - 0.006, -d / 2 + 0.006)])
    low = grid.copy()
    low[:, :, 2] = 0.004
    page = shell(grid[::-1], low[::-1])
    return of(m.PAPER, *both_sides(page)) + of(cover, box((d, w + 0.012, 0.004), 0.001))


def magazines(size: Size) -> Parts:
    """A loose pile of magazines."""
    d, w, h = size
    rng = np.random.default_rng(2)
    n = 7
    parts: Parts = []
    for k in range(n):
        one = of(COVERS[(k * 3) % 10], box((d * 0.92, w * 0.92, h / n * 0.9), 0.0015)) + of(
            m.PAPER, box((d * 0.921, w * 0.921, h / n * 0.5), 0.001).moved(z=h / n * 0.2)
        )
        parts += [
            p.moved(float(rng.uniform(-0.006, 0.006)), float(rng.uniform(-0.006, 0.006)), k * h / n)
            for p in turned(one, "z", float(rng.uniform(-7, 7)))
        ]
    return parts


def between_ends(size: Size, seed: int, ends: Material) -> Parts:
    """A row of books between two blocks."""
    d, w, h = size
    block = min(0.05, 0.14 * w)
    parts = book_row((d, w - 2 * block - 0.004, h), seed, leaning=False)
    return parts + of(ends, *(box((d * 0.9, block, 0.62 * h), 0.006, 2).moved(0, s * (w - block) / 2) for s in (1, -1)))


def file_row(size: Size, tones: tuple[Material, ...]) -> Parts:
    """Ring binders in a row, their spines toward +X."""
    d, w, h = size
    n = max(int(w / 0.075), 2)
    each = w / n
    parts: Parts = []
    for k in range(n):
        y = -w / 2 + each * (k + 0.5)
        parts += of(tones[k % len(tones)], box((d, each - 0.003, h), 0.004).moved(0, y))
        parts += of(m.PORCELAIN, box((0.002, each * 0.62, h * 0.4), 0.0008).moved(d / 2, y, h * 0.42)) + of(
            m.STEEL, cylinder(0.013, 0.004, 0.001, 18).turned("y", 90).moved(d / 2 - 0.002, y, h * 0.16)
        )
    return parts


def newspaper(size: Size) -> Parts:
    """A folded newspaper."""
    d, w, h = size
    sheets = [
        box((d * (1 - 0.012 * k), w * (1 - 0.01 * (k % 2)), h / 5 * 0.96), 0.0016).moved(
            0.002 * (-1) ** k, 0.0, k * h / 5
        )
        for k in range(5)
    ]
    lines = [
        box((0.004, w * 0.26, 0.0004), 0.0001).moved(x * d, y * w, h - 0.0002)
        for x in np.linspace(-0.36, 0.18, 8)
        for y in (-0.32, 0.0, 0.32)
    ]
    head = [
        box((0.03, w * 0.8, 0.0004), 0.0001).moved(d * 0.38, 0, h - 0.0002),
        box((d * 0.2, w * 0.4, 0.0005), 0.0001).moved(d * 0.02, -w * 0.22, h - 0.0002),
    ]
    return of(NEWSPRINT, *sheets) + of(m.CHARCOAL, *lines, *head)


NEWSPRINT = m.Material("newsprint", "paper", "#d9d4c8", 0.95, 0.0, 0.3)


DESIGNS: tuple[Design, ...] = (
    design("books", "stack-small", "stack of three books", (0.17, 0.24, 0.09), "classic", book_stack, count=3, seed=1),
    design("books", "stack-tall", "tall stack of books", (0.20, 0.28, 0.22), "modern", book_stack, count=7, seed=4),
    design("books", "stack-large", "stack of large picture books", (0.25, 0.33, 0.13), "minimal", book_stack, count=4, seed=9),
    design("books", "row", "row of books", (0.19, 0.42, 0.26), "classic", book_row, seed=3),
    design("books", "row-long", "long row of books", (0.18, 0.72, 0.25), "classic", book_row, seed=8, leaning=False),
    design("books", "open", "open book", (0.24, 0.34, 0.035), "minimal", open_book, cover=COVERS[1]),
    design("books", "single", "single book", (0.15, 0.22, 0.03), "minimal", book_stack, count=1, seed=6),
    design("books", "magazines", "pile of magazines", (0.24, 0.31, 0.05), "modern", magazines),
    design("books", "ends-marble", "row of books between marble blocks", (0.19, 0.46, 0.25), "modern", between_ends, seed=5, ends=m.MARBLE),
    design("books", "ends-oak", "row of books between oak blocks", (0.18, 0.36, 0.23), "rustic", between_ends, seed=12, ends=m.OAK),
    design("books", "binders", "row of ring binders", (0.28, 0.45, 0.32), "industrial", file_row, tones=(m.NAVY, m.GREY, m.CHARCOAL)),
    design("books", "stack-five", "stack of five novels", (0.14, 0.21, 0.14), "rustic", book_stack, count=5, seed=15),
    design("books", "newspaper", "folded newspaper", (0.30, 0.38, 0.016), "classic", newspaper),
)  # fmt: skip
