"""Whole-scene hypotheses: every unlocked object in its best, second best... alternative."""

from __future__ import annotations

from diorama_app.guest import Guest
from diorama_core.errors import EditRefused
from diorama_core.scene import edits
from diorama_core.scene.types import Scene

MOST = 5


def arrangement_count(scene: Scene) -> int:
    """How many different arrangements the objects' own alternatives give, at most `MOST`."""
    return min(MOST, max((len({c.shape_id for c in o.candidates}) for o in scene.objects if not o.locked), default=0))


def arranged(scene: Scene, rank: int) -> Scene:
    """The scene with every unlocked object in the `rank`-th of its ranked shapes (its last where it has fewer)."""
    for item in scene.objects:
        ranked = list({c.shape_id: c for c in item.candidates}.values())
        if item.locked or not ranked:
            continue
        candidate = ranked[min(rank, len(ranked) - 1)]
        if candidate.shape_id != item.shape_id:
            scene = edits.swap(scene, item.id, candidate, keep_pose=True)
    return scene


def switch_arrangement(guest: Guest, rank: int) -> None:
    """Show another arrangement, as one undo step; locked objects are kept, so that arrangements can be mixed."""
    room = guest.room
    if arrangement_count(room.scene) < 2:
        raise EditRefused("no object has alternatives to arrange")
    room.edit(f"arrangement {rank + 1}", lambda s: arranged(s, rank), by=guest)
