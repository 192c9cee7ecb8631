"""The empty room that a prompt's furniture goes into, and what such rooms have besides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diorama_core.editing.habits import usual_relations_of
from diorama_core.editing.relations import SEATS, is_long
from diorama_core.library.language import size_request
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import broad, carrier_in, category, having, with_kin
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from diorama_core.synthesis import RoomKind, groups
from diorama_core.synthesis.finishes import choose_finishes
from diorama_core.synthesis.furnisher import Furnisher
from diorama_core.synthesis.grammar import RECIPES
from diorama_core.synthesis.openings import add_door, add_window
from diorama_core.synthesis.plan import room_plan
from diorama_core.text.looks import fitting_shapes, has_look, look_of
from diorama_core.text.phrases import MAX_OF_A_KIND
from diorama_core.text.placed_rows import rows_of
from diorama_core.text.prompt import RequestedObject, RoomRequest
from diorama_core.text.requested_relations import SEAT_WIDTH_M, seats_at

ESSENTIALS: dict[RoomKind, tuple[tuple[str, int], ...]] = {
    "kitchen": (("kitchen counter", 1), ("stove", 1), ("refrigerator", 1)),
    "bathroom": (("sink", 1), ("toilet", 1), ("bathtub", 1)),
    "bedroom": (("bed", 1),),
    "dining": (("table", 1), ("chair", 4)),
    "study": (("desk", 1), ("office chair", 1)),
    "office": (("desk", 1), ("office chair", 1)),
}
"""Added where a prompt names the kind of room and nothing that does the same."""
DECOR: dict[RoomKind, tuple[str, ...]] = {
    "living": ("ceiling lamp", "picture"), "bedroom": ("ceiling lamp", "picture"), "office": ("ceiling lamp",),
    "kitchen": ("ceiling lamp", "wall cabinet"), "dining": ("ceiling lamp", "picture"),
    "study": ("ceiling lamp", "picture"), "lab": ("ceiling lamp",), "bathroom": ("ceiling lamp", "mirror"),
    "corridor": ("ceiling lamp", "picture"),
}  # fmt: skip
"""What is added at last, where nothing of its kind was asked for; it hangs, so it takes no room."""
FREE_SHARE = 0.28
"""At most this share of a room's floor is under furniture."""
MIN_AREA_M2, MIN_SHARE, MIN_SIDE_M = 8.5, 0.6, 2.3
"""Rooms are no smaller, nor smaller than this share of those of their kind: a few pieces are lost in large ones."""
AROUND_ROWS_M = 0.7
"""Free floor around objects in rows."""


def stands_in_for(name: str, present: frozenset[str]) -> bool:
    """Whether something asked for does what an essential of a room does."""
    return bool(with_kin(name, *category(name).instead or ()) & present)


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


TALL_PLANT_M = 0.6
SOFA_WIDTHS_M = {"two-seater": (1.2, 1.9), "three-seater": (1.75, 2.4), "four-seater": (2.2, 4.0)}


def shapes_for(
    library: ShapeLibrary, rng: np.random.Generator, request: RequestedObject, wanted: Sequence[RequestedObject]
) -> tuple[Shape, ...]:
    """Shapes that fit the words equally well, in an order left to chance; the others after them.

    Args:
        library: where shapes come from.
        rng: chance, seeded.
        request: what was asked for.
        wanted: all that was asked for.
    """
    on = any(w.kind == "on" for w in request.wishes)
    words = {*request.appearance, *request.label.split()}
    double, single = (
        request.category == "bed" and bool(words & set(looks)) for looks in (("double",), ("single", "twin"))
    )
    width_m = next((SOFA_WIDTHS_M[word] for word in SOFA_WIDTHS_M if word in words), None)

    def usable(shape: Shape) -> bool:
        if request.category == "plant" and request.label in ("plant", "plants", "potted plant") and not on:
            return TALL_PLANT_M < shape.size_m[2] < 1.9
        if double or single:
            return (shape.size_m[1] > 1.3) == double
        if width_m is not None and broad(request.category) == "sofa":
            return width_m[0] <= shape.size_m[1] < width_m[1]
        if request.category == "television":
            return shape.size_m[0] > 0.12
        if request.category == "kitchen counter":
            return "island" not in shape.caption
        if request.category == "sink":
            return shape.size_m[2] > 0.7
        return shape.size_m[2] < 2.35

    shapes, _ = fitting_shapes(library, request.category, request.label, request.appearance, usable)
    shapes = shapes or fitting_shapes(library, request.category, request.label, request.appearance)[0]
    under = {t for w in request.wishes if w.kind == "under" for t in w.targets}
    if request.category in having("rug"):
        shapes = tuple(s for s in shapes if float(np.prod(s.size_m[:2])) > (2.4 if under else 1.6)) or shapes
    if not shapes:
        return ()
    seats = sum(o.count for o in wanted if o.category in SEATS and _stand_around(o, request.category))
    if broad(request.category) == "table" and seats > 2:
        roomy = tuple(s for s in shapes if _seats(s) >= seats)
        shapes = roomy or tuple(sorted(shapes, key=lambda s: -float(sum(s.size_m[:2])))[:3])
    asked = [w for w in request.appearance if look_of(w) is not None]
    looks = [w for w in request.appearance if size_request(w) is None]
    most = [sum(has_look(s, w) for w in looks) for s in shapes]
    named = [s for s, n in zip(shapes, most, strict=True) if n == max(most)]
    sized = any(size_request(w) is not None for w in request.appearance)
    if (request.label != request.category and not asked) or sized:
        named = named[:4]  # "reading lamp": the search knows best which is one
    order = rng.permutation(len(named))
    return tuple(named[int(k)] for k in order)


def dress(scene: Scene, object_id: str, shape: Shape, appearance: Sequence[str]) -> Scene:
    """Colours that no shape has are painted on.

    Args:
        scene: as it is.
        object_id: of the object.
        shape: that it has.
        appearance: words of colour and material.
    """
    for word in appearance:
        look = look_of(word)
        if look is not None and not has_look(shape, word) and word not in ("light", "dark"):
            scene = edits.refinish(edits.recolour(scene, object_id, look.colour), object_id, look.finish)
    return scene


def _seats(table: Shape) -> int:
    """How many sit at a table: side by side at a long one, all around another."""
    if is_long(np.asarray(table.size_m)):
        return len(seats_at(tuple(table.size_m), MAX_OF_A_KIND))
    return int(2.0 * float(sum(table.size_m[:2])) / SEAT_WIDTH_M)


def _stand_around(seats: RequestedObject, name: str) -> bool:
    """Whether seats are wished, or usually stand, around something."""
    if seats.wishes:
        return any(w.kind == "around" and name in w.targets for w in seats.wishes)
    return any(kind == "around" and name in names for kind, names in usual_relations_of(seats.category))
