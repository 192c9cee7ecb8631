"""Geometry compressed as KHR_draco_mesh_compression stores it: Google's Draco, by DracoPy.

Positions move by at most a sixteenth of a millimetre, normals by a quarter of a degree, texture coordinates by 1/4096.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32, Int

from diorama_core.errors import UnavailableError

EXTENSION = "KHR_draco_mesh_compression"
STEP_M = 1.25e-4
"""Distance of neighbouring positions at most; rounding moves by half of it."""
UV_BITS, NORMAL_BITS, LEVEL = 12, 10, 7
_OWN = {"TANGENT": 10, "COLOR_0": 11}
"""Ids of the attributes that Draco has no type for, or rounds to bytes; they are stored as they are."""


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
        generic_attributes={_OWN[name]: _plain(values) for name, values in arrays.items() if name in _OWN} or None,
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


def _plain(values: np.ndarray | None) -> np.ndarray | None:
    return None if values is None else np.ascontiguousarray(values, dtype=np.float32)


def _double(values: np.ndarray | None) -> np.ndarray | None:
    """In the precision that DracoPy takes these in."""
    return None if values is None else np.ascontiguousarray(values, dtype=np.float64)
