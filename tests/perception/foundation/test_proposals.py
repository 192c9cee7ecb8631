"""What the recogniser proposes, with what a network for everyday objects found beside it."""

from __future__ import annotations

import numpy as np

from diorama_core.artefacts import LabelledBox
from diorama_core.perception.foundation.proposals import joined_boxes, ranked_names

CATEGORIES = ("bench", "chair", "office chair", "sofa", "table")
BOXES = np.array([[10.0, 10.0, 60.0, 90.0], [100.0, 10.0, 190.0, 90.0]])
UNDECIDED = np.full((2, len(CATEGORIES)), 1 / len(CATEGORIES))
CHAIR = LabelledBox((12.0, 11.0, 60.0, 90.0), "chair", "chair", 0.7)


def test_a_networks_word_counts_for_the_same_box_only() -> None:
    alone, told = ranked_names(CATEGORIES, UNDECIDED, BOXES), ranked_names(CATEGORIES, UNDECIDED, BOXES, [CHAIR])
    assert told[0][0] == "chair"
    assert told[1] == alone[1], "the other box is another object"
    elsewhere = LabelledBox((300.0, 10.0, 350.0, 90.0), "sofa", "sofa", 0.9)
    assert ranked_names(CATEGORIES, UNDECIDED, BOXES, [elsewhere]) == alone


def test_what_it_looks_like_decides_among_the_kinds_that_a_word_means() -> None:
    seen = np.array([[0.01, 0.04, 0.9, 0.01, 0.04], UNDECIDED[0]])
    assert ranked_names(CATEGORIES, seen, BOXES, [CHAIR])[0][0] == "office chair"


def test_of_boxes_of_one_object_the_networks_stays() -> None:
    own = (
        LabelledBox((10.0, 10.0, 60.0, 90.0), "sofa", "sofa", 0.9),
        LabelledBox((100.0, 0.0, 150.0, 50.0), "bed", "bed", 0.8),
    )
    assert joined_boxes((CHAIR,), own) == (own[1], CHAIR)
    assert joined_boxes((), own) == own
