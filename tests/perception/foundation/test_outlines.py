from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import Cancelled
from diorama_core.models.segment_anything import PromptedMask
from diorama_core.perception.foundation.outlines import PromptedMasks
from diorama_core.perception.masks import LOST_CONFIDENCE, filled_box
from diorama_core.progress import CancelToken, Progress

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
    np.testing.assert_array_equal(item.mask, filled_box(SHAPE, (18.0, 8.0, 62.0, 52.0)))
    assert item.mask_confidence == 0.9
    assert item.category == "chair"


def test_a_lost_object_is_its_box_at_low_confidence() -> None:
    elsewhere = np.zeros(SHAPE, dtype=bool)
    elsewhere[:5, :5] = True
    (item,) = found(Drawn(elsewhere), BOX)
    np.testing.assert_array_equal(item.mask, filled_box(SHAPE, BOX))
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
