"""How objects are turned on what holds them up. How much of a footprint has room on a support."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.arrangement.surfaces import RestingSurface
from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.layout.feasible.rest import align, largest_share, swing

directions = st.tuples(*(st.floats(-1.0, 1.0) for _ in range(3))).filter(lambda v: np.linalg.norm(v) > 0.1)
BACK, BOTTOM = np.array([-1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])


def unit(v: tuple[float, ...]) -> np.ndarray:
    return np.asarray(v) / np.linalg.norm(v)


def level() -> RestingSurface:
    square = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
    return RestingSurface.of(square, np.array([0.0, 0.0, 1.0]), np.inf, of_plane=True)


@given(directions, directions)
def test_a_swing_takes_one_direction_to_the_other_and_is_a_rotation(a, b):
    R = swing(unit(a), unit(b))
    np.testing.assert_allclose(R @ unit(a), unit(b), atol=1e-6)
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-6)
    assert np.linalg.det(R) == pytest.approx(1.0)


@given(directions)
def test_opposite_directions_swing_by_half_a_turn(a):
    R = swing(unit(a), -unit(a))
    np.testing.assert_allclose(R @ unit(a), -unit(a), atol=1e-6)
    assert np.trace(R) == pytest.approx(-1.0, abs=1e-6)


@pytest.mark.parametrize("yaw", [0.0, 0.7, 2.5, -1.8])
def test_what_leans_stands_upright_and_looks_where_it_looked(yaw):
    seen = rotation_from_vector(np.array([0.0, 0.0, yaw])) @ swing(np.array([0.0, 0.0, 1.0]), unit((0.0, 0.1, 1.0)))
    R = align(seen, BOTTOM, level(), [])
    np.testing.assert_allclose(R @ BOTTOM, BOTTOM, atol=1e-9)
    assert float(R[:2, 0] @ seen[:2, 0]) / np.linalg.norm(seen[:2, 0]) == pytest.approx(1.0, abs=0.01)


def test_what_stands_against_a_wall_turns_its_face_to_it():
    wall = unit((1.0, 0.2, 0.0))
    R = align(rotation_from_vector(np.array([0.0, 0.0, 0.9])), BOTTOM, level(), [(wall, BACK)])
    np.testing.assert_allclose(R @ BACK, -wall, atol=1e-9)


SIDES = np.array([[1.0, 0, 0], [0, 1.0, 0], [-1.0, 0, 0], [0, -1.0, 0]])


def share(width: float, depth: float, own: tuple[float, float]) -> float:
    """Share of a footprint of half extents `own` on a table of the given half extents."""
    return largest_share(SIDES, np.array([width, depth, width, depth]), np.array([*own, *own]))


def test_what_fits_is_whole():
    assert share(0.5, 0.3, (0.4, 0.2)) == 1.0


@given(st.floats(0.1, 1.0), st.floats(0.1, 1.0), st.floats(1.1, 4.0))
def test_what_is_too_large_is_shrunk_to_the_tightest_side(width, depth, times):
    assert share(width, depth, (times * width, 0.5 * depth)) == pytest.approx(1 / times, abs=0.01)


def test_many_sides_are_as_few():
    angles = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    m = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(16)])
    found = largest_share(m, np.full(16, 0.5), np.full(16, 1.0))
    assert found == pytest.approx(0.5, abs=0.01)
