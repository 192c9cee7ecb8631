"""Boxes with fronts: what drawers, doors, handles and open shelves have in common."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diorama_core.library.furniture.joints import door_hinge, drawer_slide
from diorama_core.library.furniture.materials import Material
from diorama_core.library.furniture.model import Parts, Size, jointed, of, with_role
from diorama_core.library.furniture.solids import Solid, ball, bend, box, cylinder, rod, tube


def pull(kind: str, width: float) -> list[Solid]:
    """A handle on the plane x = 0, reaching toward +X: "knob", "bar", "cup", "strap", "tall" or "none"."""
    if kind == "knob":
        return [cylinder(0.006, 0.014, 0.001, 10).turned("y", 90), ball(0.026, 5).moved(0.02, 0, -0.013)]
    if kind in ("bar", "tall"):
        half = min(0.07, width * 0.3) if kind == "bar" else 0.1
        ends = [rod((0, s * half * 0.8, 0), (0.024, s * half * 0.8, 0), 0.0045, segments=8) for s in (1, -1)]
        solids = [rod((0.024, -half, 0), (0.024, half, 0), 0.0055, segments=10), *ends]
        return [s.turned("x", 90) for s in solids] if kind == "tall" else solids
    if kind == "cup":
        path = bend(
            [(0, 0.04, 0), (0.018, 0.032, -0.004), (0.022, 0, -0.006), (0.018, -0.032, -0.004), (0, -0.04, 0)], 4
        )
        return [tube(path, 0.008, 8), box((0.02, 0.07, 0.006), 0.003).moved(0.008, 0, 0.002)]
    if kind == "strap":
        return [box((0.012, 0.03, 0.05), 0.004).moved(0.002, 0, -0.025)]
    return []


def drawer_front(
    x: float,
    y: float,
    z: float,
    width: float,
    height: float,
    wood: Material,
    metal: Material,
    kind: str = "bar",
    inside: DrawerSpace | None = None,
) -> Parts:
    """A drawer's front, its back on the plane `x`, bottom at `z`, with its pull (two when it is wide).

    With `inside`, the free space behind it, the drawer has a box and can be pulled out.
    """
    t = 0.018
    parts = of(wood, box((t, width, height), 0.003).moved(x + t / 2, y, z))
    spots = (-0.25, 0.25) if width > 0.62 and kind in ("knob", "cup") else (0.0,)
    parts += of(metal, *(s.moved(x + t, y + f * width, z + height * 0.5) for f in spots for s in pull(kind, width)))
    if inside is None:
        return parts
    slide = drawer_slide(x, y, z, DRAWER_TRAVEL * inside.depth)
    return jointed(slide, parts + with_role("inside", of(wood, *drawer_box(x, inside))))


@dataclass(frozen=True)
class DrawerSpace:
    """Free space behind a drawer's front."""

    depth: float
    low_y: float
    high_y: float
    low_z: float
    high_z: float


DRAWER_TRAVEL = 0.75
"""Share of the depth behind it by which a drawer comes out."""


def drawer_box(x: float, space: DrawerSpace) -> list[Solid]:
    """A box open to the top behind a front whose back is the plane `x`, with air around it."""
    air, t = 0.006, 0.01
    depth, width = space.depth - 2 * air, space.high_y - space.low_y - 2 * air
    height = 0.7 * (space.high_z - space.low_z) - air
    y, z, middle = (space.low_y + space.high_y) / 2, space.low_z + air, x - depth / 2
    floor = box((depth, width, t), 0.001).moved(middle, y, z)
    sides = [box((depth, t, height), 0.001).moved(middle, y + s * (width - t) / 2, z) for s in (1, -1)]
    ends = [box((t, width, height), 0.001).moved(xx, y, z) for xx in (x - t / 2, x - depth + t / 2)]
    return [floor, *sides, *ends]


def door_front(
    x: float,
    y: float,
    z: float,
    width: float,
    height: float,
    wood: Material,
    metal: Material,
    kind: str = "knob",
    hinge: int = 1,
    panel: str = "flat",
    infill: Material | None = None,
) -> Parts:
    """A cabinet door, its back on the plane `x`; `hinge` +1 is at its left (y high).

    `panel` is "flat", "shaker" or "slats".
    """
    t = 0.018
    if panel == "flat":
        parts = of(wood, box((t, width, height), 0.003).moved(x + t / 2, y, z))
    else:
        s = min(0.065, 0.2 * width)
        rails = [box((t, width, s), 0.003).moved(x + t / 2, y, zz) for zz in (z, z + height - s)]
        stiles = [box((t, s, height), 0.003).moved(x + t / 2, y + f * (width - s) / 2, z) for f in (1, -1)]
        parts = of(wood, *rails, *stiles)
        if panel == "slats":
            n = max(int((height - 2 * s) / 0.045), 2)
            zs = np.linspace(z + s, z + height - s, n, endpoint=False)
            parts += of(
                infill or wood,
                *(
                    box((0.007, width - 2 * s + 0.004, 0.05), 0.002).turned("y", 24).moved(x + t * 0.45, y, zz)
                    for zz in zs
                ),
            )
        else:
            parts += of(
                infill or wood,
                box((t * 0.5, width - 2 * s + 0.01, height - 2 * s + 0.01), 0.002).moved(x + t * 0.3, y, z + s - 0.005),
            )
    grip_z = z + height * (0.5 if height > 0.9 else 0.72 if z < 1.0 else 0.28)
    grip_y = y - hinge * (width / 2 - min(0.04, width * 0.12))
    parts += of(metal, *(s.moved(x + t, grip_y, grip_z) for s in pull(kind, width)))
    return jointed(door_hinge(x + t, y + hinge * width / 2, hinge), parts)


def open_case(
    size: Size,
    wood: Material,
    shelves: Sequence[float],
    t: float = 0.02,
    back: Material | None = None,
    base: float = 0.0,
) -> Parts:
    """A case open to the front, shelves' upper faces at the given heights; stands on z = `base`."""
    d, w, h = size
    z0, z1 = base, h
    sides = [box((d, t, z1 - z0), 0.002).moved(0, s * (w - t) / 2, z0) for s in (1, -1)]
    ends = [box((d, w - 2 * t + 0.002, t), 0.002).moved(0, 0, z) for z in (z0, z1 - t)]
    boards = [box((d - 0.012, w - 2 * t + 0.002, t), 0.002).moved(-0.004, 0, z - t) for z in shelves]
    panel = box((0.008, w - 2 * t + 0.004, z1 - z0 - 0.01), 0.001).moved(-d / 2 + 0.006, 0, z0 + 0.005)
    return of(wood, *sides, *ends, *boards) + of(back or wood, panel)


def plinth(d: float, w: float, height: float, material: Material) -> Parts:
    """A recessed base."""
    return of(material, box((d - 0.05, w - 0.03, height + 0.004), 0.002).moved(-0.01))
