"""Masks, each rule by itself, then whole files as people hand them in."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from diorama_core.artefacts import LabelledBox
from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.inputs.masks.reading import match_instances, read_masks
from diorama_core.perception.inputs.source import Source
from tests.perception.inputs.files import HEIGHT, WIDTH, decoded, encoded, picture, refusal


def masks(values: np.ndarray):
    return read_masks(Source(encoded(Image.fromarray(values)), "masks.png"), (), decoded())


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

    def colours(self) -> Image.Image:
        pixels = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
        pixels[10:50, 5:60] = (200, 30, 30)
        pixels[20:30, 20:35] = (30, 200, 30)
        return Image.fromarray(pixels)

    def test_ids_palettes_and_colours_agree(self) -> None:
        ids = np.zeros((HEIGHT, WIDTH), np.uint8)
        ids[10:50, 5:60], ids[20:30, 20:35] = 7, 9
        palette = Image.fromarray(ids)
        palette.putpalette([*range(256)] * 3)
        expected = read_inputs(self.photo, masks=encoded(self.colours())).inputs.instances
        for image in (Image.fromarray(ids), palette, Image.fromarray(ids.astype(np.uint16) * 257)):
            np.testing.assert_array_equal(read_inputs(self.photo, masks=encoded(image)).inputs.instances, expected)

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
            (encoded(Image.new("L", (64, 64), 1)), "64 x 64"),
            (encoded(Image.new("L", (64, 64), 1)), "give the mask of this very photo"),
            (b"nothing", "not a picture"),
        ],
    )
    def test_refused_in_one_line(self, data: bytes, word: str) -> None:
        assert word in refusal(self.photo, masks=data)
