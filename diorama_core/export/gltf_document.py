"""Putting a glTF 2.0 document together: typed data in one buffer, shared materials and pictures, and the GLB around it.

Written to the letter of the Khronos specification: little endian, every view aligned to four bytes, bounds stated
for positions, indices as small as they can be, texture rows from the top.
"""

from __future__ import annotations

import io
import json
import struct
from typing import Any

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_core.render.appearance import Material, Surface

_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963
_FLOAT, _UNSIGNED_SHORT, _UNSIGNED_INT = 5126, 5123, 5125
_MAGIC, _JSON_CHUNK, _BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942


class GltfDocument:
    """A document under construction. Every `add_` method returns the index of what it added."""

    def __init__(self, generator: str) -> None:
        self._data = bytearray()
        self._json: dict[str, Any] = {"asset": {"version": "2.0", "generator": generator}}
        self._materials: dict[tuple[int, bool], int] = {}
        self._pictures: dict[bytes, int] = {}
        self._retained: list[Material] = []

    def add(self, kind: str, entry: dict[str, Any]) -> int:
        """Append an entry to one of the document's lists (nodes, cameras, scenes, ...)."""
        self._json.setdefault(kind, []).append(entry)
        return len(self._json[kind]) - 1

    def set_scene(self, index: int) -> None:
        """State which scene is shown."""
        self._json["scene"] = index

    def add_mesh(self, name: str, surfaces: tuple[Surface, ...]) -> int:
        """A mesh with one primitive per surface."""
        return self.add("meshes", {"name": name, "primitives": [self._primitive(s) for s in surfaces]})

    def glb(self) -> bytes:
        """The finished file."""
        if self._data:
            self._json["buffers"] = [{"byteLength": len(self._data)}]
        text = json.dumps(self._json, separators=(",", ":"), allow_nan=False, ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self._data) + b"\0" * (-len(self._data) % 4)
        chunks = struct.pack("<II", len(text), _JSON_CHUNK) + text
        if binary:
            chunks += struct.pack("<II", len(binary), _BINARY_CHUNK) + binary
        return struct.pack("<III", _MAGIC, 2, 12 + len(chunks)) + chunks

    def _primitive(self, surface: Surface) -> dict[str, Any]:
        attributes = {
            "POSITION": self._accessor(surface.vertices, "VEC3", bounds=True),
            "NORMAL": self._accessor(surface.normals, "VEC3"),
        }
        if surface.uv is not None:
            attributes["TEXCOORD_0"] = self._accessor(surface.uv * [1, -1] + [0, 1], "VEC2")
        if surface.colours is not None:
            attributes["COLOR_0"] = self._accessor(surface.colours, "VEC3")
        return {
            "attributes": attributes,
            "indices": self._indices(surface.faces.reshape(-1)),
            "material": self._material(surface.material, textured=surface.uv is not None),
        }

    def _accessor(self, values: np.ndarray, kind: str, *, bounds: bool = False) -> int:
        data = np.ascontiguousarray(values, dtype="<f4")
        entry: dict[str, Any] = {
            "bufferView": self._view(data.tobytes(), _ARRAY_BUFFER),
            "componentType": _FLOAT,
            "count": len(data),
            "type": kind,
        }
        if bounds:
            entry |= {"min": [float(v) for v in data.min(axis=0)], "max": [float(v) for v in data.max(axis=0)]}
        return self.add("accessors", entry)

    def _indices(self, indices: np.ndarray) -> int:
        small = int(indices.max()) < 65535
        data = indices.astype("<u2" if small else "<u4")
        return self.add(
            "accessors",
            {
                "bufferView": self._view(data.tobytes(), _ELEMENT_ARRAY_BUFFER),
                "componentType": _UNSIGNED_SHORT if small else _UNSIGNED_INT,
                "count": len(data),
                "type": "SCALAR",
            },
        )

    def _view(self, data: bytes, target: int | None = None) -> int:
        self._data += b"\0" * (-len(self._data) % 4)
        entry: dict[str, Any] = {"buffer": 0, "byteOffset": len(self._data), "byteLength": len(data)}
        if target is not None:
            entry["target"] = target
        self._data += data
        return self.add("bufferViews", entry)

    def _material(self, material: Material, *, textured: bool) -> int:
        key = (id(material), textured)
        if key not in self._materials:
            self._retained.append(material)  # keeps the id from being reused while this document grows
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
        return entry

    def _texture(self, picture: UInt8[np.ndarray, "h w c"]) -> int:
        encoded, mime = _encoded(picture)
        if encoded not in self._pictures:
            if not self._json.get("samplers"):
                self.add("samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497})
            image = self.add("images", {"bufferView": self._view(encoded), "mimeType": mime})
            self._pictures[encoded] = self.add("textures", {"sampler": 0, "source": image})
        return self._pictures[encoded]


def _encoded(picture: UInt8[np.ndarray, "h w c"]) -> tuple[bytes, str]:
    """PNG for small or transparent pictures, JPEG for the large opaque ones."""
    buffer = io.BytesIO()
    image = Image.fromarray(np.ascontiguousarray(picture))
    if picture.shape[2] == 3 and picture.shape[0] * picture.shape[1] > 512 * 512:
        image.save(buffer, "JPEG", quality=92)
        return buffer.getvalue(), "image/jpeg"
    image.save(buffer, "PNG")
    return buffer.getvalue(), "image/png"
