"""Bowls, plates and trays."""

from __future__ import annotations

from typing import Literal

import numpy as np

from diorama_core.library.furniture.kit import *


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


def dinner_plate(size: Size, clay: Material, rim: Material | None = None, coupe: bool = False) -> Parts:
    """A plate with a flat well, or rimless (`coupe`), edged in another glaze if `rim` is given."""
    d, _, h = size
    r = d / 2
    well = 0.9 if coupe else 0.68
    outer = [(0.5 * r, 0), (0.54 * r, 0.0), (0.58 * r, 0.003), (well * r, h * 0.35), (r, h - 0.002), (0.992 * r, h)]
    inner = [(0.97 * r, h), ((well - 0.02) * r, h * 0.5), (0.5 * r, h * 0.3), (0.004, h * 0.28)]
    parts = of(clay, lathe([*outer, *inner], 48, np.deg2rad(50)))
    if rim is not None:
        lip = [(0.965 * r, h - 0.0024), (0.985 * r, h + 0.0008), (1.001 * r, h - 0.002), (0.985 * r, h - 0.005)]
        parts += of(rim, lathe([*lip, lip[0]], 48, np.pi))
    return parts


def plate_stack(size: Size, clay: Material, count: int) -> Parts:
    """Plates piled up."""
    d, w, h = size
    step = (h - 0.024) / max(count - 1, 1)
    return [p.moved(z=k * step) for k in range(count) for p in dinner_plate((d, w, 0.024), clay)]


def round_tray(size: Size, wood: Material, metal: Material | None = None) -> Parts:
    """A round tray with an upright rim, and two grips if `metal` is given."""
    d, w, h = size
    r = min(d, w) / 2 * (0.96 if metal else 1.0)
    low = h * (0.62 if metal else 1.0)
    rim = [
        (0.96 * r, 0),
        (0.985 * r, 0.004),
        (r, low - 0.003),
        (0.99 * r, low),
        (0.965 * r, low),
        (0.95 * r, 0.01),
        (0.004, 0.009),
    ]
    parts = of(wood, lathe(rim, 48, np.deg2rad(50)))
    if metal is not None:
        grip = tube(
            bend(
                [
                    (-0.06, r - 0.006, low * 0.6),
                    (-0.05, r + 0.004, h - 0.004),
                    (0.05, r + 0.004, h - 0.004),
                    (0.06, r - 0.006, low * 0.6),
                ],
                4,
            ),
            0.004,
            8,
        )
        parts += of(metal, *both_sides(grip))
    return parts


def butler_tray(size: Size, wood: Material) -> Parts:
    """A rectangular tray with cut-out handles in its ends."""
    d, w, h = size
    t = 0.012
    rails = [box((t, w, h * 0.62), 0.004).moved(s * (d - t) / 2) for s in (1, -1)]
    ends = []
    for s in (1, -1):
        y = s * (w - t) / 2
        ends += [box((d, t, h * 0.42), 0.004).moved(0, y), box((d * 0.46, t, h * 0.22), 0.005).moved(0, y, h * 0.78)]
        ends += [box((d * 0.12, t, h * 0.9), 0.005).moved(sx * d * 0.2, y, h * 0.08) for sx in (1, -1)]
    return of(wood, box((d - 0.004, w - 0.004, 0.01), 0.002).moved(z=0.003), *rails, *ends)


GOLD_RIM = m.metal("gilt", "#bd9c62", 0.3)
SPECKLED = Material("speckled stoneware", "terry", "#cfc7b8", 0.5, 0.0, 0.2)


DESIGNS: tuple[Design, ...] = (
    design("bowl", "deep-white", "white bowl", (0.24, 0.24, 0.10), "minimal", bowl, 36, clay=m.PORCELAIN, kind="deep"),
    design("bowl", "wood", "turned wooden bowl", (0.30, 0.30, 0.11), "rustic", bowl, 36, clay=m.WALNUT, kind="deep"),
    design("plate", "plate", "stoneware plate", (0.27, 0.27, 0.028), "modern", bowl, 36, id="bowl-plate", clay=m.STONEWARE, kind="plate"),
    design("bowl", "tray", "walnut tray with brass handles", (0.30, 0.45, 0.05), "modern", bowl, 2, clay=m.WALNUT, kind="tray"),
    design("bowl", "footed", "footed dish", (0.26, 0.26, 0.14), "classic", bowl, 36, clay=m.BLUE_GLAZE, kind="footed"),
    design("bowl", "stoneware", "speckled stoneware bowl", (0.16, 0.16, 0.075), "rustic", bowl, 36, clay=SPECKLED, kind="deep"),
    design("bowl", "salad", "wide blue salad bowl", (0.32, 0.32, 0.12), "classic", bowl, 36, clay=m.BLUE_GLAZE, kind="deep"),
    design("bowl", "steel", "steel mixing bowl", (0.26, 0.26, 0.13), "industrial", bowl, 36, clay=m.STAINLESS, kind="deep"),
    design("bowl", "glass", "glass bowl", (0.24, 0.24, 0.11), "minimal", bowl, 36, clay=m.GLASS, kind="deep"),
    design("plate", "white", "white dinner plate", (0.27, 0.27, 0.025), "minimal", dinner_plate, 36, clay=m.PORCELAIN),
    design("plate", "gilt", "plate with a gilt rim", (0.28, 0.28, 0.024), "classic", dinner_plate, 36, clay=m.PORCELAIN, rim=GOLD_RIM),
    design("plate", "coupe-dark", "dark rimless plate", (0.26, 0.26, 0.028), "modern", dinner_plate, 36, clay=m.DARK_STONEWARE, coupe=True),
    design("plate", "stack", "stack of stoneware plates", (0.25, 0.25, 0.09), "rustic", plate_stack, 36, clay=SPECKLED, count=6),
    design("plate", "stack-white", "stack of white plates", (0.22, 0.22, 0.12), "classic", plate_stack, 36, clay=m.PORCELAIN, count=9),
    design("tray", "round-oak", "round oak tray", (0.38, 0.38, 0.04), "minimal", round_tray, 36, wood=m.OAK),
    design("tray", "round-walnut", "round walnut tray with brass grips", (0.36, 0.38, 0.07), "modern", round_tray, 2, wood=m.WALNUT, metal=m.BRASS),
    design("tray", "butler", "butler's tray with cut-out handles", (0.36, 0.54, 0.09), "classic", butler_tray, 2, wood=m.MAHOGANY),
    design("tray", "whitewash", "whitewashed serving tray", (0.32, 0.46, 0.075), "rustic", butler_tray, 2, wood=m.WHITEWASH),
    design("tray", "steel", "round steel tray", (0.34, 0.34, 0.022), "industrial", round_tray, 36, wood=m.STAINLESS),
)  # fmt: skip
