"""Circles are told from ellipses and squares."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.circle import is_circle

ANGLES = np.linspace(0.0, 2 * np.pi, 48, endpoint=False)
CIRCLE = np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])


@given(st.floats(0.01, 5.0), st.floats(0.0, np.pi), st.floats(-3.0, 3.0))
def test_a_circle_is_one_of_any_size_turn_and_place(radius: float, turn: float, x: float) -> None:
    c, s = np.cos(turn), np.sin(turn)
    assert is_circle(radius * CIRCLE @ np.array([[c, s], [-s, c]]) + [x, 1.0])


@given(st.floats(1.06, 4.0))
def test_an_ellipse_is_none(longer: float) -> None:
    assert not is_circle(CIRCLE * [longer, 1.0])


def test_squares_lines_and_few_points_are_none() -> None:
    side = np.linspace(-1.0, 1.0, 9)
    square = np.array([(x, y) for x in side for y in side])
    assert not is_circle(square)
    assert not is_circle(np.column_stack([side, side]))
    assert not is_circle(CIRCLE[::12])


@pytest.mark.parametrize("inside", [0, 40])
def test_only_the_outline_counts(inside: int) -> None:
    rng = np.random.default_rng(0)
    assert is_circle(np.concatenate([CIRCLE, rng.uniform(-0.6, 0.6, (inside, 2))]))
