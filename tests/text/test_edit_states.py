"""Edits that say exactly what is where, as JSON of another program."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from diorama_core.editing.positioning import Positioner
from diorama_core.editing.support_changes import without_objects
from diorama_core.errors import EditRefused
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Scene
from diorama_core.text.edit_plan import Align, Edit, Exchange, Measure, SetState, TypedEdit
from diorama_core.text.edit_states import exchange, line_up, put_in_state, set_side
from diorama_core.text.edit_words_objects import object_edits, places_of_phrases
from diorama_core.text.editing_by_words import apply_edits
from diorama_core.text.phrases import PlacePhrase
from diorama_core.text.selecting import Selector
from tests.text.edited import assert_sound, living_room

EDIT: TypeAdapter[Edit] = TypeAdapter(TypedEdit)


def edited(*edits: dict) -> Scene:
    return apply_edits([EDIT.validate_python(e) for e in edits], living_room(), built_in_library()).scene


def test_a_place_is_exact_and_tells_what_it_meets() -> None:
    before = living_room()
    sofa = before.object("sofa_1").pose.position
    place = {"do": "place", "objects": ["coffee_table_1"], "base_m": [sofa[0], sofa[1], 0.0], "heading_deg": 30.0}
    proposed = apply_edits([EDIT.validate_python(place)], before, built_in_library())
    table = proposed.scene.object("coffee_table_1")
    assert table.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert table.pose.position[:2] == pytest.approx(sofa[:2])
    assert np.degrees(table.pose.yaw_rad) == pytest.approx(30.0)
    assert any("meets" in note and "sofa" in note for note in proposed.notes)


def test_a_size_keeps_the_base_and_what_is_on_it() -> None:
    after = edited({"do": "place", "objects": ["sideboard_1"], "size_m": [0.4, 1.5, 0.9]})
    sideboard, lamp = after.object("sideboard_1"), after.object("lamp_1")
    assert sideboard.size_m == pytest.approx([0.4, 1.5, 0.9])
    assert lamp.corners_world[:, 2].min() == pytest.approx(0.9, abs=0.02)


def test_supports_are_set_and_taken_away() -> None:
    after = edited({"do": "support", "objects": ["lamp_1"], "parent": "side_table_1"})
    edge = after.support_of("lamp_1")
    assert edge is not None
    assert edge.parent == "side_table_1"
    top = after.object("side_table_1").corners_world[:, 2].max()
    assert after.object("lamp_1").corners_world[:, 2].min() == pytest.approx(top, abs=0.02)
    assert edited({"do": "support", "objects": ["lamp_1"]}).support_of("lamp_1") is None
    with pytest.raises(EditRefused, match="much"):
        edited({"do": "support", "objects": ["piano_1"], "parent": "side_table_1"})
    with pytest.raises(EditRefused, match="no object, wall"):
        edited({"do": "support", "objects": ["lamp_1"], "parent": "shelf_9"})


def test_walls_move_and_the_room_is_drawn_anew() -> None:
    before = living_room()
    after = edited({"do": "wall", "plane": "wall_1", "outward_m": 0.5})
    assert after.plane("wall_1").offset == pytest.approx(before.plane("wall_1").offset - 0.5)
    drawn = edited({"do": "outline", "corners": [[-4, -4], [4, -4], [4, 4], [-4, 4]]})
    floor = drawn.architecture.floor
    assert floor is not None
    assert np.ptp(floor.polygon[:, :2], axis=0) == pytest.approx([8.0, 8.0])
    with pytest.raises(EditRefused, match=r"there are .*wall_1"):
        edited({"do": "wall", "plane": "wall_77", "outward_m": 0.5})


def test_a_refused_edit_says_which_and_nothing_is_half_done() -> None:
    with pytest.raises(EditRefused, match=r"edit 2 of 2 \(remove\): there is no object “harp_1”"):
        edited({"do": "remove", "objects": ["piano_1"]}, {"do": "remove", "objects": ["harp_1"]})


@pytest.mark.parametrize(
    ("edit", "line"),
    [
        ({"do": "fly", "objects": ["sofa_1"]}, "does not match any of the expected tags"),
        ({"do": "resize", "objects": ["sofa_1"], "factor": 90}, "less than or equal to 5"),
        ({"do": "place", "objects": ["sofa_1"], "base_m": [0, 0, float("nan")]}, "finite"),
    ],
)
def test_json_that_is_no_edit_has_one_reason(edit: dict, line: str) -> None:
    with pytest.raises(ValidationError, match=line) as refused:
        EDIT.validate_python(edit)
    assert len(refused.value.errors()) == 1


POSITIONER = Positioner(built_in_library())


def test_what_stands_on_something_higher_rises_with_it() -> None:
    scene = living_room()
    after = set_side(POSITIONER, scene, Measure(objects=["sideboard_1"], side="height", to_m=0.9)).scene
    top = after.object("sideboard_1").corners_world[:, 2].max()
    assert after.object("lamp_1").corners_world[:, 2].min() == pytest.approx(top, abs=0.02)
    with pytest.raises(EditRefused, match="cannot be 40"):
        set_side(POSITIONER, scene, Measure(objects=["lamp_1"], side="height", to_m=40.0))


def test_exchanged_objects_meet_nothing() -> None:
    after = exchange(POSITIONER, living_room(), Exchange(objects=["piano_1", "sideboard_1"])).scene
    assert_sound(living_room(), after)


def test_states_are_of_what_can_have_them() -> None:
    with pytest.raises(EditRefused, match="is no lamp"):
        put_in_state(POSITIONER, living_room(), SetState(objects=["sofa_1"], state="on"))
    with pytest.raises(EditRefused, match="is alone"):
        line_up(POSITIONER, living_room(), Align(objects=["sofa_1"], how="in line"))


def test_other_clauses_are_left_to_others() -> None:
    selector = Selector(living_room(), built_in_library())
    for clause in ("make the sofa red", "move the lamp", "turn the sofa around", "swap the sofa for a leather one"):
        assert object_edits(selector, clause) is None
    (place,) = places_of_phrases(selector, [PlacePhrase("beside", "the sofa")])
    assert place.targets == ["sofa_1"]


def test_what_stood_on_what_is_deleted_comes_down() -> None:
    after, loads = without_objects(living_room(), built_in_library(), ["sideboard_1"])
    assert set(loads) == {"lamp_1", "books_1"}
    for load in loads:
        assert after.object(load).corners_world[:, 2].min() == pytest.approx(0.0, abs=0.02)
    assert_sound(living_room(), after)
