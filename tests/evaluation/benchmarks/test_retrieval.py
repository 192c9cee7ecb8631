"""Halves of the query alone: words by a text search, looks among the kind's shapes."""

from __future__ import annotations

import pytest

from diorama_core.evaluation.benchmarks.retrieval import ALONE, MISSED, ObjectResult, _alone, _nearest, retrieval_table
from diorama_core.synthesis import render_truth, sample_cameras
from diorama_core.synthesis.layout_rooms import BoxLibrary, box_library, generate_room
from diorama_core.synthesis.truth import TruthView

LIBRARY: BoxLibrary = box_library()


@pytest.fixture(scope="module")
def view() -> TruthView:
    room = generate_room(3, 8).truth
    camera = sample_cameras(room, LIBRARY, 1, 1, (160, 120))[0]
    return render_truth(room, camera, LIBRARY, (160, 120))


@pytest.mark.parametrize("name", ALONE)
def test_each_half_finds_shapes_of_the_kind_for_every_object(name: str, view: TruthView) -> None:
    found = _alone(name, LIBRARY, view)
    for index in view.asked:
        item = view.scene.objects[index]
        assert item.category in {LIBRARY.shape(s).category for s in found[item.id]}


def test_the_nearest_of_five_counts_and_nothing_is_far(view: TruthView) -> None:
    index = view.asked[0]
    true = view.scene.objects[index].shape_id
    others = [s.id for s in LIBRARY.shapes() if s.id != true][:5]
    assert _nearest(view, index, (*others[:4], true), LIBRARY) == pytest.approx(0.0, abs=1e-6)
    assert _nearest(view, index, (*others, true), LIBRARY) > 0.0
    assert _nearest(view, index, (), LIBRARY) == MISSED


def test_a_row_for_each_half() -> None:
    item = ObjectResult(
        "r", "a", "chair", ("furniture",), 5.0, 4.0, 9.0, 8.0, 2, True, False, (("words alone", 6.0, 7.0),)
    )
    row = retrieval_table([item]).row("words alone, best of 5")
    assert (row["furniture SS"], row["furniture OOD"], row["household SS"]) == (6.0, 7.0, None)
