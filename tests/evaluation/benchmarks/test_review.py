from __future__ import annotations

import pytest

from diorama_core.evaluation.adapters.photo_annotations import AnnotatedObject
from diorama_core.evaluation.benchmarks.review import COUNTS, Reviewed, answers_table, calibration_table, shares_right
from diorama_core.evaluation.metrics.annotated import front_deg
from diorama_core.review.questions import questions
from tests.app.small_room import PlainLibrary
from tests.review.doubtful_room import doubtful_scene


@pytest.fixture
def reviewed() -> Reviewed:
    """One chair is a table in truth, and the lamp stands on the floor."""
    scene = doubtful_scene()
    kinds = {"chair_1": "table"}
    truth = {
        o.id: AnnotatedObject.model_validate(
            {
                "bbox": (0.0, 0.0, 10.0, 10.0),
                "class": o.category,
                "kind": kinds.get(o.id, o.category),
                "on": {"lamp_1": "floor", "picture_1": "wall"}.get(o.id, "floor"),
                "front": front_deg(o, scene.camera) if o.id == "chair_2" else None,
            }
        )
        for o in scene.objects
    }
    return Reviewed(scene, truth, {name: k for k, name in enumerate(truth)}, PlainLibrary())


def test_answers_of_somebody_who_knows_make_everything_right(reviewed: Reviewed) -> None:
    shares = shares_right(reviewed, lambda asked: asked[0])
    assert len(shares) == len(COUNTS)
    assert shares[0] == (3, 5)
    assert shares[-1] == (5, 5)
    assert [right for right, _ in shares] == sorted(right for right, _ in shares)


def test_what_the_annotation_does_not_say_is_not_answered(reviewed: Reviewed) -> None:
    front = next(q for q in questions(reviewed.scene) if q.id == "front:chair_1")
    assert reviewed.answer(reviewed.scene, front) is None


def test_the_tables_count_what_was_right(reviewed: Reviewed) -> None:
    table = answers_table([reviewed])
    assert {row.name for row in table.rows} == {"the review", "most doubtful first", "at random"}
    assert all(row.values[0] == pytest.approx(0.6) for row in table.rows)
    said = {row.name: row.values for row in calibration_table([reviewed]).rows}
    assert said["kind, 0.50 to 0.70"] == (1, pytest.approx(0.55), 0.0)
    assert said["supporter, 0.50 to 0.70"] == (1, pytest.approx(0.6), 0.0)
