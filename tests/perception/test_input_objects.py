"""Boxes and masks, each rule by itself, then whole files as people hand them in."""

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
from diorama_core.perception.inputs import read_inputs
from tests.perception.input_files import HEIGHT, WIDTH, box, boxes_json, encoded, picture, refusal

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


class TestBoxes:
    photo = encoded(picture())

    def test_classes_are_understood_and_words_retained(self) -> None:
        given = boxes_json(
            box(1, 1, 20, 20, word="night_stand"),
            box(1, 1, 20, 20, word="couches"),
            box(1, 1, 20, 20, word="void"),
            box(1, 1, 20, 20, word="zorgblatt"),
        )
        read = read_inputs(self.photo, boxes=given)
        assert [b.category for b in read.inputs.boxes] == ["night stand", "sofa", "object", "object"]
        assert [b.label for b in read.inputs.boxes] == ["night stand", "couches", "object", "zorgblatt"]
        assert any("zorgblatt" in w for w in read.warnings)

    def test_the_room_itself_is_no_object(self) -> None:
        read = read_inputs(self.photo, boxes=boxes_json(box(1, 1, 20, 20, word="Wall"), box(1, 1, 20, 20)))
        assert len(read.inputs.boxes) == 1
        assert any("Wall" in w for w in read.warnings)

    def test_partly_outside_is_clipped_and_said(self) -> None:
        read = read_inputs(self.photo, boxes=boxes_json(box(-30, 10, 40, 200)))
        assert read.inputs.boxes[0].box == (0, 10, 40, HEIGHT)
        assert any("clipped" in w for w in read.warnings)

    def test_a_pixel_over_the_edge_is_not_worth_a_word(self) -> None:
        assert read_inputs(self.photo, boxes=boxes_json(box(0, 0, WIDTH + 1, 20))).warnings == ()

    @pytest.mark.parametrize(
        ("data", "word"),
        [
            (boxes_json(box(1, 1, 20, 20), box(200, 10, 300, 40)), "box 1"),
            (boxes_json(box(20, 1, 5, 20)), "box 0"),
            (boxes_json(box(5, 5, 5, 5)), "no area"),
            (b"[{", "not valid JSON"),
            (b"", "0 bytes"),
            (b"\xff\xfe\x00", "no text"),
            (b'{"bbox": [1, 2, 3, 4]}', "list"),
            (boxes_json({"bbox": [1, 2, 3]}), "entry 0"),
            (boxes_json({"bbox": [1, 2, 3, "x"]}), "entry 0"),
            (boxes_json({"class": "chair"}), "entry 0"),
            (b'[{"bbox": [NaN, 1, 20, 20]}]', "NaN is no number"),
            (b'[{"bbox": [1e999, 1, 20, 20]}]', "too large"),
            (b'[{"bbox": [1e30, 1, 20, 20]}]', "entry 0"),
            (b'[{"bbox": [1, 1, 20, 20], "class": "\\ud800"}]', "no text"),
            (b"[" * 100_000, "nested"),
            (b"[" + b"1," * 3_000_000 + b"1]", "more than 500 boxes take"),
            (b'[{"bbox": [1, 1, 20, 20], "class": 7}]', "entry 0"),
            (boxes_json(*[box(1, 1, 20, 20)] * 501), "501"),
        ],
    )
    def test_refused_in_one_line(self, data: bytes, word: str) -> None:
        assert word in refusal(self.photo, boxes=data)

    def test_words_cannot_break_a_line(self) -> None:
        read = read_inputs(self.photo, boxes=boxes_json(box(1, 1, 20, 20, word="  big\n\tred\x00 chair ")))
        assert read.inputs.boxes[0].label == "big red chair"

    @given(st.lists(st.floats(-500, 500), min_size=4, max_size=4))
    def test_every_box_is_inside_or_refused(self, bbox: list[float]) -> None:
        try:
            boxes = read_inputs(self.photo, boxes=boxes_json(box(*bbox))).inputs.boxes
        except InputError:
            return
        x1, y1, x2, y2 = boxes[0].box
        assert 0 <= x1 < x2 <= WIDTH
        assert 0 <= y1 < y2 <= HEIGHT


class TestMasks:
    photo = encoded(picture())

    def colours(self, *, speck: bool = False) -> Image.Image:
        pixels = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
        pixels[10:50, 5:60] = (200, 30, 30)
        pixels[20:30, 20:35] = (30, 200, 30)
        if speck:
            pixels[60, 90] = (1, 2, 3)
            pixels[2, 2] = (200, 30, 30)
        return Image.fromarray(pixels)

    def test_colours_are_numbered_from_the_top_left(self) -> None:
        inputs = read_inputs(self.photo, masks=encoded(self.colours())).inputs
        assert inputs.instances is not None
        assert inputs.instances[12, 10] == 1
        assert inputs.instances[25, 25] == 2
        assert inputs.instances[0, 0] == 0
        assert [(k, b.category) for k, b in inputs.instance_boxes] == [(1, "object"), (2, "object")]
        assert inputs.instance_boxes[1][1].box == (20, 20, 35, 30)

    def test_ids_palettes_and_colours_agree(self) -> None:
        ids = np.zeros((HEIGHT, WIDTH), np.uint8)
        ids[10:50, 5:60], ids[20:30, 20:35] = 7, 9
        palette = Image.fromarray(ids)
        palette.putpalette([*range(256)] * 3)
        expected = read_inputs(self.photo, masks=encoded(self.colours())).inputs.instances
        for image in (Image.fromarray(ids), palette, Image.fromarray(ids.astype(np.uint16) * 257)):
            np.testing.assert_array_equal(read_inputs(self.photo, masks=encoded(image)).inputs.instances, expected)

    def test_class_of_the_box_that_fits_best(self) -> None:
        given = boxes_json(box(20, 19, 36, 31, word="pillow"), box(4, 9, 61, 51, word="sofa"))
        inputs = read_inputs(self.photo, masks=encoded(self.colours()), boxes=given).inputs
        assert [(k, b.category) for k, b in inputs.instance_boxes] == [(1, "sofa"), (2, "pillow")]
        assert inputs.instance_boxes[0][1] is inputs.boxes[1]

    def test_two_masks_of_one_box_keep_their_own_extents(self) -> None:
        inputs = read_inputs(
            self.photo, masks=encoded(self.colours()), boxes=boxes_json(box(4, 9, 61, 51, word="sofa"))
        ).inputs
        assert [b.category for _, b in inputs.instance_boxes] == ["sofa", "sofa"]
        assert inputs.instance_boxes[0][1].box == (4, 9, 61, 51)
        assert inputs.instance_boxes[1][1].box == (20, 20, 35, 30)

    def test_specks_are_dropped_and_said(self) -> None:
        read = read_inputs(self.photo, masks=encoded(self.colours(speck=True)))
        clean = read_inputs(self.photo, masks=encoded(self.colours()))
        np.testing.assert_array_equal(read.inputs.instances, clean.inputs.instances)
        assert any("specks" in w for w in read.warnings)

    def test_reduced_with_the_photo(self) -> None:
        large = encoded(picture(WIDTH * 4, HEIGHT * 4))
        mask = encoded(self.colours().resize((WIDTH * 4, HEIGHT * 4), Image.Resampling.NEAREST))
        small = read_inputs(large, masks=mask, max_side=WIDTH).inputs.instances
        expected = read_inputs(self.photo, masks=encoded(self.colours())).inputs.instances
        np.testing.assert_array_equal(small, expected)

    @pytest.mark.parametrize(
        ("data", "word"),
        [
            (encoded(Image.new("RGB", (WIDTH, HEIGHT))), "no object"),
            (encoded(picture()), "instance mask"),
            (encoded(picture(), "JPEG"), "PNG"),
            (encoded(picture(64, 64)), "64 x 64"),
            (b"nothing", "not a picture"),
        ],
    )
    def test_refused_in_one_line(self, data: bytes, word: str) -> None:
        assert word in refusal(self.photo, masks=data)
