from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from diorama_core.geometry import vectors
from diorama_core.geometry.vectors import cells_of, cross, dot, face_normals, facing, unique_rows, unit


def test_products_are_of_rows_and_broadcast(rng) -> None:
    a, b = rng.normal(size=(4, 5, 3)), rng.normal(size=3)
    np.testing.assert_allclose(dot(a, b), a @ b, rtol=1e-12)


def test_unit_vectors_have_length_one_and_null_stays_null(rng) -> None:
    vectors = np.vstack([rng.normal(size=(10, 3)), np.zeros((1, 3))])
    np.testing.assert_allclose(np.linalg.norm(unit(vectors), axis=1), [1.0] * 10 + [0.0])


def test_normals_follow_the_right_hand_and_are_null_without_area() -> None:
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 3, 0], [4, 0, 0]], dtype=np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 1], [0, 1, 3]], dtype=np.int32)
    np.testing.assert_allclose(face_normals(corners, faces), [[0, 0, 1], [0, 0, -1], [0, 0, 0]])


def test_normals_are_turned_against_the_view() -> None:
    seen = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    np.testing.assert_array_equal(facing(seen, np.array([[0.0, 0.1, -1.0]] * 2)), [[0, 0, 1], [0, 0, 1]])


vector = st.tuples(*[st.floats(-1e3, 1e3)] * 3).map(np.array)


@given(vector, vector)
def test_it_is_numpys_vector_product(a, b) -> None:
    np.testing.assert_array_equal(cross(a, b), np.cross(a, b))


def test_it_broadcasts_over_the_last_axis(rng) -> None:
    a, b = rng.normal(size=(4, 1, 3)), rng.normal(size=(5, 3))
    np.testing.assert_allclose(cross(a, b), np.cross(a, b), rtol=1e-12)
    np.testing.assert_allclose(cross(a[:, 0], b[0]), np.cross(a[:, 0], b[0]), rtol=1e-12)


small_numbers = st.sampled_from([-2.0, -0.5, -0.0, 0.0, 1e-5, 1.0, 3.0])


@given(arrays(np.float64, array_shapes(min_dims=2, max_dims=2, max_side=12), elements=small_numbers))
def test_rows_are_those_of_sorting_them(values: np.ndarray) -> None:
    first, kind = unique_rows(values)
    np.testing.assert_array_equal(values[first][kind], values)
    assert len(first) == len(np.unique(values + 0.0, axis=0))
    assert (np.diff(first) > 0).all()


def test_rows_with_equal_hashes_stay_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(vectors, "_hashes", lambda values: np.zeros(len(values), np.uint64))
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
