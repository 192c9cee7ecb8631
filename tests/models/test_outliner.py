"""The outliner's windows lie where the photo says, and its weights find what stands in a box."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import UnavailableError
from diorama_core.models.outliner import SIDE, BoxOutliner, own_outliner, pixels_of, resample, warp_to_photo, window

SIDES = st.floats(0.02, 1.0)


@given(st.floats(-0.2, 0.9), st.floats(-0.2, 0.9), SIDES, SIDES)
def test_a_windows_numbers_return_to_their_places(x: float, y: float, w: float, h: float) -> None:
    """What is smooth in the photo is the same after the way into the window and back, wherever the photo has it."""
    shape = (120, 160)
    box = (160 * x, 120 * y, 160 * (x + w), 120 * (y + h))
    rows, columns = np.mgrid[: shape[0], : shape[1]].astype(np.float32)
    smooth = np.cos(columns / 160) + np.sin(rows / 120)
    rows_in, columns_in = pixels_of(box, shape)
    back = warp_to_photo(resample(smooth, box), box, box, shape)
    there = smooth[rows_in, columns_in]
    assert back.shape == there.shape
    cell = 1.5 * max(box[2] - box[0], box[3] - box[1], 1.0) / SIDE
    far = slice(int(2 * cell) + 1, -(int(2 * cell) + 1))  # cells at the photo's edge mix with nothing
    np.testing.assert_allclose(back[far, far], there[far, far], atol=0.03)


def test_outside_the_photo_a_window_is_grey_and_says_so() -> None:
    rgb = np.full((50, 60, 3), 200, np.uint8)
    seen = window(rgb, (-30.0, 10.0, 20.0, 40.0))
    assert seen.shape == (4, SIDE, SIDE)
    assert (seen[3, :, 0] == 0).all()
    assert (seen[3, SIDE // 2, -SIDE // 4 :] == 1).all()
    np.testing.assert_allclose(seen[:3, :, 0], 114 / 255, atol=1e-6)


@pytest.mark.parametrize("box", [(5.0, 5.0, 5.0, 5.0), (-9.0, -9.0, -2.0, -2.0), (70.0, 60.0, 90.0, 80.0)])
def test_boxes_beyond_the_photo_have_a_pixel(box: tuple[float, float, float, float]) -> None:
    (found,) = own_outliner().outlines(np.zeros((50, 60, 3), np.uint8), [box])
    assert found.size >= 1
    assert np.isfinite(found).all()


def test_the_weights_outline_a_chair_like_thing_better_than_its_box() -> None:
    """Two legs and a seat before a wall: the space between the legs is not the object's."""
    rgb = np.full((240, 320, 3), (205, 200, 190), np.uint8)
    mine = np.zeros((240, 320), bool)
    mine[60:130, 120:130] = mine[120:134, 120:200] = mine[130:200, 120:128] = mine[130:200, 192:200] = True
    rgb[mine] = (95, 60, 30)
    box = (120.0, 60.0, 200.0, 200.0)
    (found,) = own_outliner().outlines(rgb, [box])
    part = mine[pixels_of(box, mine.shape)]
    share = (found > 0.5)[part].mean() - (found > 0.5)[~part].mean()
    assert share > 0.5


def test_many_boxes_are_outlined_as_each_alone(rng: np.random.Generator) -> None:
    rgb = rng.integers(0, 255, (90, 120, 3)).astype(np.uint8)
    boxes = [(3.0 * k, 2.0 * k, 3.0 * k + 40, 2.0 * k + 30) for k in range(20)]
    together = own_outliner().outlines(rgb, boxes)
    for box, found in zip(boxes, together, strict=True):
        np.testing.assert_allclose(found, own_outliner().outlines(rgb, [box])[0], atol=1e-4)


def test_missing_weights_are_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(UnavailableError, match="restore it from the repository"):
        BoxOutliner.of(tmp_path)
