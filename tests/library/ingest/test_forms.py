"""Model files in the forms that programs write: each is read as the plain one is."""

from __future__ import annotations

import io
import json
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_core.errors import LibraryError
from diorama_core.io.file_heads import head_of
from diorama_core.io.glb import read_glb, write_glb
from diorama_core.library.ingest.finding import members_of
from diorama_core.library.ingest.frames import own_frame, squaring_turn
from diorama_core.library.ingest.gltf import use_specular_glossiness
from diorama_core.library.ingest.gltf_compressed import meshopt_view
from diorama_core.library.ingest.joint import exporter_of, groups_of
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.models import MODEL_FORMS, form_of, read_model
from diorama_core.library.ingest.obj import absolute_indices, plain_mtl
from diorama_core.library.ingest.repair import repair, with_thickness
from diorama_core.library.ingest.three_ds import read_3ds
from diorama_core.library.ingest.three_mf import read_3mf
from diorama_core.library.ingest.usd_stage import frame_of, open_stage
from diorama_core.library.kinds import is_possible
from tests.library.ingest.models import chair, y_up


def read(path: Path) -> trimesh.Trimesh:
    return repair(read_model(path, path.parent).scene, DEFAULT_LIMITS).whole


def counting_back(mesh: trimesh.Trimesh) -> bytes:
    lines = []
    for part in mesh.split():
        lines += [f"o part{len(lines)}", *(f"v {x} {y} {z}" for x, y, z in part.vertices)]
        lines += ["f " + " ".join(str(k - len(part.vertices)) for k in face) for face in part.faces]
    return "\n".join(lines).encode()


def test_faces_that_count_back_name_the_vertices_before_them(tmp_path: Path) -> None:
    (tmp_path / "chair.obj").write_bytes(counting_back(chair()))
    assert read(tmp_path / "chair.obj").area == pytest.approx(chair().area, rel=1e-6)
    with pytest.raises(LibraryError, match="before the first"):
        absolute_indices(b"v 0 0 0\nf -1 -2 -3\n")


def test_options_of_maps_are_no_part_of_their_names() -> None:
    mtl = plain_mtl(b"newmtl a\nmap_Kd -s 2 3 1 -clamp off textures/my cloth.png\nmap_Bump -bm 0.5 n.png\n").decode()
    assert "map_Kd textures/my cloth.png\nuv_scale 2 3" in mtl
    assert "map_Bump n.png" in mtl


@pytest.mark.parametrize("name", ["Textures\\CLOTH.PNG", "C:\\Users\\me\\textures\\cloth.png", "textures/cloth.png"])
def test_pictures_are_found_as_any_system_names_them(tmp_path: Path, name: str) -> None:
    from PIL import Image

    (tmp_path / "textures").mkdir()
    Image.new("RGB", (2, 2), (200, 10, 10)).save(tmp_path / "textures" / "cloth.png")
    (tmp_path / "box.mtl").write_text(f"newmtl cloth\nmap_Kd {name}\n")
    (tmp_path / "box.obj").write_text(
        "mtllib Box.MTL\nusemtl cloth\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"
    )
    raw = read_model(tmp_path / "box.obj", tmp_path)
    assert raw.warnings == ()
    assert next(iter(raw.scene.geometry.values())).visual.material.image is not None


def test_a_flat_model_gets_a_thickness_and_keeps_its_middle() -> None:
    plate = trimesh.Trimesh([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]], process=False)
    (thick,), was_flat = with_thickness([plate])
    assert was_flat
    assert thick.extents == pytest.approx([2, 1, 0.01])
    assert thick.bounds.mean(axis=0) == pytest.approx([1, 0.5, 0])
    assert thick.is_watertight
    assert with_thickness([chair()])[1] is False


def test_a_turned_model_is_squared_and_a_round_one_left() -> None:
    turned = chair().apply_transform(trimesh.transformations.rotation_matrix(0.5, (0, 0, 1)))
    R, angle = squaring_turn(turned)
    assert angle == pytest.approx(0.5, abs=1e-6)
    assert np.ptp(turned.vertices @ R.T, axis=0) == pytest.approx(chair().extents, abs=1e-6)
    assert squaring_turn(chair())[1] == 0.0
    assert squaring_turn(trimesh.creation.cylinder(0.3, 1.0, sections=37))[1] == 0.0


def test_kinds_keep_to_possible_sizes() -> None:
    possible = {("rug", (2.0, 1.4, 0.01)), ("television", (0.03, 1.2, 0.7)), ("object", (9.0, 9.0, 9.0))}
    impossible = {
        ("refrigerator", (0.9, 0.03, 2.2)), ("wardrobe", (6.1, 6.9, 2.7)), ("dumbbells", (1.1, 2.3, 0.02)),
        ("dumbbells", (0.37, 0.68, 0.02)), ("dumbbells", (0.07, 0.44, 0.26)),
        ("sideboard", (5.0, 0.1, 2.5)), ("shower", (4.2, 5.2, 2.6)),
    }  # fmt: skip
    assert all(is_possible(name, np.array(size)) for name, size in possible)
    assert not any(is_possible(name, np.array(size)) for name, size in impossible)


def test_diffuse_of_specular_glossiness_is_the_base_colour() -> None:
    found = {"diffuseFactor": [0.4, 0.3, 0.2, 1.0], "diffuseTexture": {"index": 3}, "glossinessFactor": 0.25}
    material = {"extensions": {"KHR_materials_pbrSpecularGlossiness": found}}
    use_specular_glossiness(material)
    plain = material["pbrMetallicRoughness"]
    assert plain["baseColorFactor"] == [0.4, 0.3, 0.2, 1.0]
    assert plain["baseColorTexture"] == {"index": 3}
    assert (plain["metallicFactor"], plain["roughnessFactor"]) == (0.0, 0.75)


def test_the_loader_leaves_colours_of_specular_glossiness_alone(tmp_path: Path) -> None:
    mesh = chair()
    mesh.visual = trimesh.visual.TextureVisuals(material=trimesh.visual.material.PBRMaterial())
    document, binary = read_glb(mesh.export(file_type="glb"))
    dull = {"diffuseFactor": [0.43, 0.27, 0.16, 1.0], "glossinessFactor": 0.2}
    document["materials"] = [{"extensions": {"KHR_materials_pbrSpecularGlossiness": dull}}]
    document["meshes"][0]["primitives"][0]["material"] = 0
    (tmp_path / "chair.glb").write_bytes(write_glb(document, binary))
    (found,) = read_model(tmp_path / "chair.glb", tmp_path).scene.geometry.values()
    assert found.visual.material.baseColorFactor[:3] == pytest.approx([110, 69, 41], abs=1)


@pytest.mark.parametrize("compress", ["draco", "meshopt"])
def test_what_diorama_compressed_comes_back_as_it_was(tmp_path: Path, compress: str) -> None:
    if compress == "draco":
        pytest.importorskip("DracoPy")
    from diorama_core.export import export_scene
    from diorama_core.export.gathering import ExportOptions
    from tests.primitives import PrimitiveLibrary, furnished_room

    library = PrimitiveLibrary()
    scene = furnished_room(library)
    item = next(o for o in scene.objects if abs(o.pose.yaw_rad) > 0.05)
    options = ExportOptions(only=frozenset({item.id}), compression=compress)
    export_scene(scene, library, tmp_path / "one.glb", "glb", options=options)
    raw = read_model(tmp_path / "one.glb", tmp_path)
    assert raw.own is not None
    assert raw.own.category == item.category
    whole = repair(raw.scene, DEFAULT_LIMITS).whole
    assert np.ptp(whole.vertices @ raw.own.R_file_object, axis=0) == pytest.approx(np.array(item.size_m), abs=2e-3)


def test_a_view_that_claims_too_much_is_refused() -> None:
    row = {"extensions": {"EXT_meshopt_compression": {"buffer": 0, "byteLength": 4, "byteStride": 12, "count": 10**9}}}
    with pytest.raises(LibraryError, match="claims"):
        meshopt_view(row, [b"abcd"], DEFAULT_LIMITS)
    assert own_frame({"nodes": [{}]}) is None


def test_collada_3mf_and_zip_are_read(tmp_path: Path) -> None:
    pytest.importorskip("collada")
    y_up(chair()).export(tmp_path / "chair.dae")
    assert read(tmp_path / "chair.dae").area == pytest.approx(chair().area, rel=1e-4)
    mesh, mm = chair(), 1000.0
    vertices = "".join(f'<vertex x="{x * mm}" y="{y * mm}" z="{z * mm}"/>' for x, y, z in mesh.vertices)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in mesh.faces)
    model = (
        '<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
        f'<object id="1"><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object>'
        '</resources><build><item objectid="1" transform="1 0 0 0 1 0 0 0 1 10 0 0"/></build></model>'
    )
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as package:
        package.writestr("3D/3dmodel.model", model)
    scene, unit_m = read_3mf(buffer.getvalue(), DEFAULT_LIMITS)
    assert unit_m == 0.001
    assert scene.extents * unit_m == pytest.approx(chair().extents)
    with zipfile.ZipFile(tmp_path / "pack.zip", "w") as archive:
        archive.writestr("a/chair.obj", chair().export(file_type="obj"))
        archive.writestr("a/readme.txt", "x")
    assert members_of(tmp_path / "pack.zip") == ("a/chair.obj",)
    raw = read_model(tmp_path / "pack.zip", tmp_path, member="a/chair.obj")
    assert raw.scene.extents == pytest.approx(chair().extents)


def chunk(kind: int, body: bytes) -> bytes:
    return struct.pack("<HI", kind, 6 + len(body)) + body


def test_3ds_is_read_with_its_colour() -> None:
    mesh = chair()
    vertices = struct.pack("<H", len(mesh.vertices)) + mesh.vertices.astype("<f4").tobytes()
    rows = np.column_stack([mesh.faces, np.zeros(len(mesh.faces))]).astype("<u2").tobytes()
    used = chunk(0x4130, b"wood\0" + struct.pack("<H", 0))
    faces = chunk(0x4120, struct.pack("<H", len(mesh.faces)) + rows + used)
    body = chunk(0x4000, b"seat\0" + chunk(0x4100, chunk(0x4110, vertices) + faces))
    colour = chunk(0xAFFF, chunk(0xA000, b"wood\0") + chunk(0xA020, chunk(0x0011, bytes([200, 100, 50]))))
    scene, names = read_3ds(chunk(0x4D4D, chunk(0x3D3D, colour + body)))
    assert names == ("seat",)
    assert scene.extents == pytest.approx(mesh.extents, abs=1e-5)
    material = next(iter(scene.geometry.values())).visual.material
    assert np.asarray(material.baseColorFactor)[:3] == pytest.approx([200, 100, 50], abs=1)
    with pytest.raises(LibraryError, match="cut off"):
        read_3ds(b"MM\x10\x00\x00\x00")


def test_content_tells_the_format_before_the_name(tmp_path: Path) -> None:
    (tmp_path / "chair.obj").write_bytes(chair().export(file_type="glb"))
    form = form_of(head_of(tmp_path / "chair.obj"))
    assert form is not None
    assert form.name == "glTF"
    assert read(tmp_path / "chair.obj").area == pytest.approx(chair().area, rel=1e-5)
    assert len({f.name for f in MODEL_FORMS}) == len(MODEL_FORMS)
    (tmp_path / "lfs.glb").write_bytes(b"version https://git-lfs.github.com/spec/v1\noid sha256:0")
    with pytest.raises(LibraryError, match="Git LFS"):
        read(tmp_path / "lfs.glb")


def test_files_are_grouped_by_folder_and_exporter(tmp_path: Path) -> None:
    names = []
    for number in range(4):
        (tmp_path / f"{number}.obj").write_text("# Blender v2.93 OBJ File: export\n" if number else "v 0 0 0\n")
        names.append(tmp_path / f"{number}.obj")
    groups = groups_of(names, tmp_path)
    assert len(set(groups.values())) == 2
    assert "blender" in exporter_of(names[1])
    generator = json.dumps({"asset": {"version": "2.0", "generator": "Khronos glTF Blender I/O v3.2.40"}})
    (tmp_path / "a.gltf").write_text(generator)
    assert exporter_of(tmp_path / "a.gltf").startswith("khronos")


def test_usd_says_its_frame_and_is_read_in_it(tmp_path: Path) -> None:
    pytest.importorskip("pxr", reason="needs the extra [usd]")
    mesh, cm = chair(), 100.0
    points = ", ".join(f"({x * cm}, {y * cm}, {z * cm})" for x, y, z in mesh.vertices)
    indices = ", ".join(str(k) for k in mesh.faces.reshape(-1))
    (tmp_path / "chair.usda").write_text(
        '#usda 1.0\n(\n    metersPerUnit = 0.01\n    upAxis = "Z"\n)\ndef Mesh "chair"\n{\n'
        f"    int[] faceVertexCounts = [{', '.join(['3'] * len(mesh.faces))}]\n"
        f"    int[] faceVertexIndices = [{indices}]\n    point3f[] points = [{points}]\n}}\n"
    )
    assert frame_of(open_stage(tmp_path / "chair.usda")) == ("+z", 0.01)
    raw = read_model(tmp_path / "chair.usda", tmp_path)
    assert raw.scene.extents == pytest.approx(chair().extents * cm, rel=1e-5)
    assert raw.convention.up["+z"] > 0.9
