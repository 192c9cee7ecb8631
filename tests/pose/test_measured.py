"""A pose is told by the walls that were measured around its object."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.arrangement.facing.evidence import WallSamples
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.pose.depth_fit import SeenPoints
from diorama_core.pose.measured import WallBounds
from diorama_core.scene.types import yaw_rotation

SIZE_M = np.array([2.0, 1.0, 0.5])


def wall(at_x: float = 0.0, length_m: float = 4.0) -> WallSamples:
    """A wall across x whose room is on the side of larger x."""
    y = np.linspace(-length_m / 2, length_m / 2, 200)
    return WallSamples(np.column_stack([np.full_like(y, at_x), y]), np.tile([1.0, 0.0], (200, 1)))


def points(x: float) -> SeenPoints:
    y = np.linspace(-0.3, 0.3, 50)
    at = np.column_stack([np.full_like(y, x), y, np.full_like(y, 0.3)])
    return SeenPoints(np.tile([-1.0, 0.0, 0.0], (50, 1)), at, np.full(50, 3.0), np.full(50, 0.01))


def poses(x: float, degrees: float = 0.0, y: float = 0.0) -> PoseBatch:
    return PoseBatch(yaw_rotation(np.deg2rad(degrees))[None], np.array([[x, y, 0.25]]), np.ones((1, 3)))


@given(st.floats(-0.5, 3.0))
def test_what_reaches_through_a_wall_is_as_deep_as_its_farthest_corner(x: float) -> None:
    bounds = WallBounds.of(wall(), points(1.5))
    assert bounds.penetration_m(poses(x), SIZE_M)[0] == pytest.approx(max(1.0 - x, 0.0), abs=1e-9)


def test_turned_by_a_quarter_it_fits() -> None:
    bounds = WallBounds.of(wall(), points(0.9))
    along, across = (bounds.log_likelihood(poses(0.55, degrees), SIZE_M)[0] for degrees in (90.0, 0.0))
    assert along == 0.0
    assert across < -4.0


def test_a_surface_that_the_object_was_seen_behind_does_not_bound_it() -> None:
    bounds = WallBounds.of(wall(1.2), points(0.9))
    assert bounds.penetration_m(poses(0.6), SIZE_M)[0] == 0.0


def test_beyond_its_ends_a_wall_bounds_nothing() -> None:
    bounds = WallBounds.of(wall(length_m=1.0), points(0.9))
    assert bounds.penetration_m(poses(0.6, y=2.5), SIZE_M)[0] == 0.0
    assert bounds.penetration_m(poses(0.6), SIZE_M)[0] > 0.3


def test_without_walls_nothing_is_said() -> None:
    nothing = WallSamples(np.zeros((0, 2)), np.zeros((0, 2)))
    assert WallBounds.of(nothing, points(0.9)).log_likelihood(poses(0.0), SIZE_M)[0] == 0.0
