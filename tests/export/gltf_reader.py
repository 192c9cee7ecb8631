"""A strict reader of GLB files: everything the specification demands and our files use, asserted."""

from __future__ import annotations

import json
import struct

import meshoptimizer
import numpy as np

COMPONENTS = {5121: np.dtype("u1"), 5123: np.dtype("<u2"), 5125: np.dtype("<u4"), 5126: np.dtype("<f4")}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def _refuse(constant: str) -> float:
    raise ValueError(f"JSON must not contain {constant}")


def read(data: bytes) -> tuple[dict, bytes]:
    """The JSON and the binary chunk of a valid container."""
    magic, version, length = struct.unpack_from("<III", data)
    assert (magic, version, length) == (0x46546C67, 2, len(data))
    size, kind = struct.unpack_from("<II", data, 12)
    assert kind == 0x4E4F534A
    assert size % 4 == 0
    document = json.loads(data[20 : 20 + size], parse_constant=_refuse)
    at = 20 + size
    if at == len(data):
        return document, b""
    binary_size, binary_kind = struct.unpack_from("<II", data, at)
    assert binary_kind == 0x004E4942
    assert binary_size % 4 == 0
    assert at + 8 + binary_size == len(data)
    return document, data[at + 8 :]


def values(document: dict, binary: bytes, index: int) -> np.ndarray:
    """The numbers of an accessor, after checking where they lie."""
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    component, width = COMPONENTS[accessor["componentType"]], WIDTHS[accessor["type"]]
    start, count = view.get("byteOffset", 0) + accessor.get("byteOffset", 0), accessor["count"]
    assert start % component.itemsize == 0
    assert view.get("byteOffset", 0) % 4 == 0
    assert count * width * component.itemsize <= view["byteLength"]
    numbers = np.frombuffer(binary, component, count * width, start).reshape(count, width)
    assert np.isfinite(numbers).all()
    return numbers


def unpacked(document: dict, binary: bytes, index: int) -> np.ndarray:
    """The numbers of an accessor that EXT_meshopt_compression packed."""
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]["extensions"]["EXT_meshopt_compression"]
    packed = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    if view["mode"] == "TRIANGLES":
        return meshoptimizer.decode_index_buffer(view["count"], 4, packed).reshape(-1)
    return meshoptimizer.decode_vertex_buffer(view["count"], view["byteStride"], packed)


def check(data: bytes) -> dict:
    """Assert that a file is sound and return its JSON."""
    document, binary = read(data)
    assert document["asset"]["version"] == "2.0"
    for view in document.get("bufferViews", ()):
        assert view.get("byteOffset", 0) + view["byteLength"] <= document["buffers"][view["buffer"]]["byteLength"]
    used: set[int] = set()
    for mesh in document.get("meshes", ()):
        for primitive in mesh["primitives"]:
            _check_primitive(document, binary, primitive, used)
    assert used == set(range(len(document.get("accessors", ())))), "an accessor is not used"
    _check_nodes(document)
    for texture in document.get("textures", ()):
        image = document["images"][texture["source"]]
        view = document["bufferViews"][image["bufferView"]]
        start = view["byteOffset"]
        signature = {"image/png": b"\x89PNG", "image/jpeg": b"\xff\xd8\xff"}[image["mimeType"]]
        assert binary[start : start + len(signature)] == signature
    return document


def _check_primitive(document: dict, binary: bytes, primitive: dict, used: set[int]) -> None:
    counts = {document["accessors"][i]["count"] for i in primitive["attributes"].values()}
    assert len(counts) == 1
    indices = values(document, binary, primitive["indices"])
    assert len(indices) % 3 == 0
    assert int(indices.max()) < counts.pop()
    points = values(document, binary, primitive["attributes"]["POSITION"])
    stated = document["accessors"][primitive["attributes"]["POSITION"]]
    np.testing.assert_array_equal(points.min(axis=0), np.array(stated["min"], np.float32))
    np.testing.assert_array_equal(points.max(axis=0), np.array(stated["max"], np.float32))
    normals = values(document, binary, primitive["attributes"]["NORMAL"])
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-3)
    material = document["materials"][primitive["material"]]
    if "baseColorTexture" in material["pbrMetallicRoughness"]:
        assert "TEXCOORD_0" in primitive["attributes"]
    used |= {primitive["indices"], *primitive["attributes"].values()}


def _check_nodes(document: dict) -> None:
    nodes = document["nodes"]
    children = [c for node in nodes for c in node.get("children", ())]
    assert len(children) == len(set(children)), "a node has two parents"
    assert all("children" not in node or node["children"] for node in nodes), "an empty list is not allowed"
    for node in nodes:
        if "rotation" in node:
            assert abs(np.linalg.norm(node["rotation"]) - 1) < 1e-5
    names = [node["name"] for node in nodes]
    assert len(names) == len(set(names))
    assert document["scenes"][document["scene"]]["nodes"]
