"""Typed edits done with the editor's own edits; what moves is held up, free of others and inside the room."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from diorama_core.editing.placing import seat
from diorama_core.editing.positioning import Positioner
from diorama_core.errors import EditRefused
from diorama_core.library.taxonomy import broad
from diorama_core.scene import edits
from diorama_core.scene.support import descendants
from diorama_core.scene.types import Scene
from diorama_core.text import edit_plan as plan
from diorama_core.text.edit_insert import insert
from diorama_core.text.edit_looks import restyle, swap
from diorama_core.text.edit_places import move, resize, shift, turn
from diorama_core.text.edit_plan import Done, Edit, Insert, Remove, names_of
from diorama_core.text.edit_room import cover, lengthen, light, open_wall
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


def remove(positioner: Positioner, scene: Scene, edit: Remove) -> Done:
    """Without objects and what is on them; what stood on a rug stands on the floor."""
    ids = edit.objects
    riding = [d for i in ids for d in descendants(scene, i) if broad(scene.object(i).category) != "rug"]
    gone = list(dict.fromkeys((*ids, *riding)))
    extra = [i for i in gone if i not in ids]
    what = f" with what is on {'it' if len(ids) == 1 else 'them'}: {names_of(scene, extra)}" if extra else ""
    after = edits.remove(scene, gone)
    for rug in (i for i in ids if broad(scene.object(i).category) == "rug"):
        for child in scene.children_of(rug):
            after = seat(after, positioner.library, child)
    return Done(after, (f"remove {names_of(scene, ids)}{what}",))


_DO: Mapping[type[Any], Callable[[Positioner, Scene, Any], Done]] = {
    Remove: remove, plan.Move: move, plan.Shift: shift, plan.Turn: turn, Insert: insert, plan.Restyle: restyle,
    plan.Swap: swap, plan.Resize: resize, plan.Measure: set_side, plan.Copy: copy, plan.Exchange: exchange,
    plan.SetState: put_in_state, plan.Align: line_up, plan.InsertOpening: open_wall, plan.SetPlace: place_at,
    plan.SetSupport: support,
}  # fmt: skip
_DO_WITHOUT_PLACES: Mapping[type[Any], Callable[[Scene, Any], Done]] = {
    plan.Rename: rename, plan.Paint: cover, plan.RoomLength: lengthen, plan.Light: light, plan.MoveWall: wall_moved,
    plan.DrawRoom: outline,
}  # fmt: skip
"""Edits that look for no free place."""


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
        edit = self._with_ids(scene, edit)
        plain = _DO_WITHOUT_PLACES.get(type(edit))
        done = _DO[type(edit)](self.positioner, scene, edit) if plain is None else plain(scene, edit)
        if isinstance(edit, Insert) and edit.name:
            self.names[edit.name] = done.touched[0]
        return done

    def _with_ids(self, scene: Scene, edit: Edit) -> Edit:
        """The edit with known ids of objects in the place of names that edits before it gave."""
        known: dict[str, Any] = {}
        if hasattr(edit, "objects"):
            known["objects"] = self._ids(scene, edit.objects)
        for one in ("toward", "behind"):
            if getattr(edit, one, ""):
                known[one] = self._ids(scene, [getattr(edit, one)])[0]
        if isinstance(edit, plan.SetSupport):
            known["parent"] = self.names.get(edit.parent, edit.parent)
        if hasattr(edit, "places"):
            places = [(p, self._ids(scene, p.targets) if p.targets else []) for p in edit.places]
            known["places"] = [place.model_copy(update={"targets": ids}) for place, ids in places]
        return edit.model_copy(update=known)

    def _ids(self, scene: Scene, given: Sequence[str]) -> list[str]:
        """Known ids, with the names of new objects resolved, each once."""
        ids = list(dict.fromkeys(self.names.get(i, i) for i in given))
        unknown = next((i for i in ids if not scene.has_object(i)), None)
        if unknown is not None:
            raise EditRefused(f"there is no object “{unknown}” in this scene")
        if not ids:
            raise EditRefused("no object was named")
        return ids
