"""Rays against bounded planes of any shape."""

from __future__ import annotations

import numpy as np

from diorama_core.geometry.casting import cast_plane
from diorama_core.geometry.planes import is_in_plane_polygon
from diorama_core.scene.types import Plane

L = Plane("l", "floor", np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0], [1, 2, 0], [0, 2, 0]], dtype=float))
DOORWAY = Plane(
    "wall",
    "wall",
    np.array([[0, 1, 0], [1, 1, 0], [1, 1, 2], [2, 1, 2], [2, 1, 0], [3, 1, 0], [3, 1, 3], [0, 1, 3]], dtype=float),
)


def test_rays_pass_where_an_l_has_nothing():
    points = np.array([[0.5, 0.5], [1.5, 0.5], [0.5, 1.5], [1.5, 1.5], [2.5, 0.5]])
    origin = np.array([0.3, 0.4, 2.0])
    rays = np.concatenate([points, np.zeros((5, 1))], axis=1) - origin
    np.testing.assert_array_equal(np.isfinite(cast_plane(origin, rays, L)), [True, True, True, False, False])


def test_rays_pass_through_a_doorway():
    origin = np.array([1.5, -1.0, 1.0])
    through, beside, above = np.array([[0.0, 2, 0], [-1.0, 2, 0], [0, 2, 1.5]])
    hits = cast_plane(origin, np.stack([through, beside, above]), DOORWAY)
    np.testing.assert_allclose(hits, [np.inf, 1.0, 1.0])


def test_every_point_of_a_grid_is_judged_as_by_its_triangles():
    grid = np.stack(np.meshgrid(np.linspace(-0.45, 2.45, 30), np.linspace(-0.45, 2.45, 30), [0.0]), axis=-1)
    x, y = grid[..., 0], grid[..., 1]
    expected = (x > 0) & (y > 0) & (x < 2) & (y < 2) & ~((x > 1) & (y > 1))
    np.testing.assert_array_equal(is_in_plane_polygon(grid, L), expected)
