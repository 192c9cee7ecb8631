"""Putting a glTF 2.0 document together: typed data in one buffer, shared materials and pictures, and the GLB around it.

Written to the letter of the Khronos specification: little endian, every view aligned to four bytes, bounds stated
for positions, indices as small as they can be, texture rows from the top, pictures with power-of-two sides.
"""

from __future__ import annotations

import io
import json
import struct
from typing import Any

import numpy as np

from diorama_core.export import meshopt
from diorama_core.export.draco import EXTENSION, draco_mesh
from diorama_core.export.gathering import Compression
from diorama_core.export.pictures import OncePerPicture, Picture, texture_file
from diorama_core.export.tangents import tangents
from diorama_core.io.atomic import ByteSink
from diorama_core.render.appearance import Material, Surface

_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963
_COMPONENT_TYPES = {"f4": 5126, "u2": 5123, "u4": 5125, "i1": 5120}
_MEDIA_TYPES = {".jpg": "image/jpeg", ".png": "image/png"}
_WIDTHS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_MAGIC, _JSON_CHUNK, _BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942


TextureFiles = OncePerPicture[[], tuple[str, bytes]]


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

    def node(self, index: int) -> dict[str, Any]:
        """A node that was added, to be completed."""
        node: dict[str, Any] = self._json["nodes"][index]
        return node

    def add_light(self, light: dict[str, Any]) -> int:
        """A light of KHR_lights_punctual."""
        self.use("KHR_lights_punctual")
        lights = self._json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        return len(lights) - 1

    def set_scene(self, index: int) -> None:
        """State which scene is shown."""
        self._json["scene"] = index

    def add_mesh(self, name: str, surfaces: tuple[Surface, ...]) -> int:
        """A mesh with one primitive per surface."""
        return self.add("meshes", {"name": name, "primitives": [self._primitive(s) for s in surfaces]})

    def write(self, file: ByteSink) -> None:
        """Write the finished file."""
        if self._data:
            self._json["buffers"] = [{"byteLength": len(self._data)}]
        if self._decoded_bytes:
            fallback = {"byteLength": self._decoded_bytes, "extensions": {meshopt.EXTENSION: {"fallback": True}}}
            self._json["buffers"].append(fallback)
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
            arrays, faces = meshopt.prepared(arrays, faces)
        return {
            "attributes": {name: self._attribute(name, values) for name, values in arrays.items()},
            "indices": self._indices(faces.reshape(-1), len(surface.vertices)),
            "material": self._material(material, textured=textured),
        }

    def _draco_primitive(self, arrays: dict[str, np.ndarray], faces: np.ndarray, material: int) -> dict[str, Any]:
        """A primitive whose accessors say what Draco's data decode to."""
        packed = draco_mesh(arrays, faces)
        self.use(EXTENSION, required=True)
        accessors = {}
        for name in arrays:
            kind = _WIDTHS[arrays[name].shape[1]]
            entry: dict[str, Any] = {"componentType": 5126, "count": packed.vertices, "type": kind}
            if name == "POSITION":
                entry |= {"min": packed.lower.tolist(), "max": packed.upper.tolist()}
            accessors[name] = self.add("accessors", entry)
        wide = 5123 if packed.vertices < 65536 else 5125
        indices = {"componentType": wide, "count": 3 * packed.triangles, "type": "SCALAR"}
        stored = {"bufferView": self._view(packed.data), "attributes": dict(packed.attributes)}
        return {
            "attributes": accessors,
            "indices": self.add("accessors", indices),
            "material": material,
            "extensions": {EXTENSION: stored},
        }

    def _attribute(self, name: str, values: np.ndarray) -> int:
        normalised = values.dtype.itemsize == 1
        width = 3 if name in ("POSITION", "NORMAL") else values.shape[1]
        entry: dict[str, Any] = {
            "bufferView": self._vertex_view(values),
            "componentType": _COMPONENT_TYPES[values.dtype.str[1:]],
            "count": len(values),
            "type": _WIDTHS[width],
        }
        if normalised:
            self.use("KHR_mesh_quantization", required=True)
            entry["normalized"] = True
        if name == "POSITION":
            entry |= {"min": [float(v) for v in values.min(axis=0)], "max": [float(v) for v in values.max(axis=0)]}
        return self.add("accessors", entry)

    def _indices(self, indices: np.ndarray, vertices: int) -> int:
        data = indices.astype("<u2" if vertices < 65536 else "<u4")
        if self._compressed:
            view = self._compressed_view(meshopt.encoded_faces(indices, vertices), data, "TRIANGLES")
        else:
            view = self._view(data.tobytes(), _ELEMENT_ARRAY_BUFFER)
        kind = _COMPONENT_TYPES[data.dtype.str[1:]]
        return self.add("accessors", {"bufferView": view, "componentType": kind, "count": len(data), "type": "SCALAR"})

    def _vertex_view(self, values: np.ndarray) -> int:
        if self._compressed:
            return self._compressed_view(meshopt.encoded_vertices(values), values, "ATTRIBUTES")
        return self._view(values.tobytes(), _ARRAY_BUFFER)

    def _view(self, data: bytes, target: int | None = None) -> int:
        entry: dict[str, Any] = {"buffer": 0, "byteOffset": self._append(data), "byteLength": len(data)}
        if target is not None:
            entry["target"] = target
        return self.add("bufferViews", entry)

    def _compressed_view(self, encoded: bytes, values: np.ndarray, mode: str) -> int:
        """A view of the fallback buffer, which no file stores, with the compressed data that stand for it."""
        self.use(meshopt.EXTENSION, required=True)
        stride = values.itemsize * (values.shape[1] if values.ndim > 1 else 1)
        packed = {
            "buffer": 0,
            "byteOffset": self._append(encoded),
            "byteLength": len(encoded),
            "byteStride": stride,
            "count": len(values),
            "mode": mode,
        }
        entry: dict[str, Any] = {"buffer": 1, "byteOffset": self._decoded_bytes, "byteLength": values.nbytes}
        if mode == "ATTRIBUTES":
            entry["byteStride"] = stride
        entry["target"] = _ARRAY_BUFFER if mode == "ATTRIBUTES" else _ELEMENT_ARRAY_BUFFER
        self._decoded_bytes += values.nbytes + -values.nbytes % 4
        return self.add("bufferViews", {**entry, "extensions": {meshopt.EXTENSION: packed}})

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
        if textured and "metallicRoughnessTexture" in material.maps:
            surface["metallicRoughnessTexture"] = {"index": self._texture(material.maps["metallicRoughnessTexture"])}
        for slot in ("normalTexture", "occlusionTexture", "emissiveTexture"):
            if textured and slot in material.maps:
                entry[slot] = {"index": self._texture(material.maps[slot])}
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
