"""Where people put things where nobody says: at walls, under tables, on what, and with what before them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

from diorama_core.editing.relations import Relation, RelationKind
from diorama_core.library.taxonomy import broad, category, having, often_carried, usual_carriers
from diorama_core.scene.types import Scene, SceneObject

OFTEN_AT_WALLS = having("often_at_wall")
"""Categories whose back belongs to a wall."""
MID_WALL = having("mid_wall")
"""What stands in the middle of its wall rather than in a corner."""


def carries(item: SceneObject) -> bool:
    """Whether people put things on it without being told to."""
    return category(item.category).supports_objects and item.category not in having("seldom_loaded")


def host_cost(item: SceneObject, host: SceneObject) -> float:
    """How unlikely it is that people put one on the other."""
    usual = usual_carriers(item.category)
    if host.category in usual:
        return 0.6 - 0.6 * often_carried(item.category, host.category) / often_carried(item.category, usual[0])
    return 0.6 + (0.4 if host.size_m[2] > 1.3 else 0.0)


def usual_relations_of(kind: str) -> tuple[tuple[RelationKind, tuple[str, ...]], ...]:
    """How objects of a category stand where nobody says: relations in the order of their weight, and their targets."""
    row = category(kind)
    on = usual_carriers(kind) if row.mount == "surface" else ()
    stands = ((cast(RelationKind, relation), targets) for relation, targets in row.usual_relations or ())
    return (*((("on", on),) if on else ()), *stands)


def tuck_hosts(item: SceneObject) -> tuple[str, ...]:
    """Categories under which an object is pushed."""
    return category(item.category).tucked_under or ()


def belongs_before(item: SceneObject, host: SceneObject, relations: Sequence[Relation]) -> bool:
    """Whether an object is meant to be on the floor before another: its seat, its table, or as wished."""
    if broad(host.category) in tuck_hosts(item):
        return True
    before = [targets for kind, targets in category(item.category).usual_relations or () if kind == "in front of"]
    if any(broad(host.category) in targets for targets in before) or item.category in having("rug"):
        return True
    return any(
        host.id in r.targets or item.id in r.targets for r in relations if r.kind in ("in front of", "around", "facing")
    )


def stands(scene: Scene, item: SceneObject) -> bool:
    """Whether an object stands on the floor or on a rug."""
    edge = scene.support_of(item.id)
    if edge is None or not scene.has_object(edge.parent):
        return category(item.category).mount == "floor"
    return scene.object(edge.parent).category in having("rug")
