"""Compressed geometry of glTF made plain: Draco (KHR_draco_mesh_compression) and meshopt (EXT_meshopt_compression)."""

from __future__ import annotations

from typing import Any

import numpy as np

from diorama_core.errors import LibraryError, UnavailableError
from diorama_core.library.ingest.limits import Limits

Json = dict[str, Any]
DRACO = "KHR_draco_mesh_compression"
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
UINT32, FLOAT32 = 5125, 5126
_FILTERS = {"OCTAHEDRAL": "oct", "QUATERNION": "quat", "EXPONENTIAL": "exp"}
MAX_STRIDE = 256


def is_fallback(buffer: Json) -> bool:
    """Whether a buffer only reserves what compressed views unpack to."""
    extensions = buffer.get("extensions", {})
    return any(name in extensions for name in MESHOPT) and "uri" not in buffer


def meshopt_view(row: Json, buffers: list[bytes], limits: Limits) -> bytes | None:
    """The plain bytes of a view that meshopt compressed; None for a view that it did not.

    Raises:
        LibraryError: it claims too much, or cannot be unpacked.
    """
    packed = next((row["extensions"][n] for n in MESHOPT if n in row.get("extensions", {})), None)
    if packed is None:
        return None
    import meshoptimizer

    count, stride, start = packed["count"], packed["byteStride"], packed.get("byteOffset", 0)
    if not (0 <= count <= 3 * limits.triangles and 0 < stride <= MAX_STRIDE):
        raise LibraryError(f"a compressed view claims {count} rows of {stride} bytes")
    data = buffers[packed["buffer"]][start : start + packed["byteLength"]]
    mode = packed.get("mode", "ATTRIBUTES")
    try:
        if mode == "ATTRIBUTES":
            rows = meshoptimizer.decode_vertex_buffer(count, stride, data, np.dtype(f"V{stride}"))
            return _unfilter(rows.view(np.uint8).reshape(count, stride), packed.get("filter"))
        decode = meshoptimizer.decode_index_buffer if mode == "TRIANGLES" else meshoptimizer.decode_index_sequence
        indices = np.asarray(decode(count, 4, data)).reshape(-1).astype("<u4")
        return indices.astype("<u2").tobytes() if stride == 2 else indices.tobytes()
    except (RuntimeError, ValueError, TypeError) as error:
        raise LibraryError(
            f"its geometry cannot be unpacked from meshopt ({str(error)[:80]}); export it again"
        ) from error


def _unfilter(rows: np.ndarray, name: str | None) -> bytes:
    """Rows with the extension's filter undone (https://github.com/KhronosGroup/glTF, EXT_meshopt_compression)."""
    if name in (None, "NONE"):
        return rows.tobytes()
    if name not in _FILTERS:
        raise LibraryError(f"its geometry uses the filter {str(name)[:20]!r}, which is not known")
    if name == "EXPONENTIAL":
        raw = rows.view("<i4")
        return np.ldexp((raw << 8 >> 8).astype(np.float32), raw >> 24).astype("<f4").tobytes()
    kind = np.dtype("<i1") if rows.shape[1] == 4 else np.dtype("<i2")
    raw = rows.view(kind).reshape(-1, 4).astype(np.float64)
    most = float(np.iinfo(kind).max)
    if name == "QUATERNION":
        return _quaternions(raw).astype("<i2").tobytes()
    one = np.maximum(np.abs(raw[:, 2:3]), 1.0)
    xy = raw[:, :2] / one
    z = 1.0 - np.abs(xy).sum(axis=1, keepdims=True)
    fold = np.maximum(-z, 0.0)
    xy = xy + np.where(xy >= 0, -fold, fold)
    unit = np.column_stack([xy, z])
    unit /= np.maximum(np.linalg.norm(unit, axis=1, keepdims=True), 1e-12)
    return np.column_stack([np.round(unit * most), raw[:, 3]]).astype(kind).tobytes()


def _quaternions(raw: np.ndarray) -> np.ndarray:
    scale = 1.0 / np.sqrt(2.0)
    one, largest = (raw[:, 3].astype(int) | 3).astype(float), raw[:, 3].astype(int) & 3
    xyz = raw[:, :3] / one[:, None] * scale
    w = np.sqrt(np.maximum(1.0 - (xyz**2).sum(axis=1), 0.0))
    quaternions = np.empty((len(raw), 4))
    rows = np.arange(len(raw))
    for k in range(3):
        quaternions[rows, (largest + 1 + k) % 4] = xyz[:, k]
    quaternions[rows, largest] = w
    return np.round(quaternions * 32767.0)


def undo_draco(document: Json, views: list[bytes], limits: Limits) -> None:
    """Give every primitive that Draco compressed plain accessors; views and rows are added at the end.

    Raises:
        UnavailableError: DracoPy is not installed.
        LibraryError: it claims too much, or cannot be unpacked.
    """
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            packed = primitive.get("extensions", {}).pop(DRACO, None)
            if packed is not None:
                _undo(primitive, packed, document, views, limits)


def _undo(primitive: Json, packed: Json, document: Json, views: list[bytes], limits: Limits) -> None:
    try:
        import DracoPy
    except ImportError as error:
        raise UnavailableError("its geometry is compressed with Draco; run: pip install DracoPy") from error
    accessors = document["accessors"]
    if accessors[primitive["attributes"]["POSITION"]]["count"] > 3 * limits.triangles:
        raise LibraryError(f"it has more than {limits.triangles} triangles; simplify it first")
    try:
        mesh = DracoPy.decode(views[packed["bufferView"]])
        values = {a["unique_id"]: np.asarray(a["data"]) for a in mesh.attributes}
        faces = np.asarray(getattr(mesh, "faces", np.zeros((0, 3))))
    except Exception as error:  # its own exceptions have no common kind
        raise LibraryError(
            f"its geometry cannot be unpacked from Draco ({str(error)[:80]}); export it again"
        ) from error
    if "indices" in primitive:
        row = accessors[primitive["indices"]]
        _replace(row, faces.reshape(-1).astype("<u4"), UINT32, document, views)
    for name, number in packed["attributes"].items():
        if number in values and name in primitive["attributes"]:
            row = accessors[primitive["attributes"][name]]
            scale = float(np.iinfo(values[number].dtype).max) if values[number].dtype.kind in "iu" else 1.0
            plain = values[number].astype("<f4") / (scale if row.get("normalized") else 1.0)
            _replace(row, plain.astype("<f4"), FLOAT32, document, views)


def _replace(row: Json, values: np.ndarray, component: int, document: Json, views: list[bytes]) -> None:
    views.append(np.ascontiguousarray(values).tobytes())
    document.setdefault("bufferViews", []).append({"buffer": 0, "byteLength": len(views[-1])})
    row |= {"bufferView": len(views) - 1, "byteOffset": 0, "componentType": component, "count": len(values)}
    row.pop("normalized", None)
    row.pop("sparse", None)
