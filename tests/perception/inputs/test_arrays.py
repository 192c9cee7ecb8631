from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import InputError
from diorama_core.perception.inputs import arrays as input_arrays
from diorama_core.perception.inputs import read_inputs

SIZE = (60, 80)


@pytest.fixture
def picture(rng: np.random.Generator) -> input_arrays.Picture:
    return rng.integers(0, 256, (*SIZE, 3), dtype=np.uint8)


def test_arrays_arrive_as_they_were_given(picture: input_arrays.Picture, rng: np.random.Generator) -> None:
    depth = rng.uniform(1.0, 4.0, SIZE).astype(np.float32)
    depth[:5], depth[5:10] = 0.0, np.nan
    masks = np.zeros(SIZE, int)
    masks[10:40, 10:30], masks[20:50, 40:70] = 3, 700
    read = read_inputs(
        input_arrays.photo_file(picture),
        depth=input_arrays.depth_file(depth),
        masks=input_arrays.masks_file(masks),
    ).inputs
    assert np.array_equal(read.photo.rgb, picture)
    assert np.array_equal(read.depth_m, np.nan_to_num(depth))
    for instance in (3, 700):
        assert len(np.unique(read.instances[masks == instance])) == 1
    assert np.array_equal(read.instances > 0, masks > 0)


def test_boxes_may_hold_numpy_s_numbers(picture: input_arrays.Picture) -> None:
    boxes = [
        {"bbox": np.array([4, 5, 40, 50]), "class": "chair"},
        {"bbox": [np.float32(1), 2, 30, 40], "class": "sofa"},
    ]
    read = read_inputs(input_arrays.photo_file(picture), boxes=input_arrays.boxes_file(boxes)).inputs
    assert [(b.box, b.category) for b in read.boxes] == [((4, 5, 40, 50), "chair"), ((1, 2, 30, 40), "sofa")]


def test_paths_and_contents_pass_unchanged(tmp_path: Path) -> None:
    for function in (
        input_arrays.photo_file,
        input_arrays.masks_file,
        input_arrays.depth_file,
        input_arrays.boxes_file,
    ):
        assert function(str(tmp_path)) == tmp_path
        assert function(b"content") == b"content"


@pytest.mark.unchecked  # hands over arrays of wrong types on purpose
def test_what_is_not_an_input_is_one_clear_line() -> None:
    with pytest.raises(InputError, match=r"photo: float64 .* is not a picture; give an array of h x w x 3 of uint8"):
        input_arrays.photo_file(np.zeros((40, 40, 3)))
    with pytest.raises(InputError, match="masks: give an array of integer ids"):
        input_arrays.masks_file(np.full(SIZE, -1))
    with pytest.raises(InputError, match=r"boxes: .*give dictionaries"):
        input_arrays.boxes_file([{"bbox": object()}])
