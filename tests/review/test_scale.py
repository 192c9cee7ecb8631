"""A known height tells all lengths."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.errors import EditRefused
from diorama_core.review.answers import answered
from diorama_core.review.questions import questions
from diorama_core.review.scale import misplaced, ruler
from diorama_core.scene.room_edits import KNOWN_LENGTH_SIGMA
from diorama_core.scene.types import Scene
from tests.app.small_room import PlainLibrary
from tests.review.doubtful_room import doubtful_scene


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
    counts = [misplaced(scene, sigma) for sigma in (0.0, 0.02, 0.1, 0.5, 100.0)]
    assert counts == sorted(counts)
    assert counts[0] == 0.0
    everything = sum(o.belief.right for o in scene.objects if o.belief is not None)
    assert counts[-1] == pytest.approx(everything, rel=0.01)


def test_an_answer_brings_all_lengths_to_the_told_height_and_is_not_asked_again(scene: Scene) -> None:
    (question,) = [q for q in questions(scene) if q.subject == "scale"]
    before = scene.object(question.object_id).size_m[2]
    after = answered(scene, PlainLibrary(), question.id, f"{1.25 * before} m")
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
        answered(scene, PlainLibrary(), question.id, "tall")


def test_nothing_is_asked_of_a_scale_that_is_known(scene: Scene) -> None:
    for sigma in (None, 0.0, KNOWN_LENGTH_SIGMA):
        assert not [q for q in questions(replace(scene, scale_sigma=sigma)) if q.subject == "scale"]
