"""FBX through the Open Asset Import Library, an optional dependency (`pip install "diorama[fbx]"`).

The importer turns a file's declared axes to +Y up; the declared unit is read here, because the importer keeps it back.
"""

from __future__ import annotations

import io
import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from PIL import Image
from trimesh.visual.material import PBRMaterial

from diorama_core.errors import LibraryError, UnavailableError
from diorama_core.library.ingest.references import IMAGE_FORMATS, References


def read_fbx(path: Path, data: bytes, references: References) -> tuple[trimesh.Scene, tuple[str, ...], float]:
    """The scene of an FBX file, +Y up, the names in it, and metres in one unit, as the file declares.

    Raises:
        UnavailableError: when the importer is not installed.
        LibraryError: when it cannot read the file.
    """
    try:
        import assimp_py
    except ImportError as error:
        raise UnavailableError('FBX needs a converter; run: pip install "diorama[fbx]", or convert to GLB') from error
    try:
        imported = assimp_py.import_file(
            str(path), assimp_py.Process_Triangulate | assimp_py.Process_JoinIdenticalVertices
        )
    except (RuntimeError, ValueError) as error:
        raise LibraryError(f"malformed FBX ({str(error)[:100]})") from error
    materials = [_material(row, references) for row in imported.materials]
    scene = trimesh.Scene()
    names: list[str] = []
    waiting = [(imported.root_node, np.eye(4))]
    while waiting:
        node, above = waiting.pop()
        names.append(str(node.name))
        T_file_node = above @ np.asarray(node.transformation, dtype=float).reshape(4, 4)
        for index in node.mesh_indices:
            scene.add_geometry(_mesh(imported.meshes[index], materials), transform=T_file_node)
        waiting += [(child, T_file_node) for child in reversed(node.children)]
    names += [str(row.get("NAME", "")) for row in imported.materials]
    return scene, tuple(n for n in names if n and n != "RootNode"), unit_scale_m(data)


def unit_scale_m(data: bytes) -> float:
    """Metres in one unit, from the global settings of an ASCII or binary FBX; a centimetre when it says nothing."""
    centimetres = 1.0
    plain = re.search(rb'"UnitScaleFactor"[^\n]*,\s*([0-9.eE+-]+)\s*\n', data)
    at = data.find(b"UnitScaleFactor")
    if plain is not None:
        centimetres = float(plain[1])
    elif at >= 0:
        number = data.find(b"D", at + len(b"UnitScaleFactor"), at + 80)
        while number >= 0 and data[number : number + 6] == b"Double":
            number = data.find(b"D", number + 1, at + 80)
        if number >= 0 and number + 9 <= len(data):
            centimetres = struct.unpack_from("<d", data, number + 1)[0]
    return centimetres / 100.0 if 1e-4 < centimetres < 1e5 else 0.01


def _mesh(imported: Any, materials: list[PBRMaterial]) -> trimesh.Trimesh:
    vertices = np.asarray(imported.vertices, dtype=float).reshape(-1, 3)
    faces = np.asarray(imported.indices, dtype=np.int64).reshape(-1, 3)
    uv = np.zeros((len(vertices), 2))
    if imported.texcoords:
        uv = np.asarray(imported.texcoords[0], dtype=float).reshape(len(vertices), -1)[:, :2]
    visual = trimesh.visual.TextureVisuals(uv=uv, material=materials[imported.material_index])
    return trimesh.Trimesh(vertices, faces, visual=visual, process=False, metadata={"name": str(imported.name)})


def _material(row: dict[str, Any], references: References) -> PBRMaterial:
    colour = [float(c) for c in row.get("COLOR_DIFFUSE", (0.8, 0.8, 0.8))][:3]
    texture = None
    for paths in row.get("TEXTURES", {}).values():
        for name in paths if isinstance(paths, (list, tuple)) else [paths]:
            data = references.image(str(name))
            if data is not None and texture is None:
                texture = Image.open(io.BytesIO(data), formats=IMAGE_FORMATS)
    return PBRMaterial(
        name=str(row.get("NAME", "")),
        baseColorFactor=[*(colour if texture is None else (1.0, 1.0, 1.0)), float(row.get("OPACITY", 1.0))],
        baseColorTexture=texture,
        metallicFactor=0.0,
        roughnessFactor=0.7,
    )
