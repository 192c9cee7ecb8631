"""Small models that the tests write: a chair, and files that are broken in one way each."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from diorama_core.library.ingest.known_shapes import KnownShapes, relief_features
from diorama_core.library.ingest.relief import relief


def block(size: tuple[float, float, float], at: tuple[float, float, float]) -> trimesh.Trimesh:
    return trimesh.creation.box(size, transform=trimesh.transformations.translation_matrix(at))


def chair() -> trimesh.Trimesh:
    """A dining chair in metres, +Z up, its front along +X."""
    legs = [block((0.04, 0.04, 0.45), (sx * 0.2, sy * 0.2, 0.225)) for sx in (1, -1) for sy in (1, -1)]
    return trimesh.util.concatenate(
        [*legs, block((0.46, 0.46, 0.04), (0, 0, 0.46)), block((0.04, 0.46, 0.42), (-0.21, 0, 0.69))]
    )


def table() -> trimesh.Trimesh:
    """A dining table in metres, +Z up."""
    legs = [block((0.06, 0.06, 0.7), (sx * 0.38, sy * 0.65, 0.35)) for sx in (1, -1) for sy in (1, -1)]
    return trimesh.util.concatenate([*legs, block((0.85, 1.4, 0.04), (0, 0, 0.72))])


def y_up(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """A model in the frame of glTF: +Y up, front along +Z."""
    R = np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]], float)
    return trimesh.Trimesh(mesh.vertices @ R.T, mesh.faces, process=False)


def known_shapes(*rows: tuple[str, trimesh.Trimesh]) -> KnownShapes:
    """Upright shapes of some kinds, facing +X, to compare others with."""
    features = np.stack([relief_features(relief(mesh)) for _, mesh in rows])
    return KnownShapes(tuple(name for name, _ in rows), features, np.log([mesh.extents for _, mesh in rows]))


def document(**changes: Any) -> dict[str, Any]:
    """A glTF document of one triangle in buffer 0 (see `TRIANGLE`)."""
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "thing"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "buffers": [{"byteLength": 44}],
        **changes,
    }


TRIANGLE = struct.pack("<9f3H2x", 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0, 1, 2)


def write_glb(path: Path, content: dict[str, Any] | bytes, binary: bytes = TRIANGLE) -> Path:
    text = content if isinstance(content, bytes) else json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body)
    return path
