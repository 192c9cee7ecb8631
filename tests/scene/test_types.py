from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.scene.types import Intrinsics, Plane, Pose, box_corners, yaw_rotation
from tests.scene.strategies import CAMERA, poses

points = st.tuples(*[st.floats(-3, 3)] * 3)


@given(poses(), points)
def test_a_pose_is_its_matrix(pose: Pose, point: tuple) -> None:
    homogeneous = pose.matrix @ np.array([*point, 1.0])
    np.testing.assert_allclose(pose.apply(np.array(point)), homogeneous[:3], atol=1e-9)


@given(st.floats(0, 640), st.floats(0, 480), st.floats(0.3, 9))
def test_rays_and_projection_are_inverse(u: float, v: float, depth: float) -> None:
    point = CAMERA.position + depth * CAMERA.rays(np.array([u, v]))
    np.testing.assert_allclose(CAMERA.project(point), [u, v], atol=1e-6)
    assert CAMERA.to_camera(point)[2] == pytest.approx(depth)


@given(st.floats(-10, 10))
def test_yaw_turns_the_front(yaw: float) -> None:
    front = yaw_rotation(yaw) @ np.array([1.0, 0, 0])
    np.testing.assert_allclose(front, [np.cos(yaw), np.sin(yaw), 0], atol=1e-12)
    assert np.cos(Pose.upright((0, 0, 0), yaw).yaw_rad - yaw) == pytest.approx(1.0)


def test_field_of_view_round_trips() -> None:
    k = Intrinsics.from_fov(800, 600, np.radians(63))
    assert np.degrees(k.horizontal_fov_rad) == pytest.approx(63)
    assert k.resize(400, 300).horizontal_fov_rad == pytest.approx(k.horizontal_fov_rad)


def test_a_floor_seen_from_above_has_its_normal_up() -> None:
    plane = Plane("floor", "floor", np.array([[0.0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0]]))
    np.testing.assert_allclose(plane.normal, [0, 0, 1])
    assert plane.offset == pytest.approx(0.0)


def test_values_are_immutable_and_compare_by_content() -> None:
    a, b = Pose.upright((1, 2, 3)), Pose.upright((1, 2, 3))
    assert a == b
    assert hash(a) == hash(b)
    assert a != Pose.upright((1, 2, 4))
    with pytest.raises(ValueError, match="read-only"):
        a.position[0] = 5.0


def test_corner_order_is_the_bits_of_the_index() -> None:
    corners = box_corners((2, 4, 6))
    np.testing.assert_allclose(corners[0], [-1, -2, -3])
    np.testing.assert_allclose(corners[1], [1, -2, -3])
    np.testing.assert_allclose(corners[6], [-1, 2, 3])


@pytest.mark.unchecked
@pytest.mark.parametrize("bad", [np.diag([1.0, 1, -1]), np.zeros((3, 3)), np.eye(4), np.full((3, 3), np.nan)])
def test_a_pose_refuses_what_is_no_rotation(bad: np.ndarray) -> None:
    with pytest.raises(ValueError, match=r"rotation|shape|finite"):
        Pose(bad, np.zeros(3), np.ones(3))
