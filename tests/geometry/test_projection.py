"""Projected bounds of cuboids against brute force. Edges of boxes and planes in a picture."""

from __future__ import annotations

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from diorama_core.geometry.projection import (
    NEAR_M,
    box_edges,
    box_iou,
    cuboid_corners,
    plane_edges,
    visible_bounds,
    visible_segments,
)
from diorama_core.scene.types import Camera, Intrinsics, Plane, box_corners, yaw_rotation

K = Intrinsics(640, 480, 520.0, 515.0, 310.0, 250.0)
FROM_WORLD = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Camera at the world's origin, level, facing +Y."""


def surface_bounds(corners_camera: np.ndarray) -> np.ndarray | None:
    """Bounds of densely sampled surface points that are inside the picture."""
    steps = np.linspace(0, 1, 120)
    u, v = (g.ravel() for g in np.meshgrid(steps, steps))
    origin = corners_camera[0]
    axes = [corners_camera[1] - origin, corners_camera[2] - origin, corners_camera[4] - origin]
    faces = []
    for k in range(3):
        a, b, c = axes[k], axes[(k + 1) % 3], axes[(k + 2) % 3]
        faces += [origin + side * c + np.outer(u, a) + np.outer(v, b) for side in (0.0, 1.0)]
    points = np.concatenate(faces)
    points = points[points[:, 2] > NEAR_M]
    x, y = K.fx * points[:, 0] / points[:, 2] + K.cx, K.fy * points[:, 1] / points[:, 2] + K.cy
    inside = (x >= 0) & (x <= K.width) & (y >= 0) & (y <= K.height)
    if inside.sum() < 30:
        return None
    return np.array([x[inside].min(), y[inside].min(), x[inside].max(), y[inside].max()])


coordinate = st.floats(-2.5, 2.5)


@given(
    x=coordinate, y=st.floats(0.3, 5.0), z=st.floats(-1.5, 1.5), yaw=st.floats(-3.2, 3.2),
    size=st.tuples(*[st.floats(0.2, 2.5)] * 3),
)  # fmt: skip
@example(x=0.5, y=0.5, z=0.0, yaw=0.0, size=(1.03125, 1.0, 1.0))  # only the near plane's cut reaches the picture
def test_bounds_are_those_of_the_visible_surface(x: float, y: float, z: float, yaw: float, size: tuple) -> None:
    corners = cuboid_corners(np.array([[x, y, z]]), np.array([yaw]), np.array([size])) @ FROM_WORLD.T
    expected = surface_bounds(corners[0])
    bounds, visible = visible_bounds(corners, K)
    if expected is None:
        return
    assert visible[0]
    assert (bounds[0, :2] <= expected[:2] + 1e-6).all()
    assert (bounds[0, 2:] >= expected[2:] - 1e-6).all()
    nearest = max(corners[0, :, 2].min(), NEAR_M)
    coarse = 520 * max(size) / 119 / nearest * 3 + 2
    assert np.abs(bounds[0] - expected).max() <= coarse


def test_cuboid_behind_the_camera_is_invisible_and_finite() -> None:
    corners = cuboid_corners(np.array([[0.0, -3.0, 0.0]]), np.zeros(1), np.ones((1, 3))) @ FROM_WORLD.T
    bounds, visible = visible_bounds(corners, K)
    assert not visible[0]
    assert np.isfinite(bounds).all()


def test_camera_inside_a_cuboid_sees_it_everywhere() -> None:
    corners = cuboid_corners(np.zeros((1, 3)), np.zeros(1), np.full((1, 3), 4.0)) @ FROM_WORLD.T
    bounds, visible = visible_bounds(corners, K)
    assert visible[0]
    np.testing.assert_allclose(bounds[0], [0, 0, 640, 480])


def test_corners_agree_with_the_scene_types() -> None:
    corners = cuboid_corners(np.array([[1.0, 2.0, 3.0]]), np.array([0.4]), np.array([[0.5, 1.0, 2.0]]))
    expected = box_corners((0.5, 1.0, 2.0)) @ yaw_rotation(0.4).T + [1.0, 2.0, 3.0]
    np.testing.assert_allclose(corners[0], expected)


def test_box_iou() -> None:
    a = np.array([[0, 0, 2, 2], [0, 0, 1, 1]])
    np.testing.assert_allclose(box_iou(a, np.array([[1, 0, 3, 2], [2, 2, 3, 3]])), [1 / 3, 0.0])


def _camera() -> Camera:
    """At the origin, looking along +X, with x of the picture along -Y."""
    T = np.eye(4)
    T[:3, :3] = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    return Camera(Intrinsics.from_fov(200, 100, np.pi / 2), T)


def test_a_box_has_twelve_edges_each_along_one_axis() -> None:
    edges = box_edges(box_corners((1.0, 2.0, 3.0)))
    lengths = np.abs(edges[:, 1] - edges[:, 0])
    assert edges.shape == (12, 2, 3)
    assert sorted(lengths.max(axis=1)) == [1.0] * 4 + [2.0] * 4 + [3.0] * 4
    assert np.allclose(lengths.sum(axis=1), lengths.max(axis=1))


def test_a_square_before_the_camera_lands_where_it_is_projected() -> None:
    square = Plane("wall_1", "wall", np.array([[2.0, 1, 0], [2.0, -1, 0], [2.0, -1, 1], [2.0, 1, 1]]))
    seen = visible_segments(_camera(), [plane_edges(square)])
    assert seen.shape == (4, 2, 2)
    assert np.allclose(seen[0], [[50.0, 50.0], [150.0, 50.0]])


def test_lines_are_cut_near_the_camera_and_left_out_behind_it() -> None:
    through = np.array([[[-3.0, 1.0, 0.0], [3.0, 1.0, 0.0]]])
    behind = np.array([[[-3.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]])
    seen = visible_segments(_camera(), [through, behind])
    assert seen.shape == (1, 2, 2)
    far = seen[0][np.abs(seen[0, :, 0] - 100 + 100 / 3) < 1e-6]
    near = seen[0][np.abs(seen[0, :, 0] - 100 + 100 / 0.05) < 1e-3]
    assert len(far) == len(near) == 1


def test_nothing_is_seen_of_nothing() -> None:
    assert visible_segments(_camera(), []).shape == (0, 2, 2)
