"""Where people put things where nobody says: at walls, under tables, on what, and with what before them."""

from __future__ import annotations

from collections.abc import Sequence

from diorama_core.editing.relations import Relation
from diorama_core.library.taxonomy import broad, category, having
from diorama_core.scene.types import Scene, SceneObject

AT_WALLS = having("walled")
"""Categories whose back belongs to a wall."""
MID_WALL = having("mid_wall")
"""What stands in the middle of its wall rather than in a corner."""


def carries(item: SceneObject) -> bool:
    """Whether people put things on it without being told to."""
    return category(item.category).supports_objects and item.category not in having("seldom_loaded")


def host_cost(item: SceneObject, host: SceneObject) -> float:
    """How unlikely it is that people put one on the other."""
    usual = category(item.category).usual_hosts or ()
    if broad(host.category) in usual:
        return 0.1 * usual.index(broad(host.category))
    return 0.6 + (0.4 if host.size_m[2] > 1.3 else 0.0)


def pushed_under(item: SceneObject) -> tuple[str, ...]:
    """Categories under which an object is pushed."""
    return category(item.category).tucked_under or ()


def belongs_before(item: SceneObject, host: SceneObject, relations: Sequence[Relation]) -> bool:
    """Whether an object is meant to be on the floor before another: its seat, its table, or as wished."""
    if broad(host.category) in pushed_under(item):
        return True
    pairs = (("coffee table", "sofa"), ("coffee table", "armchair"), ("ottoman", "armchair"), ("ottoman", "sofa"))
    if (broad(item.category), broad(host.category)) in pairs or item.category in having("rug"):
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
