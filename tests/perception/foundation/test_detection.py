"""What is asked of an open-vocabulary detector, and what is made of its boxes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import Cancelled
from diorama_core.library.taxonomy import ARCHITECTURE_WORDS, CATEGORIES, UNKNOWN
from diorama_core.models.boxes import Detections
from diorama_core.models.owlv2 import MAX_PHRASES
from diorama_core.models.segment_anything import PromptedMask
from diorama_core.perception.foundation.detection import (
    INDOOR_WORDS,
    MAX_OBJECTS,
    OpenVocabularyDetection,
    PromptedMasks,
)
from diorama_core.perception.masks import LOST_CONFIDENCE, box_mask
from diorama_core.progress import CancelToken, Progress

PHOTO = Photo(np.zeros((100, 200, 3), np.uint8), "room.png", (200, 100))
Row = tuple[float, float, float, float, float, str]


@dataclass
class _Detector:
    """Finds what it is told, by the word in the phrase; remembers the phrases."""

    rows: Sequence[Row] = ()
    asked: list[str] = field(default_factory=list)

    def detect(
        self, rgb: np.ndarray, phrases: Sequence[str], threshold: float, progress: Progress | None = None
    ) -> Detections:
        self.asked = list(phrases)
        retained = [r for r in self.rows if r[4] >= threshold and f"a photo of {r[5]}" in phrases]
        labels = [phrases.index(f"a photo of {r[5]}") for r in retained]
        table = np.array([r[:5] for r in retained], dtype=float).reshape(-1, 5)
        return Detections(table[:, :4], table[:, 4], np.array(labels, dtype=int))


def _found(words: tuple[str, ...], *rows: Row) -> tuple[LabelledBox, ...]:
    stage = OpenVocabularyDetection(_Detector(rows))
    return stage.detect(PHOTO, words, Progress())


def test_without_words_a_vocabulary_of_rooms_is_asked_for_in_the_papers_phrase() -> None:
    detector = _Detector()
    OpenVocabularyDetection(detector).detect(PHOTO, (), Progress())
    assert detector.asked == [f"a photo of {word}" for word in INDOOR_WORDS]
    assert {c.name for c in CATEGORIES if c is not UNKNOWN} - ARCHITECTURE_WORDS == set(INDOOR_WORDS)
    assert len(INDOOR_WORDS) == len(set(INDOOR_WORDS)) <= MAX_PHRASES, "one run looks at the picture once"


def test_parts_of_the_room_are_never_objects() -> None:
    detector = _Detector()
    words = ("wall", "chair", "floor", "Ceiling", "chair")
    OpenVocabularyDetection(detector).detect(PHOTO, words, Progress())
    assert detector.asked == ["a photo of chair"]
    assert not ARCHITECTURE_WORDS & set(INDOOR_WORDS)


def test_double_boxes_of_any_class_and_parts_of_the_same_class_go() -> None:
    found = _found(
        ("chair", "armchair", "pillow"),
        (10, 10, 60, 90, 0.9, "armchair"),
        (11, 10, 60, 91, 0.6, "chair"),  # the same thing under another name
        (20, 20, 50, 60, 0.5, "armchair"),  # its back
        (20, 40, 50, 60, 0.4, "pillow"),  # something else that lies on it
        (100, 10, 150, 90, 0.3, "chair"),
        (160, 10, 190, 90, 0.1, "chair"),  # too unsure
        (5, 5, 9, 9, 0.8, "pillow"),  # too small to be anything
    )
    assert [(b.category, b.score) for b in found] == [("armchair", 0.9), ("pillow", 0.4), ("chair", 0.3)]


def test_words_that_the_library_does_not_know_keep_their_name() -> None:
    found = _found(
        ("couch", "gramophone horn"), (0, 0, 90, 90, 0.9, "couch"), (100, 0, 150, 50, 0.5, "gramophone horn")
    )
    assert [(b.category, b.label) for b in found] == [("sofa", "couch"), (UNKNOWN.name, "gramophone horn")]


def test_a_special_kind_within_its_broader_kind_is_the_same_object() -> None:
    found = _found(
        ("sofa", "sectional sofa", "table"),
        (10, 10, 90, 90, 0.9, "sectional sofa"),
        (15, 15, 60, 80, 0.6, "sofa"),  # one half of it, found as a sofa
        (100, 10, 150, 90, 0.4, "sofa"),
    )
    assert [(b.category, b.score) for b in found] == [("sectional sofa", 0.9), ("sofa", 0.4)]


def test_a_photo_has_at_most_forty_objects() -> None:
    rows = [(5.0 * k, 10.0, 5.0 * k + 9, 30.0, 0.9 - k / 100, "book") for k in range(38)]
    more = [(5.0 * k, 50.0, 5.0 * k + 9, 70.0, 0.5, "cup") for k in range(38)]
    assert len(_found(("book", "cup"), *rows, *more)) == MAX_OBJECTS


SHAPE = (60, 80)
BOX = (20.0, 10.0, 60.0, 50.0)


class Drawn:
    """A segmenter that answers every box with a given mask."""

    def __init__(self, mask: np.ndarray, quality: float = 0.9) -> None:
        self.mask, self.quality = mask, quality
        self.asked: list[np.ndarray] = []

    def masks(self, rgb: np.ndarray, boxes: np.ndarray) -> list[PromptedMask]:
        self.asked.append(boxes)
        return [PromptedMask(self.mask, self.quality) for _ in boxes]


def found(segmenter: Drawn, *boxes, progress: Progress | None = None):
    photo = Photo(np.zeros((*SHAPE, 3), np.uint8), "x", SHAPE[::-1])
    inputs = Inputs(photo, tuple(LabelledBox(b, "chair", "chair") for b in boxes))
    return PromptedMasks(segmenter).segment(inputs, progress or Progress())


def test_masks_are_the_segmenters_cut_to_a_little_more_than_the_box() -> None:
    (item,) = found(Drawn(np.ones(SHAPE, dtype=bool)), BOX)
    np.testing.assert_array_equal(item.mask, box_mask(SHAPE, (18.0, 8.0, 62.0, 52.0)))
    assert item.mask_confidence == 0.9
    assert item.category == "chair"


def test_a_lost_object_is_its_box_at_low_confidence() -> None:
    elsewhere = np.zeros(SHAPE, dtype=bool)
    elsewhere[:5, :5] = True
    (item,) = found(Drawn(elsewhere), BOX)
    np.testing.assert_array_equal(item.mask, box_mask(SHAPE, BOX))
    assert item.mask_confidence == LOST_CONFIDENCE
    (unsure,) = found(Drawn(np.ones(SHAPE, dtype=bool), 0.0), BOX)
    assert unsure.mask_confidence == LOST_CONFIDENCE


def test_all_boxes_are_asked_at_once_and_none_when_there_are_none() -> None:
    segmenter = Drawn(np.ones(SHAPE, dtype=bool))
    assert len(found(segmenter, BOX, (5.0, 5.0, 30.0, 30.0))) == 2
    assert [len(b) for b in segmenter.asked] == [2]
    assert found(segmenter) == ()
    assert len(segmenter.asked) == 1


def test_it_can_be_stopped() -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        found(Drawn(np.ones(SHAPE, dtype=bool)), BOX, progress=Progress(token=token))
