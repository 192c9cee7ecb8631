"""Rooms to learn from: furnished like homes, with every category about equally often and in many colours."""

from __future__ import annotations

import colorsys
from collections import Counter
from dataclasses import replace

import numpy as np

from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import category
from diorama_core.scene.types import Scene
from diorama_core.synthesis import ROOM_KINDS, furnish_room
from diorama_core.synthesis.bodies import Item
from diorama_core.synthesis.furnisher import Furnisher

EXTRAS = (10, 24)
"""Lowest and highest number of objects that are added without regard to the kind of the room."""
RECOLOURED = 0.6
"""Share of the objects that get a colour of chance: shapes and pictures must be told apart by form."""


def random_room(seed: int, library: ShapeLibrary) -> Scene:
    """A furnished room with objects of any category beside those that belong there; the same seed, the same room."""
    rng = np.random.default_rng((seed, 15))
    kind = ROOM_KINDS[int(rng.integers(len(ROOM_KINDS)))]
    scene = furnish_room(
        seed, kind, library, clutter=int(rng.integers(4, 20)), split="train", extra=lambda f: _extras(f, rng)
    )
    coloured = (replace(o, colour=any_colour(rng) if rng.random() <= RECOLOURED else None) for o in scene.objects)
    return replace(scene, objects=tuple(coloured))


def _extras(f: Furnisher, rng: np.random.Generator) -> None:
    names = sorted({s.category for s in f.library.shapes()} - set(OPENING_CATEGORIES))
    seen = Counter(o.category for o in f.objects)
    weights = np.array([1.0 / (1.0 + 2.0 * seen[n]) for n in names])
    for name in rng.choice(names, size=int(rng.integers(*EXTRAS)), p=weights / weights.sum()):
        item = f.pick(str(name))
        if item is not None:
            _place(f, item, rng)


def _place(f: Furnisher, item: Item, rng: np.random.Generator) -> str | None:
    mount = category(item.category).mount
    if mount == "ceiling":
        low, high = f.plan.outline.min(axis=0) + 0.5, f.plan.outline.max(axis=0) - 0.5
        return f.hang_from_ceiling(item, rng.uniform(low, high)) if (high > low).all() else None
    if mount == "wall":
        wall = f.plan.walls[int(rng.integers(len(f.plan.walls)))]
        return f.hang(item, wall, float(rng.uniform(0.0, wall.length_m)), float(rng.uniform(0.8, 2.0)))
    if mount == "surface":
        return _place_on_something(f, item, rng)
    if f.chance(0.5):
        return f.against_wall(item, free_front_m=0.0)
    return f.anywhere(item)


def _place_on_something(f: Furnisher, item: Item, rng: np.random.Generator) -> str | None:
    carriers = [o for o in f.objects if f.surfaces(o.id) and o.category not in ("rug", item.category)]
    for k in rng.permutation(len(carriers))[:8]:
        parent = carriers[int(k)]
        faces = f.surfaces(parent.id)
        index = int(rng.integers(len(faces)))
        scale = parent.pose.scale[:2]
        low, high = faces[index].polygon[:, :2].min(axis=0) * scale, faces[index].polygon[:, :2].max(axis=0) * scale
        at = rng.uniform(low, high)
        placed = f.rest(item, parent.id, index, at, float(rng.normal(0.0, 0.4)))
        if placed:
            return placed
    return None


def any_colour(rng: np.random.Generator) -> tuple[float, float, float]:
    """A colour of furniture: mostly little saturated, from near black to white."""
    hue, saturation, value = rng.random(), rng.beta(1.2, 3.0), rng.beta(1.6, 1.2)
    red, green, blue = colorsys.hsv_to_rgb(float(hue), float(saturation), float(0.04 + 0.96 * value))
    return (red, green, blue)
