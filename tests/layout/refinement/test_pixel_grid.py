from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.layout.refinement.pixel_grid import PixelGrid
from tests.layout.refinement.views import looking_down


@given(st.integers(20, 3000), st.integers(20, 3000))
def test_pixels_are_in_the_photo_and_about_so_many(width: int, height: int) -> None:
    grid = PixelGrid.of(looking_down(), width, height)
    assert 0 <= grid.rows[0] <= grid.rows[-1] < height
    assert 0 <= grid.columns[0] <= grid.columns[-1] < width
    assert max(len(grid.rows), len(grid.columns)) <= 1.5 * 320 + 1


def test_rays_go_through_the_pixels() -> None:
    grid = PixelGrid.of(looking_down(), 1280, 960)
    seen = grid.camera.project(grid.camera.position + 3.0 * grid.rays[10, 20][None])[0]
    assert seen == pytest.approx([grid.columns[20] + 0.5, grid.rows[10] + 0.5])


def test_of_masks_that_overlap_the_smaller_one_is_in_front() -> None:
    grid = PixelGrid.of(looking_down(), 320, 240)
    large, small = np.zeros((240, 320), dtype=bool), np.zeros((240, 320), dtype=bool)
    large[50:150, 50:150] = small[100:120, 100:120] = True
    labels = grid.labels([small, None, large])
    assert labels[110, 110] == 0
    assert labels[60, 60] == 2
    assert labels[0, 0] == -1


def test_a_window_contains_the_boxes_and_ends_with_the_picture() -> None:
    grid = PixelGrid.of(looking_down(), 640, 480)
    boxes = np.array([[100.0, 50.0, 200.0, 90.0], [np.nan] * 4, [590.0, 20.0, 700.0, 80.0]])
    window = grid.window(boxes)
    assert window is not None
    rows, columns = (axis[part] for axis, part in zip((grid.rows, grid.columns), window, strict=True))
    assert rows[0] <= 20
    assert rows[-1] >= 90
    assert columns[0] <= 100
    assert columns[-1] == grid.columns[-1]
    assert grid.window(np.full((2, 4), np.nan)) is None
    assert grid.window(np.array([[-90.0, -90.0, -40.0, -40.0]])) is None
