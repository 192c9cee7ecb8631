"""A furnished room that holds what a prompt asks for: relations as costs, exact collisions, every wish met or named.

Objects are placed one after the other, each at the best of thousands of candidates; then objects whose wishes are not
met are placed anew among the others. A few rooms of different sizes and openings are tried, and the best is kept.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diorama_core.editing.positioning import Positioner, new_object
from diorama_core.editing.relations import OF_ROOM, Relation, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.geometry.openings import OPENING_CATEGORIES
from diorama_core.library.record import Shape, ShapeLibrary
from diorama_core.library.taxonomy import broad
from diorama_core.progress import SILENT, Progress
from diorama_core.scene import edits
from diorama_core.scene.support import check_scene, descendants
from diorama_core.scene.types import Pose, Scene, SceneObject
from diorama_core.synthesis import furnish_room
from diorama_core.text.edit_places import lift_onto
from diorama_core.text.placed_rows import PlacedRows, place_rows
from diorama_core.text.prompt import RequestedObject, RoomRequest, Wish, read_prompt
from diorama_core.text.requested_relations import (
    is_sat_around,
    place_seat,
    placement_order,
    row_relations,
    stands_between,
    targets_of,
    usual_relations,
)
from diorama_core.text.requested_room import DECOR, dress, empty_room, shapes_for, with_essentials

TRIES = 4
"""Rooms begun anew, each a little larger, until every wish is met."""
REPAIRS = 2
SHAPES_TRIED = 4
MAX_DECOR_COST = 3.0
"""What hangs is left out where it would hang worse."""


@dataclass(frozen=True)
class Composed:
    """A room made of words, without a camera yet."""

    scene: Scene
    notes: tuple[str, ...]
    """What could not be met, in words for the user."""
    request: RoomRequest
    ids: tuple[tuple[str, ...], ...] = ()
    """Ids of the objects that each request became."""
    added: tuple[str, ...] = ()
    """Categories that the room has because rooms of its kind do."""


def compose_room(
    prompt: str,
    library: ShapeLibrary,
    seed: int = 0,
    *,
    request: RoomRequest | None = None,
    progress: Progress = SILENT,
) -> Composed:
    """The room that a prompt describes. Same prompt, seed and library give the same room.

    A prompt that names only a kind of room gets one furnished as such rooms are.

    Args:
        prompt: in plain English.
        library: where shapes come from.
        seed: another number, another room.
        request: what the prompt asks for, where somebody else understood it; by default the grammar does.
        progress: reports and cancellation.
    """
    request = request or read_prompt(prompt)
    digest = int.from_bytes(hashlib.sha256(f"{seed} {prompt}".encode()).digest()[:4], "big")
    ignored = tuple(f"the library has nothing called “{words}”, so it was left out" for words in request.ignored)
    if not request.objects:
        scene = furnish_room(digest, request.room, library, outline="box", clutter=6)
        unwished = [o.id for o in scene.objects if {o.category, broad(o.category)} & set(request.excluded)]
        scene = edits.remove(scene, [*unwished, *(c for i in unwished for c in descendants(scene, i))])
        return Composed(scene, ignored, request)
    made: list[tuple[float, Composed]] = []
    while len(made) < TRIES and all(room.notes for _, room in made):
        progress.report(len(made) / TRIES, "Composing a room from the library")
        rng = np.random.default_rng((digest, len(made)))
        made.append(_Composer(request, library, rng, len(made)).compose())
    best = min(made, key=lambda attempt: attempt[0])[1]
    return replace(best, notes=(*ignored, *best.notes))


class _Composer:
    """One attempt at one room."""

    def __init__(self, request: RoomRequest, library: ShapeLibrary, rng: np.random.Generator, attempt: int) -> None:
        self.request, self.library, self.rng, self.attempt = request, library, rng, attempt
        self.positioner = Positioner(library)
        self.ids: dict[int, list[str]] = {}
        self.relations: dict[str, list[Relation]] = {}
        self.wishes: dict[str, list[tuple[Wish, Relation]]] = {}
        self.missing: dict[int, int] = {}
        self.in_rows: dict[int, PlacedRows] = {}
        self.not_in_rows: list[int] = []

    def compose(self) -> tuple[float, Composed]:
        """The room, and how much it lacks."""
        wanted, added = with_essentials(self.request)
        shapes = {k: shapes_for(self.library, self.rng, o, wanted) for k, o in enumerate(wanted)}
        self.scene = empty_room(self.request, self.library, self.rng, wanted, shapes, self.attempt)
        if any("window" in w.targets for o in wanted for w in o.wishes):
            heaters = [o.id for o in self.scene.objects if broad(o.category) == "radiator"]
            self.scene = edits.remove(self.scene, heaters)  # they hang where that is to stand
        for k in placement_order(wanted):
            self._place(k, wanted[k], shapes[k], wanted)
        self._resolve_late(wanted)
        for _ in range(REPAIRS):
            if not self._repair():
                break
        self._decorate(wanted)
        check_scene(self.scene)
        notes, lacking = self._notes(wanted)
        ids = tuple(tuple(self.ids.get(k, ())) for k in range(len(self.request.objects)))
        return lacking, Composed(self.scene, notes, self.request, ids, added)

    def _place(
        self, k: int, request: RequestedObject, shapes: Sequence[Shape], wanted: Sequence[RequestedObject]
    ) -> None:
        if request.category in OPENING_CATEGORIES:
            present = [o.id for o in self.scene.objects if o.category == request.category][: request.count]
            self.ids[k] = present
            self.missing[k] = request.count - len(present)
            return
        if request.rows:
            rows = place_rows(self.scene, request, shapes[:SHAPES_TRIED], self.positioner, self.relations)
            if rows is not None:
                self._take_rows(k, request, rows)
                return
            self.not_in_rows.append(k)
        placed: list[str] = []
        self.ids[k] = placed
        chosen: Shape | None = None
        for copy in range(request.count):
            object_id = edits.fresh_id(self.scene, request.category)
            relations = self._resolve(k, request, copy, object_id)
            usual = usual_relations(self.scene, request, copy)
            usual += self._face_to_face(request, copy, placed, object_id)
            usual = place_seat(self.scene, usual, request, copy) + self._side_relations(request, wanted)
            usual += [Relation("in middle")] if is_sat_around(request, wanted) else []
            central = stands_between(request, wanted) or is_sat_around(request, wanted)
            middle = np.array([*RoomFrame.of(self.scene).middle, 0.0]) if central else None
            for shape in (chosen,) if chosen is not None else shapes[:SHAPES_TRIED]:
                item = new_object(self.scene, shape, request.category)
                seated = place_seat(self.scene, [r for _, r in relations], request, copy)
                wishes = row_relations(seated, request, copy, shape)
                spot = self.positioner.best(self.scene, item, wishes, usual=usual, others=self.relations, near=middle)
                if spot is None:
                    continue
                self.scene = self.positioner.put(self.scene, item, spot)
                self.scene = dress(self.scene, object_id, shape, request.appearance)
                self.scene = lift_onto(self.scene, object_id)
                placed.append(object_id)
                self.wishes[object_id] = relations
                self.relations[object_id] = [r for _, r in relations]
                chosen = shape
                break
            else:
                self.missing[k] = self.missing.get(k, 0) + 1

    def _take_rows(self, k: int, request: RequestedObject, rows: PlacedRows) -> None:
        self.scene, self.in_rows[k], self.ids[k] = rows.scene, rows, list(rows.ids)
        for object_id in rows.ids:
            item = self.scene.object(object_id)
            self.scene = dress(self.scene, object_id, self.library.shape(item.shape_id), request.appearance)

    def _resolve(self, k: int, request: RequestedObject, copy: int, object_id: str) -> list[tuple[Wish, Relation]]:
        """The wishes of one copy with ids in the place of categories."""
        resolved: list[tuple[Wish, Relation]] = []
        for wish in request.wishes:
            if wish.kind in OF_ROOM:
                resolved.append((wish, Relation(wish.kind)))
            elif wish.each_other:
                if copy:
                    resolved.append((wish, Relation(wish.kind, (self.ids[k][copy - 1],))))
            elif targets := targets_of(self.scene, wish, copy):
                resolved.append((wish, Relation(wish.kind, targets)))
            elif wish.targets:
                resolved.append((wish, Relation(wish.kind, ("?",))))
        return resolved

    def _resolve_late(self, wanted: Sequence[RequestedObject]) -> None:
        """Wishes for what was placed only later."""
        for k, request in enumerate(wanted):
            for copy, object_id in enumerate(self.ids.get(k, ())):
                if any(relation.targets == ("?",) for _, relation in self.wishes.get(object_id, ())):
                    self.wishes[object_id] = self._resolve(k, request, copy, object_id)
                    self.relations[object_id] = [r for _, r in self.wishes[object_id]]

    def _face_to_face(
        self, request: RequestedObject, copy: int, placed: Sequence[str], object_id: str
    ) -> list[Relation]:
        """Relations of things that face each other: the first stands free, and wishes of the second what it wishes."""
        for wish in request.wishes:
            if wish.each_other and wish.kind in ("facing", "opposite") and copy == 0 and request.count > 1:
                at_walls = any(w.kind == "against wall" for w in request.wishes)
                return [] if at_walls else [Relation("in middle")]
            if wish.each_other and wish.kind in ("facing", "opposite") and copy == 1 and placed:
                relation = Relation(wish.kind, (object_id,))
                self.wishes[placed[0]].append((wish, relation))
                self.relations[placed[0]].append(relation)
        return []

    def _side_relations(self, request: RequestedObject, wanted: Sequence[RequestedObject]) -> list[Relation]:
        """Relations of beds, which stand on either side of what is wished between them and was placed before."""
        return [
            Relation("beside", (self.ids[k][0],))
            for k, other in enumerate(wanted)
            if self.ids.get(k) and stands_between(other, wanted) == request.category
        ]

    def _unmet(self) -> list[tuple[str, Wish, Relation]]:
        frame = RoomFrame.of(self.scene)
        of_rows = [(rows.ids[0], wish, r) for rows in self.in_rows.values() for wish, r in rows.unmet(self.scene)]
        return of_rows + [
            (i, wish, relation)
            for i, pairs in self.wishes.items()
            for wish, relation in pairs
            if not is_met(self.scene, i, relation, frame)
        ]

    def _repair(self) -> bool:
        """Place objects with unmet wishes anew, and what they refer to; whether more wishes are met."""
        unmet = self._unmet()
        if not unmet:
            return False
        better = False
        involved = dict.fromkeys(i for o, _, r in unmet for i in (o, *r.targets) if self.scene.has_object(i))
        fixed = {i for rows in self.in_rows.values() for i in rows.ids}
        for object_id in (i for i in involved if i not in fixed):
            item = self.scene.object(object_id)
            if item.category in OPENING_CATEGORIES or broad(item.category) == "rug":
                continue
            before = self.scene
            number = len(self._unmet())
            spot = self.positioner.best(self.scene, item, self.relations.get(object_id, ()), others=self.relations)
            if spot is None:
                continue
            self.scene = self.positioner.put(self.scene, item, spot)
            if len(self._unmet()) >= number:
                self.scene = before
            else:
                better = True
        return better

    def _decorate(self, wanted: Sequence[RequestedObject]) -> None:
        """What hangs in such rooms, where nothing of its kind was asked for."""
        asked = {broad(o.category) for o in wanted} | {o.category for o in wanted}
        for name in DECOR[self.request.room]:
            if name in asked or name in self.request.excluded or not self.library.in_category(name):
                continue
            shapes = shapes_for(self.library, self.rng, RequestedObject(name, name), wanted)
            if name in ("picture", "mirror"):
                shapes = tuple(s for s in shapes if s.size_m[0] < 0.08 and s.size_m[2] < 1.0)
            for shape in shapes[:SHAPES_TRIED]:
                object_id = edits.fresh_id(self.scene, name)
                item = SceneObject(object_id, f"{name} 1", name, shape.id, shape.size_m, Pose.upright(np.zeros(3)))
                usual = usual_relations(self.scene, RequestedObject(name, name), 0)
                spot = self.positioner.best(self.scene, item, usual=usual)
                if spot is not None and spot.cost < MAX_DECOR_COST:
                    self.scene = self.positioner.put(self.scene, item, spot)
                    break

    def _notes(self, wanted: Sequence[RequestedObject]) -> tuple[tuple[str, ...], float]:
        notes, lacking = [], 0.0
        for k, count in self.missing.items():
            if count > 0:
                name = wanted[k].label or wanted[k].category
                notes.append(f"no place was found for {count} of {wanted[k].count} x {name}")
                lacking += 10.0 * count
        for k in self.not_in_rows:
            notes.append(f"{wanted[k].label} are not in {wanted[k].rows} x rows: they did not fit")
            lacking += 6.0
        for object_id, wish, _ in self._unmet():
            notes.append(f"{self.scene.object(object_id).label} is not {wish.words}: it did not fit there")
            lacking += 3.0
        return tuple(notes), lacking
