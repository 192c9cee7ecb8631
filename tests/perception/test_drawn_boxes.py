"""Where objects end whose boxes were drawn roughly."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import Box, LabelledBox
from diorama_core.models.outliner import MARGIN, SIDE, resample
from diorama_core.perception.drawn_boxes import ends_of_objects, find_drawn_box

PHOTO = (480, 640)
OBJECTS: list[Box] = [(60.0, 80.0, 180.0, 200.0), (250.0, 60.0, 420.0, 330.0), (330.0, 200.0, 600.0, 400.0)]


def window_of(item: Box, drawn: Box, blur_px: float = 2.0) -> np.ndarray:
    """What a perfect outliner sees of an object in the window of the box that was drawn for it."""
    x, y = np.arange(PHOTO[1]) + 0.5, np.arange(PHOTO[0]) + 0.5
    inside = np.minimum.outer(np.minimum(y - item[1], item[3] - y), np.minimum(x - item[0], item[2] - x))
    return resample(np.clip(0.5 + inside / (2.0 * blur_px), 0.0, 1.0).astype(np.float32), drawn)


def roughly(item: Box, rng: np.random.Generator, share: float) -> Box:
    sides = np.tile([item[2] - item[0], item[3] - item[1]], 2)
    a, b, c, d = (float(v) for v in np.array(item) + share * sides * rng.standard_normal(4))
    return a, b, c, d


def off(boxes: list[Box]) -> float:
    return float(np.abs(np.array(boxes) - np.array(OBJECTS)).mean())


def test_boxes_that_were_drawn_exactly_stay() -> None:
    windows = [window_of(item, item) for item in OBJECTS]
    np.testing.assert_allclose(ends_of_objects(OBJECTS, windows, PHOTO), OBJECTS, atol=0.3)


@pytest.mark.parametrize("seed", range(5))
def test_roughly_drawn_boxes_come_to_the_outlines(seed: int) -> None:
    rng = np.random.default_rng(seed)
    drawn = [roughly(item, rng, 0.05) for item in OBJECTS]
    windows = [window_of(item, box) for item, box in zip(OBJECTS, drawn, strict=True)]
    assert off(ends_of_objects(drawn, windows, PHOTO)) < 0.6 * off(drawn)


def test_a_box_that_is_drawn_alone_is_taken_as_it_is() -> None:
    drawn = [roughly(OBJECTS[0], np.random.default_rng(0), 0.08)]
    assert ends_of_objects(drawn, [window_of(OBJECTS[0], drawn[0])], PHOTO) == drawn


def test_unsure_outlines_move_a_box_less() -> None:
    drawn = [(x1 + 12.0, y1 - 10.0, x2 - 10.0, y2 + 12.0) for x1, y1, x2, y2 in OBJECTS]
    sharp, soft = (
        ends_of_objects(drawn, [window_of(i, b, blur) for i, b in zip(OBJECTS, drawn, strict=True)], PHOTO)
        for blur in (2.0, 25.0)
    )
    assert off(sharp) < off(soft) <= off(drawn)


def test_what_goes_on_beyond_its_window_or_is_not_seen_keeps_its_box() -> None:
    everywhere, nowhere = np.ones((SIDE, SIDE), np.float32), np.zeros((SIDE, SIDE), np.float32)
    np.testing.assert_allclose(ends_of_objects(OBJECTS, [everywhere, nowhere, everywhere], PHOTO), OBJECTS)


def test_an_edge_at_the_border_of_the_photo_stays_there() -> None:
    drawn, ends = [(0.0, 100.0, 150.0, 220.0), *OBJECTS], [(20.0, 90.0, 160.0, 210.0), *OBJECTS]
    moved = ends_of_objects(drawn, [window_of(item, box) for item, box in zip(ends, drawn, strict=True)], PHOTO)
    assert moved[0][0] == 0.0


def test_what_the_border_of_the_photo_cuts_ends_there_however_roughly_it_was_drawn() -> None:
    items = [(300.0, 200.0, 500.0, 480.0), *OBJECTS]
    drawn: list[Box] = [(310.0, 188.0, 492.0, 466.0), *((a + 6.0, b - 6.0, c - 8.0, d + 8.0) for a, b, c, d in OBJECTS)]
    moved = ends_of_objects(drawn, [window_of(i, box) for i, box in zip(items, drawn, strict=True)], PHOTO)
    assert moved[0][3] == PHOTO[0]


def test_no_box_is_moved_farther_than_its_window() -> None:
    rng = np.random.default_rng(3)
    windows = [rng.random((SIDE, SIDE)).astype(np.float32) for _ in OBJECTS]
    moved, drawn = np.array(ends_of_objects(OBJECTS, windows, PHOTO)), np.array(OBJECTS)
    assert (np.abs(moved - drawn) <= MARGIN * np.tile(drawn[:, 2:] - drawn[:, :2], 2) + 1e-6).all()
    assert ends_of_objects([], [], PHOTO) == []


def test_the_drawn_box_of_an_object_is_the_one_that_overlaps_it_most() -> None:
    boxes = [LabelledBox(box, "chair", "chair") for box in OBJECTS]
    assert find_drawn_box(boxes, (255.0, 64.0, 410.0, 335.0)) is boxes[1]
    assert find_drawn_box(boxes, (0.0, 0.0, 10.0, 10.0)) is None
    assert find_drawn_box([], OBJECTS[0]) is None
