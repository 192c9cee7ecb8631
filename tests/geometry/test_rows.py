from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from diorama_core.geometry import rows
from diorama_core.geometry.rows import cells_of, unique_rows

small_numbers = st.sampled_from([-2.0, -0.5, -0.0, 0.0, 1e-5, 1.0, 3.0])


@given(arrays(np.float64, array_shapes(min_dims=2, max_dims=2, max_side=12), elements=small_numbers))
def test_rows_are_those_of_sorting_them(values: np.ndarray) -> None:
    first, kind = unique_rows(values)
    np.testing.assert_array_equal(values[first][kind], values)
    assert len(first) == len(np.unique(values + 0.0, axis=0))
    assert (np.diff(first) > 0).all()


def test_rows_with_equal_hashes_stay_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows, "_hashes", lambda values: np.zeros(len(values), np.uint64))
    first, kind = unique_rows(np.array([[1, 2], [3, 4], [1, 2]]))
    assert first.tolist() == [0, 1]
    assert kind.tolist() == [0, 1, 0]


def test_single_precision_and_no_rows() -> None:
    first, kind = unique_rows(np.zeros((0, 3), np.float32))
    assert len(first) == len(kind) == 0
    assert unique_rows(np.array([[0.1], [0.1]], np.float32))[1].tolist() == [0, 0]


@given(arrays(np.float64, array_shapes(min_dims=2, max_dims=2, max_side=12), elements=st.integers(-40, 40)))
def test_cells_are_those_of_sorting_rows(values: np.ndarray) -> None:
    kind, count = cells_of(values)
    _, sorted_kind, sorted_count = np.unique(values, axis=0, return_inverse=True, return_counts=True)
    assert kind.tolist() == sorted_kind.ravel().tolist()
    assert count.tolist() == sorted_count.tolist()


def test_no_rows_are_in_no_cells() -> None:
    kind, count = cells_of(np.zeros((0, 3), np.uint8))
    assert len(kind) == len(count) == 0
