"""The empty room that a prompt's furniture goes into, and what such rooms have besides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diorama_core.library.company import carrier_in
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import broad, category
from diorama_core.scene.types import Scene
from diorama_core.synthesis import groups
from diorama_core.synthesis.finishes import choose_finishes
from diorama_core.synthesis.furnisher import Furnisher
from diorama_core.synthesis.grammar import RECIPES
from diorama_core.synthesis.openings import add_door, add_window
from diorama_core.synthesis.plan import room_plan
from diorama_core.text.customs import ESSENTIALS, stands_in_for
from diorama_core.text.placed_rows import rows_of
from diorama_core.text.prompt import RequestedObject, RoomRequest

FREE_SHARE = 0.28
"""At most this share of a room's floor is under furniture."""
MIN_AREA_M2, MIN_SHARE, MIN_SIDE_M = 8.5, 0.6, 2.3
"""Rooms are no smaller, nor smaller than this share of those of their kind: a few pieces are lost in large ones."""
AROUND_ROWS_M = 0.7
"""Free floor around objects in rows."""


def with_essentials(request: RoomRequest) -> tuple[list[RequestedObject], tuple[str, ...]]:
    """What a prompt asks for and what such rooms have besides; the categories of the latter."""
    asked, added = list(request.objects), list[str]()
    present = frozenset(o.category for o in asked)
    if request.named:
        for name, count in ESSENTIALS.get(request.room, ()):
            if name not in request.excluded and not stands_in_for(name, present):
                asked.append(RequestedObject(name, name, count))
                added.append(name)
    carriers = {o.category for o in asked if category(o.category).supports_objects and broad(o.category) != "rug"}
    for one in list(asked):
        host = carrier_in(one.category, request.room) if category(one.category).mount == "surface" else None
        if host is None or carriers or any(w.kind == "on" for w in one.wishes):
            continue
        asked.append(RequestedObject(host, host, min(one.count, 2)))
        added.append(host)
        carriers.add(host)
    return asked, tuple(added)


def empty_room(
    request: RoomRequest,
    library: ShapeLibrary,
    rng: np.random.Generator,
    wanted: Sequence[RequestedObject],
    shapes: Mapping[int, Sequence[Shape]],
    attempt: int,
) -> Scene:
    """A room of the kind and size that a request needs, with a door and windows; later attempts are larger.

    Args:
        request: what was asked for.
        library: where shapes come from.
        rng: chance, seeded.
        wanted: objects to be put there.
        shapes: that each may have, by its number.
        attempt: 0 for the first.
    """
    recipe = RECIPES[request.room]
    factor = request.size * (1.0 + 0.08 * attempt)
    taken = sum(
        o.count * float(np.prod(np.asarray(shapes[k][0].size_m[:2]) + 0.15))
        for k, o in enumerate(wanted)
        if shapes[k] and category(o.category).mount == "floor" and broad(o.category) != "rug"
    )
    low = np.array([recipe.width_m[0], recipe.depth_m[0]])
    area = max(taken / FREE_SHARE, MIN_AREA_M2, MIN_SHARE * float(np.prod(low)))
    low = np.maximum(low * float(np.sqrt(area / float(np.prod(low)))), MIN_SIDE_M) * factor
    for k, o in enumerate(wanted):
        if o.rows and shapes[k]:
            low = np.maximum(low, np.sort(rows_of(o, shapes[k][0]).block_m[:2]) + 2 * AROUND_ROWS_M)
    wide, deep = ((float(a), 1.08 * float(a)) for a in low)
    f = Furnisher(room_plan(rng, wide, deep, "box"), library, rng)
    add_door(f)
    if request.room != "corridor" and "window" not in request.excluded:
        windows = max(1, sum(o.count for o in wanted if o.category == "window"))
        walls = groups.long_walls(f)
        for k in range(min(windows, 4)):
            add_window(f, walls[(k + attempt) % len(walls)])
    finishes = choose_finishes(rng, request.room)
    return Scene(architecture=f.plan.architecture(finishes), objects=tuple(f.objects), supports=tuple(f.supports))
