"""Vases, bowls, cups and bottles."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from diorama_core.library.furniture import materials as m
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Builder, Design, Parts, Size, both_sides, of
from diorama_core.library.furniture.solids import (
    Profile,
    Solid,
    bend,
    box,
    cylinder,
    lathe,
    loft,
    ring_path,
    rounded_rectangle,
    smooth_profile,
    tube,
)
from diorama_core.library.record import SymmetryFold

VASES: dict[str, Profile] = {
    "urn": ((0.42, 0), (0.5, 0.02), (0.95, 0.42), (1.0, 0.58), (0.8, 0.8), (0.42, 0.92), (0.5, 1.0)),
    "bottle": ((0.7, 0), (0.78, 0.02), (1.0, 0.25), (0.85, 0.48), (0.32, 0.66), (0.24, 0.85), (0.34, 1.0)),
    "cylinder": ((0.94, 0), (1.0, 0.015), (1.0, 0.985), (0.99, 1.0)),
    "moon": ((0.36, 0), (0.42, 0.02), (0.86, 0.22), (1.0, 0.5), (0.86, 0.78), (0.42, 0.95), (0.4, 1.0)),
    "tulip": ((0.5, 0), (0.54, 0.02), (0.5, 0.1), (0.72, 0.45), (0.8, 0.7), (0.86, 0.88), (1.0, 1.0)),
}


def hollow(profile: Profile, radius: float, height: float, wall: float, bottom: float = 0.012) -> Solid:
    """A turned vessel with an inside, from an outer profile in fractions."""
    outside = [(a * radius, b * height) for a, b in profile]
    inside = [(max(r - wall, 0.004), max(z, bottom)) for r, z in reversed(outside) if z > bottom]
    floor = max(float(np.interp(bottom, [z for _, z in outside], [r for r, _ in outside])) - wall, 0.004)
    return lathe(
        [*outside, *inside, (floor, bottom + wall), (floor * 0.8, bottom), (0.004, bottom)], 36, np.deg2rad(55)
    )


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


def bowl(size: Size, clay: Material, kind: Literal["deep", "plate", "tray", "footed"]) -> Parts:
    """A bowl, plate, rectangular tray or footed dish."""
    d, w, h = size
    r = d / 2
    if kind == "tray":
        o = rounded_rectangle(d, w, 0.04, 6)
        rings = [(0.96, 0), (0.97, 0.004), (1.0, h - 0.003), (0.99, h), (0.97, h), (0.955, 0.01), (0.04, 0.009)]
        grips = both_sides(
            tube(
                bend(
                    [
                        (-0.06, w / 2 - 0.004, h * 0.8),
                        (-0.05, w / 2 + 0.012, h + 0.01),
                        (0.05, w / 2 + 0.012, h + 0.01),
                        (0.06, w / 2 - 0.004, h * 0.8),
                    ],
                    4,
                ),
                0.006,
                8,
            )
        )
        return of(clay, loft(np.array([ring_path(o * s, z) for s, z in rings]), crease_rad=np.deg2rad(50))) + of(
            m.BRASS, *grips
        )
    if kind == "plate":
        return of(
            clay,
            lathe(
                [
                    (0.55 * r, 0),
                    (0.6 * r, 0.003),
                    (0.72 * r, h * 0.35),
                    (r, h - 0.003),
                    (0.995 * r, h),
                    (0.97 * r, h),
                    (0.68 * r, h * 0.45),
                    (0.004, h * 0.4),
                ],
                48,
                np.deg2rad(50),
            ),
        )
    if kind == "footed":
        return of(
            clay,
            lathe(
                [
                    (0.45 * r, 0),
                    (0.47 * r, 0.01),
                    (0.14 * r, 0.12 * h),
                    (0.12 * r, 0.4 * h),
                    (0.5 * r, 0.55 * h),
                    (0.92 * r, 0.85 * h),
                    (r, h),
                    (0.97 * r, h),
                    (0.88 * r, 0.86 * h),
                    (0.45 * r, 0.62 * h),
                    (0.004, 0.56 * h),
                ],
                44,
                np.deg2rad(50),
            ),
        )
    return of(
        clay,
        lathe(
            [
                (0.4 * r, 0),
                (0.43 * r, 0.004),
                (0.46 * r, 0.06 * h),
                (0.8 * r, 0.35 * h),
                (0.96 * r, 0.75 * h),
                (r, h),
                (0.965 * r, h),
                (0.92 * r, 0.74 * h),
                (0.75 * r, 0.38 * h),
                (0.4 * r, 0.14 * h),
                (0.004, 0.1 * h),
            ],
            44,
            np.deg2rad(50),
        ),
    )


def cup(size: Size, clay: Material, kind: Literal["mug", "tea", "tumbler", "wine"]) -> Parts:
    """A mug, a teacup with saucer, a glass or a wine glass."""
    _, w, h = size
    if kind == "wine":
        r = w / 2
        return of(
            clay,
            lathe(
                [
                    (0.82 * r, 0),
                    (0.84 * r, 0.003),
                    (0.2 * r, 0.012),
                    (0.1 * r, 0.05 * h),
                    (0.1 * r, 0.42 * h),
                    (0.4 * r, 0.47 * h),
                    (0.95 * r, 0.66 * h),
                    (r, 0.75 * h),
                    (0.8 * r, h),
                    (0.77 * r, h),
                    (0.94 * r, 0.75 * h),
                    (0.85 * r, 0.64 * h),
                    (0.004, 0.5 * h),
                ],
                36,
                np.deg2rad(50),
            ),
        )
    if kind == "tumbler":
        return of(clay, hollow(((0.82, 0), (0.85, 0.02), (1.0, 0.98), (0.99, 1.0)), w / 2, h, 0.0035, 0.008))
    r = 0.39 * w if kind == "mug" else 0.31 * w
    lift = 0.0 if kind == "mug" else 0.012
    profile: Profile = (
        ((0.88, 0), (0.94, 0.02), (1.0, 0.08), (1.0, 0.98), (0.98, 1.0))
        if kind == "mug"
        else ((0.45, 0), (0.5, 0.03), (0.82, 0.4), (0.98, 0.9), (1.0, 1.0))
    )
    body = hollow(profile, r, h - lift, 0.004, 0.006).moved(0, 0.09 * w if kind == "mug" else 0, lift)
    y0 = (0.09 * w if kind == "mug" else 0.0) - r * 0.95
    ear = tube(
        bend(
            [
                (0, y0, lift + 0.82 * h),
                (0, y0 - 0.26 * w * 0.9, lift + 0.72 * h),
                (0, y0 - 0.22 * w, lift + 0.34 * h),
                (0, y0 + (0.0 if kind == "mug" else 0.004), lift + 0.2 * h),
            ],
            5,
        ),
        0.0055,
        8,
    )
    parts = of(clay, body, ear)
    if kind == "tea":
        s = w / 2
        parts += of(
            clay,
            lathe(
                [(0.5 * s, 0), (0.55 * s, 0.002), (s, 0.012), (0.98 * s, 0.015), (0.5 * s, 0.007), (0.004, 0.006)],
                40,
                np.deg2rad(50),
            ),
        )
    return parts


def bottle(size: Size, glass: Material, kind: Literal["wine", "water", "spray"], cap: Material) -> Parts:
    """A wine or water bottle, or a pump dispenser."""
    d, _, h = size
    r = d / 2
    if kind == "wine":
        body = lathe(
            [
                (0.9 * r, 0),
                (r, 0.01),
                (r, 0.58 * h),
                (0.86 * r, 0.66 * h),
                (0.4 * r, 0.76 * h),
                (0.34 * r, 0.9 * h),
                (0.38 * r, 0.92 * h),
                (0.36 * r, 0.95 * h),
            ],
            28,
            np.deg2rad(50),
        )
        return (
            of(glass, body)
            + of(cap, cylinder(0.36 * r, 0.12 * h, 0.002, 20).moved(z=0.88 * h))
            + of(m.PAPER, cylinder(r * 1.006, 0.24 * h, 0.001, 28).moved(z=0.2 * h))
        )
    if kind == "water":
        return of(
            glass,
            lathe(
                [(0.92 * r, 0), (r, 0.01), (r, 0.68 * h), (0.7 * r, 0.8 * h), (0.42 * r, 0.86 * h)], 28, np.deg2rad(50)
            ),
        ) + of(cap, cylinder(0.48 * r, 0.15 * h, 0.003, 24).moved(z=0.85 * h))
    pump = [
        cylinder(0.34 * r, 0.06 * h, 0.002, 18).moved(z=0.72 * h),
        cylinder(0.14 * r, 0.18 * h, 0.001, 12).moved(z=0.76 * h),
        box((1.1 * r, 0.4 * r, 0.06 * h), 0.004, 2).moved(0.28 * r, 0, 0.94 * h),
    ]
    return of(
        glass,
        lathe([(0.94 * r, 0), (r, 0.008), (r, 0.64 * h), (0.85 * r, 0.7 * h), (0.4 * r, 0.73 * h)], 28, np.deg2rad(50)),
    ) + of(cap, *pump)


GREEN_BOTTLE = m.paint("green bottle glass", "#3c4b3a", 0.12)


def _d(
    category: str, name: str, caption: str, size: Size, style: str, build: Builder, symmetry: SymmetryFold = 1
) -> Design:
    return Design(f"{category.replace(' ', '-')}-{name}", category, caption, size, style, build, symmetry)


DESIGNS: tuple[Design, ...] = (
    _d(
        "vase",
        "urn-blue",
        "blue glazed urn",
        (0.20, 0.20, 0.30),
        "classic",
        partial(vase, clay=m.BLUE_GLAZE, kind="urn"),
        36,
    ),
    _d(
        "vase",
        "bottle-white",
        "white bottle vase",
        (0.14, 0.14, 0.34),
        "modern",
        partial(vase, clay=m.PORCELAIN, kind="bottle"),
        36,
    ),
    _d(
        "vase",
        "cylinder-glass",
        "glass cylinder vase",
        (0.14, 0.14, 0.28),
        "minimal",
        partial(vase, clay=m.GLASS, kind="cylinder"),
        36,
    ),
    _d(
        "vase",
        "moon-stone",
        "round stoneware vase",
        (0.24, 0.24, 0.25),
        "modern",
        partial(vase, clay=m.STONEWARE, kind="moon"),
        36,
    ),
    _d(
        "vase",
        "amphora",
        "terracotta vase with two handles",
        (0.24, 0.315, 0.42),
        "rustic",
        partial(vase, clay=m.TERRACOTTA, kind="urn", handles=True),
        2,
    ),
    _d(
        "vase",
        "tulip-green",
        "green glazed tulip vase",
        (0.15, 0.15, 0.24),
        "classic",
        partial(vase, clay=m.GREEN_GLAZE, kind="tulip"),
        36,
    ),
    _d("vase", "jug", "stoneware jug", (0.22, 0.16, 0.24), "rustic", partial(jug, clay=m.STONEWARE)),
    _d(
        "bowl",
        "deep-white",
        "white bowl",
        (0.24, 0.24, 0.10),
        "minimal",
        partial(bowl, clay=m.PORCELAIN, kind="deep"),
        36,
    ),
    _d(
        "bowl",
        "wood",
        "turned wooden bowl",
        (0.30, 0.30, 0.11),
        "rustic",
        partial(bowl, clay=m.WALNUT, kind="deep"),
        36,
    ),
    _d(
        "bowl",
        "plate",
        "stoneware plate",
        (0.27, 0.27, 0.028),
        "modern",
        partial(bowl, clay=m.STONEWARE, kind="plate"),
        36,
    ),
    _d(
        "bowl",
        "tray",
        "walnut tray with brass handles",
        (0.30, 0.45, 0.05),
        "modern",
        partial(bowl, clay=m.WALNUT, kind="tray"),
        2,
    ),
    _d(
        "bowl",
        "footed",
        "footed dish",
        (0.26, 0.26, 0.14),
        "classic",
        partial(bowl, clay=m.BLUE_GLAZE, kind="footed"),
        36,
    ),
    _d("cup", "mug-white", "white mug", (0.085, 0.12, 0.095), "minimal", partial(cup, clay=m.PORCELAIN, kind="mug")),
    _d(
        "cup",
        "mug-stone",
        "stoneware mug",
        (0.09, 0.125, 0.10),
        "rustic",
        partial(cup, clay=m.DARK_STONEWARE, kind="mug"),
    ),
    _d(
        "cup", "tea", "teacup on a saucer", (0.145, 0.145, 0.075), "classic", partial(cup, clay=m.PORCELAIN, kind="tea")
    ),
    _d("cup", "tumbler", "glass tumbler", (0.08, 0.08, 0.11), "modern", partial(cup, clay=m.GLASS, kind="tumbler"), 36),
    _d("cup", "wine", "wine glass", (0.085, 0.085, 0.20), "classic", partial(cup, clay=m.GLASS, kind="wine"), 36),
    _d(
        "bottle",
        "wine",
        "bottle of wine",
        (0.078, 0.078, 0.30),
        "classic",
        partial(bottle, glass=GREEN_BOTTLE, kind="wine", cap=m.MAHOGANY),
        36,
    ),
    _d(
        "bottle",
        "water",
        "steel water bottle",
        (0.07, 0.07, 0.25),
        "modern",
        partial(bottle, glass=m.SAGE, kind="water", cap=m.STEEL),
        36,
    ),
    _d(
        "bottle",
        "dispenser",
        "soap dispenser",
        (0.075, 0.075, 0.19),
        "minimal",
        partial(bottle, glass=m.STONEWARE, kind="spray", cap=m.BRASS),
    ),
)
