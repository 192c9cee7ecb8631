"""Edges in the picture tell which way a case stands."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.perception.metrology.drawn_edges import DrawnEdges
from diorama_core.perception.metrology.problem import Cuboids, View
from tests.perception.metrology.test_metrology import K, rotation

HEIGHT_M = 1.5
VIEW = View(K, rotation(12.0))
LONG = (np.array([1.1, 3.2, 0.4]), np.array([0.45, 1.6, 0.8]))
"""Along the line of sight, at the right."""
BANDS_M = 0.16


def drawn(centre: np.ndarray, size: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The picture of a case with level boards, and its mask."""
    v, u = np.mgrid[: K.height, : K.width] + 0.5
    rays = np.stack([(u - K.cx) / K.fx, (v - K.cy) / K.fy, np.ones_like(u)], axis=-1) @ VIEW.R_world_camera.T
    eye = np.array([0.0, 0.0, HEIGHT_M])
    bounds = np.stack([(centre + sign * size / 2 - eye) / rays for sign in (-1.0, 1.0)])
    enter, leave = bounds.min(axis=0).max(axis=-1), bounds.max(axis=0).min(axis=-1)
    mask = (enter < leave) & (enter > 0)
    height = HEIGHT_M + enter * rays[..., 2]
    grey = np.where(mask, np.where(np.floor(height / BANDS_M) % 2 == 0, 60, 190), 128).astype(np.uint8)
    return np.repeat(grey[..., None], 3, axis=2), mask


def readings(*sizes: np.ndarray) -> Cuboids:
    return Cuboids(np.tile(LONG[0], (len(sizes), 1)), np.zeros(len(sizes)), np.stack(sizes))


def test_the_long_case_is_told_from_one_that_shows_its_front() -> None:
    edges = DrawnEdges.of(*drawn(*LONG))
    wide = np.array([1.6, 0.45, 0.8])
    right, wrong = edges.costs(readings(LONG[1], wide), HEIGHT_M, VIEW)
    assert len(edges.pixels) > 500
    assert right < wrong - 2.0


def test_a_turned_case_does_not_fit_the_edges_of_a_straight_one() -> None:
    edges = DrawnEdges.of(*drawn(*LONG))
    turned = Cuboids(np.tile(LONG[0], (2, 1)), np.deg2rad([0.0, 35.0]), np.tile(LONG[1], (2, 1)))
    right, wrong = edges.costs(turned, HEIGHT_M, VIEW)
    assert right < wrong - 2.0


@pytest.mark.parametrize("filled", [False, True])
def test_plain_and_empty_things_tell_nothing(filled: bool) -> None:
    mask = np.zeros((K.height, K.width), bool)
    mask[200:300, 300:400] = filled
    edges = DrawnEdges.of(np.full((*mask.shape, 3), 128, np.uint8), mask)
    np.testing.assert_array_equal(edges.costs(readings(LONG[1], LONG[1][::-1]), HEIGHT_M, VIEW), 0.0)
