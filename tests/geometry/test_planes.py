"""Planes, polygons, casting and segments."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.casting import cast_box, cast_plane, cast_planes
from diorama_core.geometry.depth_grid import points_camera, smooth_normals_camera
from diorama_core.geometry.planes import clip_polygon, is_in_polygon, plane_axes, plane_uv, ransac_plane
from diorama_core.geometry.segments import line_segments_px
from diorama_core.scene.types import Intrinsics, Plane
from tests.synthetic_rooms import box_room, wall

angles = st.floats(0.0, 6.28)
coordinates = st.floats(-3.0, 3.0)


@pytest.mark.parametrize("plane", box_room(-2.0, 2.0, 3.0, 2.5), ids=lambda p: p.id)
def test_axes_are_right_handed_and_uv_spans_the_unit_square(plane):
    u, v = plane_axes(plane.normal)
    np.testing.assert_allclose(np.cross(u, v), plane.normal, atol=1e-12)
    uv = plane_uv(plane)
    np.testing.assert_allclose(sorted(map(tuple, uv)), [(0, 0), (0, 1), (1, 0), (1, 1)], atol=1e-9)


@given(st.floats(-np.pi, np.pi), st.floats(-np.pi / 2, np.pi / 2))
def test_axes_of_any_normal_are_orthonormal_and_those_of_steep_planes_level(azimuth, height):
    flat = np.cos(height)
    normal = np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(height)])
    u, v = plane_axes(normal)
    np.testing.assert_allclose([u @ u, v @ v, u @ v, u @ normal, v @ normal], [1, 1, 0, 0, 0], atol=1e-12)
    np.testing.assert_allclose(np.cross(u, v), normal, atol=1e-12)
    if flat >= 0.5:
        assert u[2] == 0
        assert v[2] >= 0
    else:
        assert u[0] > 0.8  # near world +X, however little the plane is tilted


def test_wall_texture_is_upright_and_not_mirrored():
    back = wall("back", (-1, 3), (2, 3), 2.5)
    np.testing.assert_allclose(plane_uv(back), [[0, 0], [1, 0], [1, 1], [0, 1]], atol=1e-12)


@given(angles, st.floats(-0.9, 0.9))
def test_two_halves_of_a_clipped_polygon_make_the_whole(angle, offset):
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=float)
    normal = np.array([np.cos(angle), np.sin(angle), 0.0])
    parts = clip_polygon(square, normal, offset), clip_polygon(square, -normal, -offset)
    assert sum(_area(p) for p in parts) == pytest.approx(4.0, abs=1e-6)


def _area(polygon):
    if len(polygon) < 3:
        return 0.0
    return 0.5 * np.linalg.norm(np.cross(polygon, np.roll(polygon, -1, axis=0)).sum(axis=0))


@given(angles, st.floats(0.1, 1.4), st.integers(0, 100))
def test_ransac_finds_the_plane_among_outliers(azimuth, polar, seed):
    rng = np.random.default_rng(seed)
    normal = np.array([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)])
    points = rng.uniform(-1, 1, (400, 3))
    points[:280] -= (points[:280] @ normal - 0.3)[:, None] * normal
    found, offset, inliers = ransac_plane(points, 0.01)
    assert abs(found @ normal) > 0.9999
    assert abs(abs(offset) - 0.3) < 0.01
    assert inliers[:280].all()


@given(coordinates, coordinates)
def test_a_ray_meets_a_plane_exactly_inside_its_polygon(x, z):
    target = np.array([x, 3.0, z])
    distance = cast_plane(np.zeros(3), target[None], wall("w", (-1, 3), (2, 3), 2.0))[0]
    inside = -1 < x < 2 and 0 < z < 2
    if min(abs(x + 1), abs(x - 2), abs(z), abs(z - 2)) > 1e-3:
        assert np.isfinite(distance) == inside
        if inside:
            assert distance == pytest.approx(1.0)


def test_the_nearest_plane_wins():
    planes = (wall("far", (-1, 3), (1, 3), 2.0), wall("near", (-1, 2), (1, 2), 2.0))
    distance, which = cast_planes(np.array([0, 0, 1.0]), np.array([[0, 1.0, 0], [0, -1.0, 0]]), planes)
    np.testing.assert_allclose(distance, [2.0, np.inf])
    np.testing.assert_array_equal(which, [1, -1])


@given(angles, coordinates, coordinates)
def test_a_ray_enters_a_box_on_its_surface(yaw, x, z):
    c, s = np.cos(yaw), np.sin(yaw)
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
    centre, size = np.array([0.0, 4.0, 0.0]), np.array([1.0, 2.0, 1.5])
    direction = np.array([x, 4.0, z])
    t, normal = cast_box(np.zeros(3), direction[None], R, centre, size)
    if np.isfinite(t[0]):
        local = (t[0] * direction - centre) @ R
        assert np.abs(np.abs(local) / size - 0.5).min() < 1e-6
        assert (np.abs(local) <= 0.5 * size + 1e-6).all()
        assert normal[0] @ direction < 0


def test_normals_of_a_slanted_plane():
    k = Intrinsics.from_fov(160, 120, 1.0)
    normal = np.array([0.3, -0.2, -0.93])
    normal /= np.linalg.norm(normal)
    rays = points_camera(np.ones((120, 160), np.float32), k)
    depth = (-2.0 / (rays @ normal)).astype(np.float32)
    found = smooth_normals_camera(depth, k)
    inner = found[10:-10, 10:-10]
    assert (inner @ normal).min() > 0.999


def test_no_normals_without_depth():
    k = Intrinsics.from_fov(64, 48, 1.0)
    assert not smooth_normals_camera(np.zeros((48, 64), np.float32), k).any()


def test_segments_lie_on_the_edges_of_a_rectangle():
    picture = np.full((300, 400, 3), 30, np.uint8)
    picture[80:200, 100:300] = 220
    segments = line_segments_px(picture)
    assert len(segments) >= 4
    for x1, y1, x2, y2 in segments[:4]:
        on_side = min(abs(x1 - 100) + abs(x2 - 100), abs(x1 - 300) + abs(x2 - 300))
        on_top = min(abs(y1 - 80) + abs(y2 - 80), abs(y1 - 200) + abs(y2 - 200))
        assert min(on_side, on_top) < 3.0


@pytest.mark.parametrize("shape", [(1, 1), (4, 400), (20, 20)])
def test_tiny_pictures_have_no_segments(shape):
    assert line_segments_px(np.zeros((*shape, 3), np.uint8)).shape == (0, 4)


def test_plane_needs_no_particular_start():
    corners = wall("w", (-1, 3), (2, 3), 2.0).polygon
    turned = Plane("w", "wall", np.roll(corners, 2, axis=0))
    np.testing.assert_allclose(np.roll(plane_uv(turned), -2, axis=0), plane_uv(Plane("w", "wall", corners)))


def test_points_are_within_an_l_but_not_in_its_notch():
    outline = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0], [2.0, 4.0], [0.0, 4.0]])
    points = np.array([[1.0, 1.0], [3.0, 1.0], [1.0, 3.0], [3.0, 3.0], [5.0, 1.0], [-0.1, 1.0]])
    assert is_in_polygon(points, outline).tolist() == [True, True, True, False, False, False]
    assert is_in_polygon(points, outline[::-1]).tolist() == is_in_polygon(points, outline).tolist()
    assert not is_in_polygon(points, np.zeros((0, 2))).any()
