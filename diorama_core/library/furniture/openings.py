"""What hangs on or fills walls: doors, windows, pictures, mirrors, clocks. The back, -X, is the wall's."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Literal

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material, art
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, of
from diorama_core.library.furniture.solids import Solid, box, cylinder, lathe, loft, rod, superellipse, tube
from diorama_core.library.record import SymmetryFold


def frame(d: float, w: float, h: float, bar: float, radius: float = 0.004) -> list[Solid]:
    """A rectangular frame with mitred corners, its back on x = -d/2, standing on z = 0."""
    r = min(radius, bar / 3, d / 3)
    profile = [
        (-d / 2, 0.0),
        (d / 2 - r, 0.0),
        (d / 2, r),
        (d / 2 - r * 0.4, bar * 0.8),
        (d / 2 - d * 0.25, bar),
        (-d / 2, bar),
    ]
    corners = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    rings = np.array(
        [[(x, sy * (w / 2 - inset), h / 2 + sz * (h / 2 - inset)) for x, inset in profile] for sy, sz in corners]
    )
    return [loft(np.array([rings[k], rings[(k + 1) % 4]])[:, ::-1]) for k in range(4)]


def picture(size: Size, bar: Material, image: Material, width: float = 0.03, mount: float = 0.0) -> Parts:
    """A framed picture, in a passe-partout if `mount` is given."""
    d, w, h = size
    inner_w, inner_h = w - 2 * width, h - 2 * width
    parts = of(bar, *frame(d, w, h, width)) if width else []
    x = 0.0 if width else d / 2 - 0.002
    if mount:
        parts += of(m.PORCELAIN, box((0.004, inner_w + 0.01, inner_h + 0.01), 0.001).moved(x, 0, width - 0.005))
    face = box(
        (0.003, inner_w - 2 * mount + (0 if mount else 0.008), inner_h - 2 * mount + (0 if mount else 0.008)), 0.0005
    ).pictured()
    parts += of(image, face.moved(x + (0.002 if mount else 0.0), 0, width + mount - (0 if mount else 0.004)))
    return parts + of(
        m.SHADOW if width else m.LINEN, box((d * 0.4, w - width, h - width), 0.002).moved(-d * 0.3, 0, width / 2)
    )


def whiteboard(size: Size, face: Material) -> Parts:
    """A writing board with a pen tray."""
    d, w, h = size
    return of(face, box((0.008, w - 0.02, h - 0.05), 0.001).moved(0, 0, 0.04)) + of(
        m.STEEL,
        *(s.moved(-0.004, 0, 0.03) for s in frame(0.02, w, h - 0.03, 0.014)),
        box((d, w * 0.5, 0.012), 0.004).moved(0.0, 0, 0.018),
    )


def canvas(size: Size, image: Material) -> Parts:
    """A frameless canvas."""
    d, w, h = size
    return of(m.LINEN, box((d - 0.002, w, h), 0.004).moved(-0.001)) + of(
        image, box((0.004, w - 0.006, h - 0.006), 0.001).pictured().moved(d / 2 - 0.002, 0, 0.003)
    )


def mirror(
    size: Size, bar: Material, outline: Literal["square", "round", "arch", "oval"], width: float = 0.03
) -> Parts:
    """A wall mirror."""
    d, w, h = size
    if outline == "square":
        glass = box((0.004, w - width, h - width), 0.0008).pictured().moved(0, 0, width / 2)
        return of(
            bar, *frame(d, w, h, width), box((d * 0.5, w - width, h - width), 0.002).moved(-d / 4, 0, width / 2)
        ) + of(m.MIRROR, glass)
    o = _outline(outline, w, h)
    upright = _stand_up(o * 0.97, 0.005)
    back = _stand_up(o * 0.985, d * 0.55).moved(-d / 2)
    ring = tube(np.column_stack([np.zeros(len(o)), o]), d / 2, 10, closed=True).scaled(x=0.999)
    inner = replace(ring, vertices=ring.vertices * np.array([1.0, 1 - width / w, 1 - width / h]))
    return of(bar, inner, back) + of(m.MIRROR, upright.pictured().moved(0.002))


def _outline(kind: str, w: float, h: float) -> np.ndarray:
    """Points (y, z) round the middle, counter-clockwise seen from +X."""
    if kind == "arch":
        r = w / 2
        t = np.linspace(0, np.pi, 25)
        top = np.column_stack([r * np.cos(t), h / 2 - r + r * np.sin(t)])
        return np.concatenate([top, [(-r, -h / 2 + 0.02), (-r + 0.02, -h / 2), (r - 0.02, -h / 2), (r, -h / 2 + 0.02)]])
    return superellipse(w, h, 2.0, 48)


def _stand_up(outline: np.ndarray, thickness: float) -> Solid:
    """A plate of a (y, z) outline, from x = 0 to `thickness`."""
    near, far = (np.column_stack([np.full(len(outline), x), outline]) for x in (0.0, thickness))
    return loft(np.array([near, far]))


def sunburst(size: Size, metal: Material) -> Parts:
    """A round mirror in a ring of rays."""
    d, w, _ = size
    r = w / 2
    rays = [
        rod((0, 0.5 * r, 0), (0, r * (1.0 if k % 2 else 0.82), 0), 0.007, 0.003, 6).turned("x", 360 / 36 * k)
        for k in range(36)
    ]
    return [
        p.moved(0, 0, r)
        for p in of(
            metal,
            *rays,
            tube(np.column_stack([np.zeros(40), superellipse(1.06 * r, 1.06 * r, 2, 40)]), d / 2, 10, closed=True),
        )
        + of(m.MIRROR, _stand_up(superellipse(1.02 * r, 1.02 * r, 2, 40), 0.006).pictured())
    ]


def wall_clock(size: Size, rim: Material, face: Material, square: bool = False) -> Parts:
    """A clock with hands."""
    d, w, h = size
    if square:
        parts = of(rim, *frame(d, w, h, 0.02), box((d * 0.6, w - 0.01, h - 0.01), 0.003).moved(-d * 0.2, 0, 0.005))
        return parts + of(face, box((0.004, w - 0.036, h - 0.036), 0.001).pictured().moved(0.2 * d, 0, 0.018))
    r = w / 2
    ring = (
        lathe(
            [(r * 0.9, 0), (r, 0.004), (r, d * 0.8), (r * 0.97, d), (r * 0.9, d * 0.92), (r * 0.88, d * 0.5)],
            48,
            np.deg2rad(45),
        )
        .turned("y", 90)
        .moved(-d / 2, 0, h / 2)
    )
    dial = _stand_up(superellipse(2 * r * 0.9, 2 * r * 0.9, 2, 48), d * 0.55).pictured().moved(-d / 2, 0, h / 2)
    return of(rim, ring) + of(face, dial)


def alarm_clock(size: Size, body: Material, face: Material) -> Parts:
    """A twin-bell alarm clock."""
    d, w, h = size
    r = w * 0.46
    can = cylinder(r, d * 0.8, 0.006, 36).turned("y", 90).moved(-d * 0.4, 0, r + 0.012)
    dial = _stand_up(superellipse(r * 1.8, r * 1.8, 2, 40), 0.006).pictured().moved(d * 0.4 - 0.002, 0, r + 0.012)
    bells = [
        lathe([(0.02, 0), (r * 0.42, 0.002), (r * 0.38, 0.018), (r * 0.2, 0.028), (0.004, 0.03)], 20, np.pi)
        .turned("x", s * 28)
        .moved(0, -s * r * 0.5, h - 0.045)
        for s in (1, -1)
    ]
    legs = [rod((0, s * r * 0.72, 0.0), (0, s * r * 0.5, r * 0.4), 0.006) for s in (1, -1)]
    return (
        of(body, can, *bells, *legs)
        + of(face, dial)
        + of(m.STEEL, tube(np.array([(0, -0.02, h - 0.02), (0, 0, h - 0.005), (0, 0.02, h - 0.02)]), 0.003, 6))
    )


def window(size: Size, bar: Material, panes: tuple[int, int] = (2, 1), sill: bool = True) -> Parts:
    """A window in its frame; `panes` is columns by rows."""
    d, w, h = size
    low = 0.035 if sill else 0.0
    fw, fh, depth = w - (0.06 if sill else 0.0), h - low, d * 0.7
    parts = [p.moved(-d * 0.15, 0, low) for p in of(bar, *frame(depth, fw, fh, 0.06))]
    inner_w, inner_h = fw - 0.12, fh - 0.12
    parts += of(m.PANE, box((0.006, inner_w + 0.01, inner_h + 0.01), 0.001).pictured().moved(-d * 0.28, 0, low + 0.055))
    columns, rows = panes
    for k in range(1, columns):
        parts += of(
            bar,
            box((depth * 0.7, 0.05 if columns == 2 else 0.028, inner_h + 0.01), 0.006, 2).moved(
                -d * 0.2, -inner_w / 2 + inner_w * k / columns, low + 0.055
            ),
        )
    for k in range(1, rows):
        parts += of(
            bar,
            box((depth * 0.55, inner_w + 0.01, 0.028), 0.006).moved(
                -d * 0.2, 0, low + 0.06 + inner_h * k / rows - 0.014
            ),
        )
    if columns == 2:
        parts += of(m.STEEL, box((0.03, 0.02, 0.09), 0.006).moved(d * 0.12, 0, low + fh * 0.42))
    if sill:
        parts += of(bar, box((d, w, 0.035), 0.008, 2))
    return parts


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
    parts += of(leaf, *_leaf(panel, lw, lh, t, x))
    if panel == "glazed":
        parts += of(m.PANE, box((0.006, lw - 0.2, lh * 0.55), 0.001).pictured().moved(x, 0, lh * 0.38))
    y, z = -lw / 2 + 0.065, 1.0
    grip = [
        box((0.006, 0.042, 0.19), 0.003).moved(front + 0.003, y, z - 0.12),
        rod((front, y, z), (front + 0.05, y, z), 0.009),
        rod((front + 0.05, y - 0.008, z), (front + 0.05, y + 0.11, z), 0.009),
    ]
    hinges = [cylinder(0.007, 0.09, 0.001, 10).moved(front, lw / 2, zz) for zz in (0.2, h - 0.35)]
    return parts + of(handle, *grip, *hinges)


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


HILLS = art("hills print", "hills", "#5c6f74")
WARM_HILLS = art("dusk hills print", "hills", "#8a6656")
ABSTRACT = art("abstract print", "abstract", "#6d7f83")
ABSTRACT_TWO = art("abstract print in ochre", "abstract", "#9c7a55")
BOTANIC = art("botanical print", "botanic", "#5f7355")
SEASCAPE = art("seascape", "waves", "#5e7887")
DIAL = art("clock dial", "dial", "#f0ece2")
DARK_DIAL = art("dark clock dial", "dial", "#2f3235")
CHALK = art("blackboard", "clay", "#2f3a36", 0.9)


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 1
) -> Design:
    return Design(f"{category}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d(
        "picture",
        "hills-oak",
        "landscape print in an oak frame",
        (0.03, 0.80, 0.60),
        "modern",
        partial(picture, bar=m.OAK, image=HILLS, mount=0.06),
    ),
    _d(
        "picture",
        "abstract-black",
        "abstract print in a black frame",
        (0.028, 0.60, 0.80),
        "modern",
        partial(picture, bar=m.BLACK_WOOD, image=ABSTRACT, width=0.02, mount=0.07),
    ),
    _d(
        "picture",
        "botanic",
        "botanical print in a walnut frame",
        (0.028, 0.42, 0.58),
        "classic",
        partial(picture, bar=m.WALNUT, image=BOTANIC, mount=0.04),
    ),
    _d(
        "picture",
        "seascape-gilt",
        "seascape in a gilt frame",
        (0.045, 0.95, 0.70),
        "classic",
        partial(picture, bar=m.BRASS, image=SEASCAPE, width=0.06),
    ),
    _d(
        "picture",
        "canvas",
        "large abstract canvas",
        (0.036, 1.10, 0.80),
        "minimal",
        partial(canvas, image=ABSTRACT_TWO),
    ),
    _d(
        "picture",
        "small-photo",
        "small framed photograph",
        (0.022, 0.24, 0.30),
        "minimal",
        partial(picture, bar=m.WHITE, image=WARM_HILLS, width=0.018, mount=0.03),
    ),
    _d(
        "picture",
        "panorama",
        "wide landscape print",
        (0.026, 1.30, 0.50),
        "modern",
        partial(picture, bar=m.BLACK_WOOD, image=WARM_HILLS, width=0.02),
    ),
    _d(
        "picture",
        "whiteboard",
        "whiteboard with a pen tray",
        (0.06, 1.50, 1.00),
        "industrial",
        partial(whiteboard, face=m.WHITE),
    ),
    _d("picture", "blackboard", "blackboard", (0.05, 1.20, 0.90), "rustic", partial(whiteboard, face=CHALK)),
    _d(
        "mirror",
        "oak",
        "rectangular mirror in an oak frame",
        (0.035, 0.65, 0.95),
        "modern",
        partial(mirror, bar=m.OAK, outline="square"),
    ),
    _d(
        "mirror",
        "round-brass",
        "round brass mirror",
        (0.03, 0.75, 0.75),
        "modern",
        partial(mirror, bar=m.BRASS, outline="round", width=0.02),
    ),
    _d(
        "mirror",
        "arch-black",
        "arched black mirror",
        (0.03, 0.70, 1.20),
        "industrial",
        partial(mirror, bar=m.BLACK_STEEL, outline="arch", width=0.02),
    ),
    _d(
        "mirror",
        "gilt",
        "gilt-framed mirror",
        (0.05, 0.80, 1.10),
        "classic",
        partial(mirror, bar=m.BRASS, outline="square", width=0.07),
    ),
    _d(
        "mirror",
        "oval",
        "oval walnut mirror",
        (0.035, 0.55, 0.80),
        "classic",
        partial(mirror, bar=m.WALNUT, outline="oval", width=0.02),
    ),
    _d("mirror", "sunburst", "sunburst mirror", (0.03, 0.80, 0.80), "classic", partial(sunburst, metal=m.BRASS)),
    _d(
        "clock",
        "round-black",
        "round black wall clock",
        (0.045, 0.32, 0.32),
        "modern",
        partial(wall_clock, rim=m.BLACK_STEEL, face=DIAL),
    ),
    _d("clock", "round-oak", "oak wall clock", (0.05, 0.36, 0.36), "rustic", partial(wall_clock, rim=m.OAK, face=DIAL)),
    _d(
        "clock",
        "square-dark",
        "square clock with a dark dial",
        (0.04, 0.30, 0.30),
        "minimal",
        partial(wall_clock, rim=m.STEEL, face=DARK_DIAL, square=True),
    ),
    _d(
        "clock",
        "alarm",
        "twin-bell alarm clock",
        (0.06, 0.12, 0.16),
        "classic",
        partial(alarm_clock, body=m.SAGE, face=DIAL),
    ),
    _d(
        "window",
        "white-double",
        "white double window with a sill",
        (0.12, 1.20, 1.25),
        "classic",
        partial(window, bar=m.WHITE),
    ),
    _d(
        "window",
        "sash-grid",
        "white window with six panes",
        (0.12, 1.00, 1.40),
        "classic",
        partial(window, bar=m.WHITE, panes=(2, 3)),
    ),
    _d(
        "window",
        "black-grid",
        "black steel window",
        (0.08, 1.40, 1.60),
        "industrial",
        partial(window, bar=m.BLACK_STEEL, panes=(3, 3), sill=False),
    ),
    _d(
        "window",
        "single-oak",
        "oak picture window",
        (0.10, 1.50, 1.10),
        "modern",
        partial(window, bar=m.OAK, panes=(1, 1)),
    ),
    _d(
        "door",
        "flat-white",
        "plain white door",
        (0.10, 0.92, 2.08),
        "minimal",
        partial(door, leaf=m.WHITE, casing=m.WHITE, panel="flat"),
    ),
    _d(
        "door",
        "six-panel",
        "white six-panel door",
        (0.10, 0.94, 2.10),
        "classic",
        partial(door, leaf=m.WHITE, casing=m.WHITE, panel="six", handle=m.BRASS),
    ),
    _d(
        "door",
        "oak",
        "oak door with two panels",
        (0.10, 0.92, 2.08),
        "modern",
        partial(door, leaf=m.OAK, casing=m.OAK, panel="two", handle=m.BLACK_STEEL),
    ),
    _d(
        "door",
        "glazed",
        "half-glazed door",
        (0.10, 0.92, 2.08),
        "classic",
        partial(door, leaf=m.WALNUT, casing=m.WALNUT, panel="glazed", handle=m.BRASS),
    ),
    _d(
        "door",
        "plank",
        "rustic plank door",
        (0.10, 0.90, 2.02),
        "rustic",
        partial(door, leaf=m.RECLAIMED, casing=m.DARK_WALNUT, panel="plank", handle=m.IRON),
    ),
)
