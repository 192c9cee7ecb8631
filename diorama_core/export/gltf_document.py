"""Putting a glTF 2.0 document together: typed data in one buffer, shared materials and pictures, and the GLB around it.

Written to the letter of the Khronos specification: little endian, every view aligned to four bytes, bounds stated
for positions, indices as small as they can be, texture rows from the top, pictures with power-of-two sides.

Compressed by EXT_meshopt_compression, positions are rounded to a sixteenth of a millimetre and texture coordinates to
1/4096, which moves nothing visibly; directions become normalised bytes (KHR_mesh_quantization). By
KHR_draco_mesh_compression (Google's Draco, by DracoPy) normals move by a quarter of a degree, the others by as much.
"""

from __future__ import annotations

import io
import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import meshoptimizer
import numpy as np
from jaxtyping import Float, Float32, Int, Integer
from scipy.spatial.transform import Rotation

from diorama_core.errors import UnavailableError
from diorama_core.export.gathering import Compression
from diorama_core.export.pictures import OncePerPicture, Picture, texture_file
from diorama_core.io.atomic import ByteSink
from diorama_core.render.appearance import Material, Surface

_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963
_COMPONENT_TYPES = {"f4": 5126, "u2": 5123, "u4": 5125, "i1": 5120}
_MEDIA_TYPES = {".jpg": "image/jpeg", ".png": "image/png"}
_WIDTHS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_MAGIC, _JSON_CHUNK, _BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
TextureFiles = OncePerPicture[[], tuple[str, bytes]]
MESHOPT_EXTENSION = "EXT_meshopt_compression"
_STEPS = {"POSITION": 2.0**14, "TEXCOORD_0": 2.0**12, "TEXCOORD_1": 2.0**12, "COLOR_0": 2.0**8}
DRACO_EXTENSION = "KHR_draco_mesh_compression"
STEP_M = 1.25e-4
"""Distance of neighbouring positions at most; rounding moves by half of it."""
UV_BITS, NORMAL_BITS, LEVEL = 12, 10, 7
_OWN = {"TANGENT": 10, "COLOR_0": 11}
"""Ids of the attributes that Draco has no type for, or rounds to bytes; they are stored as they are."""


class GltfDocument:
    """A document under construction. Every `add_` method returns the index of what it added.

    Args:
        generator: The program that the file names.
        compression: Of its geometry.
        texture_files: Files of pictures, shared with other documents that show the same ones.
    """

    def __init__(
        self, generator: str, *, compression: Compression = "none", texture_files: TextureFiles | None = None
    ) -> None:
        self._texture_files = OncePerPicture(texture_file) if texture_files is None else texture_files
        self._data = bytearray()
        self._compressed = compression == "meshopt"
        self._draco = compression == "draco"
        self._decoded_bytes = 0
        self._json: dict[str, Any] = {"asset": {"version": "2.0", "generator": generator}}
        self._materials: dict[tuple[int, bool], int] = {}
        self._pictures: dict[int, int] = {}
        self._referenced: list[Any] = []

    def add(self, kind: str, entry: dict[str, Any]) -> int:
        """Append an entry to one of the document's lists (nodes, cameras, scenes, ...)."""
        self._json.setdefault(kind, []).append(entry)
        return len(self._json[kind]) - 1

    def add_light(self, light: dict[str, Any]) -> int:
        """A light of KHR_lights_punctual."""
        self.use("KHR_lights_punctual")
        lights = self._json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        return len(lights) - 1

    def add_light_node(self, name: str, light: int, T: Float[np.ndarray, "4 4"], **more: Any) -> int:
        """A node that shines with a light, at a rigid transform in its parent's frame."""
        extension = {"KHR_lights_punctual": {"light": light}}
        return self.add("nodes", {"name": name, **placement(T), "extensions": extension, **more})

    def set_scene(self, name: str, root: int) -> None:
        """State which node the scene that is shown has."""
        self._json["scene"] = self.add("scenes", {"name": name, "nodes": [root]})

    def add_mesh(self, name: str, surfaces: tuple[Surface, ...]) -> int:
        """A mesh with one primitive per surface."""
        return self.add("meshes", {"name": name, "primitives": [self._primitive(s) for s in surfaces]})

    def write(self, file: ByteSink) -> None:
        """Write the finished file."""
        if self._data:
            self._json["buffers"] = [{"byteLength": len(self._data)}]
        if self._decoded_bytes:
            fallback = {MESHOPT_EXTENSION: {"fallback": True}}
            self._json["buffers"].append({"byteLength": self._decoded_bytes, "extensions": fallback})
        text = json.dumps(self._json, separators=(",", ":"), allow_nan=False, ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        self._data += b"\0" * (-len(self._data) % 4)
        chunks = 8 + len(text) + (8 + len(self._data) if self._data else 0)
        file.write(struct.pack("<III", _MAGIC, 2, 12 + chunks))
        file.write(struct.pack("<II", len(text), _JSON_CHUNK) + text)
        if self._data:
            file.write(struct.pack("<II", len(self._data), _BINARY_CHUNK))
            file.write(self._data)

    def glb(self) -> bytes:
        """The finished file's content."""
        file = io.BytesIO()
        self.write(file)
        return file.getvalue()

    def use(self, extension: str, *, required: bool = False) -> None:
        """Name an extension that the document uses, or that its readers must know."""
        for field in ("extensionsUsed", "extensionsRequired") if required else ("extensionsUsed",):
            names = self._json.setdefault(field, [])
            if extension not in names:
                names.append(extension)

    def _primitive(self, surface: Surface) -> dict[str, Any]:
        material = surface.material
        textured = surface.uv is not None and (material.texture is not None or bool(material.maps))
        arrays = {"POSITION": surface.vertices, "NORMAL": surface.normals}
        if textured and "normalTexture" in material.maps:
            arrays["TANGENT"] = tangents(surface)
        if textured and surface.uv is not None:
            arrays["TEXCOORD_0"] = surface.uv * [1, -1] + [0, 1]
        if surface.light_uv is not None:
            arrays["TEXCOORD_1"] = surface.light_uv * [1, -1] + [0, 1]
            arrays.setdefault("TEXCOORD_0", arrays["TEXCOORD_1"])  # sets are numbered from 0 without gaps
        if surface.colours is not None:
            arrays["COLOR_0"] = surface.colours
        arrays = {name: np.ascontiguousarray(values, dtype="<f4") for name, values in arrays.items()}
        faces = surface.faces
        if self._draco:
            return self._draco_primitive(arrays, faces, self._material(material, textured=textured))
        if self._compressed:
            arrays, faces = prepare(arrays, faces)
        return {
            "attributes": {name: self._attribute(name, values) for name, values in arrays.items()},
            "indices": self._indices(faces.reshape(-1), len(surface.vertices)),
            "material": self._material(material, textured=textured),
        }

    def _draco_primitive(self, arrays: dict[str, np.ndarray], faces: np.ndarray, material: int) -> dict[str, Any]:
        """A primitive whose accessors say what Draco's data decode to."""
        packed = draco_mesh(arrays, faces)
        self.use(DRACO_EXTENSION, required=True)
        accessors = {}
        for name in arrays:
            bounds = {"min": packed.lower.tolist(), "max": packed.upper.tolist()} if name == "POSITION" else {}
            accessors[name] = self._accessor("f4", packed.vertices, arrays[name].shape[1], **bounds)
        indices = self._accessor(_index_type(packed.vertices), 3 * packed.triangles, 1)
        stored = {"bufferView": self._view(packed.data), "attributes": dict(packed.attributes)}
        primitive = {"attributes": accessors, "indices": indices, "material": material}
        return {**primitive, "extensions": {DRACO_EXTENSION: stored}}

    def _attribute(self, name: str, values: np.ndarray) -> int:
        if self._compressed:
            view = self._add_compressed_view(encode_vertices(values), values, "ATTRIBUTES")
        else:
            view = self._view(values.tobytes(), _ARRAY_BUFFER)
        more: dict[str, Any] = {}
        if values.dtype.itemsize == 1:
            self.use("KHR_mesh_quantization", required=True)
            more["normalized"] = True
        if name == "POSITION":
            more |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        width = 3 if name in ("POSITION", "NORMAL") else values.shape[1]
        return self._accessor(values.dtype.str[1:], len(values), width, view, **more)

    def _indices(self, indices: np.ndarray, vertices: int) -> int:
        data = indices.astype(f"<{_index_type(vertices)}")
        if self._compressed:
            view = self._add_compressed_view(encode_faces(indices, vertices), data, "TRIANGLES")
        else:
            view = self._view(data.tobytes(), _ELEMENT_ARRAY_BUFFER)
        return self._accessor(data.dtype.str[1:], len(data), 1, view)

    def _accessor(self, number: str, count: int, width: int, view: int | None = None, **more: Any) -> int:
        about = {"componentType": _COMPONENT_TYPES[number], "count": count, "type": _WIDTHS[width], **more}
        return self.add("accessors", about if view is None else {"bufferView": view, **about})

    def _view(self, data: bytes, target: int | None = None) -> int:
        entry: dict[str, Any] = {"buffer": 0, "byteOffset": self._append(data), "byteLength": len(data)}
        if target is not None:
            entry["target"] = target
        return self.add("bufferViews", entry)

    def _add_compressed_view(self, encoded: bytes, values: np.ndarray, mode: str) -> int:
        """A view of the fallback buffer, which no file stores, with the compressed data that stand for it."""
        self.use(MESHOPT_EXTENSION, required=True)
        stride = values.itemsize * (values.shape[1] if values.ndim > 1 else 1)
        packed: dict[str, Any] = {"buffer": 0, "byteOffset": self._append(encoded), "byteLength": len(encoded)}
        packed |= {"byteStride": stride, "count": len(values), "mode": mode}
        entry: dict[str, Any] = {"buffer": 1, "byteOffset": self._decoded_bytes, "byteLength": values.nbytes}
        if mode == "ATTRIBUTES":
            entry["byteStride"] = stride
        entry["target"] = _ARRAY_BUFFER if mode == "ATTRIBUTES" else _ELEMENT_ARRAY_BUFFER
        self._decoded_bytes += values.nbytes + -values.nbytes % 4
        return self.add("bufferViews", {**entry, "extensions": {MESHOPT_EXTENSION: packed}})

    def _append(self, data: bytes) -> int:
        self._data += b"\0" * (-len(self._data) % 4)
        offset = len(self._data)
        self._data += data
        return offset

    def _material(self, material: Material, *, textured: bool) -> int:
        key = (id(material), textured)
        if key not in self._materials:
            self._referenced.append(material)  # keeps the id from being reused while this document grows
            self._materials[key] = self.add("materials", self._material_entry(material, textured))
        return self._materials[key]

    def _material_entry(self, material: Material, textured: bool) -> dict[str, Any]:
        surface: dict[str, Any] = {
            "baseColorFactor": [*material.colour, material.alpha],
            "metallicFactor": material.metallic,
            "roughnessFactor": material.roughness,
        }
        entry: dict[str, Any] = {"name": material.name, "pbrMetallicRoughness": surface}
        if textured and material.texture is not None:
            surface["baseColorTexture"] = {"index": self._texture(material.texture)}
        for slot in ("metallicRoughnessTexture", "normalTexture", "occlusionTexture", "emissiveTexture"):
            if textured and slot in material.maps:
                owner = surface if slot == "metallicRoughnessTexture" else entry
                owner[slot] = {"index": self._texture(material.maps[slot])}
        if any(material.emissive):
            entry["emissiveFactor"] = [min(max(c, 0.0), 1.0) for c in material.emissive]
        if material.alpha < 1:
            entry["alphaMode"] = "BLEND"
        if material.double_sided:
            entry["doubleSided"] = True
        if material.photographed:  # its photo shows what it mirrors already
            self.use("KHR_materials_specular")
            entry["extensions"] = {"KHR_materials_specular": {"specularFactor": 0.0}}
        return entry

    def _texture(self, picture: Picture) -> int:
        if id(picture) not in self._pictures:
            self._referenced.append(picture)
            if not self._json.get("samplers"):
                self.add("samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497})
            suffix, content = self._texture_files(picture)
            image = self.add("images", {"bufferView": self._view(content), "mimeType": _MEDIA_TYPES[suffix]})
            self._pictures[id(picture)] = self.add("textures", {"sampler": 0, "source": image})
        return self._pictures[id(picture)]


def placement(T: Float[np.ndarray, "4 4"]) -> dict[str, list[float]]:
    """A node's rotation (glTF quaternions are x, y, z, w) and translation."""
    quaternion = Rotation.from_matrix(T[:3, :3]).as_quat(canonical=True)
    return {"rotation": [float(v) for v in quaternion], "translation": [float(v) for v in T[:3, 3]]}


def _index_type(vertices: int) -> str:
    """As small as it can be."""
    return "u2" if vertices < 65536 else "u4"


def tangents(surface: Surface) -> Float32[np.ndarray, "n 4"]:
    """Unit tangents along growing u, orthogonal to the normals, with the sign of the bitangent as fourth component.

    Sums over the faces at each vertex, after E. Lengyel, Foundations of Game Engine Development, volume 2, section 7.5.
    Where the texture coordinates say nothing, any direction along the surface is taken.
    """
    if surface.uv is None:
        raise ValueError("tangents follow texture coordinates; this surface has none")
    p, uv = surface.vertices[surface.faces].astype(np.float64), surface.uv[surface.faces] * [1.0, -1.0]
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    (x1, y1), (x2, y2) = (uv[:, 1] - uv[:, 0]).T, (uv[:, 2] - uv[:, 0]).T
    area = x1 * y2 - x2 * y1
    sign = np.sign(area)[:, None]
    along_u = sign * (e1 * y2[:, None] - e2 * y1[:, None])
    along_v = sign * (e2 * x1[:, None] - e1 * x2[:, None])
    total = [_sums(values, surface.faces, len(surface.vertices)) for values in (along_u, along_v)]
    n = surface.normals.astype(np.float64)
    t = total[0] - n * (n * total[0]).sum(axis=1, keepdims=True)
    length = np.linalg.norm(t, axis=1, keepdims=True)
    axis = np.eye(3)[np.abs(n).argmin(axis=1)]
    fallback = np.cross(n, axis)
    t = np.where(length > 1e-12, t / np.maximum(length, 1e-12), fallback / np.linalg.norm(fallback, axis=1)[:, None])
    hand = np.where((np.cross(n, t) * total[1]).sum(axis=1) < 0, -1.0, 1.0)
    return np.column_stack([t, hand]).astype(np.float32)


def _sums(values: np.ndarray, faces: np.ndarray, count: int) -> np.ndarray:
    out = np.zeros((count, 3))
    for corner in range(3):
        np.add.at(out, faces[:, corner], values)
    return out


def prepare(
    arrays: dict[str, np.ndarray], faces: Integer[np.ndarray, "m 3"]
) -> tuple[dict[str, np.ndarray], Integer[np.ndarray, "m 3"]]:
    """Vertices and faces in the order in which they are used, their values rounded."""
    count = len(arrays["POSITION"])
    indices = np.ascontiguousarray(faces.reshape(-1), dtype=np.uint32)
    ordered = np.zeros_like(indices)
    meshoptimizer.optimize_vertex_cache(ordered, indices, len(indices), count)
    _, first = np.unique(ordered, return_index=True)
    used = ordered[np.sort(first)]
    place = np.zeros(count, dtype=np.uint32)
    place[used] = np.arange(len(used), dtype=np.uint32)
    return {name: _round(name, values[used]) for name, values in arrays.items()}, place[ordered].reshape(-1, 3)


def encode_vertices(values: np.ndarray) -> bytes:
    """Attribute data, one row a vertex, rows of a multiple of four bytes."""
    meshoptimizer.encode_vertex_version(0)  # the only one that the extension allows
    return bytes(meshoptimizer.encode_vertex_buffer(values))


def encode_faces(indices: Integer[np.ndarray, " n"], vertices: int) -> bytes:
    """Indices of triangles."""
    meshoptimizer.encode_index_version(1)
    return bytes(meshoptimizer.encode_index_buffer(np.ascontiguousarray(indices, np.uint32), len(indices), vertices))


def _round(name: str, values: np.ndarray) -> np.ndarray:
    if name in ("NORMAL", "TANGENT"):
        packed = np.zeros((len(values), 4), dtype="<i1")
        packed[:, : values.shape[1]] = np.round(values * 127.0)
        return packed
    step = _STEPS[name]
    return np.ascontiguousarray(np.round(values * step) / step, dtype="<f4")


@dataclass(frozen=True, eq=False)
class DracoMesh:
    """One compressed primitive."""

    data: bytes
    attributes: Mapping[str, int]
    """Draco's id of each glTF attribute."""
    vertices: int
    triangles: int
    lower: Float32[np.ndarray, "3"]
    """Bounds of the positions as they are decoded."""
    upper: Float32[np.ndarray, "3"]


def draco_mesh(arrays: Mapping[str, np.ndarray], faces: Int[np.ndarray, "m 3"]) -> DracoMesh:
    """Compress one primitive; vertices and triangles may come back in another order.

    Args:
        arrays: glTF attributes by name, one row a vertex; POSITION at least.
        faces: Triangles.

    Raises:
        UnavailableError: DracoPy is not installed.
    """
    try:
        import DracoPy
    except ImportError as missing:
        raise UnavailableError("Draco compression needs an optional library: pip install 'diorama[draco]'") from missing
    positions = np.ascontiguousarray(arrays["POSITION"], dtype=np.float32)
    extent = float(np.ptp(positions, axis=0).max())
    data = DracoPy.encode(
        positions,
        np.ascontiguousarray(faces, dtype=np.uint32),
        quantization_bits=int(np.clip(np.ceil(np.log2(max(extent, STEP_M) / STEP_M)), 8, 24)),
        compression_level=LEVEL,
        tex_coord=_double(arrays.get("TEXCOORD_0")),
        normals=_double(arrays.get("NORMAL")),
        tex_coord_quantization_bits=UV_BITS,
        normal_quantization_bits=NORMAL_BITS,
        generic_attributes={_OWN[n]: np.ascontiguousarray(v, np.float32) for n, v in arrays.items() if n in _OWN}
        or None,
    )
    decoded = DracoPy.decode(data)
    points = np.asarray(decoded.points, dtype=np.float32)
    kinds = {DracoPy.AttributeType.POSITION: "POSITION", DracoPy.AttributeType.NORMAL: "NORMAL"}
    kinds[DracoPy.AttributeType.TEX_COORD] = "TEXCOORD_0"
    kinds_by_id = {number: name for name, number in _OWN.items()}
    ids = {
        kinds.get(a["attribute_type"], kinds_by_id.get(a["unique_id"], "")): a["unique_id"] for a in decoded.attributes
    }
    return DracoMesh(data, ids, len(points), len(decoded.faces), points.min(axis=0), points.max(axis=0))


def _double(values: np.ndarray | None) -> np.ndarray | None:
    """In the precision that DracoPy takes these in."""
    return None if values is None else np.ascontiguousarray(values, dtype=np.float64)
