"""How much of a footprint has room on a support."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.layout.feasible.footprints import largest_share

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
