"""Glasses to drink from."""

from __future__ import annotations

import numpy as np

from diorama_core.library.furniture.kit import *

SHAPES: dict[str, tuple[Profile, float]] = {
    "tumbler": (((0.82, 0), (0.85, 0.02), (1.0, 0.98), (0.995, 1.0)), 0.09),
    "highball": (((0.9, 0), (0.94, 0.015), (1.0, 0.98), (0.995, 1.0)), 0.08),
    "lowball": (((0.86, 0), (0.92, 0.03), (0.97, 0.3), (1.0, 0.97), (0.99, 1.0)), 0.13),
    "pint": (((0.7, 0), (0.73, 0.02), (0.86, 0.6), (1.0, 0.8), (0.96, 1.0)), 0.06),
}
"""Outline and thickness of the bottom as a share of the height."""
BOWLS: dict[str, tuple[Profile, float]] = {
    "wine": (((0.1, 0.0), (0.44, 0.08), (0.95, 0.42), (1.0, 0.58), (0.8, 1.0)), 0.45),
    "flute": (((0.14, 0.0), (0.6, 0.12), (0.95, 0.5), (0.86, 1.0)), 0.36),
    "coupe": (((0.1, 0.0), (0.5, 0.16), (0.9, 0.55), (1.0, 1.0)), 0.62),
    "balloon": (((0.1, 0.0), (0.6, 0.12), (1.0, 0.45), (0.95, 0.66), (0.68, 1.0)), 0.42),
}
"""Outline of the bowl above the stem, and the stem's share of the height."""


def tumbler(size: Size, kind: str, glass: Material = m.GLASS, drink: Material | None = None) -> Parts:
    """A glass without a stem, filled to two thirds if a `drink` is given."""
    _, w, h = size
    outline, bottom = SHAPES[kind]
    parts = of(glass, hollow(outline, w / 2, h, 0.0026, bottom * h, 32))
    if drink is not None:
        inside = [
            (w / 2 * float(np.interp(z, [b for _, b in outline], [a for a, _ in outline])) - 0.0034, z * h)
            for z in (bottom + 0.02, 0.4, 0.66)
        ]
        parts += of(drink, lathe([*inside, (0.003, 0.66 * h)], 28, np.deg2rad(55)))
    return parts


def stemmed(size: Size, kind: str, glass: Material = m.GLASS, drink: Material | None = None) -> Parts:
    """A glass on a stem."""
    _, w, h = size
    r = w / 2
    bowl, stem = BOWLS[kind]
    low, span = stem * h, (1 - stem) * h
    outer = [(r * a, low + b * span) for a, b in smooth_profile(bowl, 3)]
    inner = [(max(a - 0.0016, 0.003), max(z, low + 0.006)) for a, z in reversed(outer)]
    foot = [
        (0.72 * r, 0),
        (0.76 * r, 0.0024),
        (0.2 * r, 0.01),
        (0.085 * r, 0.08 * h),
        (0.075 * r, 0.8 * low),
        (0.1 * r, low),
    ]
    parts = of(glass, lathe([*foot, *outer[1:], *inner, (0.002, low + 0.006)], 32, np.deg2rad(50)))
    if drink is not None:
        level = low + 0.5 * span
        filled = [(a - 0.0026, z) for a, z in outer if low + 0.012 < z < level]
        parts += of(drink, lathe([*filled, (filled[-1][0], level), (0.003, level)], 28, np.deg2rad(55)))
    return parts


RED_WINE = m.glass("red wine", "#5b2530", 0.92)
WHITE_WINE = m.glass("white wine", "#d9c98f", 0.55)
WHISKY = m.glass("whisky", "#b07a3c", 0.75)
SMOKED = m.glass("smoked glass", "#6f7476", 0.5)
GREEN_TUMBLER = m.glass("sea-green glass", "#8fb0a4", 0.42)


DESIGNS: tuple[Design, ...] = (
    design("glass", "tumbler", "glass tumbler", (0.08, 0.08, 0.11), "modern", tumbler, 36, id="cup-tumbler", kind="tumbler"),
    design("glass", "wine", "wine glass", (0.085, 0.085, 0.20), "classic", stemmed, 36, id="cup-wine", kind="wine"),
    design("glass", "red-wine", "glass of red wine", (0.095, 0.095, 0.22), "classic", stemmed, 36, kind="balloon", drink=RED_WINE),
    design("glass", "flute", "champagne flute", (0.062, 0.062, 0.23), "modern", stemmed, 36, kind="flute", drink=WHITE_WINE),
    design("glass", "coupe", "cocktail coupe", (0.10, 0.10, 0.15), "minimal", stemmed, 36, kind="coupe"),
    design("glass", "highball", "tall glass", (0.07, 0.07, 0.15), "minimal", tumbler, 36, kind="highball"),
    design("glass", "whisky", "glass of whisky", (0.085, 0.085, 0.09), "industrial", tumbler, 36, kind="lowball", drink=WHISKY),
    design("glass", "pint", "pint glass", (0.09, 0.09, 0.15), "rustic", tumbler, 36, kind="pint"),
    design("glass", "green", "sea-green glass tumbler", (0.085, 0.085, 0.10), "rustic", tumbler, 36, kind="tumbler", glass=GREEN_TUMBLER),
)  # fmt: skip
