"""Masks inside boxes on pictures whose truth is known."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import Cancelled
from diorama_core.perception.masks import EmbeddedMasks
from diorama_core.progress import CancelToken, Progress


def picture(height: int = 240, width: int = 320) -> tuple[np.ndarray, np.ndarray]:
    """A blue oval on a noisy grey ground, and where it is."""
    generator = np.random.default_rng(5)
    rgb = generator.integers(140, 190, (height, width, 3)).astype(np.uint8)
    y, x = np.mgrid[:height, :width]
    oval = ((x - 160) / 60) ** 2 + ((y - 120) / 40) ** 2 <= 1
    rgb[oval] = generator.integers(20, 60, (int(oval.sum()), 3)) + np.array([0, 20, 120])
    return rgb, oval


def inputs(rgb: np.ndarray, *boxes: LabelledBox, **more: object) -> Inputs:
    return Inputs(Photo(rgb, "test.png", (rgb.shape[1], rgb.shape[0])), boxes, **more)


def chair(*box: float) -> LabelledBox:
    return LabelledBox(box, "chair", "chair")


def test_oval_is_found_inside_its_box() -> None:
    rgb, oval = picture()
    (item,) = EmbeddedMasks().segment(inputs(rgb, chair(100, 80, 220, 160)), Progress())
    iou = (item.mask & oval).sum() / (item.mask | oval).sum()
    assert iou > 0.9
    assert item.mask_confidence > 0.8


def test_masks_stay_inside_their_boxes_and_repeat_exactly() -> None:
    rgb, _ = picture()
    boxes = [chair(90, 70, 200, 170), chair(10, 10, 100, 200), chair(150, 100, 320, 240)]
    first = EmbeddedMasks().segment(inputs(rgb, *boxes), Progress())
    second = EmbeddedMasks().segment(inputs(rgb, *boxes), Progress())
    assert first == second
    for item in first:
        rows, columns = np.nonzero(item.mask)
        assert columns.min() >= item.box[0] - 1
        assert columns.max() <= item.box[2]
        assert rows.min() >= item.box[1] - 1
        assert rows.max() <= item.box[3]


def test_ids_are_snake_case_numbered_and_unique() -> None:
    rgb, _ = picture()
    stand = LabelledBox((10.0, 10.0, 60.0, 60.0), "night stand", "bedside table")
    found = EmbeddedMasks().segment(inputs(rgb, stand, chair(100, 80, 220, 160), stand), Progress())
    assert [o.id for o in found] == ["night_stand_1", "chair_1", "night_stand_2"]
    assert [o.mask_id for o in found] == [1, 2, 3]
    assert found[0].label == "bedside table"


@pytest.mark.parametrize(
    "box",
    [(5, 5, 6, 6), (0, 0, 320, 240), (100.2, 50.1, 100.9, 50.8), (319, 239, 320, 240), (0, 100, 320, 101)],
)
def test_degenerate_boxes_give_a_mask(box: tuple[float, ...]) -> None:
    rgb, _ = picture()
    (item,) = EmbeddedMasks().segment(inputs(rgb, chair(*box)), Progress())
    assert item.mask.any()
    assert 0 < item.mask_confidence <= 1


def test_picture_of_one_colour_falls_back_to_the_box() -> None:
    (item,) = EmbeddedMasks().segment(inputs(np.full((60, 80, 3), 127, np.uint8), chair(10, 10, 40, 50)), Progress())
    assert item.mask.sum() > 0
    assert item.mask_confidence < 1


def test_picture_of_one_pixel() -> None:
    (item,) = EmbeddedMasks().segment(inputs(np.zeros((1, 1, 3), np.uint8), chair(0, 0, 1, 1)), Progress())
    assert item.mask.all()


def test_given_instances_are_taken_as_they_are() -> None:
    rgb, oval = picture()
    instances = np.where(oval, 3, 0).astype(np.int32)
    matched = chair(100, 80, 220, 160)
    other = LabelledBox((5.0, 5.0, 50.0, 50.0), "table", "table")
    given = inputs(rgb, matched, other, instances=instances, instance_boxes=((3, matched),))
    first, second = EmbeddedMasks().segment(given, Progress())
    assert (first.mask == oval).all()
    assert (first.mask_id, first.mask_confidence, first.box) == (3, 1.0, matched.box)
    assert second.mask_id == 4
    assert second.category == "table"


def test_no_boxes_no_objects() -> None:
    assert EmbeddedMasks().segment(inputs(picture()[0]), Progress()) == ()


def test_cancel_is_honoured() -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        EmbeddedMasks().segment(inputs(picture()[0], chair(100, 80, 220, 160)), Progress(token=token))
