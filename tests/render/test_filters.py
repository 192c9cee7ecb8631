from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.render.filters import Neighbours, as_bytes, tone_mapped
from diorama_core.render.lighting import TILE


def flat(height: int = 12, width: int = 16) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points a centimetre apart on one plane."""
    y, x = np.mgrid[:height, :width].astype(np.float32) * 0.01
    points = np.stack([x, y, np.zeros_like(x)], axis=-1)
    normals = np.zeros_like(points)
    normals[..., 2] = 1.0
    return points, normals, np.ones((height, width), dtype=bool), np.full((height, width), 1e-3, np.float32)


def test_on_one_plane_the_mean_is_that_of_a_whole_tile() -> None:
    neighbours = Neighbours.of(*flat())
    rng = np.random.default_rng(0)
    tile = rng.random((TILE, TILE, 3)).astype(np.float32)
    interleaved = np.tile(tile, (3, 4, 1))
    inside = neighbours.mean(interleaved)[2:-2, 2:-2]
    np.testing.assert_allclose(inside, np.broadcast_to(tile.mean(axis=(0, 1)), inside.shape), rtol=1e-5)


def test_light_does_not_cross_an_edge_a_step_or_a_hole() -> None:
    points, normals, found, tolerance = flat()
    light = np.where(np.arange(16)[None, :, None] < 8, 1.0, 5.0) * np.ones((12, 16, 1))
    turned = normals.copy()
    turned[:, 8:] = [1.0, 0.0, 0.0]
    stepped = points.copy()
    stepped[:, 8:, 2] += 0.1
    holed = found.copy()
    holed[:, 8:] = False
    for given_points, given_normals, given_found in (
        (points, turned, found), (stepped, normals, found), (points, normals, holed)
    ):  # fmt: skip
        neighbours = Neighbours.of(given_points, given_normals, given_found, tolerance)
        np.testing.assert_allclose(neighbours.mean(light.astype(np.float32))[:, :8], 1.0, rtol=1e-5)
    together = Neighbours.of(points, normals, found, tolerance).mean(light.astype(np.float32))
    assert together[6, 7, 0] > 1.5


@given(st.lists(st.floats(0, 50), min_size=3, max_size=3))
def test_tones_rise_with_the_light_and_stay_below_one(rgb) -> None:
    radiance = np.array([rgb, np.array(rgb) * 1.1 + 1e-3])
    low, high = tone_mapped(radiance)
    assert (high > low).all() or (high >= 0.999).any()
    assert (tone_mapped(radiance) <= 1.0).all()


def test_bytes_round_and_clip() -> None:
    assert as_bytes(np.array([-0.1, 0.0, 0.5, 0.999, 1.0, 2.0])).tolist() == [0, 0, 128, 255, 255, 255]
    assert tone_mapped(np.zeros((1, 3))).max() == pytest.approx(0.0)
