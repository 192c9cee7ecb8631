"""What a prompt's wishes mean in a scene: relations to objects that are there, and the order to place them in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diorama_core.editing.habits import usual_relations_of
from diorama_core.editing.relations import LONG_RATIO, SEATS, Relation
from diorama_core.library.record import Shape
from diorama_core.library.taxonomy import broad, category, having
from diorama_core.scene.types import Scene
from diorama_core.text.prompt import RequestedObject, Wish

_FIRST = ("bed", "sofa", "kitchen counter", "bathtub", "desk", "table", "wardrobe", "tv stand", "piano", "bookshelf")


ROW_GAP_M, ROW_MOST = 0.15, 3
"""Between seats in a row, and how many make one."""


SEAT_WIDTH_M, SEAT_OUT_M = 0.62, 0.1
"""Length of a long side for each who sits there, and how far their seat's middle is from the edge."""


_APART = frozenset({"opposite", "facing", "in corner"})
"""Wishes that take the second of two beds to another wall than the first."""


def row_relations(relations: Sequence[Relation], request: RequestedObject, copy: int, shape: Shape) -> list[Relation]:
    """The relations of one of several seats that are wished before or opposite something: each has its place.

    Args:
        relations: of this copy, with ids.
        request: what is asked for; how many of it are in the row.
        copy: which of them, from 0.
        shape: its width decides how far the places are apart.
    """
    if not 1 < request.count <= ROW_MOST or broad(request.category) not in ("armchair", "chair", "office chair"):
        return list(relations)
    aside = (copy - (request.count - 1) / 2) * (float(shape.size_m[1]) + ROW_GAP_M)
    return [replace(r, aside_m=aside) if r.kind in ("opposite", "in front of") else r for r in relations]


def placement_order(wanted: Sequence[RequestedObject]) -> list[int]:
    """What others refer to comes first; then large before small, the floor before walls and tables."""

    def size(k: int) -> int:
        kind = broad(wanted[k].category)
        return _FIRST.index(kind) if kind in _FIRST else len(_FIRST)

    mounts = {"floor": 0, "ceiling": 2, "wall": 2, "surface": 3}
    depth = {k: _depth(k, wanted, ()) for k in range(len(wanted))}
    rug = {k: 1.5 if o.category in having("rug") else 0.0 for k, o in enumerate(wanted)}
    return sorted(
        range(len(wanted)),
        key=lambda k: (max(mounts[category(wanted[k].category).mount], rug[k]), depth[k], size(k), k),
    )


def seats_at(size_m: Sequence[float], count: int) -> tuple[tuple[float, float], ...]:
    """Places around a table that is longer than wide, from its middle along its own axes: in pairs across it, the
    ends last; none for a table without long sides.

    Args:
        size_m: of the table.
        count: of seats.
    """
    length, width = max(size_m[:2]), min(size_m[:2])
    if length <= LONG_RATIO * width:
        return ()
    across = max(int(length / SEAT_WIDTH_M), 1)
    each = min(across, (count + 1) // 2) if count <= 2 * across else across
    if count >= 6 and count % 2 == 0 and each * 2 == count:
        each -= 1  # people take the ends before they sit close
    along = [(k - (each - 1) / 2) * length / each for k in range(each)]
    flat = [(x, side * (width / 2 + SEAT_OUT_M)) for x in along for side in (1.0, -1.0)]
    flat += [(side * (length / 2 + SEAT_OUT_M), 0.0) for side in (1.0, -1.0)]
    return tuple(p if size_m[0] >= size_m[1] else (p[1], p[0]) for p in flat[:count])


def place_seat(scene: Scene, relations: Sequence[Relation], request: RequestedObject, copy: int) -> list[Relation]:
    """The relations of one of several seats with its place at the long table that they are around.

    Args:
        scene: as it is.
        relations: what is to hold.
        request: what was asked for.
        copy: which of the seats.
    """

    def place(relation: Relation) -> Relation:
        target = next((t for t in relation.targets if scene.has_object(t)), None)
        if relation.kind != "around" or target is None or broad(scene.object(target).category) != "table":
            return relation
        places = seats_at(tuple(scene.object(target).size_m), request.count)
        return replace(relation, seat_m=places[copy]) if copy < len(places) else relation

    return [place(r) for r in relations] if request.count > 1 else list(relations)


def is_sat_around(request: RequestedObject, wanted: Sequence[RequestedObject]) -> bool:
    """Whether seats are wished around a table, which then needs free floor on all sides."""
    around = any(w.kind == "around" and request.category in w.targets for o in wanted for w in o.wishes)
    return around and broad(request.category) in ("table", "coffee table") and not request.wishes


def stands_between(request: RequestedObject, wanted: Sequence[RequestedObject]) -> str:
    """The category of beds that something is wished between; they are placed at its sides, after it. Else empty."""
    for wish in request.wishes:
        for o in wanted if wish.kind == "between" and len(wish.targets) == 1 else ():
            if o.category == wish.targets[0] and broad(o.category) == "bed" and o.count > 1:
                return o.category
    return ""


def _depth(k: int, wanted: Sequence[RequestedObject], seen: tuple[int, ...]) -> int:
    """How many requests in a row have to be placed before one."""
    if k in seen:
        return 0
    rank = stands_between(wanted[k], wanted)
    named = {t for w in wanted[k].wishes for t in w.targets} - {rank}
    named |= {o.category for o in wanted if wanted[k].category == stands_between(o, wanted)}
    for _, targets in usual_relations_of(wanted[k].category):
        named |= {t for t in targets if t != rank and not _asks_for(t, wanted[k].category, wanted, ())}
    named -= {wanted[k].category, broad(wanted[k].category)}
    below = [
        _depth(j, wanted, (*seen, k))
        for j, o in enumerate(wanted)
        if {o.category, broad(o.category)} & named and j != k
    ]
    return 1 + max(below, default=-1)


def _asks_for(name: str, other: str, wanted: Sequence[RequestedObject], seen: tuple[str, ...]) -> bool:
    """Whether requests of one category wish something of another, directly or through others."""
    if name in seen:
        return False
    named = {t for o in wanted if o.category == name for w in o.wishes for t in w.targets}
    return other in named or any(_asks_for(t, other, wanted, (*seen, name)) for t in named)


def targets_of(scene: Scene, wish: Wish, copy: int) -> tuple[str, ...]:
    """Ids of the objects that a wish of one of several copies names; none where they are not there."""
    present = [[o.id for o in scene.objects if o.category == name] for name in wish.targets]
    if wish.kind == "between":
        if len(present) == 1 and len(present[0]) > 1:
            return tuple(present[0][:2])  # "between the beds"
        return tuple(g[0] for g in present if g)
    return tuple(g[copy % len(g)] for g in present if g)[:1]


def _ids_of_kind(scene: Scene, name: str) -> list[str]:
    """Ids of the objects of a category, or of special kinds of it: a sectional sofa is a sofa."""
    return [o.id for o in scene.objects if name in (o.category, broad(o.category))]


def usual_relations(scene: Scene, request: RequestedObject, copy: int) -> list[Relation]:
    """How such an object stands where the prompt does not say."""
    requested = {w.kind for w in request.wishes}
    relations: list[Relation] = []
    for wish in request.wishes:
        if wish.kind == "in front of" and request.category in SEATS and "bed" not in wish.targets:
            relations += [Relation("facing", targets)] if (targets := targets_of(scene, wish, copy)) else []
    if copy and broad(request.category) == "bed" and not requested & _APART:
        relations += [
            Relation("beside", (present[0],)) for present in (_ids_of_kind(scene, request.category),) if present
        ]
    for kind, names in usual_relations_of(request.category):
        if kind in requested or (
            requested and kind in ("in corner", "above", "on") and request.category != "television"
        ):
            continue
        if requested & {"in corner", "against wall"} and kind in ("beside", "near", "under", "in front of"):
            continue
        if not names:
            relations.append(Relation(kind))
            continue
        present = next((ids for n in names if (ids := _ids_of_kind(scene, n))), None)
        if present:
            relations.append(Relation(kind, (present[copy % len(present)],)))
    return relations
