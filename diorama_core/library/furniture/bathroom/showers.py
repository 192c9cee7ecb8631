"""Showers; the back, -X, is the wall's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.furniture.kit import *

SHOWER_GLASS = m.glass("shower glass", "#aebfbb", 0.16)
WALL_TILES = Material("white tiles", "tiles", "#dfe2e0", 0.2, 0.0, 0.6)
GREEN_TILES = Material("green tiles", "tiles", "#8fa398", 0.2, 0.0, 0.4)


def tray(d: float, w: float, h: float, x: float = 0.0) -> Parts:
    """A shallow tray with a drain."""
    o = rounded_rectangle(d, w, 0.03, 4)
    rows = [(1.0, 0.0), (1.0, h - 0.006), (0.99, h), (0.93, h), (0.91, h - 0.015), (0.04, h - 0.022)]
    body = loft(np.array([ring_path(o * s, z) for s, z in rows]), crease_rad=np.deg2rad(50)).moved(x)
    return of(m.PORCELAIN, body) + of(m.CHROME, cylinder(0.045, 0.006, 0.002, 24).moved(x + 0.2 * d, 0, h - 0.022))


def fittings(x: float, y: float, h: float, metal: Material, rain: bool = True) -> Parts:
    """Riser, head, hand shower and mixer on the wall at `x`."""
    bar = rod((x + 0.05, y, 1.0), (x + 0.05, y, h - 0.08), 0.011)
    solids: list[Solid] = [bar, *(rod((x, y, z), (x + 0.05, y, z), 0.009) for z in (1.05, h - 0.3))]
    solids.append(cylinder(0.022, 0.26, 0.006, 18).turned("x", 90).moved(x + 0.05, y + 0.13, 1.0))
    solids += [cylinder(0.026, 0.03, 0.005, 18).turned("x", 90 * s).moved(x + 0.05, y - s * 0.13, 1.0) for s in (1, -1)]
    if rain:
        solids.append(
            tube(
                bend(
                    [
                        (x + 0.05, y, h - 0.1),
                        (x + 0.07, y, h - 0.03),
                        (x + 0.16, y, h - 0.02),
                        (x + 0.36, y, h - 0.03),
                        (x + 0.38, y, h - 0.06),
                    ],
                    4,
                ),
                0.01,
                10,
            )
        )
        solids.append(
            lathe([(0.125, 0), (0.128, 0.006), (0.04, 0.016), (0.014, 0.03)], 36).moved(x + 0.38, y, h - 0.09)
        )
    hand = [
        lathe([(0.045, 0), (0.048, 0.006), (0.02, 0.022)], 24).turned("y", 118).moved(x + 0.12, y + 0.05, 1.56),
        rod((x + 0.11, y + 0.05, 1.55), (x + 0.06, y + 0.03, 1.36), 0.011, 0.009),
    ]
    hose = tube(
        bend(
            [(x + 0.06, y + 0.03, 1.36), (x + 0.09, y + 0.06, 1.0), (x + 0.1, y + 0.04, 0.72), (x + 0.06, y, 0.98)], 5
        ),
        0.006,
        8,
    )
    return of(metal, *solids, *hand, hose)


def pane(width: float, height: float, z: float) -> Solid:
    """A sheet of glass in the plane y-z, standing on z."""
    return box((0.008, width, height), 0.002).moved(z=z)


def cabin(size: Size, metal: Material, quadrant: bool = False, tiles: Material = WALL_TILES) -> Parts:
    """A corner shower: tiled walls at -X and -Y, glass on the other sides, a tray below."""
    d, w, h = size
    t, low = 0.03, 0.05
    walls = [box((t, w, h), 0.002).moved(-d / 2 + t / 2), box((d, t, h), 0.002).moved(0, w / 2 - t / 2)]
    parts = of(tiles, *walls)
    inner_d, inner_w = d - t, w - t
    if quadrant:
        r = 0.55 * min(inner_d, inner_w)
        a = np.linspace(0, -np.pi / 2, 11)
        corner = [(d / 2 - r + r * np.cos(x), -w / 2 + r + r * np.sin(x)) for x in a]
        outline = np.array([(d / 2, w / 2 - t), (-d / 2 + t, w / 2 - t), (-d / 2 + t, -w / 2), *reversed(corner)])
        path = np.array([(d / 2 - 0.012, w / 2 - t), *corner, (-d / 2 + t, -w / 2 + 0.012)])
        parts += of(m.PORCELAIN, prism(outline, low, 0.01))
        sheet = np.array([[(x, y, z) for x, y in path] for z in (low, h * 0.95)])
        parts += of(SHOWER_GLASS, slab(sheet, 0.007))
        rails = [tube(np.column_stack([path, np.full(len(path), z)]), 0.014, 6) for z in (low + 0.01, h * 0.95)]
        knob = rod((d / 2 - 0.3 * r, -w / 2 + 0.27 * r, 0.95), (d / 2 - 0.3 * r, -w / 2 + 0.27 * r, 1.15), 0.012)
        parts += of(metal, *rails, knob)
    else:
        parts += [p.moved(t / 2, -t / 2) for p in tray(inner_d, inner_w, low)]
        front = [
            pane(inner_w * 0.98, h * 0.95 - low, low).moved(d / 2 - 0.02, -t / 2),
            pane(inner_d * 0.97, h * 0.95 - low, low).turned("z", 90).moved(t / 2, -w / 2 + 0.02),
        ]
        parts += of(SHOWER_GLASS, *front)
        posts = [
            box((0.025, 0.025, h * 0.95), 0.004).moved(x, y)
            for x, y in (
                (d / 2 - 0.02, -w / 2 + 0.02),
                (d / 2 - 0.02, w / 2 - t - 0.012),
                (-d / 2 + t + 0.012, -w / 2 + 0.02),
            )
        ]
        rails = [
            box((0.025, inner_w, 0.025), 0.004).moved(d / 2 - 0.02, -t / 2, h * 0.95 - 0.025),
            box((inner_d, 0.025, 0.025), 0.004).moved(t / 2, -w / 2 + 0.02, h * 0.95 - 0.025),
        ]
        grip = rod((d / 2, -w * 0.3, 0.9), (d / 2, -w * 0.3, 1.25), 0.011)
        parts += of(metal, *posts, *rails, grip)
    parts += fittings(-d / 2 + t, 0.08 * w, h * 0.97, m.CHROME if metal is not m.BLACK_STEEL else metal)
    return [replace(p, solid=p.solid.mirrored()) for p in parts]


def walk_in(size: Size, metal: Material, tiles: Material, grid: bool = False) -> Parts:
    """A tiled back wall, a flat tray and one glass screen."""
    d, w, h = size
    t = 0.03
    parts = of(tiles, box((t, w, h), 0.002).moved(-d / 2 + t / 2))
    parts += [p.moved(t / 2) for p in tray(d - t, w, 0.035)]
    parts += of(SHOWER_GLASS, pane(d - t - 0.03, h * 0.92, 0.035).turned("z", 90).moved(t / 2, -w / 2 + 0.02))
    frame = [box((d - t, 0.02, 0.025), 0.004).moved(t / 2, -w / 2 + 0.02, z) for z in (0.035, 0.92 * h + 0.02)]
    frame += [
        box((0.022, 0.02, 0.92 * h), 0.004).moved(x, -w / 2 + 0.02, 0.04) for x in (d / 2 - 0.012, -d / 2 + t + 0.012)
    ]
    frame.append(rod((d * 0.32, -w / 2 + 0.02, 0.92 * h), (-d / 2 + t, -w * 0.1, 0.92 * h), 0.008))
    if grid:
        frame += [box((d - t, 0.016, 0.018), 0.003).moved(t / 2, -w / 2 + 0.02, 0.92 * h * k / 5) for k in range(1, 5)]
        frame += [
            box((0.018, 0.016, 0.9 * h), 0.003).moved(-d / 2 + t + (d - t) * k / 3, -w / 2 + 0.02, 0.05) for k in (1, 2)
        ]
    return parts + of(metal, *frame) + fittings(-d / 2 + t, 0.1 * w, h * 0.97, metal)


DESIGNS: tuple[Design, ...] = (
    design("shower", "corner", "corner shower with chrome frames", (0.92, 0.92, 2.10), "modern", cabin, metal=m.CHROME),
    design("shower", "quadrant", "rounded corner shower", (0.92, 0.92, 2.05), "classic", cabin, metal=m.WHITE, quadrant=True),
    design("shower", "walk-in", "walk-in shower with a glass screen", (0.90, 1.30, 2.15), "minimal", walk_in, metal=m.STEEL, tiles=WALL_TILES),
    design("shower", "grid", "shower with a black gridded screen", (0.90, 1.20, 2.15), "industrial", walk_in, metal=m.BLACK_STEEL, tiles=GREEN_TILES, grid=True),
    design("shower", "brass", "brass-framed corner shower with green tiles", (0.95, 0.95, 2.10), "rustic", cabin, metal=m.BRASS, tiles=GREEN_TILES),
)  # fmt: skip
