"""Geometry compressed as EXT_meshopt_compression stores it.

Positions are rounded to a sixteenth of a millimetre and texture coordinates to 1/4096, which compresses well and
moves nothing visibly; directions become normalised bytes (KHR_mesh_quantization).
"""

from __future__ import annotations

import meshoptimizer
import numpy as np
from jaxtyping import Integer

EXTENSION = "EXT_meshopt_compression"
_STEPS = {"POSITION": 2.0**14, "TEXCOORD_0": 2.0**12, "TEXCOORD_1": 2.0**12, "COLOR_0": 2.0**8}


def prepared(
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
    return {name: _rounded(name, values[used]) for name, values in arrays.items()}, place[ordered].reshape(-1, 3)


def encoded_vertices(values: np.ndarray) -> bytes:
    """Attribute data, one row a vertex, rows of a multiple of four bytes."""
    meshoptimizer.encode_vertex_version(0)  # the only one that the extension allows
    return bytes(meshoptimizer.encode_vertex_buffer(values))


def encoded_faces(indices: Integer[np.ndarray, " n"], vertices: int) -> bytes:
    """Indices of triangles."""
    meshoptimizer.encode_index_version(1)
    return bytes(meshoptimizer.encode_index_buffer(np.ascontiguousarray(indices, np.uint32), len(indices), vertices))


def _rounded(name: str, values: np.ndarray) -> np.ndarray:
    if name in ("NORMAL", "TANGENT"):
        packed = np.zeros((len(values), 4), dtype="<i1")
        packed[:, : values.shape[1]] = np.round(values * 127.0)
        return packed
    step = _STEPS[name]
    return np.ascontiguousarray(np.round(values * step) / step, dtype="<f4")
