"""CIEDE2000 against the published pairs (Sharma, Wu and Dalal 2005, table 1)."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.evaluation.metrics.colour import HALF_LIGHTNESS, delta_e_2000, lab_of, perceived_difference

PUBLISHED = (
    ((50.0, 2.6772, -79.7751), (50.0, 0.0, -82.7485), 2.0425),
    ((50.0, -1.3802, -84.2814), (50.0, 0.0, -82.7485), 1.0),
    ((50.0, 0.0, 0.0), (50.0, -1.0, 2.0), 2.3669),
    ((50.0, 2.49, -0.001), (50.0, -2.49, 0.0009), 7.1792),
    ((50.0, 2.5, 0.0), (73.0, 25.0, -18.0), 27.1492),
    ((50.0, 2.5, 0.0), (58.0, 24.0, 15.0), 19.4535),
    ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
    ((22.7233, 20.0904, -46.6940), (23.0331, 14.9730, -42.5619), 2.0373),
    ((90.8027, -2.0831, 1.4410), (91.1528, -1.6435, 0.0447), 1.4441),
    ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082),
)
unit = st.floats(0.0, 1.0, width=32)
colours = st.tuples(unit, unit, unit).map(np.array)


@pytest.mark.parametrize(("first", "second", "expected"), PUBLISHED)
def test_the_published_pairs(first, second, expected) -> None:
    assert delta_e_2000(np.array(first), np.array(second)) == pytest.approx(expected, abs=1e-4)


@settings(deadline=None)  # the first conversion loads OpenCV
@given(colours, colours)
def test_it_is_symmetric_and_nothing_for_equal_colours(a, b) -> None:
    assert perceived_difference(a, b) == pytest.approx(perceived_difference(b, a), abs=1e-6)
    assert perceived_difference(a, a) == pytest.approx(0.0, abs=1e-6)


@settings(deadline=None)
@given(unit, unit)
def test_grays_differ_half_as_much_with_lightness_at_half_weight(a, b) -> None:
    first, second = lab_of(np.full(3, a)) * (1, 0, 0), lab_of(np.full(3, b)) * (1, 0, 0)
    half = delta_e_2000(first, second, HALF_LIGHTNESS)
    assert half == pytest.approx(delta_e_2000(first, second) / 2, abs=1e-9)
