"""Vases and jugs."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *

VASES: dict[str, Profile] = {
    "urn": ((0.42, 0), (0.5, 0.02), (0.95, 0.42), (1.0, 0.58), (0.8, 0.8), (0.42, 0.92), (0.5, 1.0)),
    "bottle": ((0.7, 0), (0.78, 0.02), (1.0, 0.25), (0.85, 0.48), (0.32, 0.66), (0.24, 0.85), (0.34, 1.0)),
    "cylinder": ((0.94, 0), (1.0, 0.015), (1.0, 0.985), (0.99, 1.0)),
    "moon": ((0.36, 0), (0.42, 0.02), (0.86, 0.22), (1.0, 0.5), (0.86, 0.78), (0.42, 0.95), (0.4, 1.0)),
    "bud": ((0.5, 0), (0.56, 0.02), (0.98, 0.2), (1.0, 0.28), (0.62, 0.46), (0.26, 0.58), (0.22, 0.82), (0.34, 1.0)),
    "gourd": ((0.5, 0), (0.56, 0.02), (0.96, 0.22), (0.98, 0.34), (0.5, 0.54), (0.62, 0.7), (0.6, 0.8), (0.34, 1.0)),
    "trumpet": ((0.62, 0), (0.64, 0.02), (0.5, 0.06), (0.4, 0.2), (0.46, 0.5), (0.68, 0.82), (1.0, 1.0)),
    "tulip": ((0.5, 0), (0.54, 0.02), (0.5, 0.1), (0.72, 0.45), (0.8, 0.7), (0.86, 0.88), (1.0, 1.0)),
}


def vase(size: Size, clay: Material, kind: str, handles: bool = False) -> Parts:
    """A vase; with two handles if asked."""
    d, w, h = size
    r = min(d, w) / 2 * (0.78 if handles else 1.0)
    parts = of(clay, hollow(smooth_profile(VASES[kind]), r, h, 0.008))
    if handles:
        ear = tube(
            bend([(0, r * 0.46, 0.93 * h), (0, r * 1.0, 0.92 * h), (0, r * 1.2, 0.78 * h), (0, r * 0.93, 0.62 * h)], 5),
            0.011,
            8,
        )
        parts += of(clay, *both_sides(ear))
    return parts


def jug(size: Size, clay: Material) -> Parts:
    """A pitcher with a handle at its back."""
    _, w, h = size
    r = w / 2
    body = hollow(
        smooth_profile(((0.72, 0), (0.78, 0.02), (1.0, 0.35), (0.9, 0.6), (0.62, 0.82), (0.7, 1.0))), r, h, 0.006
    )
    handle = tube(
        bend([(-r * 0.6, 0, 0.88 * h), (-r * 1.35, 0, 0.86 * h), (-r * 1.45, 0, 0.6 * h), (-r * 0.96, 0, 0.38 * h)], 5),
        0.011,
        8,
    )
    return of(clay, body, handle)


def fluted_vase(size: Size, clay: Material, ribs: int = 20, twist: float = 0.0) -> Parts:
    """A vase with ribs from foot to lip, spiralling by `twist` turns."""
    _, w, h = size
    r = w / 2
    outer = smooth_profile(((0.56, 0), (0.6, 0.02), (0.84, 0.3), (0.9, 0.55), (0.6, 0.85), (0.72, 1.0)))
    body = hollow(outer, r, h, 0.007, segments=4 * ribs)
    angle = np.arctan2(body.vertices[:, 1], body.vertices[:, 0]) + 2 * np.pi * twist * body.vertices[:, 2] / h
    factor = 1 + 0.045 * np.cos(ribs * angle)
    return of(clay, replace(body, vertices=body.vertices * np.column_stack([factor, factor, np.ones(len(factor))])))


def ring_vase(size: Size, clay: Material) -> Parts:
    """A vase like an upright ring on a foot."""
    d, w, h = size
    r = 0.5 * w - d * 0.26
    t = np.linspace(0, 2 * np.pi, 41)[:-1]
    path = np.stack([0 * t, r * np.cos(t), h * 0.46 + r * np.sin(t) * (h * 0.8 / w)], axis=1)
    ring = tube(path, d * 0.3, 14, closed=True)
    neck = hollow(((0.8, 0), (0.66, 0.4), (0.8, 1.0)), d * 0.3, 0.24 * h, 0.006, 0.004, 24).moved(z=0.76 * h)
    foot = lathe([(d * 0.48, 0), (d * 0.5, 0.006), (d * 0.42, 0.05 * h), (d * 0.2, 0.1 * h)], 28)
    return of(clay, ring, neck, foot)


BUD_SPOTS = {
    1: ((0.0, 0.0, 1.0, 0.45),),
    2: ((-0.06, -0.24, 1.0, 0.26), (0.06, 0.25, 0.68, 0.25)),
    3: ((-0.05, -0.3, 1.0, 0.2), (0.2, 0.02, 0.72, 0.19), (-0.1, 0.31, 0.52, 0.18)),
    4: ((-0.18, -0.34, 0.84, 0.15), (0.2, -0.16, 0.6, 0.15), (-0.12, 0.08, 1.0, 0.16), (0.16, 0.34, 0.72, 0.15)),
}
"""Where slender vases stand, how high each is and its radius: shares of depth, width, height and width."""


def bud_vases(size: Size, glass: Material, count: Literal[1, 2, 3, 4] = 3) -> Parts:
    """Slender vases of different heights."""
    d, w, h = size
    spots = [(x * d, y * w, share, r) for x, y, share, r in BUD_SPOTS[count]]
    outer = smooth_profile(((0.8, 0), (0.9, 0.03), (1.0, 0.3), (0.5, 0.6), (0.3, 0.8), (0.42, 1.0)))
    return of(glass, *(hollow(outer, r * w, share * h, 0.004, 0.008, 28).moved(x, y) for x, y, share, r in spots))


AMBER = m.glass("amber vase glass", "#a87b4a", 0.5)
RAKU = Material("raku glaze", "speckle", "#6d6a66", 0.45, 0.0, 0.3)


DESIGNS: tuple[Design, ...] = (
    design("vase", "urn-blue", "blue glazed urn", (0.20, 0.20, 0.30), "classic", vase, 36, clay=m.BLUE_GLAZE, kind="urn"),
    design("vase", "bottle-white", "white bottle vase", (0.14, 0.14, 0.34), "modern", vase, 36, clay=m.PORCELAIN, kind="bottle"),
    design("vase", "cylinder-glass", "glass cylinder vase", (0.14, 0.14, 0.28), "minimal", vase, 36, clay=m.GLASS, kind="cylinder"),
    design("vase", "moon-stone", "round stoneware vase", (0.24, 0.24, 0.25), "modern", vase, 36, clay=m.STONEWARE, kind="moon"),
    design("vase", "amphora", "terracotta vase with two handles", (0.24, 0.315, 0.42), "rustic", vase, 2, clay=m.TERRACOTTA, kind="urn", handles=True),
    design("vase", "tulip-green", "green glazed tulip vase", (0.15, 0.15, 0.24), "classic", vase, 36, clay=m.GREEN_GLAZE, kind="tulip"),
    design("vase", "jug", "stoneware jug", (0.22, 0.16, 0.24), "rustic", jug, clay=m.STONEWARE),
    design("vase", "fluted-white", "fluted white vase", (0.18, 0.18, 0.28), "modern", fluted_vase, 36, clay=m.PORCELAIN),
    design("vase", "spiral-sand", "vase with spiral ribs", (0.20, 0.20, 0.34), "minimal", fluted_vase, 36, clay=m.STONEWARE, ribs=14, twist=0.08),
    design("vase", "ring", "ring-shaped vase", (0.09, 0.24, 0.30), "modern", ring_vase, 2, clay=m.CREAM),
    design("vase", "floor", "tall floor vase", (0.28, 0.28, 0.72), "rustic", vase, 36, clay=RAKU, kind="bottle"),
    design("vase", "bud-white", "small white bud vase", (0.09, 0.09, 0.19), "minimal", vase, 36, clay=m.PORCELAIN, kind="bud"),
    design("vase", "bud-green", "green glass bud vase", (0.07, 0.07, 0.22), "modern", vase, 36, clay=m.glass("green vase glass", "#7f9c84", 0.5), kind="bud"),
    design("vase", "gourd-sand", "sand-coloured gourd vase", (0.17, 0.17, 0.30), "rustic", vase, 36, clay=m.STONEWARE, kind="gourd"),
    design("vase", "trumpet-glass", "tall trumpet-shaped glass vase", (0.16, 0.16, 0.40), "classic", vase, 36, clay=m.GLASS, kind="trumpet"),
    design("vase", "bud-blue-pair", "pair of blue bud vases", (0.10, 0.19, 0.20), "classic", bud_vases, glass=m.BLUE_GLAZE, count=2),
    design("vase", "bud-amber", "three amber bud vases", (0.18, 0.26, 0.22), "industrial", bud_vases, glass=AMBER),
)  # fmt: skip
