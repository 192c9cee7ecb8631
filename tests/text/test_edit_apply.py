"""Edits in a row: names of new objects hold for the next, and what cannot be done is refused with the reason."""

from __future__ import annotations

import pytest

from diorama_core.editing.positioning import Positioner
from diorama_core.editing.relations import Relation, is_met
from diorama_core.editing.room_frame import RoomFrame
from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Scene
from diorama_core.text.edit_apply import EditApplier
from diorama_core.text.edit_plan import Edit, Insert, Move, Place, Remove, Restyle
from tests.text.edited import done


def test_removed_furniture_goes_with_what_is_on_it(living: Scene) -> None:
    after = done(living, Remove(objects=["sideboard_1"]))
    assert not any(after.has_object(i) for i in ("sideboard_1", "lamp_1", "books_1"))
    without_rug = done(living, Remove(objects=["rug_1"]))
    assert without_rug.has_object("coffee_table_1")
    assert without_rug.object("coffee_table_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-3)


def test_later_edits_call_new_objects_by_the_name_they_got(living: Scene) -> None:
    applier = EditApplier(Positioner(built_in_library()))
    chair = Insert(what="armchair", name="mine", places=[Place(relation="near", targets=["sofa_1"])])
    first = applier.apply(living, chair)
    lamp = Insert(what="floor lamp", places=[Place(relation="beside", targets=["mine"])])
    second = applier.apply(first.scene, lamp)
    frame = RoomFrame.of(second.scene)
    assert is_met(second.scene, second.touched[0], Relation("beside", first.touched), frame)


@pytest.mark.parametrize(
    ("edit", "why"),
    [
        (Remove(objects=["nothing_1"]), "no object"),
        (Insert(what="bed", places=[Place(relation="on", targets=["coffee_table_1"])]), "no free place"),
        (Insert(what="zorkmid"), "nothing called"),
        (Restyle(objects=["sofa_1"], look="zorkmid"), "no colour"),
        (Move(objects=["sofa_1"], places=[Place(relation="beside", targets=["sofa_1"])]), "itself"),
        (Insert(what="bed", count=12), "would fit"),
    ],
    ids=["unknown id", "too large", "unknown noun", "unknown look", "itself", "too many"],
)
def test_what_cannot_be_done_is_refused(living: Scene, edit: Edit, why: str) -> None:
    with pytest.raises(EditRefused, match=why):
        done(living, edit)
