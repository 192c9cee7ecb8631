"""Whole-scene hypotheses: every unlocked object, or set of them, in its best, second best... alternative."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from diorama_app.editing import names_of
from diorama_app.guest import Guest
from diorama_core.errors import EditRefused
from diorama_core.pipeline.arrangements import plausible_shapes
from diorama_core.scene import edits
from diorama_core.scene.types import Candidate, Scene, SceneObject

MOST = 5


def arrangement_count(scene: Scene) -> int:
    """How many different arrangements the objects' own alternatives give, at most `MOST`."""
    return min(MOST, max((len(offers) for offers in _offers(scene).values()), default=0))


def arranged(scene: Scene, rank: int, only: Collection[str] | None = None) -> Scene:
    """The scene with every unlocked object (or `only` these) in the `rank`-th of its shapes; sets change as one.

    An object with fewer shapes takes its last.
    """
    for object_id, candidate in _taken(scene, rank, only).items():
        if candidate.shape_id != scene.object(object_id).shape_id:
            scene = edits.swap(scene, object_id, candidate, keep_pose=True)
    return scene


def is_arranged(scene: Scene, rank: int, only: Collection[str] | None = None) -> bool:
    """Whether everything that `arranged` would change is so already."""
    return all(c.shape_id == scene.object(name).shape_id for name, c in _taken(scene, rank, only).items())


def _taken(scene: Scene, rank: int, only: Collection[str] | None) -> dict[str, Candidate]:
    offers = _offers(scene)
    return {name: of[min(rank, len(of) - 1)] for name, of in offers.items() if only is None or name in only}


def _offers(scene: Scene) -> dict[str, tuple[Candidate, ...]]:
    """For every unlocked object its shapes, best first: those that its set finds likely, where it is of one.

    Things of one kind are a set when the same shape was found best for them.
    """
    sets: dict[tuple[str, str], list[SceneObject]] = {}
    for item in scene.objects:
        if item.candidates:
            best = item.candidates[0].shape_id
            sets.setdefault((item.category, best), []).append(replace(item, shape_id=best))
    offers = {}
    for members in sets.values():
        known = {c.shape_id: c for m in reversed(members) for c in reversed(m.candidates)}
        shapes = plausible_shapes(members)
        for item in members:
            own = {c.shape_id: c for c in reversed(item.candidates)}
            if not item.locked:
                offers[item.id] = tuple(own.get(s, known[s]) for s in shapes)
    return offers


def switch_arrangement(guest: Guest, rank: int, only: Collection[str] | None = None) -> None:
    """Take another arrangement, as one undo step: of the whole room, or of `only` some objects, so that they are mixed.

    Locked objects are kept.
    """
    room = guest.room
    if arrangement_count(room.scene) < 2:
        raise EditRefused("no object has alternatives to arrange")
    whose = "" if only is None else f" for {names_of(room.scene, only)}"
    room.edit(f"arrangement {rank + 1}{whose}", lambda s: arranged(s, rank, only), by=guest)
