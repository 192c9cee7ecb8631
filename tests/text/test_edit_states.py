from __future__ import annotations

import pytest

from diorama_core.editing.positioning import Positioner
from diorama_core.editing.removal import without_objects
from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.text.edit_plan import Align, Exchange, Measure, SetState
from diorama_core.text.edit_states import aligned, exchanged, measured, put_in_state
from diorama_core.text.edit_words_objects import object_edits, places_of_phrases
from diorama_core.text.phrases import PlacePhrase
from diorama_core.text.selecting import Selector
from tests.text.edited import assert_sound, living_room

POSITIONER = Positioner(built_in_library())


def test_what_stands_on_something_higher_rises_with_it() -> None:
    scene = living_room()
    after = measured(
        POSITIONER, scene, ["sideboard_1"], Measure(objects=["sideboard_1"], side="height", to_m=0.9)
    ).scene
    top = after.object("sideboard_1").corners_world[:, 2].max()
    assert after.object("lamp_1").corners_world[:, 2].min() == pytest.approx(top, abs=0.02)
    with pytest.raises(EditRefused, match="cannot be 40"):
        measured(POSITIONER, scene, ["lamp_1"], Measure(objects=["lamp_1"], side="height", to_m=40.0))


def test_exchanged_objects_meet_nothing() -> None:
    after = exchanged(POSITIONER, living_room(), Exchange(objects=["piano_1", "sideboard_1"])).scene
    assert_sound(living_room(), after)


def test_states_are_of_what_can_have_them() -> None:
    with pytest.raises(EditRefused, match="is no lamp"):
        put_in_state(built_in_library(), living_room(), ["sofa_1"], SetState(objects=["sofa_1"], state="on"))
    with pytest.raises(EditRefused, match="is alone"):
        aligned(POSITIONER, living_room(), ["sofa_1"], Align(objects=["sofa_1"], how="in line"))


def test_other_clauses_are_left_to_others() -> None:
    selector = Selector(living_room(), built_in_library())
    for clause in ("make the sofa red", "move the lamp", "turn the sofa around", "swap the sofa for a leather one"):
        assert object_edits(selector, clause, lambda s, words: s.objects(words)) is None
    (place,) = places_of_phrases(selector, [PlacePhrase("beside", "the sofa")])
    assert place.targets == ["sofa_1"]


def test_what_stood_on_what_is_deleted_comes_down() -> None:
    after, loads = without_objects(living_room(), built_in_library(), ["sideboard_1"])
    assert set(loads) == {"lamp_1", "books_1"}
    for load in loads:
        assert after.object(load).corners_world[:, 2].min() == pytest.approx(0.0, abs=0.02)
    assert_sound(living_room(), after)
