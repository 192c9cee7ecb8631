"""Broken and hostile files are refused or repaired, each with its reason; nothing outside the folder is read."""

from __future__ import annotations

import io
import re
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from PIL import Image

from diorama_core.errors import LibraryError
from diorama_core.library.ingest.limits import Limits
from diorama_core.library.ingest.models import RawModel, read_model
from diorama_core.library.ingest.repair import Repaired, repair
from tests.library.ingest.models import TRIANGLE, block, chair, document, write_glb

LIMITS = Limits(file_bytes=2**20, triangles=5_000, nodes=100, image_pixels=2**20, texture_side_px=64)


def read(path: Path) -> tuple[RawModel, Repaired]:
    raw = read_model(path, path.parent, LIMITS)
    return raw, repair(raw.scene, LIMITS)


def test_the_sound_triangle_is_read(tmp_path: Path) -> None:
    raw, model = read(write_glb(tmp_path / "a.glb", document()))
    assert raw.names == ("thing",)
    assert model.warnings == ()
    assert len(model.whole.faces) == 1


CHAINED = [{"mesh": 0}, {"children": [2]}, {"children": [1]}]
DOUBLING = [{"children": [1, 1]}, {"children": [2, 2]}, {"mesh": 0}]
MANY_PARTS = [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}] * 60}]
REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "cyclic": ({"nodes": CHAINED}, "its own ancestor|circle"),
    "own child": ({"nodes": [{"mesh": 0, "children": [0]}]}, "its own ancestor"),
    "doubling": ({"nodes": DOUBLING}, "two parents"),
    "endless accessor": ({"accessors.0": {"count": 10**12, "bufferView": None}}, "claims 1000000000000 items"),
    "past the view": ({"accessors.0": {"count": 4}}, "past its buffer view"),
    "past the buffer": ({"bufferViews.0": {"byteLength": 10**6}}, "past its buffer"),
    "negative offset": ({"bufferViews.0": {"byteOffset": -8}}, "past its buffer"),
    "old version": ({"asset": {"version": "1.0"}}, "version '1.0'"),
    "climbing": ({"buffers.0": {"uri": "../secret.bin"}}, "outside the folder"),
    "absolute": ({"buffers.0": {"uri": "/etc/hostname"}}, "outside the folder"),
    "encoded": ({"buffers.0": {"uri": "%2e%2e/secret.bin"}}, "outside the folder"),
    "from the web": ({"buffers.0": {"uri": "https://example.org/a.bin"}}, "web address"),
    "no mesh": ({"nodes": [{"name": "nothing"}]}, "no triangle|malformed"),
    "mesh of no kind": ({"meshes": 7}, "malformed|list of objects"),
    "many nodes": ({"nodes": [{"mesh": 0}] * 101}, "101 nodes"),
    "repeated mesh": (
        {"meshes": MANY_PARTS, "nodes": [{"mesh": 0}] * 99, "scenes": [{"nodes": list(range(99))}]},
        "5940 triangles",
    ),
}
"""Entries of a document, or of the first row of one of its tables, that are changed; None takes one away."""


@pytest.mark.parametrize("name", REFUSED)
def test_a_hostile_gltf_is_refused(tmp_path: Path, name: str) -> None:
    changes, reason = REFUSED[name]
    made = document()
    for key, value in changes.items():
        table, _, row = key.partition(".")
        if row:
            made[table][0] = {k: v for k, v in (made[table][0] | value).items() if v is not None}
        else:
            made[table] = value
    (tmp_path / "secret.bin").write_bytes(TRIANGLE)
    (tmp_path / "models").mkdir()
    with pytest.raises(LibraryError, match=reason):
        read(write_glb(tmp_path / "models" / "a.glb", made))


BYTES = {
    "empty": (b"", "empty"),
    "noise": (bytes(range(256)) * 4, "malformed|JSON"),
    "header only": (b"glTF" + struct.pack("<II", 2, 10**6), "within its header"),
    "cut off": (b"glTF" + struct.pack("<IIII", 2, 10**6, 4, 0x4E4F534A) + b"{}  ", "cut off"),
    "deep": (b"[" * 200_000, "JSON"),
    "a list": (b"[]", "no glTF document"),
}


@pytest.mark.parametrize("name", BYTES)
def test_bytes_that_are_no_model_are_refused(tmp_path: Path, name: str) -> None:
    data, reason = BYTES[name]
    path = tmp_path / ("a.glb" if data[:4] == b"glTF" else "a.gltf")
    path.write_bytes(data)
    with pytest.raises(LibraryError, match=reason):
        read(path)


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".stl"])
def test_empty_and_noisy_files_of_every_format_are_refused(tmp_path: Path, suffix: str) -> None:
    for data in (b"", b"\x00\xff" * 200, b"hello there\n" * 20):
        path = tmp_path / f"a{suffix}"
        path.write_bytes(data)
        with pytest.raises(LibraryError):
            read(path)


def test_a_huge_file_is_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    with path.open("wb") as stream:
        stream.truncate(2**40)
    with pytest.raises(LibraryError, match=r"has more than the 1\.05 MB"):
        read(path)


def test_too_many_triangles_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.stl"
    trimesh.creation.icosphere(subdivisions=5).export(path)
    with pytest.raises(LibraryError, match=r"MB|triangles"):
        read(path)


def test_a_link_out_of_the_folder_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "secret.bin").write_bytes(TRIANGLE)
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "inside.bin").symlink_to(tmp_path / "secret.bin")
    made = document(buffers=[{"byteLength": 44, "uri": "inside.bin"}])
    with pytest.raises(LibraryError, match="behind a link"):
        read(write_glb(tmp_path / "models" / "a.glb", made))


def test_points_that_are_not_finite_are_left_out(tmp_path: Path) -> None:
    mesh = chair()
    vertices = np.array(mesh.vertices)
    vertices[0] = np.nan
    vertices[9] = np.inf
    path = tmp_path / "a.glb"
    path.write_bytes(trimesh.Scene(trimesh.Trimesh(vertices, mesh.faces, process=False)).export(file_type="glb"))
    _, model = read(path)
    assert any("not finite" in w for w in model.warnings)
    assert np.isfinite(model.whole.vertices).all()
    assert 0 < len(model.whole.faces) < len(mesh.faces)


def test_only_broken_points_is_refused(tmp_path: Path) -> None:
    binary = struct.pack("<9f3H2x", *[float("nan")] * 9, 0, 1, 2)
    with pytest.raises(LibraryError, match="no triangle"):
        read(write_glb(tmp_path / "a.glb", document(), binary))


def test_triangles_of_points_that_do_not_exist_are_left_out(tmp_path: Path) -> None:
    made = document()
    made["accessors"][1]["count"] = 6
    made["bufferViews"][1]["byteLength"] = 12
    made["buffers"] = [{"byteLength": 48}]
    binary = struct.pack("<9f6H", 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0, 1, 2, 0, 1, 60000)
    _, model = read(write_glb(tmp_path / "a.glb", made, binary))
    assert len(model.whole.faces) == 1
    assert any("do not exist" in w for w in model.warnings)


def test_a_flat_line_is_refused(tmp_path: Path) -> None:
    binary = struct.pack("<9f3H2x", 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 2)
    with pytest.raises(LibraryError, match="no triangle"):
        read(write_glb(tmp_path / "a.glb", document(), binary))


def test_a_surface_that_is_not_manifold_is_retained_and_said(tmp_path: Path) -> None:
    fan = trimesh.Trimesh(
        [(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, -1, 0)], [(0, 1, 2), (0, 1, 3), (0, 1, 4)], process=False
    )
    path = tmp_path / "a.ply"
    fan.export(path)
    _, model = read(path)
    assert len(model.whole.faces) == 3
    assert any("not closed and manifold" in w for w in model.warnings)


def png_claiming(width: int, height: int) -> bytes:
    """A PNG of a few bytes whose header claims a huge picture."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(b"\0" * 1000))
        + chunk(b"IEND", b"")
    )


def textured(image: dict[str, Any]) -> dict[str, Any]:
    made = document(
        images=[image],
        textures=[{"source": 0}],
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [0.2, 0.4, 0.6, 1]}}],
    )
    made["meshes"][0]["primitives"][0]["material"] = 0
    return made


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (png_claiming(60_000, 60_000), "decompression bomb|60000 x 60000"),
        (png_claiming(2000, 2000), "2000 x 2000"),
        (b"no picture", "no picture"),
    ],
    ids=["bomb", "large", "noise"],
)
def test_a_texture_that_cannot_be_unpacked_is_left_out(tmp_path: Path, data: bytes, reason: str) -> None:
    (tmp_path / "wood.png").write_bytes(data)
    raw, model = read(write_glb(tmp_path / "a.glb", textured({"uri": "wood.png"})))
    assert len(model.whole.faces) == 1
    assert any(re.search(reason, w) for w in raw.warnings)


def test_a_missing_texture_leaves_the_plain_colour(tmp_path: Path) -> None:
    raw, model = read(write_glb(tmp_path / "a.glb", textured({"uri": "gone.png"})))
    assert raw.warnings == ("texture left out: 'gone.png' is missing",)
    colour = np.asarray(model.meshes[0].visual.material.baseColorFactor)[:3]
    assert np.allclose(colour / (255 if colour.max() > 1 else 1), [0.2, 0.4, 0.6], atol=0.01)


def test_a_texture_outside_the_folder_is_left_out(tmp_path: Path) -> None:
    buffer = io.BytesIO()
    Image.new("RGB", (4, 4), (255, 0, 0)).save(buffer, "PNG")
    (tmp_path / "secret.png").write_bytes(buffer.getvalue())
    (tmp_path / "models").mkdir()
    raw, _ = read(write_glb(tmp_path / "models" / "a.glb", textured({"uri": "../secret.png"})))
    assert "outside the folder" in raw.warnings[0]


def test_textures_are_made_small(tmp_path: Path) -> None:
    Image.new("RGB", (512, 256), (255, 0, 0)).save(tmp_path / "wood.png")
    _, model = read(write_glb(tmp_path / "a.glb", textured({"uri": "wood.png"})))
    assert model.meshes[0].visual.material.baseColorTexture.size == (64, 32)


OBJ = "mtllib {library}\nv 0 0 0\nv 1 0 0\nv 0 1 0.5\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl wood\nf 1/1 2/2 3/3\n"


def test_an_obj_finds_textures_by_an_authors_own_path(tmp_path: Path) -> None:
    Image.new("RGB", (8, 8), (10, 200, 30)).save(tmp_path / "wood.png")
    (tmp_path / "a.obj").write_text(OBJ.format(library="a.mtl"))
    (tmp_path / "a.mtl").write_text("newmtl wood\nKd 1 1 1\nmap_Kd C:\\Users\\me\\textures\\wood.png\n")
    raw, model = read(tmp_path / "a.obj")
    assert raw.warnings == ()
    assert model.meshes[0].visual.material.baseColorTexture.getpixel((0, 0))[1] == pytest.approx(200, abs=6)


@pytest.mark.parametrize("library", ["../secret.mtl", "/etc/passwd", "gone.mtl"])
def test_an_obj_without_its_materials_is_still_a_shape(tmp_path: Path, library: str) -> None:
    (tmp_path / "secret.mtl").write_text("newmtl wood\nKd 1 0 0\n")
    (tmp_path / "models").mkdir()
    path = tmp_path / "models" / "a.obj"
    path.write_text(OBJ.format(library=library))
    raw, model = read(path)
    assert len(model.whole.faces) == 1
    (warning,) = raw.warnings[:1]
    assert "outside" in warning or "missing" in warning


def test_an_obj_face_of_points_that_do_not_exist(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 999999999\n")
    try:
        _, model = read(path)
    except LibraryError:
        return
    assert len(model.whole.faces) == 1


def test_an_unknown_format_says_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "a.blend").write_bytes(b"BLENDER")
    with pytest.raises(LibraryError, match="export GLB"):
        read(tmp_path / "a.blend")


def test_scaled_integers_are_read_as_the_numbers_they_stand_for(tmp_path: Path) -> None:
    made = document(buffers=[{"byteLength": 32}])
    made["accessors"][0] |= {"componentType": 5122, "normalized": True}
    made["bufferViews"] = [
        {"buffer": 0, "byteOffset": 0, "byteLength": 24, "byteStride": 8},
        {"buffer": 0, "byteOffset": 24, "byteLength": 6},
    ]
    binary = struct.pack("<hhhxxhhhxxhhhxx3H2x", 0, 0, 0, 32767, 0, 0, 0, 32767, 16384, 0, 1, 2)
    _, model = read(write_glb(tmp_path / "a.glb", made, binary))
    assert np.allclose(model.whole.bounds, [[0, 0, 0], [1, 1, 0.5]], atol=1e-3)


def test_a_mirrored_part_keeps_its_faces_outward(tmp_path: Path) -> None:
    scene = trimesh.Scene()
    scene.add_geometry(block((1, 1, 1), (0, 0, 0)), transform=np.diag([-1.0, 1, 1, 1]))
    path = tmp_path / "a.glb"
    path.write_bytes(scene.export(file_type="glb"))
    _, model = read(path)
    assert model.whole.volume == pytest.approx(1.0)
