"""Diorama's marks in a GLB or glTF file, whatever program saved it last."""

from __future__ import annotations

import base64
import io
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image
from scipy.spatial.transform import Rotation

from diorama_core.errors import InputError, LibraryError
from diorama_core.importing.marked import MarkedFile, ObjectNode, as_bytes, as_ids, as_mapping
from diorama_core.io.bounded import shorten
from diorama_core.library.ingest.gltf import container
from diorama_core.library.ingest.limits import DEFAULT_LIMITS
from diorama_core.library.ingest.references import IMAGE_FORMATS, References, read_bytes
from diorama_core.library.ingest.usd_stage import Z_UP

Json = dict[str, Any]
MARK = "diorama"
FLOAT = 5126
LARGEST = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}
"""Integers that stand for 1, by glTF's numbers of component types."""
CAMERA_AXES = np.diag([1.0, -1.0, -1.0, 1.0])
"""glTF cameras look along their -z with y up; ours along +z with y down."""


@dataclass(frozen=True, eq=False)
class _Node:
    index: int
    row: Json
    M_world: Float[np.ndarray, "4 4"]
    """Node frame to glTF's frame."""
    parent: int | None

    @property
    def extras(self) -> Mapping[str, Any]:
        extras = self.row.get("extras")
        return extras if isinstance(extras, Mapping) else {}


def read_marked_gltf(path: Path) -> MarkedFile | None:
    """What Diorama wrote into a file; None when the file is not from it.

    Raises:
        InputError: when the file cannot be read.
    """
    try:
        return _mark(path)
    except (LibraryError, LookupError, TypeError, ValueError, AttributeError, ArithmeticError, OSError) as error:
        reason = shorten(str(error))
        raise InputError(f"{path.name} cannot be read as glTF ({reason}); export it again") from error


def _mark(path: Path) -> MarkedFile | None:
    document, binary = container(read_bytes(path, DEFAULT_LIMITS), DEFAULT_LIMITS)
    nodes = tuple(_walk(document))
    root = next((n for n in nodes if "objects" in (as_mapping(n.extras.get(MARK)) or {})), None)
    if root is None:
        return None
    mark = root.extras[MARK]
    camera = next((n for n in nodes if "camera" in n.row and "fx" in n.extras), None)
    pictures = _Pictures(document, binary, References(path.parent, path.parent, DEFAULT_LIMITS))
    planes = {str(n.extras["diorama_plane"]): n for n in nodes if "diorama_plane" in n.extras}
    return MarkedFile(
        document=mark if isinstance(mark, str) else json.dumps(mark),
        nodes=_object_nodes(nodes, document),
        written=as_ids(root.extras.get("diorama_objects")),
        planes={i: Z_UP @ n.M_world @ _to_stored(document, n.row, n.extras.get("bounds")) for i, n in planes.items()},
        T_world_camera=None if camera is None else Z_UP @ camera.M_world @ CAMERA_AXES,
        pictures={i: p for i, n in planes.items() if (p := pictures.mesh_picture(n.row.get("mesh"))) is not None},
        material_pictures=pictures.from_photo(),
        provenance=as_mapping(root.extras.get("provenance")) or {},
        photo=as_bytes(root.extras.get("diorama_photo")),
    )


def _walk(document: Json) -> Iterator[_Node]:
    """Nodes of the shown scene, parents before children."""
    rows = document.get("nodes", [])
    scenes = document.get("scenes", [])
    roots = scenes[document.get("scene", 0)].get("nodes", []) if scenes else range(len(rows))
    waiting: list[tuple[int, Float[np.ndarray, "4 4"], int | None]] = [
        (int(i), np.eye(4), None) for i in reversed(roots)
    ]
    places: dict[int, int] = {}
    while waiting:
        index, above, parent = waiting.pop()
        if index in places:
            raise ValueError(f"node {index} has two parents")
        node = _Node(index, rows[index], above @ _local(rows[index]), parent)
        places[index] = len(places)
        yield node
        waiting += [(int(c), node.M_world, places[index]) for c in reversed(node.row.get("children", []))]


def _local(row: Json) -> Float[np.ndarray, "4 4"]:
    if "matrix" in row:
        return np.array(row["matrix"], dtype=np.float64).reshape(4, 4).T
    M = np.eye(4)
    M[:3, :3] = Rotation.from_quat(row.get("rotation", [0, 0, 0, 1])).as_matrix() * np.array(
        row.get("scale", [1, 1, 1])
    )
    M[:3, 3] = row.get("translation", [0, 0, 0])
    return M


def _object_nodes(nodes: tuple[_Node, ...], document: Json) -> tuple[ObjectNode, ...]:
    """Nodes that carry an object's entry, with the transform of the mesh that shows it."""
    shapes: dict[int, _Node] = {}
    for node in nodes:
        if "diorama_mesh" in node.extras and node.parent is not None:
            shapes.setdefault(node.parent, node)
    numbers: dict[int, int] = {}
    object_nodes: list[ObjectNode] = []
    for number, node in enumerate(nodes):
        entry = as_mapping(node.extras.get(MARK))
        if entry is None or "id" not in entry:
            continue
        above = node.parent
        while above is not None and above not in numbers:
            above = nodes[above].parent
        numbers[number] = len(object_nodes)
        parent = None if above is None else numbers[above]
        shown = shapes.get(number, node)
        M = Z_UP @ shown.M_world @ _to_stored(document, shown.row, node.extras.get("bounds"))
        object_nodes.append(ObjectNode(str(entry["id"]), str(node.row.get("name", "")), M, entry, parent))
    return tuple(object_nodes)


def _to_stored(document: Json, row: Json, bounds: Any) -> Float[np.ndarray, "4 4"]:
    """The shape's frame to that of a node's mesh: programs that store positions as integers stretch the node instead.

    Bounds are the least and largest corner of the mesh in the shape's frame, as it was written.
    """
    out = np.eye(4)
    primitives = document["meshes"][row["mesh"]]["primitives"] if "mesh" in row else []
    stored = [document["accessors"][p["attributes"]["POSITION"]] for p in primitives]
    if bounds is None or not stored or any(a["componentType"] == FLOAT for a in stored):
        return out
    low, high = (
        pick([np.array(a[end]) / (LARGEST[a["componentType"]] if a.get("normalized") else 1) for a in stored], axis=0)
        for pick, end in ((np.min, "min"), (np.max, "max"))
    )
    extent = np.subtract(*bounds[::-1])
    stretch = np.where(extent > 0, high - low, 1.0) / np.where(extent > 0, extent, 1.0)
    out[:3, :3], out[:3, 3] = np.diag(stretch), low - stretch * bounds[0]
    return out


FROM_PHOTO = re.compile(r" from the photo (\S+)(?: \d+)?$")
"""The end of such a material's name, where a number may tell equal ones apart."""


@dataclass(frozen=True, eq=False)
class _Pictures:
    """Base colour pictures of meshes."""

    document: Json
    binary: bytes | None
    references: References

    def mesh_picture(self, mesh: int | None) -> UInt8[np.ndarray, "h w 3"] | None:
        """The picture of the first textured part; None where there is none that can be read."""
        if mesh is None:
            return None
        for primitive in self.document["meshes"][mesh]["primitives"]:
            material = self.document.get("materials", [])[primitive["material"]] if "material" in primitive else {}
            if _texture(material) is not None:
                return self._image(material)
        return None

    def from_photo(self) -> dict[str, UInt8[np.ndarray, "_ _ 3"]]:
        """Pictures of the objects' materials from the photo, by the texture names that the materials carry."""
        pictures = {}
        for material in self.document.get("materials", []):
            name = FROM_PHOTO.search(str(material.get("name", "")))
            picture = None if name is None else self._image(material)
            if name is not None and picture is not None:
                pictures[name.group(1)] = picture
        return pictures

    def _image(self, material: Json) -> UInt8[np.ndarray, "h w 3"] | None:
        number = _texture(material)
        if number is None or "source" not in self.document["textures"][number]:
            return None
        image = self.document["images"][self.document["textures"][number]["source"]]
        data = self._view_bytes(image["bufferView"]) if "bufferView" in image else self._uri_bytes(image.get("uri", ""))
        data = None if data is None else self.references.check_image(data, str(image.get("name", "a picture")))
        if data is None:
            return None
        with Image.open(io.BytesIO(data), formats=IMAGE_FORMATS) as picture:
            return np.asarray(picture.convert("RGB"))

    def _view_bytes(self, view: int) -> bytes | None:
        row = self.document["bufferViews"][view]
        buffer = self.document["buffers"][row["buffer"]]
        data = self._uri_bytes(buffer["uri"]) if "uri" in buffer else self.binary
        start = row.get("byteOffset", 0)
        return None if data is None else data[start : start + row["byteLength"]]

    def _uri_bytes(self, uri: str) -> bytes | None:
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        return self.references.read(uri)


def _texture(material: Json) -> int | None:
    texture = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
    return None if texture is None else texture["index"]
