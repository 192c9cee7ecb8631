from __future__ import annotations

import numpy as np
import pytest

from diorama_core.errors import EditRefused
from diorama_core.review.answers import apply_answer
from diorama_core.review.questions import questions
from diorama_core.scene.schema import scene_from_json, scene_to_json
from diorama_core.scene.types import Scene
from tests.app.small_room import PlainLibrary, furnished_scene
from tests.review.doubtful_room import doubtful_scene

LIBRARY = PlainLibrary()


def others(scene: Scene, object_id: str) -> dict:
    return {o.id: o for o in scene.objects if o.id != object_id}


@pytest.mark.parametrize("question", [q.id for q in questions(doubtful_scene())])
def test_every_choice_settles_its_question_and_changes_only_that_object(question: str) -> None:
    before = doubtful_scene()
    (asked,) = (q for q in questions(before) if q.id == question)
    for choice in asked.choices:
        after = apply_answer(before, LIBRARY, question, choice.value)
        assert question not in {q.id for q in questions(after)}
        assert others(after, asked.object_id) == others(before, asked.object_id)
        assert scene_from_json(scene_to_json(after)).objects == after.objects


def test_the_answer_that_was_taken_for_right_moves_nothing() -> None:
    scene = doubtful_scene()
    for question, value in (("kind:chair_1", "chair"), ("front:chair_1", "as it is"), ("supporter:lamp_1", "table_1")):
        object_id = question.split(":")[1]
        after = apply_answer(scene, LIBRARY, question, value).object(object_id)
        assert after.pose == scene.object(object_id).pose
        assert after.shape_id == scene.object(object_id).shape_id


def test_another_kind_takes_a_shape_of_it_at_its_place() -> None:
    scene = doubtful_scene()
    after = apply_answer(scene, LIBRARY, "kind:chair_1", "table").object("chair_1")
    assert (after.category, after.label) == ("table", "table")
    assert LIBRARY.shape(after.shape_id).category == "table"
    np.testing.assert_allclose(after.pose.position[:2], scene.object("chair_1").pose.position[:2])
    assert after.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    assert after.belief.kinds == (("table", 1.0),)


def test_a_turn_is_a_quarter_counter_clockwise() -> None:
    scene = doubtful_scene()
    after = apply_answer(scene, LIBRARY, "front:chair_1", "left").object("chair_1")
    assert after.pose.yaw_rad == pytest.approx(scene.object("chair_1").pose.yaw_rad + np.pi / 2)


def test_another_supporter_takes_it_there() -> None:
    after = apply_answer(doubtful_scene(), LIBRARY, "supporter:lamp_1", "floor")
    assert after.support_of("lamp_1").parent == "floor"
    assert after.object("lamp_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)


def test_what_is_no_object_goes() -> None:
    assert not apply_answer(doubtful_scene(), LIBRARY, "presence:picture_1", "no").has_object("picture_1")


@pytest.mark.parametrize(
    ("question", "value", "words"),
    [
        ("kind:nobody", "chair", "ask for the questions again"),
        ("colour:chair_1", "red", "ask for the questions again"),
        ("kind:chair_1", "unicorn", "armchair"),
        ("kind:chair_1", "bathtub", "the library has no bathtub"),
        ("front:chair_1", "up", "backwards"),
        ("presence:picture_1", "maybe", "yes or no"),
        ("supporter:lamp_1", "moon", "id of an object"),
    ],
)
def test_what_is_no_answer_is_refused_in_one_line(question: str, value: str, words: str) -> None:
    with pytest.raises(EditRefused, match=words) as refused:
        apply_answer(doubtful_scene(), LIBRARY, question, value)
    assert "\n" not in str(refused.value)


def test_an_object_that_no_build_found_can_be_answered_about() -> None:
    after = apply_answer(furnished_scene(), LIBRARY, "kind:chair_1", "table").object("chair_1")
    assert after.belief is not None
