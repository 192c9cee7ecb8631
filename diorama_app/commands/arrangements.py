"""Whole-scene hypotheses: the k-th uses the k-th ranked candidate of every unlocked object or set of objects."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property

from diorama_app.commands.edit import names_of
from diorama_app.session.client import Client
from diorama_app.strings import _
from diorama_core.errors import EditRefused
from diorama_core.pipeline.arrangements import plausible_shapes
from diorama_core.scene import edits
from diorama_core.scene.types import Candidate, Scene, SceneObject

MAX = 5


@dataclass(frozen=True, eq=False)
class Arrangements:
    """The arrangements of one scene, numbered from 0, the best."""

    scene: Scene

    @property
    def count(self) -> int:
        """How many differ, at most `MOST`."""
        return min(MAX, max((len(offers) for offers in self._offers.values()), default=0))

    def take(self, rank: int, only: Collection[str] | None = None) -> Scene:
        """The scene with every unlocked object (or `only` these) in the `rank`-th of its shapes; sets change as one.

        An object with fewer shapes takes its last.
        """
        scene = self.scene
        for object_id, candidate in self._candidates_at(rank, only).items():
            if candidate.shape_id != scene.object(object_id).shape_id:
                scene = edits.swap(scene, object_id, candidate, keep_pose=True)
        return scene

    def is_taken(self, rank: int, only: Collection[str] | None = None) -> bool:
        """Whether everything that `take` would change is so already."""
        return all(c.shape_id == self.scene.object(i).shape_id for i, c in self._candidates_at(rank, only).items())

    def _candidates_at(self, rank: int, only: Collection[str] | None) -> dict[str, Candidate]:
        chosen = self._offers if only is None else {i: self._offers[i] for i in only if i in self._offers}
        return {object_id: of[min(rank, len(of) - 1)] for object_id, of in chosen.items()}

    @cached_property
    def _offers(self) -> dict[str, tuple[Candidate, ...]]:
        """For every unlocked object its shapes, best first: those that its set finds likely, where it is of one.

        Objects of one kind are a set when the same shape was found best for them.
        """
        sets: dict[tuple[str, str], list[SceneObject]] = {}
        for item in self.scene.objects:
            if item.candidates:
                sets.setdefault((item.category, item.candidates[0].shape_id), []).append(item)
        offers = {}
        for (_category, best), members in sets.items():
            known = {c.shape_id: c for m in reversed(members) for c in reversed(m.candidates)}
            shapes = plausible_shapes(members, chosen_id=best)
            for item in members:
                candidates = {c.shape_id: c for c in reversed(item.candidates)}
                if not item.locked:
                    offers[item.id] = tuple(candidates.get(s, known[s]) for s in shapes)
        return offers


def switch_arrangement(client: Client, rank: int, only: Collection[str] | None = None) -> None:
    """Take another arrangement, as one undo step: of the whole room, or of `only` some objects, so that they are mixed.

    Locked objects are kept.
    """
    session = client.session
    if Arrangements(session.scene).count < 2:
        raise EditRefused("no object has alternatives to arrange")
    label = _("arrangement {number}") if only is None else _("arrangement {number} for {names}")
    label = label.format(number=rank + 1, names=names_of(session.scene, only or ()))
    session.edit(label, lambda s: Arrangements(s).take(rank, only), by=client)
