"""Windows; the back, -X, is the wall's."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


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


def round_window(size: Size, bar: Material) -> Parts:
    """A round window with a cross of glazing bars."""
    d, w, h = size
    o = superellipse(w - 0.06, h - 0.06, 2.0, 52)
    rim = [frame_ring(w, h, d)]
    cross = [
        box((0.03, 0.03, h - 0.08), 0.006).moved(0, 0, 0.04),
        box((0.03, w - 0.08, 0.03), 0.006).moved(0, 0, h / 2 - 0.015),
    ]
    return of(bar, *rim, *cross) + of(m.PANE, stand_up(o, 0.006).pictured().moved(-0.01, 0, h / 2))


def frame_ring(w: float, h: float, d: float) -> Solid:
    """A flat ring of rectangular section, upright on z = 0."""
    outer, inner = superellipse(w, h, 2.0, 52), superellipse(w - 0.11, h - 0.11, 2.0, 52)
    rows = [(outer, -d / 2), (outer, d / 2), (inner, d / 2), (inner, -d / 2)]
    rings = np.array([np.column_stack([np.full(len(o), x), o]) for o, x in rows])
    return loft(rings, closed=True, crease_rad=np.deg2rad(40)).moved(z=h / 2)


def arched_window(size: Size, bar: Material) -> Parts:
    """A tall window with a round head and glazing bars."""
    d, w, h = size
    outer, inner = wall_outline("arch", w, h), wall_outline("arch", w - 0.12, h - 0.12)
    rows = [(outer, -d / 2), (outer, d / 2), (inner, d / 2), (inner, -d / 2)]
    rings = np.array([np.column_stack([np.full(len(o), x), o]) for o, x in rows])
    rim = loft(rings, closed=True, crease_rad=np.deg2rad(40)).moved(z=h / 2)
    spring = h - w / 2
    bars = [box((0.03, 0.028, spring), 0.005).moved(0, 0, 0.05)]
    bars += [box((0.03, w - 0.1, 0.028), 0.005).moved(0, 0, z) for z in np.linspace(0, spring, 4)[1:]]
    bars += [
        rod((0, 0, spring), (0, 0.5 * (w - 0.12) * np.sin(a), spring + 0.5 * (w - 0.12) * np.cos(a)), 0.012, segments=8)
        for a in np.deg2rad((-45, 0, 45))
    ]
    return of(bar, rim, *bars) + of(m.PANE, stand_up(inner * 1.01, 0.006).pictured().moved(-0.01, 0, h / 2))


def roof_window(size: Size, bar: Material, blind: Material) -> Parts:
    """A pivoting roof window with a blind half down."""
    d, w, h = size
    parts = of(bar, *frame(d, w, h, 0.075, 0.008)) + of(
        m.PANE, box((0.006, w - 0.13, h - 0.13), 0.001).pictured().moved(-d * 0.15, 0, 0.065)
    )
    sheet = box((0.004, w - 0.15, 0.36 * h), 0.001).moved(0.0, 0, 0.6 * h)
    return (
        parts
        + of(blind, sheet)
        + of(
            m.STEEL,
            rod((d * 0.3, -w * 0.36, h - 0.06), (d * 0.3, w * 0.36, h - 0.06), 0.008),
            box((0.012, w - 0.15, 0.018), 0.004).moved(0.004, 0, 0.59 * h),
        )
    )


def shuttered(size: Size, bar: Material, leaf: Material) -> Parts:
    """A window between open slatted shutters."""
    d, w, h = size
    inner = w * 0.52
    parts = [*window((d, inner, h), bar, (2, 2))]
    each = (w - inner) / 2 - 0.01
    for s in (1, -1):
        y = s * (inner / 2 + each / 2 + 0.008)
        parts += of(leaf, *(b.moved(-d * 0.2, y) for b in frame(0.03, each, h, 0.05)))
        zs = np.arange(0.06, h - 0.07, 0.036)
        parts += of(
            leaf, *(box((0.006, each - 0.09, 0.04), 0.002).turned("y", 30).moved(-d * 0.24, y, float(z)) for z in zs)
        )
    return parts


DESIGNS: tuple[Design, ...] = (
    design("window", "white-double", "white double window with a sill", (0.12, 1.20, 1.25), "classic", window, bar=m.WHITE),
    design("window", "sash-grid", "white window with six panes", (0.12, 1.00, 1.40), "classic", window, bar=m.WHITE, panes=(2, 3)),
    design("window", "black-grid", "black steel window", (0.08, 1.40, 1.60), "industrial", window, bar=m.BLACK_STEEL, panes=(3, 3), sill=False),
    design("window", "single-oak", "oak picture window", (0.10, 1.50, 1.10), "modern", window, bar=m.OAK, panes=(1, 1)),
    design("window", "round", "round window", (0.10, 0.80, 0.80), "classic", round_window, bar=m.WHITE),
    design("window", "arched", "arched window with glazing bars", (0.10, 0.90, 1.60), "classic", arched_window, bar=m.WHITE),
    design("window", "roof", "roof window with a blind", (0.12, 0.80, 1.18), "minimal", roof_window, bar=m.PINE, blind=m.LIGHT_FABRIC),
    design("window", "shutters", "window with grey shutters", (0.12, 1.50, 1.20), "rustic", shuttered, bar=m.WHITE, leaf=m.SAGE),
    design("window", "black-tall", "tall black-framed window", (0.10, 0.90, 1.90), "modern", window, bar=m.BLACK_STEEL, panes=(1, 3), sill=False),
)  # fmt: skip
