from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.vectors import cross, dot, face_normals, facing, unit


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
