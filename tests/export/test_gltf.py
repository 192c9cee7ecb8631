"""The GLB file against an independent loader and a strict reader."""

from __future__ import annotations

import io
import json
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from PIL import Image
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from diorama_core.errors import LibraryError
from diorama_core.export.gathering import ExportOptions
from diorama_core.export.gltf import glb_bytes, write_gathered, write_glb
from diorama_core.scene.schema import scene_from_json
from diorama_core.scene.types import Architecture, Intrinsics, Scene
from tests.export import gltf_reader
from tests.export.scenes import gathered
from tests.export.validators import gltf_findings, needs_gltf_validator
from tests.primitives import PrimitiveLibrary, box_room, furnished_room, place

LIBRARY = PrimitiveLibrary()


def load(data: bytes) -> trimesh.Scene:
    loaded = trimesh.load_scene(io.BytesIO(data), file_type="glb")
    assert isinstance(loaded, trimesh.Scene)
    return loaded


def node(document: dict, name: str) -> dict:
    return next(n for n in document["nodes"] if n["name"] == name)


def test_the_file_is_sound() -> None:
    document = gltf_reader.check(glb_bytes(furnished_room(LIBRARY), LIBRARY))
    assert "extensionsRequired" not in document


@needs_gltf_validator
@pytest.mark.parametrize("source", ["example", "primitives", "fittings", "boxes", "empty shell"])
def test_the_khronos_validator_finds_nothing(source: str, tmp_path) -> None:
    path = tmp_path / "scene.glb"
    write_gathered(gathered(source), path)
    assert gltf_findings(path) == []


@needs_gltf_validator
@pytest.mark.parametrize("compression", ["meshopt", "draco"])
def test_only_the_unknown_extension_is_remarked_on_in_compressed_files(tmp_path, compression: str) -> None:
    if compression == "draco":
        pytest.importorskip("DracoPy", reason="DracoPy is not installed (optional extra 'draco')")
    path = tmp_path / "scene.glb"
    write_gathered(gathered("example", compression=compression), path)
    codes = [finding.split()[1] for finding in gltf_findings(path)]
    # What only the extension refers to looks unused to a validator that does not know it.
    assert codes.count("UNSUPPORTED_EXTENSION") == 1
    assert set(codes) - {"UNSUPPORTED_EXTENSION"} <= ({"UNUSED_OBJECT"} if compression == "draco" else set())


def test_extents_in_metres_with_y_up() -> None:
    """The room of 4 x 5 x 2.6 m plus the slabs' thickness; depth (world y) runs along glTF's -z."""
    bounds = load(glb_bytes(furnished_room(LIBRARY), LIBRARY)).bounds
    np.testing.assert_allclose(bounds, [[-2.05, -0.05, -5.05], [2.05, 2.65, 0.05]], atol=1e-5)


def test_every_object_stands_where_the_scene_says() -> None:
    scene = furnished_room(LIBRARY)
    loaded = load(glb_bytes(scene, LIBRARY))
    for item in scene.objects:
        points = item.pose.apply(LIBRARY.mesh(item.shape_id).vertices)
        upright = np.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=1)
        matrix = loaded.graph.get(f"{item.label} ({item.id})")[0]
        mine = trimesh.transform_points(LIBRARY.mesh(item.shape_id).vertices, matrix)
        np.testing.assert_allclose(mine, upright, atol=1e-5)


def test_nodes_carry_what_the_scene_knows() -> None:
    scene = furnished_room(LIBRARY)
    document = gltf_reader.check(glb_bytes(scene, LIBRARY))
    extras = node(document, "ball (b)")["extras"]
    assert extras["category"] == "toy"
    assert extras["shape"] == "ball"
    assert extras["support"] == {"parent": "t", "relation": "placed on", "against": []}
    assert json.loads(extras["diorama"])["id"] == "b"
    assert scene_from_json(node(document, "diorama")["extras"]["diorama"]) == scene


def test_the_tree_follows_the_supports_beside_the_architecture() -> None:
    document = gltf_reader.check(glb_bytes(furnished_room(LIBRARY), LIBRARY))

    def below(name: str) -> set[str]:
        return {document["nodes"][i]["name"] for i in node(document, name).get("children", ())}

    lights = {name for name in below("diorama") if name.startswith("even light")}
    assert below("diorama") - lights == {"architecture", "objects", "photo camera"}
    assert len(lights) == 8  # four parallel ones, four points
    assert len({node(document, name)["extensions"]["KHR_lights_punctual"]["light"] for name in lights}) == 5
    assert below("architecture") == {"floor", "ceiling", "wall back", "wall left", "wall right", "wall front"}
    assert below("table (t)") == {"ball (b)"}
    assert "ball (b)" not in below("objects")


def test_children_do_not_inherit_scale() -> None:
    scene = furnished_room(LIBRARY)
    table = scene.object("t")
    wide = replace(table, pose=replace(table.pose, scale=np.array([1.0, 2.0, 1.0])))
    stretched = replace(scene, objects=tuple(wide if o.id == "t" else o for o in scene.objects))
    document = gltf_reader.check(glb_bytes(stretched, LIBRARY))
    assert "scale" not in node(document, "table (t)")
    assert node(document, "table (t) shape")["scale"] == [1.0, 2.0, 1.0]
    loaded = load(glb_bytes(stretched, LIBRARY))
    corners = loaded.graph.get("ball (b)")[0][:3, :3]
    np.testing.assert_allclose(np.linalg.norm(corners, axis=0), scene.object("b").pose.scale, atol=1e-6)


def test_without_the_ceiling_and_only_the_selection() -> None:
    scene = furnished_room(LIBRARY)
    open_room = gltf_reader.check(glb_bytes(scene, LIBRARY, options=ExportOptions(ceiling=False)))
    assert "ceiling" not in {n["name"] for n in open_room["nodes"]}
    assert "floor" in {n["name"] for n in open_room["nodes"]}
    ball = gltf_reader.check(glb_bytes(scene, LIBRARY, options=ExportOptions(only=frozenset({"b"}))))
    assert {n["name"] for n in ball["nodes"]} == {"diorama", "objects", "ball (b)", "photo camera"}
    assert len(ball["meshes"]) == 1


def test_pictures_are_limited_and_have_sides_of_powers_of_two() -> None:
    picture = np.zeros((300, 700, 3), np.uint8)
    planes = tuple(replace(p, texture="wall.png") if p.id == "back" else p for p in box_room().planes)
    scene = Scene(None, Architecture(planes))
    for limit, expected in ((None, (1024, 512)), (256, (256, 128))):
        data = glb_bytes(scene, LIBRARY, textures={"wall.png": picture}, options=ExportOptions(max_texture_px=limit))
        document, binary = gltf_reader.read(data)
        view = document["bufferViews"][document["images"][0]["bufferView"]]
        image = Image.open(io.BytesIO(binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]))
        assert image.size == expected
        (seen,) = (m for m in document["materials"] if "extensions" in m)  # the photo shows what it mirrors already
        assert seen["extensions"]["KHR_materials_specular"]["specularFactor"] == 0.0


def test_lamps_and_windows_shine(tmp_path) -> None:
    write_gathered(gathered("fittings"), tmp_path / "scene.glb")
    document = gltf_reader.check((tmp_path / "scene.glb").read_bytes())
    lights = document["extensions"]["KHR_lights_punctual"]["lights"]
    assert {light["type"] for light in lights if light["name"] != "even light"} == {"point", "spot"}
    spot = next(n for n in document["nodes"] if n["name"].startswith("window") and "extensions" in n)
    R = Rotation.from_quat(spot["rotation"]).as_matrix()
    window = gathered("fittings").object("window_1")
    into_room = window.T_world[:3, :3] @ -R[:, 2]
    np.testing.assert_allclose(into_room, [0.0, -1.0, 0.0], atol=1e-9)


def test_compressed_geometry_is_the_same_within_a_tenth_of_a_millimetre(tmp_path) -> None:
    for name in ("none", "meshopt"):
        write_gathered(gathered("example", compression=name), tmp_path / name)
    plain, packed = ((tmp_path / name).read_bytes() for name in ("none", "meshopt"))
    assert len(packed) < 0.8 * len(plain)
    (document, binary), (other, data) = gltf_reader.read(plain), gltf_reader.read(packed)
    for mesh, same in zip(document["meshes"], other["meshes"], strict=True):
        for first, second in zip(mesh["primitives"], same["primitives"], strict=True):
            points = gltf_reader.values(document, binary, first["attributes"]["POSITION"])
            faces = gltf_reader.values(document, binary, first["indices"]).reshape(-1, 3)
            unpacked = gltf_reader.unpacked(other, data, second["attributes"]["POSITION"])
            order = gltf_reader.unpacked(other, data, second["indices"]).reshape(-1, 3)
            _assert_same_triangles(points[faces], unpacked[order])


def _assert_same_triangles(a: np.ndarray, b: np.ndarray) -> None:
    assert a.shape == b.shape
    distance, _ = KDTree(b.mean(axis=1)).query(a.mean(axis=1))
    assert distance.max() < 1e-4
    areas = [np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1).sum() for t in (a, b)]
    assert areas[0] == pytest.approx(areas[1], rel=1e-2)


def test_identical_shapes_share_a_mesh_and_colours_do_not_leak() -> None:
    scene = furnished_room(LIBRARY)
    third = replace(scene.object("c1"), id="c3", pose=scene.object("c1").pose.move(np.array([0.0, 1.0, 0.0])))
    document = gltf_reader.check(glb_bytes(replace(scene, objects=(*scene.objects, third)), LIBRARY))
    plain, painted = node(document, "chair (c1)")["mesh"], node(document, "chair (c2)")["mesh"]
    assert node(document, "chair (c3)")["mesh"] == plain
    assert painted != plain

    def colours(mesh: int) -> list[list[float]]:
        used = [p["material"] for p in document["meshes"][mesh]["primitives"]]
        return [document["materials"][m]["pbrMetallicRoughness"]["baseColorFactor"][:3] for m in used]

    override = [pytest.approx(c, abs=1 / 255) for c in (0.6038, 0.2140, 0.0100)]
    assert override in colours(painted), "the seat, the larger part, takes the linear value of the override"
    assert len([c for c in colours(painted) if c in colours(plain)]) == 1, "the back keeps its own colour"


def test_hidden_objects_are_left_out() -> None:
    scene = furnished_room(LIBRARY)
    hidden = replace(scene, objects=tuple(replace(o, hidden=o.id == "t") for o in scene.objects))
    names = {n["name"] for n in gltf_reader.check(glb_bytes(hidden, LIBRARY))["nodes"]}
    assert "table (t)" not in names
    assert "ball (b)" in names


def test_textures_survive_upright() -> None:
    """The print's picture has a blue bar on top; so must the reloaded one, seen through its coordinates."""
    loaded = load(glb_bytes(furnished_room(LIBRARY), LIBRARY))
    meshes = [m for m in loaded.geometry.values() if getattr(m.visual, "material", None) is not None]
    textured = [m for m in meshes if m.visual.material.baseColorTexture is not None]
    assert len(textured) == 1
    mesh = textured[0]
    top = mesh.vertices[:, 2].argmax()
    pixels = np.asarray(mesh.visual.material.baseColorTexture.convert("RGB"))
    row = int(np.clip((1 - mesh.visual.uv[top, 1]) * 63, 0, 63))
    assert pixels[row, 32, 2] > 200


def test_plane_texture_covers_the_face_only() -> None:
    picture = np.zeros((40, 80, 3), np.uint8)
    architecture = box_room()
    planes = tuple(replace(p, texture="wall.png") if p.id == "back" else p for p in architecture.planes)
    data = glb_bytes(Scene(None, Architecture(planes)), LIBRARY, textures={"wall.png": picture})
    document = gltf_reader.check(data)
    primitives = document["meshes"][node(document, "wall back")["mesh"]]["primitives"]
    assert ["TEXCOORD_0" in p["attributes"] for p in primitives] == [True, False]
    assert len(document["images"]) == 1


def test_camera_faces_where_the_photo_was_taken() -> None:
    scene = furnished_room(LIBRARY)
    assert scene.camera is not None
    document = gltf_reader.check(glb_bytes(scene, LIBRARY))
    lens = document["cameras"][0]["perspective"]
    assert lens["yfov"] == pytest.approx(scene.camera.intrinsics.vertical_fov_rad)
    assert lens["aspectRatio"] == pytest.approx(4 / 3)
    placed = node(document, "photo camera")
    R_world_camera = Rotation.from_quat(placed["rotation"]).as_matrix()
    np.testing.assert_allclose(-R_world_camera[:, 2], scene.camera.T_world_camera[:3, 2], atol=1e-6)
    np.testing.assert_allclose(-R_world_camera[:, 1], scene.camera.T_world_camera[:3, 1], atol=1e-6)
    np.testing.assert_allclose(placed["translation"], scene.camera.position, atol=1e-6)
    assert document["nodes"].index(placed) in node(document, "diorama")["children"]


def test_pixels_need_not_be_square() -> None:
    scene = furnished_room(LIBRARY)
    assert scene.camera is not None
    squeezed = replace(scene.camera, intrinsics=Intrinsics(320, 240, 200.0, 100.0, 160.0, 120.0))
    document = gltf_reader.check(glb_bytes(replace(scene, camera=squeezed), LIBRARY))
    lens = document["cameras"][0]["perspective"]
    assert np.tan(lens["yfov"] / 2) == pytest.approx(1.2)
    assert lens["aspectRatio"] * np.tan(lens["yfov"] / 2) == pytest.approx(0.8)


def test_an_empty_scene_is_a_valid_file() -> None:
    document = gltf_reader.check(glb_bytes(Scene(), LIBRARY))
    assert [n["name"] for n in document["nodes"]] == ["diorama"]


def test_names_are_unique_and_any_text_is_allowed() -> None:
    objects = tuple(place(LIBRARY, f"o{i}", "ball", (i, 0, 0.1), label='"Ball" <ü> \\ 球') for i in range(3))
    document = gltf_reader.check(glb_bytes(Scene(objects=objects), LIBRARY))
    assert node(document, '"Ball" <ü> \\ 球 (o1)')


def test_same_scene_same_bytes() -> None:
    scene = furnished_room(LIBRARY)
    assert glb_bytes(scene, LIBRARY) == glb_bytes(scene, LIBRARY)


def test_missing_shape_is_named() -> None:
    lost = replace(furnished_room(LIBRARY).objects[0], shape_id="gone")
    with pytest.raises(LibraryError, match="gone"):
        glb_bytes(Scene(objects=(lost,)), LIBRARY)


def test_write_replaces_whole_files(tmp_path) -> None:
    target = tmp_path / "room.glb"
    target.write_bytes(b"old")
    write_glb(furnished_room(LIBRARY), LIBRARY, target)
    gltf_reader.check(target.read_bytes())
    assert [p.name for p in tmp_path.iterdir()] == ["room.glb"]
