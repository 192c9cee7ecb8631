"""Outlines of objects on the floor."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.editing.footprints import footprints, gaps, lie_within, overlapping, to_outline
from diorama_core.synthesis.plan import quads_overlap

numbers = st.floats(-3, 3)
boxes = st.tuples(numbers, numbers, st.floats(0.1, 2), st.floats(0.1, 2), st.floats(-4, 4))


@given(boxes, boxes)
def test_outlines_overlap_as_two_by_two(a: tuple, b: tuple) -> None:
    one, two = (footprints(np.array(x[2:4]), np.array([x[:2]]), np.array([x[4]])) for x in (a, b))
    assert bool(overlapping(one, two[0])[0]) == quads_overlap(one[0], two[0])
    gap = float(gaps(one, two[0])[0])
    assert gap == pytest.approx(float(gaps(two, one[0])[0]), abs=1e-9)
    if not overlapping(one, two[0], 0.0)[0]:
        assert gap <= np.linalg.norm(one[0].mean(0) - two[0].mean(0))


def test_outlines_stay_within_rooms_with_corners() -> None:
    room = np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4.0]])
    places = np.array([[1, 1], [3, 3], [2.0, 2.0], [0.2, 1]])
    assert lie_within(footprints(np.ones(2), places, np.zeros(4)), room).tolist() == [True, False, False, False]
    assert to_outline(np.array([[1.0, 0.5]]), room)[0] == pytest.approx(0.5)
