"""glTF and GLB: checked, and packed into one GLB that refers to nothing outside itself.

What a hostile or broken file could do (read other files, claim terabytes, turn in circles) is refused here, before a
general loader sees it. Rules: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
"""

from __future__ import annotations

import base64
import binascii
import io
from typing import Any

import numpy as np
from PIL import Image

from diorama_core.errors import LibraryError
from diorama_core.io.bounded import parse_json, shorten
from diorama_core.io.contained import quote
from diorama_core.io.glb import GlbError, is_glb, split_glb, write_glb
from diorama_core.library.ingest.frames import OwnFrame, own_frame
from diorama_core.library.ingest.gltf_compressed import is_fallback, meshopt_view, undo_draco
from diorama_core.library.ingest.limits import Limits
from diorama_core.library.ingest.references import References

Json = dict[str, Any]
_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_ITEMS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
SPECULAR_GLOSSINESS = "KHR_materials_pbrSpecularGlossiness"
TRANSFORM = "KHR_texture_transform"
METAL_SPECULAR, METAL_DIFFUSE = 0.5, 0.2
"""A dark material that reflects so much is metal."""


def pack_glb(data: bytes, references: References, limits: Limits) -> bytes:
    """A GLB with the same content, every reference inside it and every number checked.

    Args:
        data: A GLB, or the text of a glTF file.
        references: Reads the buffers and pictures it names; collects warnings.
        limits: What is refused.

    Raises:
        LibraryError: with the reason, when the file is malformed, hostile, too large or needs a missing decoder.
    """
    document, binary = container(data, limits)
    try:
        version = str(document.get("asset", {}).get("version", ""))
        if not version.startswith("2"):
            raise LibraryError(f"glTF version {quote(version)} is not supported; save it as glTF 2.0")
        buffers = [_buffer(row, k, binary, references) for k, row in enumerate(_rows(document, "buffers"))]
        views = [_view(row, buffers, limits) for row in _rows(document, "bufferViews")]
        undo_draco(document, views, limits)
        for accessor in _rows(document, "accessors"):
            _check_accessor(accessor, document, views, limits)
        _check_nodes(document, limits)
        return _repack(document, views, references)
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise LibraryError(f"malformed glTF ({type(error).__name__}: {shorten(str(error))})") from error


def node_names(glb: bytes) -> tuple[str, ...]:
    """Names that the author gave to scenes, nodes, meshes and materials, in the file's order."""
    document, _ = container(glb, Limits())
    rows = [row for kind in ("scenes", "nodes", "meshes", "materials") for row in document.get(kind, [])]
    return tuple(str(row["name"]) for row in rows if isinstance(row, dict) and row.get("name"))


def frame_of_own(glb: bytes) -> OwnFrame | None:
    """The frame of the one object that Diorama wrote into a file; None where there is none."""
    return own_frame(container(glb, Limits())[0])


def container(data: bytes, limits: Limits) -> tuple[Json, bytes | None]:
    """The JSON document and the binary chunk of a GLB, or the document alone of a glTF file, as they stand.

    Raises:
        LibraryError: when the container or its JSON is malformed or too large.
    """
    text, binary = data, None
    if is_glb(data):
        try:
            text, binary = split_glb(data)
        except GlbError as error:
            raise LibraryError(str(error)) from error
    if len(text) > limits.json_bytes:
        raise LibraryError(f"its JSON has {len(text) / 2**20:.0f} MB; the limit is {limits.json_bytes / 2**20:.0f} MB")
    document = parse_json(text, "its JSON", LibraryError, advice="export the model again", finite=False)
    if not isinstance(document, dict):
        raise LibraryError("its JSON is no glTF document")
    return document, binary


def _rows(document: Json, name: str) -> list[Json]:
    rows = document.get(name, [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise LibraryError(f"malformed glTF ('{name}' is no list of objects)")
    return rows


def _buffer(row: Json, number: int, binary: bytes | None, references: References) -> bytes:
    length, uri = row["byteLength"], row.get("uri")
    if is_fallback(row):
        return b""
    if uri is None:
        if number != 0 or binary is None:
            raise LibraryError("a buffer names no data")
        data = binary
    elif uri.startswith("data:"):
        data = _data_uri(uri)
    else:
        data = references.read(uri)
    if not 0 <= length <= len(data):
        raise LibraryError(f"a buffer is cut off: {len(data)} of {length} bytes")
    return data[:length]


def _data_uri(uri: str) -> bytes:
    head, _, body = uri.partition(",")
    if not head.endswith(";base64"):
        raise LibraryError("a data address is not base64")
    try:
        return base64.b64decode(body, validate=True)
    except binascii.Error as error:
        raise LibraryError("a data address is broken base64") from error


def _view(row: Json, buffers: list[bytes], limits: Limits) -> bytes:
    plain = meshopt_view(row, buffers, limits)
    if plain is not None:
        return plain
    start, length = row.get("byteOffset", 0), row["byteLength"]
    data = buffers[row["buffer"]]
    if start < 0 or length < 0 or start + length > len(data):
        raise LibraryError("a buffer view reaches past its buffer")
    return data[start : start + length]


def _check_accessor(accessor: Json, document: Json, views: list[bytes], limits: Limits) -> None:
    count = accessor["count"]
    width = _ITEMS[accessor["type"]] * np.dtype(_COMPONENTS[accessor["componentType"]]).itemsize
    if not isinstance(count, int) or count < 0 or count > 3 * limits.triangles:
        raise LibraryError(f"an accessor claims {count} items; the limit is {3 * limits.triangles}")
    if "bufferView" not in accessor:
        return
    row = document["bufferViews"][accessor["bufferView"]]
    stride = row.get("byteStride", width)
    if not isinstance(stride, int) or stride < width:
        raise LibraryError("a buffer view has an impossible stride")
    start = accessor.get("byteOffset", 0)
    if start < 0 or (count and start + (count - 1) * stride + width > len(views[accessor["bufferView"]])):
        raise LibraryError("an accessor reaches past its buffer view")


def _check_nodes(document: Json, limits: Limits) -> None:
    """Nodes form a forest (each has one parent, none is its own ancestor), and what they draw is bounded."""
    nodes = _rows(document, "nodes")
    if len(nodes) > limits.nodes:
        raise LibraryError(f"{len(nodes)} nodes; the limit is {limits.nodes}")
    parents = [-1] * len(nodes)
    for number, node in enumerate(nodes):
        for child in node.get("children", []):
            if not 0 <= child < len(nodes):
                raise LibraryError(f"node {number} has a child that does not exist")
            if parents[child] >= 0:
                raise LibraryError(f"node {child} has two parents, which glTF forbids")
            parents[child] = number
    settled = [False] * len(nodes)
    for number in range(len(nodes)):
        trail = [number]
        while not settled[trail[-1]] and parents[trail[-1]] >= 0:
            trail.append(parents[trail[-1]])
            if trail[-1] == number:
                raise LibraryError(f"node {number} is its own ancestor")
            if len(trail) > len(nodes):
                raise LibraryError("nodes refer to one another in a circle")
        for step in trail:
            settled[step] = True
    drawn = sum(_triangles(document["meshes"][n["mesh"]], document) for n in nodes if "mesh" in n)
    if drawn > limits.triangles:
        raise LibraryError(f"{drawn} triangles; the limit is {limits.triangles}")


def _triangles(mesh: Json, document: Json) -> int:
    total = 0
    for primitive in mesh["primitives"]:
        accessor = primitive.get("indices", primitive["attributes"]["POSITION"])
        total += document["accessors"][accessor]["count"] // (3 if primitive.get("mode", 4) == 4 else 1)
    return total


def _repack(document: Json, views: list[bytes], references: References) -> bytes:
    """The document with one buffer, floats instead of scaled integers, and pictures that can be unpacked."""
    views = list(views)
    rows = [dict(row) for row in document.get("bufferViews", [])]
    for accessor in document.get("accessors", []):
        if accessor.get("normalized") and accessor["componentType"] != 5126 and "bufferView" in accessor:
            _unscale(accessor, rows, views)
    place_textures(document, rows, views)
    for image in document.get("images", []):
        data = _image_bytes(image, views, references) or _blank_png()
        image.clear()
        image["bufferView"] = len(views)
        image["mimeType"] = "image/png" if data[:4] == b"\x89PNG" else "image/jpeg"
        views.append(data)
        rows.append({})
    for texture in document.get("textures", []):
        _use_webp(texture)
    for material in document.get("materials", []):
        use_specular_glossiness(material)
    parts, at = [], 0
    for name in ("extensionsRequired", "extensionsUsed"):
        document.pop(name, None)  # what needed them is plain now
    for row, data in zip(rows, views, strict=True):
        row.pop("extensions", None)
        row |= {"buffer": 0, "byteOffset": at, "byteLength": len(data)}
        parts.append(data + b"\0" * (-len(data) % 4))
        at += len(parts[-1])
    document["bufferViews"], document["buffers"] = rows, [{"byteLength": at}]
    document.setdefault("accessors", [])
    return write_glb(document, b"".join(parts), allow_nan=True)


def _unscale(accessor: Json, rows: list[Json], views: list[bytes]) -> None:
    """Turn an accessor of scaled integers into one of floats, which every loader reads alike."""
    raw = _numbers(accessor, _ITEMS[accessor["type"]], rows, views)
    scaled = np.maximum(raw.astype("<f4") / np.iinfo(raw.dtype).max, -1.0).astype("<f4")
    accessor |= {"componentType": 5126, "bufferView": len(views), "byteOffset": 0, "normalized": False}
    views.append(scaled.tobytes())
    rows.append({})


def _numbers(accessor: Json, items: int, rows: list[Json], views: list[bytes]) -> np.ndarray:
    """The first numbers of every item of an accessor, as they are stored."""
    kind, at = np.dtype(_COMPONENTS[accessor["componentType"]]), accessor["bufferView"]
    strides = (rows[at].get("byteStride", kind.itemsize * items), kind.itemsize)
    return np.ndarray((accessor["count"], items), kind, views[at], accessor.get("byteOffset", 0), strides)


def _image_bytes(image: Json, views: list[bytes], references: References) -> bytes | None:
    if "bufferView" in image:
        return references.check_image(views[image["bufferView"]], str(image.get("name", "a picture inside the file")))
    uri = image.get("uri", "")
    if uri.startswith("data:"):
        return references.check_image(_data_uri(uri), "a picture inside the file")
    return references.image(uri)


def _use_webp(texture: Json) -> None:
    """Textures whose picture is named by an extension only: read that picture as if it were named plainly."""
    extensions = texture.get("extensions", {})
    for name in ("EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds"):
        if "source" not in texture and name in extensions:
            texture["source"] = extensions[name]["source"]


def _blank_png() -> bytes:
    """A white picture: where a texture is left out, the material's plain colour remains."""
    buffer = io.BytesIO()
    Image.new("RGB", (1, 1), (255, 255, 255)).save(buffer, "PNG")
    return buffer.getvalue()


def use_specular_glossiness(material: Json) -> None:
    """Diffuse colour and picture as base colour, glossiness as 1 - roughness, where the material has nothing else."""
    # The loader converts what it still finds, and makes dull colours white.
    extension = material.get("extensions", {}).pop(SPECULAR_GLOSSINESS, None)
    plain = material.setdefault("pbrMetallicRoughness", {})
    if extension is None or "baseColorTexture" in plain or "baseColorFactor" in plain:
        return
    diffuse = [float(v) for v in extension.get("diffuseFactor", [1.0, 1.0, 1.0, 1.0])]
    specular = [float(v) for v in extension.get("specularFactor", [1.0, 1.0, 1.0])]
    metal = (
        "diffuseTexture" not in extension
        and "specularGlossinessTexture" not in extension
        and max(specular) > METAL_SPECULAR
        and max(diffuse[:3]) < METAL_DIFFUSE
    )
    plain["baseColorFactor"] = [*specular, diffuse[3]] if metal else diffuse
    if "diffuseTexture" in extension:
        plain["baseColorTexture"] = extension["diffuseTexture"]
    plain["metallicFactor"] = 1.0 if metal else 0.0
    plain["roughnessFactor"] = 1.0 - float(extension.get("glossinessFactor", 1.0)) * (
        0.5 if "specularGlossinessTexture" in extension else 1.0
    )


def place_textures(document: Json, rows: list[Json], views: list[bytes]) -> None:
    """Texture coordinates as the base colour's picture uses them: its set, moved, turned and scaled as it says."""
    made: dict[tuple[int, str], int] = {}
    materials = document.get("materials", [])
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            if "material" not in primitive:
                continue
            texture = materials[primitive["material"]].get("pbrMetallicRoughness", {}).get("baseColorTexture")
            transform = (texture or {}).get("extensions", {}).get(TRANSFORM, {})
            number = transform.get("texCoord", (texture or {}).get("texCoord", 0))
            source = primitive["attributes"].get(f"TEXCOORD_{number}")
            if source is None or not (transform or number):
                continue
            key = (source, repr(sorted(transform.items())))
            if key not in made:
                made[key] = _place(document, rows, views, source, transform)
            primitive["attributes"] = {**primitive["attributes"], "TEXCOORD_0": made[key]}


def _place(document: Json, rows: list[Json], views: list[bytes], source: int, transform: Json) -> int:
    """A new accessor with the coordinates of another one, transformed."""
    accessor = document["accessors"][source]
    if accessor["componentType"] != 5126 or "bufferView" not in accessor:
        return source
    angle = float(transform.get("rotation", 0.0))
    c, s = np.cos(angle), np.sin(angle)
    scaled = _numbers(accessor, 2, rows, views) * np.asarray(transform.get("scale", [1.0, 1.0]), float)
    turned = scaled @ np.array([[c, -s], [s, c]])
    moved = turned + np.asarray(transform.get("offset", [0.0, 0.0]), float)
    views.append(moved.astype("<f4").tobytes())
    rows.append({"buffer": 0, "byteLength": len(views[-1])})
    plain = {"bufferView": len(views) - 1, "componentType": 5126, "count": accessor["count"], "type": "VEC2"}
    document["accessors"].append(plain)
    return len(document["accessors"]) - 1
