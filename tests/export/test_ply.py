"""PLY, read back by trimesh and Open3D."""

from __future__ import annotations

import numpy as np
import open3d
import pytest
import trimesh

from diorama_core.export import export_scene
from diorama_core.export.ply import MAX_PIECES, finely_cut, vertex_colours
from diorama_core.render.appearance import Material, Surface
from tests.export.test_obj import LIBRARY, photographed_room
from tests.primitives import furnished_room


def test_bounds_normals_and_colours(tmp_path) -> None:
    scene, textures = photographed_room()
    export_scene(scene, LIBRARY, tmp_path / "room.ply", "ply", textures=textures)
    loaded = trimesh.load_mesh(tmp_path / "room.ply", process=False)
    np.testing.assert_allclose(loaded.bounds, [[-2.05, -0.05, -0.05], [2.05, 5.05, 2.65]], atol=1e-5)
    mesh = open3d.io.read_triangle_mesh(str(tmp_path / "room.ply"))
    assert mesh.has_vertex_normals()
    assert mesh.has_vertex_colors()
    points, colours = np.asarray(mesh.vertices), 255 * np.asarray(mesh.vertex_colors)
    on_wall = (np.abs(points[:, 1] - 5.0) < 1e-4) & (np.abs(points[:, 0]) < 1.9)
    high = colours[on_wall & (points[:, 2] > 1.5) & (points[:, 2] < 2.5)]
    low = colours[on_wall & (points[:, 2] < 1.1) & (points[:, 2] > 0.1)]
    np.testing.assert_allclose(high, np.broadcast_to([250, 10, 10], high.shape), atol=2)
    np.testing.assert_allclose(low, np.broadcast_to([10, 10, 250], low.shape), atol=2)


def test_triangle_count_is_the_scenes(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    gathered = export_scene(scene, LIBRARY, tmp_path / "room.ply", "ply")
    plain = [gathered.meshes[n.mesh] for n in (*gathered.planes, *gathered.objects)]
    mesh = trimesh.load_mesh(tmp_path / "room.ply", process=False)
    textured = [s for m in plain for s in m.surfaces if s.uv is not None and s.material.texture is not None]
    extra = sum(len(finely_cut(s).faces) - len(s.faces) for s in textured)
    assert len(mesh.faces) == sum(m.triangles for m in plain) + extra


def flat(width_m: float, depth_m: float, picture: np.ndarray, repeats: float = 1.0) -> Surface:
    corners = np.array([[0, 0, 0], [width_m, 0, 0], [width_m, depth_m, 0], [0, depth_m, 0]], np.float32)
    up = np.tile(np.array([0, 0, 1], np.float32), (4, 1))
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    uv = repeats * corners[:, :2] / np.array([width_m, depth_m], np.float32)
    return Surface(corners, up, faces, Material(colour=(1.0, 1.0, 1.0), texture=picture), uv=uv)


def half_dark() -> np.ndarray:
    picture = np.full((4, 4, 3), 220, np.uint8)
    picture[:, :2] = 30
    return picture


def test_cutting_keeps_the_area_and_is_bounded() -> None:
    quad = flat(40, 30, half_dark())
    cut = finely_cut(quad)
    assert len(quad.faces) < len(cut.faces) <= 4 * MAX_PIECES
    assert cut.area_m2 == pytest.approx(1200.0, rel=1e-4)
    assert (vertex_colours(cut)[:, 3] == 255).all()


def test_what_a_picture_shows_is_seen_where_it_is() -> None:
    cut = finely_cut(flat(1.0, 1.0, half_dark()))
    red = vertex_colours(cut)[:, 0]
    assert (red[cut.vertices[:, 0] < 0.45] == 30).all()
    assert (red[cut.vertices[:, 0] > 0.55] == 220).all()


def test_grain_is_averaged_and_costs_no_triangles() -> None:
    grain = np.where(np.indices((64, 64)).sum(axis=0)[..., None] % 2, 200, 100).astype(np.uint8).repeat(3, axis=2)
    quad = flat(1.0, 1.0, grain)
    assert finely_cut(quad) is quad
    assert np.ptp(vertex_colours(quad)[:, :3]) == 0
    assert vertex_colours(quad)[0, 0] == pytest.approx(150, abs=1)
