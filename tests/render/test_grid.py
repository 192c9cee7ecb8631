from __future__ import annotations

import numpy as np
import pytest

from diorama_core.render.grid import Grid, bands, pixel_footprint
from diorama_core.render.raycast import OrthographicView, PinholeView
from tests.synthetic_rooms import look


@pytest.mark.parametrize(("height", "rows"), [(1, 48), (48, 48), (100, 48), (7, 3)])
def test_bands_cover_every_row_once(height: int, rows: int) -> None:
    covered = np.concatenate([np.arange(height)[band] for band in bands(height, rows)])
    np.testing.assert_array_equal(covered, np.arange(height))
    assert max(b.stop - b.start for b in bands(height, rows)) <= rows


def test_a_part_is_a_view_of_the_same_memory() -> None:
    shape = (4, 6)
    flat, deep = np.zeros(shape, np.float32), np.zeros((*shape, 3), np.float32)
    seen, nothing = np.ones(shape, dtype=bool), np.zeros(shape, dtype=bool)
    grid = Grid(seen, deep, deep.copy(), deep.copy(), np.zeros(shape, int), flat, flat.copy(), nothing)
    part = grid.part(slice(1, 3), slice(2, 5))
    assert part.points.shape == (2, 3, 3)
    part.depth[0, 0] = 7.0
    assert grid.depth[1, 2] == 7.0
    assert grid.part(slice(0, 2)).found.shape == (2, 6)


def test_a_pixels_width_grows_with_its_depth() -> None:
    camera = look(0, 0, size=(320, 240))
    depth = np.array([[1.0, 4.0]], np.float32)
    found = pixel_footprint(PinholeView(camera), depth)
    np.testing.assert_allclose(found, depth / camera.intrinsics.fx, rtol=1e-3)
    parallel = OrthographicView(camera.T_world_camera, 320, 240, 0.02)
    np.testing.assert_allclose(pixel_footprint(parallel, depth), 0.02, rtol=1e-4)
