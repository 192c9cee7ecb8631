"""Radiators."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def panel_radiator(size: Size, paint: Material) -> Parts:
    """A pressed-steel panel radiator."""
    d, w, h = size
    n = max(int(w / 0.055), 6)
    ribs = [
        box((0.02, w / n * 0.5, h - 0.07), 0.008, 2).moved(d / 2 - 0.012, -w / 2 + w / n * (k + 0.5), 0.035)
        for k in range(n)
    ]
    return of(
        paint,
        box((0.026, w, h - 0.02), 0.008, 2).moved(d / 2 - 0.022, 0, 0.01),
        *ribs,
        box((d - 0.02, w - 0.01, 0.012), 0.004).moved(0.004, 0, h - 0.012),
        box((0.02, w * 0.9, h * 0.84), 0.005).moved(-d / 2 + 0.03, 0, 0.08 * h),
    ) + of(m.WHITE, cylinder(0.018, 0.05, 0.004, 16).moved(d / 2 - 0.035, -w / 2 - 0.02, 0.05))


def column_radiator(size: Size, paint: Material) -> Parts:
    """A cast-iron radiator of rounded columns."""
    d, w, h = size
    n = max(round(w / 0.06), 5)
    columns: list[Solid] = []
    for k in range(n):
        y = -w / 2 + w / n * (k + 0.5)
        low = 0.0 if k in (0, n - 1) else 0.05
        columns += [rod((x, y, 0.09), (x, y, h - 0.05), 0.019, segments=10) for x in (-0.28 * d, 0.28 * d)]
        columns += [
            box((d, w / n * 0.82, 0.075), 0.024, 2).moved(0, y, h - 0.075),
            box((d, w / n * 0.82, 0.075), 0.024, 2).moved(0, y, 0.05),
        ]
        if low == 0.0:
            columns.append(box((d * 0.8, 0.03, 0.07), 0.01).moved(0, y))
    pipes = [rod((0, -w / 2, z), (0, w / 2, z), 0.017) for z in (0.087, h - 0.037)]
    return of(paint, *columns, *pipes)


def towel_radiator(size: Size, metal: Material) -> Parts:
    """A ladder of tubes."""
    d, w, h = size
    posts = [rod((0, s * (w / 2 - 0.015), 0), (0, s * (w / 2 - 0.015), h), 0.015) for s in (1, -1)]
    groups = np.concatenate([np.linspace(0.06, 0.36, 6), np.linspace(0.44, 0.68, 5), np.linspace(0.76, 0.96, 4)]) * h
    bars = [rod((0.012, -w / 2 + 0.015, z), (0.012, w / 2 - 0.015, z), 0.011, segments=10) for z in groups]
    stays = [
        rod((-d + 0.02, s * (w / 2 - 0.06), z), (0.01, s * (w / 2 - 0.06), z), 0.008)
        for s in (1, -1)
        for z in (0.2 * h, 0.82 * h)
    ]
    return of(metal, *posts, *bars, *stays)


def slim_panels(size: Size, paint: Material) -> Parts:
    """Upright flat bars between two pipes."""
    d, w, h = size
    count = max(int(w / 0.075), 3)
    pitch = w / count
    bars = [
        box((d * 0.34, pitch * 0.84, h), 0.008, 2).moved(d * 0.28, -w / 2 + pitch * (k + 0.5)) for k in range(count)
    ]
    pipes = [rod((0.0, -w / 2 + 0.01, z), (0.0, w / 2 - 0.01, z), 0.014) for z in (0.08, h - 0.08)]
    stays = [rod((-d / 2, s * w * 0.36, z), (0.0, s * w * 0.36, z), 0.009) for s in (1, -1) for z in (0.08, h - 0.08)]
    return of(paint, *bars, *pipes, *stays)


DESIGNS: tuple[Design, ...] = (
    design("radiator", "panel", "white panel radiator", (0.11, 1.00, 0.60), "minimal", panel_radiator, paint=m.WHITE),
    design("radiator", "column-white", "white column radiator", (0.14, 0.90, 0.66), "classic", column_radiator, paint=m.WHITE),
    design("radiator", "column-grey", "charcoal column radiator", (0.14, 0.66, 0.75), "industrial", column_radiator, paint=m.CHARCOAL),
    design("radiator", "towel", "chrome towel radiator", (0.10, 0.50, 1.10), "modern", towel_radiator, metal=m.CHROME),
    design("radiator", "slim-black", "tall black flat-bar radiator", (0.09, 0.50, 1.60), "industrial", slim_panels, 1, paint=m.CHARCOAL),
    design("radiator", "slim-white", "low white flat-bar radiator", (0.09, 1.10, 0.60), "minimal", slim_panels, 1, paint=m.WHITE),
)  # fmt: skip
