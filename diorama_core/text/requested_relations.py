"""What a prompt's wishes mean in a scene: relations to objects that are there, and the order to place them in."""

from __future__ import annotations

from collections.abc import Sequence

from diorama_core.editing.relations import SEATS, Relation
from diorama_core.library.taxonomy import broad, category
from diorama_core.scene.types import Scene
from diorama_core.text.customs import USUAL
from diorama_core.text.prompt import RequestedObject, Wish

_FIRST = ("bed", "sofa", "kitchen counter", "bathtub", "desk", "table", "wardrobe", "tv stand", "piano", "bookshelf")


def placement_order(wanted: Sequence[RequestedObject]) -> list[int]:
    """What others refer to comes first; then large before small, the floor before walls and tables."""

    def size(k: int) -> int:
        kind = broad(wanted[k].category)
        return _FIRST.index(kind) if kind in _FIRST else len(_FIRST)

    mounts = {"floor": 0, "ceiling": 2, "wall": 2, "surface": 3}
    depth = {k: _depth(k, wanted, ()) for k in range(len(wanted))}
    rug = {k: 1.5 if broad(o.category) == "rug" else 0.0 for k, o in enumerate(wanted)}
    return sorted(
        range(len(wanted)),
        key=lambda k: (max(mounts[category(wanted[k].category).mount], rug[k]), depth[k], size(k), k),
    )


def _depth(k: int, wanted: Sequence[RequestedObject], seen: tuple[int, ...]) -> int:
    """How many requests in a row have to be placed before one."""
    if k in seen:
        return 0
    named = {t for w in wanted[k].wishes for t in w.targets}
    for _, targets in USUAL.get(wanted[k].category, USUAL.get(broad(wanted[k].category), ())):
        named |= {t for t in targets if not _asks_for(t, wanted[k].category, wanted, ())}
    named -= {wanted[k].category}
    below = [_depth(j, wanted, (*seen, k)) for j, o in enumerate(wanted) if o.category in named and j != k]
    return 1 + max(below, default=-1)


def _asks_for(name: str, other: str, wanted: Sequence[RequestedObject], seen: tuple[str, ...]) -> bool:
    """Whether requests of one category wish something of another, directly or through others."""
    if name in seen:
        return False
    named = {t for o in wanted if o.category == name for w in o.wishes for t in w.targets}
    return other in named or any(_asks_for(t, other, wanted, (*seen, name)) for t in named)


def targets_of(scene: Scene, wish: Wish, copy: int) -> tuple[str, ...]:
    """Ids of the objects that a wish of one of several copies names; none where they are not there."""
    there = [[o.id for o in scene.objects if o.category == name] for name in wish.targets]
    if wish.kind == "between":
        if len(there) == 1 and len(there[0]) > 1:
            return tuple(there[0][:2])  # "between the beds"
        return tuple(g[0] for g in there if g)
    return tuple(g[copy % len(g)] for g in there if g)[:1]


def usual_relations(scene: Scene, request: RequestedObject, copy: int) -> list[Relation]:
    """How such an object stands where the prompt does not say."""
    said = {w.kind for w in request.wishes}
    found: list[Relation] = []
    for wish in request.wishes:
        if wish.kind == "in front of" and broad(request.category) in SEATS and "bed" not in wish.targets:
            found += [Relation("facing", targets)] if (targets := targets_of(scene, wish, copy)) else []
    for kind, names in USUAL.get(request.category, USUAL.get(broad(request.category), ())):
        if kind in said or (said and kind in ("in corner", "above", "on") and request.category != "television"):
            continue
        if said & {"in corner", "against wall"} and kind in ("beside", "near", "under", "in front of"):
            continue
        if not names:
            found.append(Relation(kind))
            continue
        there = next((ids for n in names if (ids := [o.id for o in scene.objects if o.category == n])), None)
        if there:
            found.append(Relation(kind, (there[copy % len(there)],)))
    return found
