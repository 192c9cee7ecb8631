"""Depth, normals and ids against geometry that can be worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.render.raycast import (
    Grid,
    MeshCaster,
    OrthographicView,
    PinholeView,
    bands,
    pixel_centres,
    pixel_footprint,
)
from diorama_core.scene.types import Camera, Intrinsics, Pose
from tests.primitives import eye_camera
from tests.synthetic_rooms import look

LOOKING_ALONG_Y = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], float)
"""Camera at the world's origin, x right, z up, looking along +Y."""


def camera(width: int = 64, height: int = 48) -> Camera:
    return Camera(Intrinsics.from_fov(width, height, np.radians(60)), LOOKING_ALONG_Y)


def box_at(position: tuple[float, float, float]) -> tuple[trimesh.Trimesh, np.ndarray]:
    return trimesh.creation.box((1, 1, 1)), Pose.upright(position).matrix


def test_depth_is_z_not_distance() -> None:
    """A wall facing the camera has one depth all over, however far the corner pixels are."""
    wall = trimesh.creation.box((50, 0.1, 50)), Pose.upright((0, 3.05, 0)).matrix
    buffers = MeshCaster([wall]).buffers(camera())
    assert buffers.silhouette.all()
    np.testing.assert_allclose(buffers.depth_m, 3.0, atol=1e-4)
    np.testing.assert_allclose(buffers.normals_world, np.broadcast_to([0, -1, 0], (48, 64, 3)), atol=1e-5)


def test_the_nearer_mesh_hides_the_farther() -> None:
    buffers = MeshCaster([box_at((0, 5, 0)), box_at((0, 3, 0)), box_at((1.6, 4, 0))]).buffers(camera())
    assert buffers.instance[24, 32] == 1
    assert set(np.unique(buffers.instance)) == {-1, 1, 2}
    assert buffers.instance.dtype == np.int32
    assert buffers.depth_m.dtype == np.float32
    assert (buffers.depth_m[buffers.instance == -1] == 0).all()


def test_what_rays_meet_is_what_the_buffers_show() -> None:
    rays = PinholeView(camera()).rays(pixel_centres(64, 48))
    for boxes in ([], [box_at((0, 5, 0)), box_at((1.6, 4, 0))]):
        caster = MeshCaster(boxes)
        np.testing.assert_array_equal(caster.instances(rays), caster.buffers(camera()).instance)


def test_nothing_to_see() -> None:
    buffers = MeshCaster([]).buffers(camera())
    assert not buffers.silhouette.any()
    assert buffers.depth_m.shape == (48, 64)


@given(st.floats(-0.8, 0.8), st.floats(2.0, 6.0), st.floats(-0.5, 0.5), st.floats(-3, 3), st.floats(0.3, 1.4))
def test_pixels_agree_with_projection(x: float, y: float, z: float, yaw: float, stretch: float) -> None:
    """The silhouette's bounds are the projected corners' bounds, to a pixel, and depths lie between the corners'."""
    pose = Pose.upright((x, y, z), yaw, (0.6, stretch, 0.5))
    box = trimesh.creation.box((1, 1, 1))
    view = eye_camera(160, 120, 90.0)
    buffers = MeshCaster([(box, pose.matrix)]).buffers(view)
    corners = pose.apply(box.vertices)
    pixels = view.project(corners)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    if (view.to_camera(corners)[:, 2] < 0.3).any() or (low < 0).any() or (high > [160, 120]).any():
        return
    rows, columns = np.nonzero(buffers.silhouette)
    assert abs(columns.min() - low[0]) <= 1.5
    assert abs(columns.max() + 1 - high[0]) <= 1.5
    assert abs(rows.min() - low[1]) <= 1.5
    assert abs(rows.max() + 1 - high[1]) <= 1.5
    depths = view.to_camera(corners)[:, 2]
    seen = buffers.depth_m[buffers.silhouette]
    assert depths.min() - 1e-3 <= seen.min()
    assert seen.max() <= depths.max() + 1e-3


def test_normals_face_the_viewer() -> None:
    view = eye_camera(80, 60)
    buffers = MeshCaster([(trimesh.creation.icosphere(3, 0.8), Pose.upright((0, 3, 1)).matrix)]).buffers(view)
    inside = buffers.silhouette
    rows, columns = np.nonzero(inside)
    rays = view.rays(np.stack([columns + 0.5, rows + 0.5], axis=1))
    assert (np.sum(rays * buffers.normals_world[inside], axis=1) < 0).all()


def test_parallel_rays_keep_sizes() -> None:
    """A metre is 50 pixels at 2 cm a pixel, near or far."""
    view = OrthographicView(LOOKING_ALONG_Y, 200, 200, 0.02)
    for distance in (3.0, 9.0):
        seen = MeshCaster([box_at((0, distance, 0))]).buffers(view).silhouette
        assert seen.sum() == 50 * 50


def test_same_input_same_bytes() -> None:
    meshes = [box_at((0.1, 3, 0.2)), box_at((0.7, 4, -0.3))]
    first, second = MeshCaster(meshes).buffers(camera()), MeshCaster(meshes).buffers(camera())
    assert first.depth_m.tobytes() == second.depth_m.tobytes()
    assert first.instance.tobytes() == second.instance.tobytes()


@pytest.mark.parametrize(("height", "rows"), [(1, 48), (48, 48), (100, 48), (7, 3)])
def test_bands_cover_every_row_once(height: int, rows: int) -> None:
    covered = np.concatenate([np.arange(height)[band] for band in bands(height, rows)])
    np.testing.assert_array_equal(covered, np.arange(height))
    assert max(b.stop - b.start for b in bands(height, rows)) <= rows


def test_a_part_is_a_view_of_the_same_memory() -> None:
    shape = (4, 6)
    flat, deep = np.zeros(shape, np.float32), np.zeros((*shape, 3), np.float32)
    seen, nothing = np.ones(shape, dtype=bool), np.zeros(shape, dtype=bool)
    grid = Grid(seen, deep, deep.copy(), deep.copy(), np.zeros(shape, int), flat, flat.copy(), nothing)
    part = grid.part(slice(1, 3), slice(2, 5))
    assert part.points.shape == (2, 3, 3)
    part.depth[0, 0] = 7.0
    assert grid.depth[1, 2] == 7.0
    assert grid.part(slice(0, 2)).found.shape == (2, 6)


def test_a_pixels_width_grows_with_its_depth() -> None:
    camera = look(0, 0, size=(320, 240))
    depth = np.array([[1.0, 4.0]], np.float32)
    found = pixel_footprint(PinholeView(camera), depth)
    np.testing.assert_allclose(found, depth / camera.intrinsics.fx, rtol=1e-3)
    parallel = OrthographicView(camera.T_world_camera, 320, 240, 0.02)
    np.testing.assert_allclose(pixel_footprint(parallel, depth), 0.02, rtol=1e-4)
