"""The two conversions: known values, inverse of one another, the same for one value as for many."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from diorama_core.io.srgb import linear_to_srgb, luminance, srgb_to_linear

VALUES = arrays(np.float64, st.integers(1, 20), elements=st.floats(0, 1))


def test_values_of_the_standard() -> None:
    display = np.array([0.0, 0.04045, 0.5, 188 / 255, 1.0])
    np.testing.assert_allclose(srgb_to_linear(display), [0, 0.0031308, 0.214041, 0.502886, 1], atol=1e-6)


@given(VALUES)
def test_they_undo_one_another(values: np.ndarray) -> None:
    # As well as the standard's two pieces meet.
    np.testing.assert_allclose(linear_to_srgb(srgb_to_linear(values)), values, atol=1e-7)
    np.testing.assert_allclose(srgb_to_linear(linear_to_srgb(values)), values, atol=1e-7)


@given(VALUES)
def test_brighter_stays_brighter(values: np.ndarray) -> None:
    for convert in (srgb_to_linear, linear_to_srgb):
        assert (np.diff(convert(np.sort(values))) >= -1e-7).all()


def test_every_byte_survives_and_negative_light_is_no_error() -> None:
    display = np.arange(256) / 255
    np.testing.assert_array_equal(np.rint(255 * linear_to_srgb(srgb_to_linear(display))), np.arange(256))
    with np.errstate(all="raise"):
        assert linear_to_srgb(np.array(-0.5)) < 0
        assert srgb_to_linear(np.array(-0.5)) < 0


def test_luminance_of_white_is_one_and_green_is_brightest() -> None:
    assert luminance(np.ones((1, 3)))[0] == pytest.approx(1.0)
    red, green, blue = luminance(np.eye(3))
    assert green > red > blue
