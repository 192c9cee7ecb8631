"""Doors and windows, and what belongs to them: free floor, curtains, radiators."""

from __future__ import annotations

import numpy as np

from diorama_core.editing.room_frame import WallLine
from diorama_core.geometry.openings import STANDS_OUT_M
from diorama_core.synthesis.bodies import Item
from diorama_core.synthesis.furnisher import Furnisher
from diorama_core.synthesis.plan import footprint

DOOR_SWING_M = 0.95
WINDOW_REACH_M = 0.45


def add_door(f: Furnisher, wall: WallLine | None = None) -> str | None:
    """A door in a wall near one of its ends, with floor to walk through it."""
    item = f.pick("door")
    if item is None:
        return None
    item = _sink(item)
    for candidate in [wall] if wall else _shuffle(f):
        if candidate.length_m < item.size_m[1] + 0.3:
            continue
        reach = candidate.length_m - item.size_m[1] / 2 - 0.12
        ends = [item.size_m[1] / 2 + f.rng.uniform(0.12, 0.5), candidate.length_m - item.size_m[1] / 2 - 0.15]
        t = float(np.clip(ends[int(f.chance(0.5))], item.size_m[1] / 2 + 0.05, reach))
        placed = f.hang(item, candidate, t, item.size_m[2] / 2)
        if placed:
            size = np.array([DOOR_SWING_M, item.size_m[1], 0.0])
            f.keep_free(footprint(size, candidate.point(t, DOOR_SWING_M / 2), candidate.yaw_rad))
            return placed
    return None


def add_window(f: Furnisher, wall: WallLine, t_m: float | None = None, *, dressed: float = 0.6) -> str | None:
    """A window in a wall, perhaps with curtains and a radiator below; tall furniture keeps clear of it.

    Args:
        f: the furnisher of the room.
        wall: where it is.
        t_m: of its middle from the wall's left end; None for anywhere.
        dressed: how likely it has curtains.
    """
    item = f.pick("window", where=lambda s: s.size_m[1] < wall.length_m - 0.5)
    if item is None:
        return None
    item = _sink(item)
    t = float(f.rng.uniform(0.35, 0.65) * wall.length_m) if t_m is None else t_m
    top = min(2.2, f.plan.height_m - 0.2)
    placed = f.hang(item, wall, t, top - item.size_m[2] / 2)
    if placed is None:
        return None
    sill = top - item.size_m[2]
    size = np.array([WINDOW_REACH_M, item.size_m[1], 0.0])
    f.keep_free(footprint(size, wall.point(t, WINDOW_REACH_M / 2), wall.yaw_rad), above_m=sill - 0.02)
    if f.chance(dressed):
        _dress(f, wall, t, item)
    if sill > 0.75 and f.chance(0.5):
        radiator = f.pick("radiator", where=lambda s: s.size_m[2] < sill - 0.15 and s.size_m[2] < 0.8)
        if radiator:
            f.hang(radiator, wall, t, 0.12 + radiator.size_m[2] / 2)
    return placed


def _dress(f: Furnisher, wall: WallLine, t: float, window: Item) -> None:
    """One curtain on each side of a window, hung from near the ceiling."""
    curtain = f.pick("curtain", where=lambda s: 1.9 < s.size_m[2] < f.plan.height_m - 0.1 and s.size_m[1] < 1.3)
    if curtain is None:
        return
    narrowed = Item(curtain.shape, (curtain.scale[0] * 0.8, 0.5 / curtain.shape.size_m[1], curtain.scale[2]))
    offset = window.size_m[1] / 2 + narrowed.size_m[1] / 2 + 0.07
    centre = min(f.plan.height_m - 0.06, 2.45) - narrowed.size_m[2] / 2
    for side in (-1.0, 1.0):
        f.hang(narrowed, wall, t + side * offset, max(centre, narrowed.size_m[2] / 2 + 0.01))


def _sink(item: Item) -> Item:
    depth = item.shape.size_m[0]
    return Item(item.shape, (min(1.0, STANDS_OUT_M / depth), item.scale[1], item.scale[2]))


def _shuffle(f: Furnisher) -> list[WallLine]:
    return [f.plan.walls[int(k)] for k in f.rng.permutation(len(f.plan.walls))]
