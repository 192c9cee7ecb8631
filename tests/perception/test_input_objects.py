"""Boxes and masks, each rule by itself; the whole of it is in `test_inputs`."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import InputError
from diorama_core.perception.input_objects import match_instances, read_boxes, read_masks, understood
from diorama_core.perception.input_photo import Source
from tests.perception.test_inputs import box, boxes_json, encoded

SIZE = (96, 64)


def boxes(*records, original=SIZE, photo=SIZE):
    return read_boxes(Source(boxes_json(*records), "boxes.json"), original, photo)


def masks(values: np.ndarray, given=(), size=SIZE, fmt: str = "PNG"):
    return read_masks(Source(encoded(Image.fromarray(values), fmt), "masks.png"), tuple(given), size)


def test_boxes_are_scaled_with_the_photo() -> None:
    (found,), notes = boxes(box(100, 80, 400, 240), original=(960, 640))
    assert found.box == pytest.approx((10, 8, 40, 24))
    assert (found.category, found.label, found.score, notes) == ("chair", "chair", 1.0, ())


def test_parts_of_the_room_are_left_out_and_far_boxes_clipped_with_a_note() -> None:
    found, notes = boxes(box(0, 0, 90, 60, word="wall"), box(-30, 5, 40, 200, word="night_stand"))
    assert [b.box for b in found] == [(0, 5, 40, 64)]
    assert found[0].label == "night stand"
    assert "part of the room itself" in notes[0]
    assert "was clipped" in notes[1]


@pytest.mark.parametrize(
    ("bbox", "reason"),
    [((10, 10, 10, 40), "has no area"), ((40, 10, 10, 40), "has no area"), ((200, 10, 300, 40), "outside the picture")],
)
def test_impossible_boxes_are_named_by_number(bbox, reason) -> None:
    with pytest.raises(InputError, match=f"box 1 .*{reason}"):
        boxes(box(10, 10, 40, 40), box(*bbox))


@pytest.mark.parametrize(
    "data", [b"{", b'{"bbox": [1,2,3,4]}', b'[{"bbox": [1,2,3]}]', b'[{"bbox": [1,2,3,"NaN"]}]', b'[{"class": "x"}]']
)
def test_what_is_no_list_of_boxes_is_refused_with_an_example(data: bytes) -> None:
    with pytest.raises(InputError, match="boxes are a JSON list"):
        read_boxes(Source(data, "boxes.json"), SIZE, SIZE)


def test_unknown_words_are_understood_as_the_nearest_and_said() -> None:
    category, label, note = understood("armchiar")
    assert (category, label) == ("armchair", "armchiar")
    assert "armchair" in note
    assert understood("object")[1:] == ("object", "")


def painted(*areas: tuple[int, int, int, int, int]) -> np.ndarray:
    """Ids in rectangles: id, x1, y1, x2, y2."""
    values = np.zeros((64, 96), np.uint8)
    for number, x1, y1, x2, y2 in areas:
        values[y1:y2, x1:x2] = number
    return values


def test_instances_are_numbered_from_the_top_left_and_specks_dropped() -> None:
    values = painted((200, 50, 2, 90, 30), (7, 5, 20, 40, 60), (9, 90, 60, 93, 62))
    found, matched, notes = masks(values)
    assert found[10, 60] == 1
    assert found[40, 20] == 2
    assert found[61, 91] == 0
    assert notes == ("1 specks of the masks were dropped",)
    assert [(k, b.category, b.box) for k, b in matched] == [
        (1, "object", (50, 2, 90, 30)),
        (2, "object", (5, 20, 40, 60)),
    ]


def test_colours_and_transparency_are_ids_too() -> None:
    rgba = np.zeros((64, 96, 4), np.uint8)
    rgba[5:30, 5:40] = (255, 0, 0, 255)
    rgba[5:30, 50:90] = (254, 0, 0, 255)
    rgba[40:60, 5:40] = (0, 255, 0, 10)
    found, _, _ = masks(rgba)
    assert found.max() == 2
    assert found[50, 20] == 0


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 3), st.integers(1, 3))
def test_masks_of_another_size_are_sampled_by_pixel_centres(down: int, up: int) -> None:
    small = painted((3, 24, 16, 72, 48))
    grown = np.kron(small, np.ones((up, up), np.uint8))[::1]
    found, _, _ = masks(grown)
    np.testing.assert_array_equal(found > 0, small > 0)


@pytest.mark.parametrize(
    ("values", "fmt", "reason"),
    [
        (np.zeros((64, 96), np.uint8), "PNG", "hold no object"),
        (painted((3, 10, 10, 60, 60)), "JPEG", "exact colours"),
        (np.random.default_rng(0).integers(0, 255, (64, 96, 3), dtype=np.uint8), "PNG", "no instance mask"),
        (np.ones((64, 64), np.uint8), "PNG", "give the mask of this very photo"),
    ],
)
def test_pictures_that_are_no_masks_are_refused(values, fmt, reason) -> None:
    with pytest.raises(InputError, match=reason):
        masks(values, fmt=fmt)


def test_masks_take_the_class_of_the_box_they_overlap_most() -> None:
    instances = painted((1, 10, 10, 60, 50), (2, 20, 20, 35, 30), (3, 70, 10, 90, 30)).astype(np.int32)
    sofa = LabelledBox((9.0, 9.0, 61.0, 51.0), "sofa", "sofa", 0.9)
    pillow = LabelledBox((19.0, 19.0, 36.0, 31.0), "pillow", "pillow", 0.8)
    found = dict(match_instances(instances, (pillow, sofa)))
    assert found[1] is sofa
    assert found[2] is pillow
    assert (found[3].category, found[3].box) == ("object", (70, 10, 90, 30))


def test_a_box_goes_whole_to_one_mask_only() -> None:
    instances = painted((1, 10, 10, 40, 50), (2, 42, 10, 50, 50)).astype(np.int32)
    sofa = LabelledBox((10.0, 10.0, 50.0, 50.0), "sofa", "my sofa", 0.9)
    found = dict(match_instances(instances, (sofa,)))
    assert found[1] is sofa
    assert found[2] == LabelledBox((42.0, 10.0, 50.0, 50.0), "sofa", "my sofa", 0.9)
