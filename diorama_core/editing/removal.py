"""Objects deleted: what stood on them comes down to what is left below."""

from __future__ import annotations

from collections.abc import Iterable

from diorama_core.editing.placing import seated
from diorama_core.editing.positioning import Positioner
from diorama_core.library.record import ShapeLibrary
from diorama_core.scene import edits
from diorama_core.scene.types import Scene


def without_objects(scene: Scene, library: ShapeLibrary, object_ids: Iterable[str]) -> tuple[Scene, tuple[str, ...]]:
    """The scene without objects, and the ids of what stood on them: lowered, beside what is in the way there.

    Args:
        scene: where.
        library: where shapes come from.
        object_ids: what goes.

    Raises:
        EditRefused: one of them is locked.
    """
    gone = set(object_ids)
    after = edits.remove(scene, gone)
    loads = tuple(s.child for s in scene.supports if s.parent in gone and s.child not in gone)
    positioner = Positioner(library)
    for load in loads:
        after = seated(after, library, load)
        removed = (load, *after.children_of(load))
        spot = positioner.nearby(after, load) if positioner.collisions.of(after, removed) else None
        after = after if spot is None else edits.move(after, load, spot.pose)
    return after, loads
