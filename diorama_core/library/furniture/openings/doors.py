"""Doors; the back, -X, is the wall's."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


def door(
    size: Size,
    leaf: Material,
    casing: Material,
    panel: Literal["flat", "six", "two", "glazed", "plank"],
    handle: Material = m.STEEL,
) -> Parts:
    """A closed door in its casing; hinges at its left (+Y)."""
    d, w, h = size
    bar, t = 0.075, d * 0.55
    x = -d / 2 + t / 2 + d * 0.1
    jambs = [box((d, bar, h), 0.006, 2).moved(0, s * (w - bar) / 2) for s in (1, -1)]
    parts = of(casing, *jambs, box((d, w, bar), 0.006, 2).moved(z=h - bar))
    lw, lh = w - 2 * bar + 0.004, h - bar - 0.008
    front = x + t / 2
    swung = of(leaf, *_leaf(panel, lw, lh, t, x))
    if panel == "glazed":
        swung += of(m.PANE, box((0.006, lw - 0.2, lh * 0.55), 0.001).pictured().moved(x, 0, lh * 0.38))
    y, z = -lw / 2 + 0.065, 1.0
    grip = [
        box((0.006, 0.042, 0.19), 0.003).moved(front + 0.003, y, z - 0.12),
        rod((front, y, z), (front + 0.05, y, z), 0.009),
        rod((front + 0.05, y - 0.008, z), (front + 0.05, y + 0.11, z), 0.009),
    ]
    hinges = [cylinder(0.007, 0.09, 0.001, 10).moved(front, lw / 2, zz) for zz in (0.2, h - 0.35)]
    swung += of(handle, *grip)
    return parts + jointed(door_hinge(front, lw / 2, 1), swung) + of(handle, *hinges)


def _leaf(panel: str, w: float, h: float, t: float, x: float) -> list[Solid]:
    if panel == "flat":
        return [box((t, w, h), 0.003).moved(x, 0, 0.004)]
    if panel == "plank":
        n = 6
        boards = [
            box((t * 0.8, w / n - 0.004, h), 0.004).moved(x - t * 0.1, -w / 2 + w / n * (k + 0.5), 0.004)
            for k in range(n)
        ]
        return [
            *boards,
            *(box((t * 0.4, w * 0.94, 0.12), 0.004).moved(x + t * 0.3, 0, z) for z in (0.2, h - 0.32)),
            box((t * 0.5, w, h), 0.002).moved(x - t * 0.2, 0, 0.004),
        ]
    stile = 0.1
    rows = {"six": ((0.0, 0.2), (0.24, 0.62), (0.66, 1.0)), "two": ((0.0, 0.42), (0.47, 1.0)), "glazed": ((0.0, 0.3),)}[
        panel
    ]
    columns = 2 if panel == "six" else 1
    low, span = 0.2, h - 0.32
    solids = (
        [box((t * 0.45, w - 0.02, h), 0.002).moved(x, 0, 0.004)]
        if panel != "glazed"
        else [box((t * 0.45, w - 0.02, low + span * 0.33), 0.002).moved(x, 0, 0.004)]
    )
    solids += [box((t, stile, h), 0.004).moved(x, s * (w - stile) / 2, 0.004) for s in (1, -1)]
    solids += [
        box((t, w - 2 * stile + 0.002, low), 0.004).moved(x, 0, 0.004),
        box((t, w - 2 * stile + 0.002, h - low - span), 0.004).moved(x, 0, low + span + 0.004),
    ]
    for (_, top), (bottom, _) in pairwise(rows):
        solids.append(box((t, w - 2 * stile + 0.002, (bottom - top) * span), 0.004).moved(x, 0, low + top * span))
    if panel == "glazed":
        solids.append(box((t, w - 2 * stile + 0.002, 0.1), 0.004).moved(x, 0, low + 0.28 * span))
    if columns == 2:
        solids.append(box((t, stile, span), 0.004).moved(x, 0, low))
    cell_w = (w - 2 * stile - (stile if columns == 2 else 0.0)) / columns
    for a, b in rows:
        for c in range(columns):
            y = 0.0 if columns == 1 else (c - 0.5) * (cell_w + stile)
            solids.append(
                box((t * 0.75, cell_w - 0.06, (b - a) * span - 0.06), 0.012).moved(x, y, low + a * span + 0.03)
            )
    return solids


def grip(x: float, y: float, z: float) -> list[Solid]:
    """A long upright bar to pull."""
    return [
        rod((x + 0.045, y, z - 0.3), (x + 0.045, y, z + 0.3), 0.011),
        *(rod((x, y, z + s * 0.24), (x + 0.045, y, z + s * 0.24), 0.008) for s in (1, -1)),
    ]


def french_door(size: Size, leaf: Material, handle: Material = m.STEEL, rows: int = 5) -> Parts:
    """Two glazed leaves in one frame."""
    d, w, h = size
    bar, t = 0.06, d * 0.5
    parts = of(
        leaf,
        *both_sides(box((d, bar, h), 0.006, 2).moved(0, (w - bar) / 2)),
        box((d, w, bar), 0.006, 2).moved(z=h - bar),
    )
    each, tall = (w - 2 * bar) / 2 - 0.003, h - bar - 0.012
    lever = [
        rod((t / 2, -0.05, 1.0), (t / 2 + 0.05, -0.05, 1.0), 0.008),
        rod((t / 2 + 0.05, -0.05, 1.0), (t / 2 + 0.05, -0.16, 1.0), 0.008),
        box((0.006, 0.04, 0.2), 0.003).moved(t / 2, -0.05, 0.9),
    ]
    for s in (1, -1):
        y = s * (each / 2 + 0.0015)
        stile = 0.085
        swung = of(leaf, *(box((t, stile, tall), 0.005).moved(0, y + f * (each - stile) / 2, 0.006) for f in (1, -1)))
        swung += of(leaf, *(box((t, each, hh), 0.005).moved(0, y, z) for z, hh in ((0.006, 0.2), (tall - 0.09, 0.095))))
        swung += of(
            leaf,
            *(
                box((t * 0.6, each - 2 * stile + 0.01, 0.022), 0.004).moved(0, y, 0.2 + (tall - 0.29) * k / rows)
                for k in range(1, rows)
            ),
        )
        swung += of(
            m.PANE, box((0.006, each - 2 * stile + 0.01, tall - 0.28), 0.001).pictured().moved(-t * 0.1, y, 0.2)
        )
        swung += of(handle, *lever) if s < 0 else []
        parts += jointed(door_hinge(t / 2, s * (each + 0.0015), s), swung)
    return parts


def barn_door(size: Size, wood: Material, iron: Material) -> Parts:
    """A boarded sliding door on a rail, braced with a Z."""
    _, w, h = size
    lw, lh = w * 0.62, h - 0.14
    n = 6
    boards = [box((0.024, lw / n - 0.003, lh), 0.004).moved(0, -lw / 2 + lw / n * (k + 0.5), 0.01) for k in range(n)]
    face = 0.02
    rails = [box((0.02, lw, 0.12), 0.004).moved(face, 0, z) for z in (0.01, lh * 0.5 - 0.05, lh - 0.11)]
    braces = [
        beam((face, -lw * 0.44, 0.13), (face, lw * 0.44, lh * 0.5 - 0.05), 0.02, 0.1),
        beam((face, -lw * 0.44, lh * 0.5 + 0.07), (face, lw * 0.44, lh - 0.11), 0.02, 0.1),
    ]
    rail = box((0.01, w, 0.045), 0.003).moved(0.035, 0, h - 0.1)
    hangers = [box((0.008, 0.045, 0.26), 0.003).moved(0.036, s * lw * 0.36, h - 0.3) for s in (1, -1)]
    wheels = [cylinder(0.045, 0.02, 0.004, 24).turned("y", 90).moved(0.035, s * lw * 0.36, h - 0.05) for s in (1, -1)]
    slide = Joint("door", "slide", (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.0, (w - lw) / 2)
    leaf = jointed(slide, of(wood, *boards, *rails, *braces))
    return leaf + of(iron, rail) + jointed(slide, of(iron, *hangers, *wheels, *grip(0.03, -lw * 0.42, 1.0)))


def sliding_glass(size: Size, frame_of: Material) -> Parts:
    """A wide glazed door of two panels, one before the other."""
    d, w, h = size
    parts = of(
        frame_of,
        *both_sides(box((d, 0.05, h), 0.004).moved(0, w / 2 - 0.025)),
        *(box((d, w, 0.05), 0.004).moved(z=z) for z in (0.0, h - 0.05)),
    )
    slide = Joint("door", "slide", (0.0, 0.0, 0.0), (0.0, -1.0, 0.0), 0.0, w * 0.47)
    for s in (1, -1):
        x, y, each = s * d * 0.16, s * w * 0.235, w * 0.5
        panel = of(frame_of, *(b.moved(x, y, 0.03) for b in frame(d * 0.3, each, h - 0.06, 0.055)))
        panel += of(m.PANE, box((0.006, each - 0.1, h - 0.16), 0.001).pictured().moved(x, y, 0.08))
        parts += jointed(slide, panel) if s > 0 else panel
    return parts + jointed(slide, of(m.STEEL, *grip(d * 0.3, 0.03, 1.0)))


def slatted_door(size: Size, leaf: Material) -> Parts:
    """A door of fine upright slats."""
    d, w, h = size
    bar, t = 0.07, d * 0.5
    parts = of(
        leaf,
        *both_sides(box((d, bar, h), 0.006, 2).moved(0, (w - bar) / 2)),
        box((d, w, bar), 0.006, 2).moved(z=h - bar),
    )
    lw, lh = w - 2 * bar + 0.004, h - bar - 0.008
    ys = np.arange(int(lw / 0.036)) * 0.036
    ys = ys - ys.mean()
    slats = [box((0.014, 0.022, lh), 0.003).moved(t / 2, float(y), 0.004) for y in ys]
    swung = of(leaf, box((t, lw, lh), 0.003).moved(0, 0, 0.004), *slats)
    swung += of(m.BLACK_STEEL, *grip(t / 2 + 0.004, -lw / 2 + 0.07, 1.05))
    return parts + jointed(door_hinge(t / 2 + 0.007, lw / 2, 1), swung)


DESIGNS: tuple[Design, ...] = (
    design("door", "flat-white", "plain white door", (0.10, 0.92, 2.08), "minimal", door, leaf=m.WHITE, casing=m.WHITE, panel="flat"),
    design("door", "six-panel", "white six-panel door", (0.10, 0.94, 2.10), "classic", door, leaf=m.WHITE, casing=m.WHITE, panel="six", handle=m.BRASS),
    design("door", "oak", "oak door with two panels", (0.10, 0.92, 2.08), "modern", door, leaf=m.OAK, casing=m.OAK, panel="two", handle=m.BLACK_STEEL),
    design("door", "glazed", "half-glazed door", (0.10, 0.92, 2.08), "classic", door, leaf=m.WALNUT, casing=m.WALNUT, panel="glazed", handle=m.BRASS),
    design("door", "plank", "rustic plank door", (0.10, 0.90, 2.02), "rustic", door, leaf=m.RECLAIMED, casing=m.DARK_WALNUT, panel="plank", handle=m.IRON),
    design("door", "french", "white double glazed doors", (0.12, 1.50, 2.15), "classic", french_door, leaf=m.WHITE, handle=m.BRASS),
    design("door", "steel-glass", "black steel and glass doors", (0.10, 1.40, 2.20), "industrial", french_door, leaf=m.BLACK_STEEL, rows=3),
    design("door", "barn", "sliding barn door on a rail", (0.12, 1.60, 2.20), "rustic", barn_door, wood=m.RECLAIMED, iron=m.BLACK_STEEL),
    design("door", "sliding", "sliding glass door", (0.14, 1.80, 2.10), "minimal", sliding_glass, frame_of=m.CHARCOAL),
    design("door", "slats", "oak slatted door", (0.11, 0.94, 2.12), "modern", slatted_door, leaf=m.OAK),
    design("door", "navy-two", "navy door with two panels", (0.10, 0.92, 2.08), "classic", door, leaf=m.NAVY, casing=m.WHITE, panel="two", handle=m.BRASS),
    design("door", "walnut-flat", "plain walnut door", (0.10, 0.90, 2.06), "modern", door, leaf=m.WALNUT, casing=m.WALNUT, panel="flat", handle=m.BLACK_STEEL),
)  # fmt: skip
