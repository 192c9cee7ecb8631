"""Blankets and towels: folded, rolled, draped, hung."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

TERRY = Material("white terry", "terry", "#eae7e0", 0.97, 0.0, 0.07)
BLUE_TERRY = Material("slate blue terry", "terry", "#6c8496", 0.97, 0.0, 0.07)
SAGE_TERRY = Material("sage terry", "terry", "#93a08c", 0.97, 0.0, 0.07)
ROSE_TERRY = Material("rose terry", "terry", "#b98f86", 0.97, 0.0, 0.07)
GREY_TERRY = Material("grey terry", "terry", "#a2a5a5", 0.97, 0.0, 0.07)
KNIT = Material("cream knit", "knit", "#ddd2be", 0.97, 0.0, 0.22)
RUST_KNIT = Material("rust knit", "knit", "#9b6a51", 0.97, 0.0, 0.2)
TARTAN = Material("grey tartan", "plaid", "#7d7f7e", 0.95, 0.0, 0.3)
RED_TARTAN = Material("red tartan", "plaid", "#8c5148", 0.95, 0.0, 0.3)
TWEED = Material("herringbone wool", "herringbone", "#8b8f90", 0.95, 0.0, 0.25)
QUILT = Material("patchwork", "blocks", "#7f93a0", 0.93, 0.0, 0.5)


def fold(d: float, w: float, h: float, layers: int = 3) -> Solid:
    """Cloth folded over and over: rounded folds toward +X, `layers` thick, on z = 0."""
    each = h / layers
    a = np.linspace(-np.pi / 2, np.pi / 2, 6)
    outline: list[tuple[float, float]] = []
    for k in range(layers):
        z = each * (k + 0.5)
        bulge = 0.94 - 0.02 * (k % 2)
        outline += [(d / 2 * bulge + each * 0.5 * np.cos(t), z + each * 0.47 * np.sin(t)) for t in a]
    back = [(-d / 2 + 0.004 * (k % 2), h - (k + 0.5) * h / 6) for k in range(6)]
    section = np.array([*outline, *back])
    u = np.linspace(-1, 1, 7)
    rows = []
    for s in u:
        pinch = 1 - 0.03 * abs(s) ** 6
        rows.append(
            np.column_stack(
                [section[:, 0] * pinch, np.full(len(section), s * w / 2), section[:, 1] * (1 - 0.06 * abs(s) ** 8)]
            )
        )
    return loft(np.array(rows)[:, ::-1], crease_rad=np.deg2rad(70))


def pile(size: Size, cloths: tuple[Material, ...], layers: int = 2) -> Parts:
    """Folded pieces on each other."""
    d, w, h = size
    each = h / len(cloths)
    parts: Parts = []
    for k, cloth in enumerate(cloths):
        f = 1.0 - 0.025 * (k % 3)
        parts += shifted(of(cloth, fold(d * f, w * f, each * 1.02, layers)), 0, 0.004 * (-1) ** k, k * each)
    return parts


def rolled(size: Size, cloths: tuple[Material, ...]) -> Parts:
    """Rolled towels: two below, one on top."""
    d, w, _ = size
    r = w / 4
    parts: Parts = []
    for cloth, (y, z) in zip(cloths, ((-r, r), (r, r), (0.0, 2.6 * r)), strict=True):
        body = lathe(
            [
                (0.003, -d / 2 + 0.012),
                (0.6 * r, -d / 2 + 0.003),
                (0.93 * r, -d / 2),
                (r, -d / 2 + 0.02),
                (r, d / 2 - 0.02),
                (0.93 * r, d / 2),
                (0.6 * r, d / 2 - 0.003),
                (0.003, d / 2 - 0.012),
            ],
            26,
            np.deg2rad(60),
        )
        t = np.linspace(0, 5.2 * np.pi, 44)
        swirl = np.stack(
            [np.full_like(t, d / 2 + 0.0005), 0.9 * r * t / t[-1] * np.cos(t), 0.9 * r * t / t[-1] * np.sin(t)], axis=1
        )
        parts += of(cloth, body.turned("y", 90).moved(0, y, z), tube(swirl, 0.0035, 5).moved(0, y, z))
    return parts


def over_rail(size: Size, cloths: tuple[Material, ...], metal: Material) -> Parts:
    """Towels hung on a rail from the wall."""
    d, w, h = size
    x, z = d / 2 - 0.035, h - 0.022
    parts = of(
        metal,
        rod((x, -w / 2 + 0.012, z), (x, w / 2 - 0.012, z), 0.009),
        *both_sides(
            rod((-d / 2 + 0.006, w / 2 - 0.03, z), (x, w / 2 - 0.03, z), 0.008),
            cylinder(0.022, 0.01, 0.003, 20).turned("y", 90).moved(-d / 2, w / 2 - 0.03, z),
        ),
    )
    each = (w - 0.1) / len(cloths)
    for k, cloth in enumerate(cloths):
        y = -w / 2 + 0.05 + each * (k + 0.5)
        parts += shifted(of(cloth, *hung(each * 0.86, h - 0.04, (h - 0.04) * (0.72 + 0.08 * (k % 2)))), x, y, z)
    return parts


def hung(w: float, front: float, back: float) -> list[Solid]:
    """A towel over a rail at the origin: `front` and `back` are how far it hangs on either side."""
    a = np.linspace(0, np.pi, 7)
    r = 0.017
    line = [
        (r + 0.004, -front),
        (r + 0.002, -0.66 * front),
        (r, -0.33 * front),
        *((r * np.cos(t), r * np.sin(t)) for t in a),
        (-r, -0.4 * back),
        (-r - 0.003, -back),
    ]
    u = np.linspace(-0.5, 0.5, 13)
    grid = np.array(
        [
            [(x + 0.005 * np.sin(11 * s + 2) * min(-z / front, 1.0) if z < 0 else x, s * w, z) for x, z in line]
            for s in u
        ]
    )
    bands = [box((0.002, w * 0.985, 0.012), 0.0006).moved(r + 0.0075, 0, -front + lift) for lift in (0.06, 0.09)]
    return [slab(grid[::-1], 0.007), *bands]


def draped(size: Size, cloth: Material, fringe: Material | None = None) -> Parts:
    """A throw thrown down: a soft heap with folds, as at the foot of a bed."""
    d, w, h = size
    n, k = 25, 33
    v, u = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, k), indexing="ij")
    ridge = 0.34 + 0.22 * np.sin(5.2 * u + 1.6 * v) + 0.16 * np.sin(9 * u - 3.1 * v + 1) + 0.14 * np.cos(4 * v + 2 * u)
    rim = (1 - np.abs(v) ** 6) * (1 - np.abs(u) ** 8)
    z = h * np.clip(0.10 + 0.95 * np.maximum(ridge / 0.86, 0.0) ** 1.7, 0.1, 1.0) * np.clip(rim, 0.0, 1) ** 0.5
    x = v * d / 2 * (1 - 0.05 * np.sin(3 * u + 1)) * (0.94 if fringe else 1.0)
    y = u * w / 2 * (1 - 0.05 * np.sin(4 * v))
    top = np.stack([x, y, np.maximum(z, 0.012)], axis=-1)
    low = top.copy()
    low[..., 2] = 0.0
    parts = of(cloth, shell(top, low, np.pi))
    if fringe is not None:
        rows = [(x[i, j], y[i, j], s) for i, s in ((0, -1), (n - 1, 1)) for j in range(1, k - 1)]
        parts += of(
            fringe,
            *(
                rod((px, py, 0.007), (px + s * 0.03 * d, py + 0.006 * (-1) ** j, 0.004), 0.004, 0.003, 4)
                for j, (px, py, s) in enumerate(rows)
            ),
        )
    return parts


DESIGNS: tuple[Design, ...] = (
    design("blanket", "folded-knit", "folded cream knitted throw", (0.36, 0.46, 0.13), "rustic", pile, cloths=(KNIT,), layers=3),
    design("blanket", "folded-tartan", "folded grey tartan blanket", (0.34, 0.44, 0.11), "classic", pile, cloths=(TARTAN,), layers=3),
    design("blanket", "stack", "stack of folded blankets", (0.36, 0.46, 0.26), "modern", pile, cloths=(TWEED, KNIT, RUST_KNIT)),
    design("blanket", "draped-rust", "rust throw lying in folds", (0.75, 1.15, 0.13), "modern", draped, cloth=RUST_KNIT, fringe=RUST_KNIT),
    design("blanket", "draped-red", "red tartan blanket lying in folds", (0.80, 1.20, 0.14), "classic", draped, cloth=RED_TARTAN, fringe=m.LINEN),
    design("blanket", "draped-linen", "crumpled linen throw", (0.70, 1.10, 0.10), "minimal", draped, cloth=m.LINEN),
    design("blanket", "quilt", "folded patchwork quilt", (0.42, 0.54, 0.20), "classic", pile, cloths=(QUILT,), layers=4),
    design("blanket", "tweed", "folded grey wool blanket", (0.34, 0.42, 0.10), "industrial", pile, cloths=(TWEED,), layers=2),
    design("towel", "pile-white", "pile of white towels", (0.30, 0.40, 0.22), "minimal", pile, cloths=(TERRY, TERRY, TERRY, TERRY)),
    design("towel", "pile-mixed", "pile of coloured towels", (0.30, 0.40, 0.18), "modern", pile, cloths=(BLUE_TERRY, TERRY, GREY_TERRY)),
    design("towel", "rolled", "three rolled towels", (0.36, 0.24, 0.22), "rustic", rolled, cloths=(SAGE_TERRY, TERRY, TERRY)),
    design("towel", "rail", "towels on a chrome rail", (0.10, 0.70, 0.62), "modern", over_rail, cloths=(TERRY, BLUE_TERRY), metal=m.CHROME),
    design("towel", "rail-black", "bath towel on a black rail", (0.10, 0.52, 0.66), "industrial", over_rail, cloths=(GREY_TERRY,), metal=m.BLACK_STEEL),
    design("towel", "rail-brass", "rose towel on a brass rail", (0.09, 0.46, 0.55), "classic", over_rail, cloths=(ROSE_TERRY,), metal=m.BRASS),
    design("towel", "folded", "folded hand towel", (0.18, 0.28, 0.05), "minimal", pile, cloths=(SAGE_TERRY,)),
)  # fmt: skip
