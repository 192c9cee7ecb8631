"""Files of other programs as scenes of objects."""

from __future__ import annotations

import xml.etree.ElementTree as ET
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.export import export_scene
from diorama_core.importing.foreign import scene_of_parts, take_missing_shapes
from diorama_core.importing.forms import SceneParts, open_form, read_mark
from diorama_core.importing.opening import open_marked
from diorama_core.library.ingest.known_shapes import KnownShapes, load_known_shapes
from diorama_core.library.store import CombinedLibrary, StoredLibrary
from diorama_core.progress import Progress
from diorama_core.scene.support import check_scene
from diorama_core.scene.types import Scene
from tests.importing.stages import write_stage
from tests.importing.test_gltf import LIBRARY, edited, edited_room
from tests.primitives import furnished_room


@pytest.fixture(scope="module")
def known(tmp_path_factory: pytest.TempPathFactory) -> KnownShapes:
    return load_known_shapes(tmp_path_factory.mktemp("known"), library=LIBRARY)


def opened(path: Path, known: KnownShapes, folder: Path):
    with open_form(path) as (form, place):
        content = form.read(place, Progress(), None)
    assert isinstance(content, SceneParts)
    return scene_of_parts(content.parts, path, StoredLibrary(folder / "models", create=True), Progress(), known)


def unmarked(tmp_path: Path, scene: Scene) -> Path:
    path = tmp_path / "foreign.glb"
    export_scene(scene, LIBRARY, path, "glb")
    with edited(path) as document:
        for node in document["nodes"]:
            node.pop("extras", None)
    return path


def test_a_foreign_glb_becomes_objects_in_a_room(tmp_path, known: KnownShapes) -> None:
    scene = furnished_room(LIBRARY)
    path = unmarked(tmp_path, scene)
    assert read_mark(path) is None
    found = opened(path, known, tmp_path).scene
    check_scene(found)
    assert {p.role for p in found.architecture.planes} == {"floor", "ceiling", "wall"}
    assert len(found.architecture.by_role("wall")) == 4
    for item in scene.objects:
        mine = next(o for o in found.objects if o.label.startswith(f"{item.label} ({item.id})"))
        for k in (np.min, np.max):
            np.testing.assert_allclose(k(mine.corners_world, axis=0), k(item.corners_world, axis=0), atol=1e-3)
    ball = next(o for o in found.objects if "ball" in o.label)
    edge = found.support_of(ball.id)
    assert "table" in found.object(edge.parent).label
    chair = found.support_of(next(o for o in found.objects if "chair (c1)" in o.label).id)
    assert chair.parent == "floor"


def test_copies_share_a_shape(tmp_path, known: KnownShapes) -> None:
    stool = trimesh.Scene({"seat": trimesh.creation.box((0.4, 0.3, 0.5))})
    scene = trimesh.Scene()
    for number, (x, turn) in enumerate(((0.0, 0.0), (1.5, 0.9), (3.0, 2.0))):
        T = trimesh.transformations.rotation_matrix(turn, (0, 1, 0))
        T[:3, 3] = [x, 0.25, 0.0]
        scene.add_geometry(stool.geometry["seat"], node_name=f"stool {number}", geom_name="seat", transform=T)
    (tmp_path / "stools.glb").write_bytes(scene.export(file_type="glb"))
    result = opened(tmp_path / "stools.glb", known, tmp_path)
    assert len(result.scene.objects) == 3
    assert len({o.shape_id for o in result.scene.objects}) == 1
    assert result.changes == ("the file has no floor: there is one under the lowest object",)
    floor = result.scene.architecture.floor
    assert floor.centre[2] == pytest.approx(0.1, abs=1e-6)
    turned = sorted(float(o.pose.yaw_rad) for o in result.scene.objects)
    assert turned[1] - turned[0] == pytest.approx(0.9, abs=1e-3) or turned[2] - turned[1] == pytest.approx(
        0.9, abs=1e-3
    )


def test_a_file_in_centimetres_is_brought_to_size(tmp_path, known: KnownShapes) -> None:
    box = trimesh.creation.box((120.0, 75.0, 60.0))
    far = trimesh.creation.box((50.0, 90.0, 50.0), trimesh.transformations.translation_matrix((300.0, 0, 0)))
    (tmp_path / "cm.glb").write_bytes(trimesh.Scene({"desk": box, "chair": far}).export(file_type="glb"))
    found = opened(tmp_path / "cm.glb", known, tmp_path).scene
    assert sorted(round(float(o.size_m.max()), 3) for o in found.objects) == [0.9, 1.2]


def move_piece(path: Path, object_id: str, by_m: np.ndarray) -> None:
    """Move a piece of furniture in a Sweet Home 3D file, whose y points down the plan, in centimetres."""
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    home = ET.fromstring(files["Home.xml"])
    piece = next(e for e in home.iter() if e.get("id") == f"piece-{object_id}")
    for axis, by_cm in (("x", 100 * by_m[0]), ("y", -100 * by_m[1])):
        piece.set(axis, str(float(piece.get(axis, "")) + by_cm))
    files["Home.xml"] = ET.tostring(home)
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)


def test_sweet_home_there_and_back_with_a_piece_that_was_moved(tmp_path, known: KnownShapes) -> None:
    scene, by_m = furnished_room(LIBRARY), np.array([0.25, -0.4, 0.0])
    export_scene(scene, LIBRARY, tmp_path / "home.sh3d", "sh3d")
    move_piece(tmp_path / "home.sh3d", "c1", by_m)
    scene_found = opened(tmp_path / "home.sh3d", known, tmp_path).scene
    found = scene_found.objects
    assert len(found) == len(scene.objects)
    for item in scene.objects:
        expected = item.corners_world + (by_m if item.id == "c1" else 0.0)
        ends = np.stack([expected.min(axis=0), expected.max(axis=0)])
        off = [np.abs(np.stack([o.corners_world.min(axis=0), o.corners_world.max(axis=0)]) - ends).max() for o in found]
        assert min(off) < 1e-3, f"{item.id} is off by {1000 * min(off):.1f} mm"
    found_walls = scene_found.architecture.by_role("wall")
    assert len(found_walls) == 4
    for wall in scene.architecture.by_role("wall"):
        offsets = [w.offset for w in found_walls if w.normal @ wall.normal > 0.999]
        assert offsets == [pytest.approx(wall.offset, abs=1e-3)]


def test_foreign_usd(tmp_path, known: KnownShapes) -> None:
    pytest.importorskip("pxr", reason="needs the extra [usd]")
    meshes = {name: trimesh.creation.box((60.0, 80.0, 40.0)) for name in ("cabinet", "crate")}
    for mesh, x in zip(meshes.values(), (0.0, 200.0), strict=True):
        mesh.apply_translation((x, 40.0, 0.0))
    write_stage(tmp_path / "props.usda", meshes, 0.01, "Y")
    found = opened(tmp_path / "props.usda", known, tmp_path).scene
    assert sorted(np.round(o.size_m[2], 3) for o in found.objects) == [0.8, 0.8]
    assert sorted(round(float(o.pose.position[0]), 3) for o in found.objects) == [0.0, 2.0]


def test_shapes_that_no_library_has_come_out_of_the_file(tmp_path, known: KnownShapes) -> None:
    scene = edited_room()
    path = tmp_path / "room.glb"
    export_scene(scene, LIBRARY, path, "glb")
    marked = read_mark(path)
    found = open_marked(marked).scene
    sink = StoredLibrary(tmp_path / "models", create=True)
    take_missing_shapes(path, marked, found, {"table", "ball"}, sink, Progress(), known)
    library = CombinedLibrary([sink])
    for shape_id in ("table", "ball"):
        np.testing.assert_allclose(library.shape(shape_id).size_m, LIBRARY.shape(shape_id).size_m, atol=1e-4)
        np.testing.assert_allclose(library.mesh(shape_id).bounds, LIBRARY.mesh(shape_id).bounds, atol=1e-4)
    lost = replace(scene.object("c1"), shape_id="gone")
    with pytest.raises(InputError, match="gone"):
        take_missing_shapes(path, marked, Scene(objects=(lost,)), {"gone"}, sink, Progress(), known)


def test_files_that_are_no_scene(tmp_path) -> None:
    Image.new("RGB", (4, 4)).save(tmp_path / "photo.png")
    with pytest.raises(InputError, match="is a picture: build a room from it"):
        read_mark(tmp_path / "photo.png")
    with pytest.raises(InputError, match="does not exist"):
        read_mark(tmp_path / "missing.glb")
