from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.review.questions import LEAST_GAIN, NO, YES, questions
from diorama_core.scene.belief import Belief
from diorama_core.scene.types import Support
from tests.app.small_room import furnished_scene
from tests.review.doubtful_room import BELIEFS, believed, doubtful_scene

SHARE = st.floats(0.01, 1.0)


def test_only_what_is_doubtful_is_asked() -> None:
    asked = {q.id for q in questions(doubtful_scene())}
    assert asked == {"presence:picture_1", "supporter:lamp_1", "kind:chair_1", "front:chair_1", "kind:chair_2"}
    assert questions(furnished_scene()) == ()


def test_choices_are_named_as_people_name_them_and_the_likeliest_is_first() -> None:
    found = {q.id: q for q in questions(doubtful_scene())}
    assert [(c.value, c.label) for c in found["supporter:lamp_1"].choices] == [
        ("table_1", "the dining table"),
        ("floor", "the floor"),
    ]
    assert [c.value for c in found["presence:picture_1"].choices] == [YES, NO]
    assert found["kind:chair_1"].sentence == "Is this a chair?"
    assert {c.label for c in found["front:chair_1"].choices} <= {
        "toward the camera",
        "away from the camera",
        "to the left",
        "to the right",
    }


def test_an_object_of_which_the_rest_is_sure_is_asked_about_before_one_that_stays_wrong_anyway() -> None:
    """Equally doubtful kinds: the answer helps where everything else about the object is right already."""
    sure = Belief(kinds=(("chair", 0.5), ("table", 0.5)))
    doubtful = Belief(kinds=(("chair", 0.5), ("table", 0.5)), fronts=(0.4, 0.3, 0.3, 0.0))
    scene = believed(furnished_scene(), {"chair_1": doubtful, "chair_2": sure})
    assert questions(scene)[0].id == "kind:chair_2"


def test_what_a_person_decided_since_is_not_asked() -> None:
    scene = doubtful_scene()
    chair = scene.object("chair_1")
    renamed = replace(chair, category="armchair", by_hand=True)
    changed = replace(
        scene,
        objects=tuple(renamed if o.id == "chair_1" else o for o in scene.objects),
        supports=(*(s for s in scene.supports if s.child != "lamp_1"), Support("lamp_1", "floor")),
    )
    asked = {q.id for q in questions(changed)}
    assert asked == {"presence:picture_1", "kind:chair_2"}


@given(SHARE, SHARE, SHARE)
def test_an_answer_is_worth_what_it_makes_right(present: float, kind: float, front: float) -> None:
    belief = Belief(
        round(present, 3),
        (("chair", kind), ("table", 1.0 - kind)),
        (front, 1.0 - front, 0.0, 0.0),
    )
    scene = believed(furnished_scene(), {"chair_1": belief})
    for question in questions(scene):
        assert question.gain >= LEAST_GAIN
        if question.subject == "kind":
            assert question.gain == pytest.approx((1.0 - kind) * belief.present * front, abs=1e-9)
        assert question.gain <= 1.0 + 1.0


def test_plural_kinds_are_asked_after_in_the_plural() -> None:
    scene = believed(furnished_scene(), {"chair_1": Belief(0.5)})
    books = replace(scene.object("chair_1"), label="books")
    scene = replace(scene, objects=tuple(books if o.id == "chair_1" else o for o in scene.objects))
    assert [q.sentence for q in questions(scene)] == ["Are these books?"]


def test_a_question_as_json_says_everything() -> None:
    first = questions(doubtful_scene())[0]
    assert first.to_json()["id"] == first.id
    assert first.to_json()["choices"][0]["probability"] == first.choices[0].probability
    assert set(BELIEFS) == {o.id for o in doubtful_scene().objects}
