"""Matrices, quaternions and rotation vectors against one another and against known turns."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from diorama_core.geometry.rotations import (
    quaternion_wxyz,
    rotation_from_quaternion,
    rotation_from_vector,
    rotation_vector,
    yaw_rotations,
)
from diorama_core.scene.types import yaw_rotation

VECTORS = arrays(np.float64, 3, elements=st.floats(-1.8, 1.8))  # shorter than pi
ANGLES = st.floats(-3.1, 3.1)


@given(VECTORS)
def test_all_three_forms_say_the_same(vector: np.ndarray) -> None:
    R = rotation_from_vector(vector)
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(R) > 0
    np.testing.assert_allclose(R @ vector, vector, atol=1e-12)
    np.testing.assert_allclose(rotation_vector(R), vector, atol=1e-9)
    quaternion = quaternion_wxyz(R)
    assert quaternion[0] >= 0
    np.testing.assert_allclose(rotation_from_quaternion(3.0 * quaternion), R, atol=1e-12)


@given(ANGLES)
def test_turns_about_up(angle: float) -> None:
    R = yaw_rotation(angle)
    np.testing.assert_allclose(rotation_from_vector(np.array([0, 0, angle])), R, atol=1e-12)
    np.testing.assert_allclose(quaternion_wxyz(R), [np.cos(angle / 2), 0, 0, np.sin(angle / 2)], atol=1e-9)


def test_many_vectors_at_once() -> None:
    vectors = np.random.default_rng(0).normal(size=(5, 3))
    one_by_one = np.array([rotation_from_vector(v) for v in vectors])
    np.testing.assert_allclose(rotation_from_vector(vectors), one_by_one, atol=1e-15)


def test_many_turns_about_up_are_each_as_one() -> None:
    yaws = np.linspace(-4.0, 4.0, 9)
    np.testing.assert_allclose(yaw_rotations(yaws), [yaw_rotation(float(yaw)) for yaw in yaws], atol=1e-15)
