"""Whole-scene hypotheses: every unlocked object in its best, second best... alternative."""

from __future__ import annotations

from collections.abc import Collection

from diorama_app.editing import names_of
from diorama_app.guest import Guest
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.types import Candidate, Scene, SceneObject

MOST = 5


def arrangement_count(scene: Scene) -> int:
    """How many different arrangements the objects' own alternatives give, at most `MOST`."""
    return min(MOST, max((len({c.shape_id for c in o.candidates}) for o in scene.objects if not o.locked), default=0))


def arranged(scene: Scene, rank: int, only: Collection[str] | None = None) -> Scene:
    """The scene with every unlocked object (or `only` these) in the `rank`-th of its ranked shapes.

    An object with fewer shapes takes its last.
    """
    for item in scene.objects:
        candidate = _taken(item, rank, only)
        if candidate is not None and candidate.shape_id != item.shape_id:
            scene = edits.swap(scene, item.id, candidate, keep_pose=True)
    return scene


def is_arranged(scene: Scene, rank: int, only: Collection[str] | None = None) -> bool:
    """Whether everything that `arranged` would change is so already."""
    taken = [(item, _taken(item, rank, only)) for item in scene.objects]
    return all(candidate is None or candidate.shape_id == item.shape_id for item, candidate in taken)


def _taken(item: SceneObject, rank: int, only: Collection[str] | None) -> Candidate | None:
    ranked = list({c.shape_id: c for c in item.candidates}.values())
    if item.locked or not ranked or (only is not None and item.id not in only):
        return None
    return ranked[min(rank, len(ranked) - 1)]


def switch_arrangement(guest: Guest, rank: int, only: Collection[str] | None = None) -> None:
    """Take another arrangement, as one undo step: of the whole room, or of `only` some objects, so that they are mixed.

    Locked objects are kept.
    """
    room = guest.room
    if arrangement_count(room.scene) < 2:
        raise EditRefused("no object has alternatives to arrange")
    whose = "" if only is None else f" for {names_of(room.scene, only)}"
    room.edit(f"arrangement {rank + 1}{whose}", lambda s: arranged(s, rank, only), by=guest)
