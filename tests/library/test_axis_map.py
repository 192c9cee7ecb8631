"""Maps of an axis: ends stay, order stays, and slopes are how much lengths grow."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.library.axis_map import AxisMap

STEPS = st.lists(st.floats(0.1, 5.0), min_size=3, max_size=3)


@given(STEPS, STEPS)
@settings(deadline=None)
def test_ends_stay_and_lengths_grow_by_the_slope(widths: list[float], grown: list[float]) -> None:
    knots = np.concatenate([[0.0], np.cumsum(widths)]) / sum(widths)
    values = np.concatenate([[0.0], np.cumsum(grown)]) / sum(grown)
    axis = AxisMap(knots, values)
    np.testing.assert_allclose(axis(np.array([0.0, 1.0])), [0.0, 1.0], atol=1e-12)
    middle = (knots[:-1] + knots[1:]) / 2
    short = np.diff(knots) / 10
    np.testing.assert_allclose(axis(middle + short) - axis(middle), axis.slope(middle) * short, atol=1e-12)
    assert (np.diff(axis(np.linspace(0, 1, 50))) > 0).all()
