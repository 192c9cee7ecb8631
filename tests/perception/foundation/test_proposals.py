"""What the recogniser proposes, with what a network for everyday objects found beside it. What objects look like to the
namer that comes with Diorama.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from diorama_core.artefacts import DetectedObject, LabelledBox, Photo
from diorama_core.io.assets import has_own_recogniser
from diorama_core.library.taxonomy import CATEGORIES
from diorama_core.models.boxes import Detections
from diorama_core.perception.foundation.proposals import (
    JoinedDetection,
    OwnDetection,
    count_left_out,
    join_boxes,
    own_naming,
    rank_names,
)
from diorama_core.progress import Progress

NAMED = ("bench", "chair", "office chair", "sofa", "table")
BOXES = np.array([[10.0, 10.0, 60.0, 90.0], [100.0, 10.0, 190.0, 90.0]])
UNDECIDED = np.full((2, len(NAMED)), 1 / len(NAMED))
CHAIR = LabelledBox((12.0, 11.0, 60.0, 90.0), "chair", "chair", 0.7)


def test_a_networks_word_counts_for_the_same_box_only() -> None:
    alone, told = rank_names(NAMED, UNDECIDED, BOXES), rank_names(NAMED, UNDECIDED, BOXES, [CHAIR])
    assert told[0][0] == "chair"
    assert told[1] == alone[1], "the other box is another object"
    elsewhere = LabelledBox((300.0, 10.0, 350.0, 90.0), "sofa", "sofa", 0.9)
    assert rank_names(NAMED, UNDECIDED, BOXES, [elsewhere]) == alone


def test_what_it_looks_like_decides_among_the_kinds_that_a_word_means() -> None:
    seen = np.array([[0.01, 0.04, 0.9, 0.01, 0.04], UNDECIDED[0]])
    assert rank_names(NAMED, seen, BOXES, [CHAIR])[0][0] == "office chair"


@dataclass(frozen=True)
class _Finds:
    """Stands for the recogniser and for a network: three boxes, of which one is sure."""

    categories: tuple[str, ...] = NAMED

    def propose(self, rgb: np.ndarray, threshold: float, most: int) -> Detections:
        rows = np.array(
            [[10.0, 10.0, 60.0, 90.0, 0.9], [70.0, 10.0, 95.0, 90.0, 0.55], [100.0, 10.0, 190.0, 90.0, 0.52]]
        )
        rows = rows[rows[:, 4] >= threshold][:most]
        return Detections(rows[:, :4], rows[:, 4], np.zeros(len(rows), dtype=int))

    def name(self, rgb: np.ndarray, boxes: np.ndarray) -> np.ndarray:
        return np.full((len(boxes), len(NAMED)), 1 / len(NAMED))

    def detect(self, photo: Photo, words: tuple[str, ...], progress: Progress) -> tuple[LabelledBox, ...]:
        return (LabelledBox((100.0, 10.0, 188.0, 90.0), "sofa", "sofa", 0.4),)


@pytest.mark.unchecked
def test_likely_objects_that_a_build_leaves_out_are_counted() -> None:
    photo = Photo(np.zeros((100, 200, 3), np.uint8), "room.png", (200, 100))
    own = OwnDetection(_Finds())
    assert len(own.detect(photo, (), Progress())) == 1
    assert count_left_out(own, photo) == 2
    assert count_left_out(JoinedDetection(_Finds(), own), photo) == 1, "the network found one of them"


def test_of_boxes_of_one_object_the_networks_stays() -> None:
    own = (
        LabelledBox((10.0, 10.0, 60.0, 90.0), "sofa", "sofa", 0.9),
        LabelledBox((100.0, 0.0, 150.0, 50.0), "bed", "bed", 0.8),
    )
    assert join_boxes((CHAIR,), own) == (own[1], CHAIR)
    assert join_boxes((), own) == own


@pytest.mark.skipif(not has_own_recogniser(), reason="the recogniser's weights were left out")
def test_every_object_gets_probabilities_of_kinds() -> None:
    rgb = np.random.default_rng(0).integers(0, 255, (60, 80, 3)).astype(np.uint8)
    objects = tuple(
        DetectedObject(name, "object", "object", box, np.ones((60, 80), bool), 1, 1.0)
        for name, box in (("a", (0.0, 0.0, 30.0, 40.0)), ("b", (20.0, 10.0, 80.0, 60.0)))
    )
    naming = own_naming()
    assert naming is not None
    found = naming.name(Photo(rgb, "0" * 64, (80, 60)), objects, Progress())
    assert [one.object_id for one in found] == ["a", "b"]
    for one in found:
        assert set(one.kinds) <= {c.name for c in CATEGORIES}
        assert one.probabilities.sum() == pytest.approx(1.0)
    assert naming.name(Photo(rgb, "0" * 64, (80, 60)), (), Progress()) == ()
