"""What stands on what, from where the boxes are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.library.taxonomy import Category
from diorama_core.perception.measured.boxes import TurnedExtent
from diorama_core.perception.measured.cloud import SETTINGS, MeasuredSettings
from diorama_core.scene.types import Support, yaw_rotation


def supporters(
    extents: dict[str, TurnedExtent], categories: dict[str, Category], settings: MeasuredSettings = SETTINGS
) -> tuple[Support, ...]:
    """One edge per object: to the floor, to an object below, to the wall or the ceiling; never a cycle."""
    return tuple(_edge(key, extents, categories, settings) for key in extents)


def _edge(
    key: str, extents: dict[str, TurnedExtent], categories: dict[str, Category], settings: MeasuredSettings
) -> Support:
    extent, category = extents[key], categories[key]
    bottom = float(extent.low[2])
    if category.mount == "ceiling":
        return Support(key, "ceiling", "mounted on")
    if category.mount == "wall" and bottom > settings.rug_m:
        return Support(key, "wall", "mounted on")
    below = _below(key, extents, categories, settings)
    if below is not None and (category.mount == "surface" or bottom > settings.on_floor_m):
        return Support(key, below)
    if category.mount == "wall":
        return Support(key, "wall", "mounted on")
    return Support(key, "floor")


def _below(
    key: str, extents: dict[str, TurnedExtent], categories: dict[str, Category], settings: MeasuredSettings
) -> str | None:
    """The object whose top, or seat, is nearest under this one's bottom and under its middle."""
    extent = extents[key]
    bottom = float(extent.low[2])
    best: tuple[float, str] | None = None
    for other, candidate in extents.items():
        if other == key or not categories[other].supports_objects or not _over(extent, candidate):
            continue
        if candidate.low[2] >= bottom or _volume(candidate) <= _volume(extent):
            continue
        gap = min(abs(bottom - height) for height in resting_heights(candidate, categories[other]))
        if gap < settings.contact_m + 0.25 * float(extent.size[2]) and (best is None or gap < best[0]):
            best = (gap, other)
    return best[1] if best else None


def _volume(extent: TurnedExtent) -> float:
    return float(np.prod(extent.size))


def _over(child: TurnedExtent, parent: TurnedExtent) -> bool:
    """Whether the child's middle is above the parent's footprint, within a small margin."""
    middle = child.centre_world @ yaw_rotation(parent.yaw_rad)
    return bool(((middle[:2] > parent.low[:2] - 0.08) & (middle[:2] < parent.high[:2] + 0.08)).all())


def resting_heights(extent: TurnedExtent, category: Category) -> list[float]:
    """Heights of an object's support surfaces: its top, and its seat."""
    heights = [float(extent.high[2])]
    if category.seat_height_m is not None and category.seat_height_m < extent.high[2]:
        heights.append(category.seat_height_m)
    return heights


def grounded(
    extents: dict[str, TurnedExtent],
    categories: dict[str, Category],
    edges: tuple[Support, ...],
    settings: MeasuredSettings = SETTINGS,
) -> dict[str, TurnedExtent]:
    """The boxes reaching down to what holds them: the floor, or the supporter's top or seat.

    What people put on furniture and is seen well above the floor stays as it is: nobody marked what is below it.

    Args:
        extents: measured boxes by object id, in the world (m).
        categories: by object id.
        edges: what stands on what.
        settings: how far above the floor a thing may be and still stand on it.
    """
    out = dict(extents)
    for edge in edges:
        extent = extents[edge.child]
        if edge.parent == "floor" and categories[edge.child].mount == "surface" and extent.low[2] > settings.on_floor_m:
            continue
        if edge.parent == "floor":
            out[edge.child] = _with_bottom(extent, 0.0)
        elif edge.parent in extents:
            heights = resting_heights(extents[edge.parent], categories[edge.parent])
            out[edge.child] = _with_bottom(extent, min(heights, key=lambda h: abs(h - float(extent.low[2]))))
    return out


def _with_bottom(extent: TurnedExtent, bottom_m: float) -> TurnedExtent:
    low, high = extent.low.copy(), extent.high.copy()
    low[2] = bottom_m
    high[2] = max(high[2], bottom_m + 0.02)
    return replace(extent, low=low, high=high)
