"""Cookers."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *


def stove(size: Size, body: Material, hob: str) -> Parts:
    """A cooker with an oven door; `hob` is "gas", "glass" or "rings"."""
    d, w, h = size
    back = 0.07 if hob != "glass" else 0.0
    top = h - back - (0.035 if hob == "gas" else 0.0)
    hole = (0.02 - w / 2, w / 2 - 0.02, 0.2, top - 0.16)
    parts = Cavity((d - 0.06, w, top - 0.05), (-0.03, 0, 0.04), hole=hole).body(body, 0.006, 2)
    parts += of(m.BLACK, box((d - 0.14, w - 0.03, 0.05), 0.002).moved(-0.04))
    parts += of(
        m.DARK_GLASS if hob == "glass" else m.STAINLESS,
        box((d - 0.03, w, 0.012), 0.004, 2).moved(-0.015, 0, top - 0.012),
    )
    xf = d / 2 - 0.06
    leaf = of(body, box((0.03, w - 0.012, top - 0.36), 0.01, 2).moved(xf + 0.01, 0, 0.2))
    parts += of(body, box((0.026, w - 0.012, 0.13), 0.008, 2).moved(xf + 0.01, 0, 0.06))
    leaf += of(m.DARK_GLASS, box((0.006, w - 0.14, top - 0.52), 0.002).moved(xf + 0.025, 0, 0.25)) + at(
        bar_handle(w * 0.72, False), xf + 0.02, 0, top - 0.2
    )
    parts += drop_front(xf + 0.025, 0.2, leaf)
    parts += of(body, box((0.028, w - 0.004, 0.115), 0.006, 2).moved(xf + 0.008, 0, top - 0.14))
    for y in np.linspace(-0.36 * w, 0.36 * w, 5):
        parts += at(knob(), xf + 0.022, float(y), top - 0.08)
    if back:
        parts += of(body, box((0.04, w, back + 0.03), 0.006).moved(-d / 2 + 0.02, 0, top - 0.03))
    return parts + burners(d, w, top, hob)


def burners(d: float, w: float, top: float, hob: str) -> Parts:
    """Four burners, their foot on the plane z = `top`; `hob` as in `stove`."""
    parts: Parts = []
    for x in (-0.22 * d, 0.17 * d):
        for y in (-0.24 * w, 0.24 * w):
            r = 0.085 if x * y > 0 else 0.068
            if hob == "glass":
                parts += of(
                    m.GREY,
                    tube(ring_path(superellipse(2 * r, 2 * r, 2, 32), top - 0.0005), 0.0015, 4, closed=True).moved(
                        x, y
                    ),
                )
                continue
            parts += of(m.BLACK, cylinder(r * 0.5, 0.016, 0.005, 20).moved(x, y, top - 0.002))
            if hob == "rings":
                parts += of(
                    m.BLACK,
                    *(
                        tube(ring_path(superellipse(2 * a, 2 * a, 2, 24), top + 0.008), 0.006, 6, closed=True).moved(
                            x, y
                        )
                        for a in (r * 0.55, r * 0.78, r)
                    ),
                )
                continue
            bars = [
                rod((r * 0.3, 0, top + 0.028), (r * 1.25, 0, top + 0.028), 0.005, segments=6).turned("z", 90.0 * k)
                for k in range(4)
            ]
            posts = [
                rod((r * 1.25, 0, top), (r * 1.25, 0, top + 0.03), 0.005, segments=6).turned("z", 90.0 * k)
                for k in range(4)
            ]
            parts += of(m.BLACK_STEEL, *(b.moved(x, y) for b in (*bars, *posts)))
    return parts


DESIGNS: tuple[Design, ...] = (
    design("stove", "gas-white", "white gas cooker", (0.62, 0.60, 0.95), "classic", stove, body=m.WHITE, hob="gas"),
    design("stove", "glass-steel", "stainless-steel cooker with a glass hob", (0.62, 0.60, 0.90), "modern", stove, body=m.STAINLESS, hob="glass"),
    design("stove", "range", "wide charcoal range cooker", (0.64, 0.90, 0.96), "classic", stove, body=m.CHARCOAL, hob="gas"),
    design("stove", "rings", "cream electric cooker", (0.60, 0.54, 0.93), "rustic", stove, body=m.CREAM, hob="rings"),
)  # fmt: skip
