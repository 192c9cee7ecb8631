"""Masks, each rule by itself, then whole files as people hand them in."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from diorama_core.artefacts import LabelledBox
from diorama_core.errors import InputError
from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.inputs.masks.reading import match_instances, read_masks
from diorama_core.perception.inputs.source import Source
from tests.perception.inputs.files import HEIGHT, WIDTH, box, boxes_json, decoded, encoded, picture, refusal

SIZE = (96, 64)


def masks(values: np.ndarray, given=(), size=SIZE, fmt: str = "PNG"):
    return read_masks(Source(encoded(Image.fromarray(values), fmt), "masks.png"), tuple(given), decoded(*size))


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


@settings(max_examples=25)
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
