"""Numbers as text, against Python's own formatting."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from diorama_core.export.text import index_rows, number_rows


@given(arrays(np.float64, (7, 3), elements=st.floats(-1e4, 1e4)), st.integers(1, 6))
def test_numbers_are_rounded_like_pythons(values: np.ndarray, decimals: int) -> None:
    lines = number_rows("vn", values, decimals).decode().splitlines()
    assert len(lines) == 7
    for line, row in zip(lines, values, strict=True):
        prefix, *words = line.split()
        assert prefix == "vn"
        assert all(len(w.partition(".")[2]) == decimals for w in words)
        np.testing.assert_allclose([float(w) for w in words], row, atol=0.5001 * 10.0**-decimals)


def test_columns_and_signs() -> None:
    text = number_rows("v", np.array([[-0.25, 12.0, 0.0], [3.5, -1.0, 100.125]]), 2).decode()
    assert [line.split() for line in text.splitlines()] == [
        ["v", "-0.25", "12.00", "0.00"],
        ["v", "3.50", "-1.00", "100.12"],
    ]


def test_nothing_is_no_text() -> None:
    assert number_rows("v", np.zeros((0, 3)), 3) == b""


def test_indices_follow_the_pattern() -> None:
    assert index_rows("f %d//%d", np.array([[1, 2], [30, 4]])) == b"f 1//2\nf 30//4\n"
