"""Boxes of copies and of unturned pixels are laid over the photo, by what the file states or the picture shows."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import LabelledBox, Photo
from diorama_core.errors import InputError
from diorama_core.perception.inputs.boxes.agreement import EdgeMap, is_upside_down
from diorama_core.perception.inputs.boxes.entry import BoxEntry, BoxFile
from diorama_core.perception.inputs.boxes.placing import place_boxes
from diorama_core.perception.inputs.photos.frame import PhotoFrame
from diorama_core.perception.inputs.photos.reading import DecodedPhoto

WIDTH, HEIGHT = 480, 360
THINGS = [(40, 50, 140, 200), (180, 90, 300, 330), (330, 30, 450, 160), (350, 200, 420, 340), (60, 230, 150, 320)]


def painted(orientation: int = 1) -> DecodedPhoto:
    rgb = np.random.default_rng(3).integers(110, 140, (HEIGHT, WIDTH, 3)).astype(np.uint8)
    for number, (x1, y1, x2, y2) in enumerate(THINGS):
        rgb[y1:y2, x1:x2] = (40 * number, 200 - 30 * number, 60)
    return DecodedPhoto(Photo(rgb, "p.png", (WIDTH, HEIGHT)), PhotoFrame((WIDTH, HEIGHT), orientation=orientation))


def file_of(boxes, **about) -> BoxFile:
    return BoxFile(tuple(BoxEntry(tuple(map(float, b))) for b in boxes), **about)


def test_the_edges_of_the_picture_know_the_right_boxes() -> None:
    edges = EdgeMap(painted().photo.rgb)
    right = edges.agreement(THINGS)
    wrong = edges.agreement([(x1 + 13, y1 - 11, x2 + 13, y2 - 11) for x1, y1, x2, y2 in THINGS])
    assert right > wrong + 0.5


def test_right_boxes_stay_without_a_word() -> None:
    found, notes = place_boxes("b", file_of(THINGS), painted())
    assert found == THINGS
    assert notes == ()


@pytest.mark.parametrize("share", [1 / 2, 2 / 3, 320 / 480])
def test_boxes_of_a_smaller_copy_are_scaled_and_said(share: float) -> None:
    small = [tuple(share * v for v in b) for b in THINGS]
    found, notes = place_boxes("b", file_of(small), painted())
    np.testing.assert_allclose(found, THINGS, atol=2.0)
    assert f"{round(WIDTH * share)} x {round(HEIGHT * share)}" in notes[0]


def test_few_boxes_in_a_corner_are_left_and_several_are_remarked() -> None:
    plain = DecodedPhoto(
        Photo(np.full((HEIGHT, WIDTH, 3), 90, np.uint8), "p", (WIDTH, HEIGHT)), PhotoFrame((WIDTH, HEIGHT))
    )
    small = [tuple(v / 2 for v in b) for b in THINGS]
    found, notes = place_boxes("b", file_of(small), plain)
    assert found == small
    assert "may be of a smaller copy (240 x 180)" in notes[0]
    assert place_boxes("b", file_of(small[:2]), plain) == (small[:2], ())


def test_a_stated_size_scales_and_another_picture_s_is_refused() -> None:
    found, notes = place_boxes("b", file_of([(10, 10, 100, 80)], size=(240, 180)), painted())
    assert found == [(20, 20, 200, 160)]
    assert "copy of 240 x 180" in notes[0]
    with pytest.raises(InputError, match="of a picture of 300 x 300"):
        place_boxes("b", file_of([(10, 10, 100, 80)], size=(300, 300)), painted())


@pytest.mark.parametrize("orientation", range(2, 9))
def test_boxes_of_unturned_pixels_are_turned(orientation: int) -> None:
    photo = painted(orientation)
    stored = _stored_boxes(photo.frame)
    found, notes = place_boxes("b", file_of(stored), photo)
    np.testing.assert_allclose(found, THINGS)
    assert f"orientation {orientation}" in notes[0]


def _stored_boxes(frame: PhotoFrame) -> list[tuple[float, float, float, float]]:
    """Where the things are in the stored pixels, found by turning a map of their numbers."""
    width, height = frame.stored_size
    numbers = np.arange(width * height).reshape(height, width)
    upright = frame.upright(numbers)
    boxes = []
    for x1, y1, x2, y2 in THINGS:
        inside = upright[y1:y2, x1:x2]
        rows, columns = inside // width, inside % width
        boxes.append((columns.min(), rows.min(), columns.max() + 1, rows.max() + 1))
    return boxes


def test_shares_percent_and_sizes_are_seen() -> None:
    photo = painted()
    shares = [(x1 / WIDTH, y1 / HEIGHT, x2 / WIDTH, y2 / HEIGHT) for x1, y1, x2, y2 in THINGS]
    found, notes = place_boxes("b", file_of(shares), photo)
    np.testing.assert_allclose(found, THINGS)
    assert "shares" in notes[0]
    found, notes = place_boxes("b", file_of([tuple(100 * v for v in b) for b in shares]), photo)
    np.testing.assert_allclose(found, THINGS)
    assert "percent" in notes[0]
    sized = [(x1, y1, x2 - x1, y2 - y1) for x1, y1, x2, y2 in THINGS]
    found, notes = place_boxes("b", file_of(sized, ambiguous_layout=True), photo)
    np.testing.assert_allclose(found, THINGS)
    assert "width, height" in notes[0]


def test_things_say_that_a_photo_is_upside_down() -> None:
    usual = [("ceiling lamp", 10, 60), ("rug", 280, 340), ("chair", 180, 280), ("picture", 60, 140), ("sofa", 170, 300)]
    boxes = [LabelledBox((0.0, float(a), 50.0, float(b)), word, word) for word, a, b in usual]
    turned = [LabelledBox((0.0, HEIGHT - b.box[3], 50.0, HEIGHT - b.box[1]), b.category, b.label) for b in boxes]
    assert not is_upside_down(boxes, HEIGHT)
    assert is_upside_down(turned, HEIGHT)
    assert not is_upside_down(turned[2:3], HEIGHT)


def test_boxes_that_fit_the_photo_are_of_no_larger_copy() -> None:
    grey = np.full((HEIGHT, WIDTH, 3), 128, np.uint8)
    blank = DecodedPhoto(Photo(grey, "p.png", (WIDTH, HEIGHT)), PhotoFrame((WIDTH, HEIGHT)))
    for photo in (painted(), blank):
        inset = [(x1 + 7, y1 + 9, x2 - 11, y2 - 5) for x1, y1, x2, y2 in THINGS]
        corners, notes = place_boxes("boxes", file_of(inset), photo)
        assert corners == [tuple(map(float, b)) for b in inset]
        assert notes == ()
