"""A known height tells all lengths."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import EditRefused
from diorama_core.review.answers import apply_answer
from diorama_core.review.questions import LEAST_GAIN, NO, YES, count_misplaced, questions, ruler
from diorama_core.scene.belief import Belief
from diorama_core.scene.room_edits import KNOWN_LENGTH_SIGMA
from diorama_core.scene.types import Scene, Support
from tests.app.small_room import PlainLibrary, furnished_scene
from tests.review.doubtful_room import BELIEFS, believed, doubtful_scene


@pytest.fixture
def scene() -> Scene:
    """The chairs and the table are seen whole; all lengths may be wrong by 10 %."""
    base = doubtful_scene()
    boxes = {
        "table_1": (200.0, 200.0, 400.0, 300.0),
        "chair_1": (50.0, 200.0, 150.0, 320.0),
        "chair_2": (0.0, 0.0, 90.0, 99.0),
    }
    objects = tuple(replace(o, box_px=boxes.get(o.id)) for o in base.objects)
    return replace(base, objects=objects, scale_sigma=0.1)


def test_the_ruler_stands_on_the_floor_whole_and_is_large_or_of_a_known_height(scene: Scene) -> None:
    item = ruler(scene)
    assert item is not None
    assert item.id == "chair_1", "it is the largest in the picture"
    larger = {"table_1": (200.0, 100.0, 400.0, 300.0), "chair_1": (50.0, 100.0, 150.0, 290.0)}
    objects = tuple(
        replace(o, box_px=larger.get(o.id), category={"chair_1": "door"}.get(o.id, o.category)) for o in scene.objects
    )
    door = ruler(replace(scene, objects=objects))
    assert door is not None
    assert door.id == "chair_1", "heights of doors differ least"
    cut = tuple(replace(o, box_px=(0.0, 10.0, 50.0, 60.0)) for o in scene.objects)
    assert ruler(replace(scene, objects=cut)) is None
    assert ruler(replace(scene, camera=None)) is None


def test_more_is_misplaced_the_less_the_scale_is_known(scene: Scene) -> None:
    counts = [count_misplaced(scene, sigma) for sigma in (0.0, 0.02, 0.1, 0.5, 100.0)]
    assert counts == sorted(counts)
    assert counts[0] == 0.0
    everything = sum(o.belief.right for o in scene.objects if o.belief is not None)
    assert counts[-1] == pytest.approx(everything, rel=0.01)


def test_an_answer_brings_all_lengths_to_the_told_height_and_is_not_asked_again(scene: Scene) -> None:
    (question,) = [q for q in questions(scene) if q.subject == "scale"]
    before = scene.object(question.object_id).size_m[2]
    after = apply_answer(scene, PlainLibrary(), question.id, f"{1.25 * before} m")
    assert after.object(question.object_id).size_m[2] == pytest.approx(1.25 * before)
    for item in scene.objects:
        np.testing.assert_allclose(after.object(item.id).pose.position, 1.25 * item.pose.position)
    assert after.scale_sigma == KNOWN_LENGTH_SIGMA
    assert not [q for q in questions(after) if q.subject == "scale"]


def test_choices_are_lengths_of_which_the_present_one_is_likeliest(scene: Scene) -> None:
    (question,) = [q for q in questions(scene) if q.subject == "scale"]
    assert float(question.choices[0].value) == pytest.approx(scene.object(question.object_id).size_m[2], abs=0.006)
    assert sum(c.probability for c in question.choices) == pytest.approx(1.0)
    with pytest.raises(EditRefused, match="no length"):
        apply_answer(scene, PlainLibrary(), question.id, "tall")


def test_nothing_is_asked_of_a_scale_that_is_known(scene: Scene) -> None:
    for sigma in (None, 0.0, KNOWN_LENGTH_SIGMA):
        assert not [q for q in questions(replace(scene, scale_sigma=sigma)) if q.subject == "scale"]


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
