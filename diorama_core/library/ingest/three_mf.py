"""3MF: meshes of its model parts with their placement. Millimetres unless it says otherwise, +Z up.

https://github.com/3MFConsortium/spec_core
"""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
import zipfile
from dataclasses import dataclass, field

import numpy as np
import trimesh
from jaxtyping import Float

from diorama_core.errors import LibraryError
from diorama_core.io.text import parse_xml
from diorama_core.library.ingest.limits import DEFAULT_LIMITS, Limits

UNITS_M = {
    "micron": 1e-6, "millimeter": 1e-3, "centimeter": 1e-2, "inch": 0.0254, "foot": 0.3048, "meter": 1.0,
}  # fmt: skip


@dataclass
class _Objects:
    meshes: dict[str, trimesh.Trimesh] = field(default_factory=dict)
    parts: dict[str, list[tuple[str, Float[np.ndarray, "4 4"]]]] = field(default_factory=dict)


def read_3mf(data: bytes, limits: Limits) -> tuple[trimesh.Scene, float]:
    """The scene of a 3MF package in its own unit, and metres in one unit.

    Raises:
        LibraryError: it is no such package, or too large.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as package:
            names = [i for i in package.infolist() if i.filename.lower().endswith(".model")]
            if not names or sum(i.file_size for i in names) > limits.file_bytes:
                raise LibraryError("it has no 3D model, or unpacks to too much")
            roots = [parse_xml(package.read(name), "its 3D model", LibraryError) for name in names]
    except (zipfile.BadZipFile, OSError, RuntimeError, NotImplementedError) as error:
        raise LibraryError(f"malformed 3MF ({str(error)[:80]}); export it again") from error
    objects = _Objects()
    for root in roots:
        for row in root.iter(_tag(root, "object")):
            _take(objects, row, root)
    scene, main = trimesh.Scene(), next((r for r in roots if r.find(f"{_tag(r, 'build')}") is not None), roots[0])
    items = main.findall(f"{_tag(main, 'build')}/{_tag(main, 'item')}")
    placed = [(i.get("objectid", ""), _matrix(i.get("transform"))) for i in items]
    for object_id, T in placed or [(name, np.eye(4)) for name in objects.meshes]:
        _place(scene, objects, object_id, T, ())
    return scene, UNITS_M.get(main.get("unit", "millimeter"), 1e-3)


def _tag(root: ET.Element, name: str) -> str:
    return f"{root.tag.partition('}')[0]}}}{name}" if root.tag.startswith("{") else name


def _take(objects: _Objects, row: ET.Element, root: ET.Element) -> None:
    name, mesh = row.get("id", ""), row.find(_tag(root, "mesh"))
    if mesh is not None:
        vertices = [[float(v.get(axis, "nan")) for axis in "xyz"] for v in mesh.iter(_tag(root, "vertex"))]
        faces = [[int(t.get(key, "-1")) for key in ("v1", "v2", "v3")] for t in mesh.iter(_tag(root, "triangle"))]
        if vertices and faces:
            objects.meshes[name] = trimesh.Trimesh(vertices, faces, process=False)
    parts = row.findall(f"{_tag(root, 'components')}/{_tag(root, 'component')}")
    objects.parts[name] = [(p.get("objectid", ""), _matrix(p.get("transform"))) for p in parts]


def _matrix(text: str | None) -> Float[np.ndarray, "4 4"]:
    T = np.eye(4)
    if text:
        T[:3] = np.array([float(v) for v in text.split()]).reshape(4, 3).T
    return T


def _place(
    scene: trimesh.Scene, objects: _Objects, name: str, T: Float[np.ndarray, "4 4"], above: tuple[str, ...]
) -> None:
    if name in above or len(scene.geometry) > DEFAULT_LIMITS.nodes:
        raise LibraryError("its parts refer to one another in a circle")
    if name in objects.meshes:
        scene.add_geometry(objects.meshes[name].copy(), transform=T)
    for part, T_part in objects.parts.get(name, []):
        _place(scene, objects, part, T @ T_part, (*above, name))
