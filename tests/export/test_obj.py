"""OBJ with materials, read back by trimesh and Open3D."""

from __future__ import annotations

import zipfile
from dataclasses import replace

import numpy as np
import open3d
import pytest
import trimesh

from diorama_core.export import export_scene
from diorama_core.scene.types import Architecture
from tests.primitives import PrimitiveLibrary, furnished_room

LIBRARY = PrimitiveLibrary()
ROOM_Y_UP = [[-2.05, -0.05, -5.05], [2.05, 2.65, 0.05]]


def photographed_room():
    scene = furnished_room(LIBRARY)
    planes = tuple(replace(p, texture="w") if p.id == "back" else p for p in scene.architecture.planes)
    picture = np.zeros((40, 60, 3), np.uint8)
    picture[:20], picture[20:] = (250, 10, 10), (10, 10, 250)
    return replace(scene, architecture=Architecture(planes)), {"w": picture}


def test_zip_opens_with_materials_and_pictures(tmp_path) -> None:
    scene, textures = photographed_room()
    export_scene(scene, LIBRARY, tmp_path / "room.zip", "obj", textures=textures)
    with zipfile.ZipFile(tmp_path / "room.zip") as archive:
        assert archive.testzip() is None
        archive.extractall(tmp_path / "out")
    loaded = trimesh.load_scene(tmp_path / "out" / "room.obj")
    np.testing.assert_allclose(loaded.bounds, ROOM_Y_UP, atol=1e-4)
    pictures = [m.visual.material.image for m in loaded.geometry.values() if m.visual.material.image is not None]
    assert sorted(p.size for p in pictures) == [(60, 40), (64, 64)]
    wall = next(m for m in loaded.geometry.values() if getattr(m.visual.material.image, "size", None) == (60, 40))
    assert wall.extents[0] == pytest.approx(4.0)


def test_objects_keep_their_names_and_places(tmp_path) -> None:
    scene = furnished_room(LIBRARY)
    gathered = export_scene(scene, LIBRARY, tmp_path / "room.obj", "obj")
    lines = (tmp_path / "room.obj").read_text().splitlines()
    assert [line[2:] for line in lines if line.startswith("o ")] == [
        *(p.name for p in gathered.planes),
        *(o.name for o in gathered.objects),
    ]
    loaded = trimesh.load_scene(tmp_path / "room.obj", split_object=True, group_material=False)
    ball = scene.object("b")
    near = [m for m in loaded.geometry.values() if np.allclose(m.extents, 0.2, atol=0.01)]
    centre = ball.pose.position[[0, 2, 1]] * [1, 1, -1]
    assert any(np.allclose(m.bounds.mean(axis=0), centre, atol=1e-3) for m in near)


def test_companions_lie_beside_an_obj_and_open3d_reads_them(tmp_path) -> None:
    scene, textures = photographed_room()
    gathered = export_scene(scene, LIBRARY, tmp_path / "room.obj", "obj", textures=textures)
    assert {p.name for p in tmp_path.iterdir()} == {"room.obj", "room_files"}
    mesh = open3d.io.read_triangle_mesh(str(tmp_path / "room.obj"), enable_post_processing=True)
    assert len(mesh.textures) >= 2
    written = (*gathered.planes, *gathered.objects)
    assert len(mesh.triangles) == sum(gathered.meshes[x.mesh].triangles for x in written)


def test_materials_say_colour_metal_and_roughness(tmp_path) -> None:
    export_scene(furnished_room(LIBRARY), LIBRARY, tmp_path / "room.obj", "obj")
    text = (tmp_path / "room_files" / "room.mtl").read_text()
    blocks = {block.split("\n", 1)[0]: block for block in text.split("newmtl ")[1:]}
    assert "Kd 0.698039 0.050980 0.050980" in blocks["red"]
    assert "Pr 0.7000" in blocks["red"]
    assert "Pm 0.0000" in blocks["red"]
