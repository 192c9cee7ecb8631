"""Typed edits done with the editor's own edits; what moves is held up, free of others and inside the room."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from diorama_core.editing.placing import seat
from diorama_core.editing.positioning import Positioner
from diorama_core.editing.relations import OF_ROOM, Relation
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.errors import EditRefused
from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import broad
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene
from diorama_core.text.edit_insert import insert
from diorama_core.text.edit_looks import restyle, swap
from diorama_core.text.edit_places import move, resize, shift, turn
from diorama_core.text.edit_plan import (
    Align,
    Copy,
    Done,
    DrawRoom,
    Edit,
    Exchange,
    Insert,
    InsertOpening,
    Light,
    Measure,
    Move,
    MoveWall,
    Paint,
    Place,
    Remove,
    Rename,
    Resize,
    Restyle,
    RoomLength,
    SetPlace,
    SetState,
    SetSupport,
    Shift,
    Side,
    Swap,
    Turn,
    names_of,
)
from diorama_core.text.edit_room import cover, direction_of, lengthen, light, open_wall, wall_on
from diorama_core.text.edit_states import (
    copy,
    exchange,
    line_up,
    outline,
    place_at,
    put_in_state,
    rename,
    set_side,
    support,
    wall_moved,
)


@dataclass(eq=False)
class EditApplier:
    """Applies edits one after the other; a refused one leaves everything as it was."""

    positioner: Positioner
    names: dict[str, str] = field(default_factory=dict)
    """Ids of objects that edits of the same list have named."""

    def apply(self, scene: Scene, edit: Edit) -> Done:
        """The scene with one edit done.

        Raises:
            EditRefused: it cannot be done: one line that says why.
        """
        if isinstance(edit, MoveWall):
            return wall_moved(scene, edit)
        if isinstance(edit, DrawRoom):
            return outline(scene, edit)
        if isinstance(edit, (Paint, RoomLength, Light, InsertOpening)):
            return self._room(scene, edit)
        if isinstance(edit, Insert):
            done = insert(self.positioner, scene, edit, self._relations(scene, edit.places))
            if edit.name:
                self.names[edit.name] = done.touched[0]
            return done
        ids = self._ids(scene, edit.objects)
        if isinstance(edit, Remove):
            return _remove(self.positioner.library, scene, ids)
        if isinstance(edit, Move):
            return move(self.positioner, scene, ids, self._relations(scene, edit.places, ids))
        if isinstance(edit, Shift):
            toward = self._ids(scene, [edit.toward])[0] if edit.toward else ""
            return shift(self.positioner, scene, ids, edit, toward)
        if isinstance(edit, Turn):
            toward = self._ids(scene, [edit.toward])[0] if edit.toward else ""
            return turn(self.positioner, scene, ids, edit, toward)
        if isinstance(edit, Restyle):
            return restyle(self.positioner.library, scene, ids, edit.look)
        if isinstance(edit, Swap):
            return swap(self.positioner, scene, ids, edit.what)
        if isinstance(edit, Resize):
            return resize(self.positioner, scene, ids, edit.factor)
        return self._object(scene, ids, edit)

    def _room(self, scene: Scene, edit: Paint | RoomLength | Light | InsertOpening) -> Done:
        if isinstance(edit, (Paint, InsertOpening)) and edit.behind:
            edit = edit.model_copy(update={"behind": self._ids(scene, [edit.behind])[0]})
        if isinstance(edit, Paint):
            return cover(scene, edit)
        if isinstance(edit, RoomLength):
            return lengthen(scene, edit)
        return light(scene, edit) if isinstance(edit, Light) else open_wall(self.positioner.library, scene, edit)

    def _object(
        self,
        scene: Scene,
        ids: Sequence[str],
        edit: Measure | Copy | Exchange | SetState | Rename | Align | SetPlace | SetSupport,
    ) -> Done:
        if isinstance(edit, SetPlace):
            return place_at(self.positioner, scene, ids[0], edit)
        if isinstance(edit, SetSupport):
            parent = self.names.get(edit.parent, edit.parent)
            return support(self.positioner, scene, ids, parent, edit.against)
        if isinstance(edit, Measure):
            return set_side(self.positioner, scene, ids, edit)
        if isinstance(edit, Copy):
            return copy(self.positioner, scene, ids, edit.count, self._relations(scene, edit.places))
        if isinstance(edit, Exchange):
            if len(ids) < 2:
                raise EditRefused("two different objects can change places")
            return exchange(self.positioner, scene, edit.model_copy(update={"objects": list(ids)}))
        if isinstance(edit, SetState):
            return put_in_state(self.positioner.library, scene, ids, edit)
        if isinstance(edit, Rename):
            return rename(scene, ids[0], edit)
        return line_up(self.positioner, scene, ids, edit)

    def _ids(self, scene: Scene, given: Sequence[str]) -> list[str]:
        """Known ids, with the names of new objects resolved, each once."""
        ids = list(dict.fromkeys(self.names.get(i, i) for i in given))
        unknown = next((i for i in ids if not scene.has_object(i)), None)
        if unknown is not None:
            raise EditRefused(f"there is no object “{unknown}” in this scene")
        if not ids:
            raise EditRefused("no object was named")
        return ids

    def _relations(self, scene: Scene, places: Sequence[Place], moved_ids: Sequence[str] = ()) -> list[Relation]:
        relations = []
        for place in places:
            targets = tuple(self._ids(scene, place.targets)) if place.targets else ()
            if not targets and place.relation not in OF_ROOM and not moved_ids:
                raise EditRefused(f"“{place.relation}” what? Name the object")
            if set(targets) & set(moved_ids):
                raise EditRefused(f"{scene.object(targets[0]).label} cannot be {place.relation} itself")
            toward = _side_direction(scene, place.side, moved_ids)
            if place.relation == "against wall" and place.side not in ("", "other"):
                wall_on(scene, place.side)
            relations.append(Relation(place.relation, targets, toward=toward, side=place.side))
        return relations


def _side_direction(scene: Scene, side: Side, moved_ids: Sequence[str]) -> tuple[float, float] | None:
    """The direction of a side of the room; "other" is away from where the first object is."""
    if not side or (side == "other" and not moved_ids):
        return None
    if side == "other":
        way = RoomFrame.of(scene).middle - scene.object(moved_ids[0]).pose.position[:2]
    else:
        way = direction_of(scene, side)
    return float(way[0]), float(way[1])


def _remove(library: ShapeLibrary, scene: Scene, ids: Sequence[str]) -> Done:
    """Without objects and what is on them; what stood on a rug stands on the floor."""
    riding = [d for i in ids for d in descendants(scene, i) if broad(scene.object(i).category) != "rug"]
    gone = list(dict.fromkeys((*ids, *riding)))
    extra = [i for i in gone if i not in ids]
    what = f" with what is on {'it' if len(ids) == 1 else 'them'}: {names_of(scene, extra)}" if extra else ""
    after = edits.remove(scene, gone)
    for rug in (i for i in ids if broad(scene.object(i).category) == "rug"):
        for child in scene.children_of(rug):
            after = seat(after, library, child)
    return Done(after, (f"remove {names_of(scene, ids)}{what}",))
