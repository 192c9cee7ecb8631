"""What ingestion makes of a glTF: one GLB with everything inside. Hostile files are in `test_hostile`."""

from __future__ import annotations

import base64
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from PIL import Image

from diorama_core.errors import LibraryError
from diorama_core.io.glb import split_glb, write_glb
from diorama_core.library.ingest.gltf import node_names, pack_glb
from diorama_core.library.ingest.limits import Limits
from diorama_core.library.ingest.references import References

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0]], "<f4")


def png(colour: tuple[int, int, int] = (10, 200, 30)) -> bytes:
    buffer = io.BytesIO()
    Image.new("RGB", (4, 4), colour).save(buffer, "PNG")
    return buffer.getvalue()


def document(**more: Any) -> dict[str, Any]:
    """One triangle whose points are the whole of buffer 0."""
    return {
        "asset": {"version": "2.0"},
        "scenes": [{"name": "Room", "nodes": [0]}],
        "scene": 0,
        "nodes": [{"name": "Lamp", "mesh": 0}],
        "meshes": [{"name": "Shade", "primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36}],
    } | more


def pack(tmp_path: Path, data: bytes, limits: Limits | None = None) -> tuple[dict[str, Any], bytes, list[str]]:
    """Document, binary chunk and warnings."""
    limits = limits or Limits()
    references = References(tmp_path, tmp_path, limits)
    text, binary = split_glb(pack_glb(data, references, limits))
    return json.loads(text), binary, references.warnings


def packed(tmp_path: Path, **more: Any) -> tuple[dict[str, Any], bytes, list[str]]:
    """`pack` of the one triangle with these entries."""
    return pack(tmp_path, write_glb(document(**more), POINTS.tobytes()))


def picture_in(doc: dict[str, Any], binary: bytes) -> bytes:
    (image,) = doc["images"]
    view = doc["bufferViews"][image["bufferView"]]
    return binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]


def accessor_values(row: dict[str, Any], doc: dict[str, Any], binary: bytes) -> np.ndarray:
    view = doc["bufferViews"][row["bufferView"]]
    raw = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    return np.frombuffer(raw, "<f4").reshape(row["count"], -1)


def source(kind: str, folder: Path) -> bytes:
    """One triangle as a GLB, with a data address, or with a file beside it."""
    if kind == "glb":
        return write_glb(document(), POINTS.tobytes())
    if kind == "data":
        uri = "data:application/octet-stream;base64," + base64.b64encode(POINTS.tobytes()).decode()
    else:
        uri = "points.bin"
        (folder / uri).write_bytes(POINTS.tobytes() + b"rest")
    return json.dumps(document(buffers=[{"byteLength": 36, "uri": uri}])).encode()


@pytest.mark.parametrize("kind", ["glb", "data", "beside"])
def test_points_end_up_inside_one_glb(tmp_path: Path, kind: str) -> None:
    doc, binary, warnings = pack(tmp_path, source(kind, tmp_path))
    np.testing.assert_array_equal(accessor_values(doc["accessors"][0], doc, binary), POINTS)
    assert doc["buffers"] == [{"byteLength": len(binary)}]
    assert warnings == []
    limits = Limits()
    glb = pack_glb(source(kind, tmp_path), References(tmp_path, tmp_path, limits), limits)
    mesh = trimesh.load(io.BytesIO(glb), file_type="glb", force="mesh")
    np.testing.assert_allclose(mesh.bounds, [[0, 0, 0], [1, 2, 0]])


def test_views_of_several_buffers_are_laid_one_after_another_on_fours(tmp_path: Path) -> None:
    other = b"\x01\x02\x03\x04\x05"
    uri = "data:application/octet-stream;base64," + base64.b64encode(b"--" + other).decode()
    more = document(
        bufferViews=[{"buffer": 1, "byteOffset": 2, "byteLength": 5}, {"buffer": 0, "byteLength": 36}],
        accessors=[{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}],
        buffers=[{"byteLength": 36}, {"byteLength": 7, "uri": uri}],
    )
    doc, binary, _ = pack(tmp_path, write_glb(more, POINTS.tobytes()))
    first, second = doc["bufferViews"]
    assert (first["byteOffset"], first["byteLength"], second["byteOffset"]) == (0, 5, 8)
    assert binary[:5] == other
    np.testing.assert_array_equal(accessor_values(doc["accessors"][0], doc, binary), POINTS)


def test_scaled_integers_with_a_stride_become_floats(tmp_path: Path) -> None:
    raw = b"".join(np.array(row, "<i2").tobytes() + b"pad!" for row in ([32767, 0], [-32768, -16384], [16384, 1]))
    whole = document(buffers=[{"byteLength": 60}])
    whole["accessors"].append({"bufferView": 1, "componentType": 5122, "count": 3, "type": "VEC2", "normalized": True})
    whole["bufferViews"].append({"buffer": 0, "byteOffset": 36, "byteLength": 24, "byteStride": 8})
    doc, binary, _ = pack(tmp_path, write_glb(whole, POINTS.tobytes() + raw))
    row = doc["accessors"][1]
    assert (row["componentType"], row["normalized"]) == (5126, False)
    expected = np.array([[1.0, 0.0], [-1.0, -16384 / 32767], [16384 / 32767, 1 / 32767]])
    np.testing.assert_allclose(accessor_values(row, doc, binary), expected, rtol=1e-6)


def test_a_picture_beside_the_model_is_taken_inside(tmp_path: Path) -> None:
    (tmp_path / "wood.png").write_bytes(png())
    doc, binary, warnings = packed(tmp_path, images=[{"uri": "wood.png", "name": "wood"}])
    assert picture_in(doc, binary) == png()
    assert doc["images"][0]["mimeType"] == "image/png"
    assert "uri" not in doc["images"][0]
    assert warnings == []


def test_a_missing_picture_becomes_white_with_a_warning(tmp_path: Path) -> None:
    doc, binary, warnings = packed(tmp_path, images=[{"uri": "gone.png"}])
    assert np.asarray(Image.open(io.BytesIO(picture_in(doc, binary)))).tolist() == [[[255, 255, 255]]]
    assert warnings == ["texture left out: 'gone.png' is missing"]


def test_a_webp_texture_is_named_plainly(tmp_path: Path) -> None:
    textures = [{"extensions": {"EXT_texture_webp": {"source": 1}}}, {"source": 0}]
    images = [{"uri": "data:image/png;base64," + base64.b64encode(png()).decode()}] * 2
    doc, _, _ = packed(tmp_path, textures=textures, images=[dict(i) for i in images])
    assert [t["source"] for t in doc["textures"]] == [1, 0]


def test_names_come_in_the_files_order() -> None:
    glb = write_glb(document(materials=[{"name": "Brass"}, {}]), POINTS.tobytes())
    assert node_names(glb) == ("Room", "Lamp", "Shade", "Brass")


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "no data": ({"buffers": [{"byteLength": 36}, {"byteLength": 4}]}, "a buffer names no data"),
    "not base64": ({"buffers": [{"byteLength": 4, "uri": "data:text/plain,abcd"}]}, "is not base64"),
    "broken base64": ({"buffers": [{"byteLength": 4, "uri": "data:;base64,a!"}]}, "broken base64"),
    "stride": ({"bufferViews": [{"buffer": 0, "byteLength": 36, "byteStride": 4}]}, "impossible stride"),
    "child": ({"nodes": [{"mesh": 0, "children": [7]}]}, "a child that does not exist"),
    "two parents": ({"nodes": [{"children": [2]}, {"children": [2]}, {"mesh": 0}]}, "two parents"),
    "rows": ({"nodes": {"0": {}}}, "'nodes' is no list"),
    "type": ({"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC9"}]}, "malformed glTF"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_breaks_the_rules_is_refused_with_the_reason(tmp_path: Path, name: str) -> None:
    edit, reason = REFUSED[name]
    with pytest.raises(LibraryError, match=reason):
        packed(tmp_path, **edit)


def test_limits_are_counted_over_what_is_drawn(tmp_path: Path) -> None:
    three = document(nodes=[{"mesh": 0}] * 3)
    glb = write_glb(three, POINTS.tobytes())
    pack(tmp_path, glb, Limits(triangles=3))
    with pytest.raises(LibraryError, match="3 triangles; the limit is 2"):
        pack(tmp_path, glb, Limits(triangles=2))
    with pytest.raises(LibraryError, match="3 nodes; the limit is 2"):
        pack(tmp_path, glb, Limits(nodes=2))
    with pytest.raises(LibraryError, match="its JSON has"):
        pack(tmp_path, glb, Limits(json_bytes=10))


@pytest.mark.parametrize("data", [b"[1, 2]", b"{", b"glTF\x02\0\0\0"])
def test_what_is_no_document_is_refused(tmp_path: Path, data: bytes) -> None:
    with pytest.raises(LibraryError):
        pack(tmp_path, data)
