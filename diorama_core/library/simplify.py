"""Models with fewer triangles, for browsers that draw without a graphics card: there a triangle costs microseconds."""

from __future__ import annotations

from typing import Any

import meshoptimizer
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from diorama_core.io.glb import read_glb, write_glb

LARGEST_ERRORS = (0.05, 0.015, 0.004)
"""How far a simplified surface may lie from the true one, in the part's size: the first that keeps the part."""
MIN_AREA_SHARE = 0.8
"""A part of thin bars loses its surface before anything else: less than so much of it is not the same part."""
MAX_AREA_SHARE = 1.08
"""Wires that are joined by a web of triangles have more surface than before."""
MAX_SHORTER = 0.03
"""Share of a piece's longest side by which its sides may become shorter."""
MIN_TRIANGLES = 12
"""Triangles that every connected piece of a model keeps: those of a box."""

_TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_INDICES, _VERTICES = 34963, 34962


def simplify_glb(data: bytes, max_triangles: int) -> bytes:
    """A GLB with about `max_triangles` at most, its materials and pictures as they are.

    Models that are light enough, and those with parts this does not know (animations, compressed or sparse data), come
    back unchanged. Simplified by quadric error (meshoptimizer), every vertex one of the original ones.
    """
    document, binary = read_glb(data)
    parts = [p for mesh in document.get("meshes", ()) for p in mesh["primitives"]]
    if not all(map(_is_plain, parts)) or not _is_known(document):
        return data
    total = sum(document["accessors"][p["indices"]]["count"] for p in parts) // 3
    if total <= max_triangles:
        return data
    written = _Writer(document)
    for part in parts:
        triangles = _array(document, binary, part["indices"]).ravel().astype(np.uint32)
        arrays = {name: _array(document, binary, k) for name, k in part["attributes"].items()}
        fewer = simplify(triangles, arrays["POSITION"], max_triangles / total)
        ordered = np.empty_like(fewer)
        meshoptimizer.optimize_vertex_cache(ordered, fewer, len(fewer), len(arrays["POSITION"]))
        used, renumbered = np.unique(ordered, return_inverse=True)
        part["attributes"] = {name: written.vertices(name, array[used]) for name, array in arrays.items()}
        part["indices"] = written.indices(renumbered.astype(np.uint32))
    for image in document.get("images", ()):
        if "bufferView" in image:
            image["bufferView"] = written.piece(_view(document, binary, image["bufferView"]))
    return written.glb()


def simplify(
    triangles: np.ndarray,
    positions: np.ndarray,
    share: float,
    errors: tuple[float, ...] = LARGEST_ERRORS,
    max_shorter: float = MAX_SHORTER,
) -> np.ndarray:
    """Fewer triangles of a part, piece by piece: the thinnest rail among them stays as much as the largest board.

    Args:
        triangles: rows of `positions`, three a triangle.
        positions: corners, n x 3.
        share: of the triangles that should be left.
        errors: how far the surface may move, in each piece's size: the first that keeps the piece.
        max_shorter: share of a piece's longest side by which its sides may become shorter.
    """
    points = np.ascontiguousarray(positions, dtype=np.float32)
    pieces = [_fewer(piece, points, share, errors, max_shorter) for piece in _pieces(triangles, points)]
    return np.concatenate(pieces) if pieces else triangles


def _fewer(
    triangles: np.ndarray, points: np.ndarray, share: float, errors: tuple[float, ...], max_shorter: float
) -> np.ndarray:
    target = 3 * max(round(share * len(triangles) / 3), MIN_TRIANGLES)
    if target >= len(triangles):
        return triangles
    used, faces_used = np.unique(triangles, return_inverse=True)
    near, faces_used = np.ascontiguousarray(points[used]), faces_used.astype(np.uint32)
    area, extents = _area(faces_used, near), np.ptp(near, axis=0)
    for error in errors:
        simplified = np.empty_like(faces_used)
        count = meshoptimizer.simplify(simplified, faces_used, near, target_index_count=target, target_error=error)
        left = simplified[:count]
        share_left = _area(left, near) / max(area, 1e-12)
        if count and MIN_AREA_SHARE <= share_left <= MAX_AREA_SHARE and _spans(left, near, extents, max_shorter):
            return used[left].astype(np.uint32)
    return triangles


def _spans(triangles: np.ndarray, points: np.ndarray, extents: np.ndarray, max_shorter: float) -> bool:
    """Whether a simplified piece is about as long, wide and high as the piece."""
    left = np.ptp(points[triangles], axis=0)
    return bool((left >= extents - max_shorter * extents.max()).all())


def _pieces(triangles: np.ndarray, points: np.ndarray) -> list[np.ndarray]:
    """The triangles of each connected piece; corners at one place are one corner, whatever their normals."""
    _, corner = np.unique(points, axis=0, return_inverse=True)
    faces = corner.ravel()[triangles.reshape(-1, 3)]
    edges = np.concatenate([faces[:, :2], faces[:, 1:]])
    count = int(corner.max()) + 1
    graph = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    piece = connected_components(graph, directed=False)[1][faces[:, 0]]
    order = np.argsort(piece, kind="stable")
    bounds = np.flatnonzero(np.diff(piece[order])) + 1
    return [triangles.reshape(-1, 3)[rows].ravel() for rows in np.split(order, bounds)] if len(order) else []


def _area(triangles: np.ndarray, points: np.ndarray) -> float:
    a, b, c = (points[triangles.reshape(-1, 3)[:, k]].astype(np.float64) for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


class _Writer:
    """Collects new accessors and buffers for a document."""

    def __init__(self, document: dict[str, Any]) -> None:
        self._document = document
        self._accessors: list[dict[str, Any]] = []
        self._views: list[dict[str, Any]] = []
        self._data = bytearray()

    def vertices(self, name: str, array: np.ndarray) -> int:
        width = {v: k for k, v in _WIDTHS.items()}[array.shape[1]]
        bounds = {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()} if name == "POSITION" else {}
        return self._add(array, _VERTICES, {"type": width, **bounds})

    def indices(self, array: np.ndarray) -> int:
        return self._add(array, _INDICES, {"type": "SCALAR"})

    def piece(self, data: bytes, **about: int) -> int:
        self._data.extend(b"\0" * (-len(self._data) % 4))
        self._views.append({"buffer": 0, "byteOffset": len(self._data), "byteLength": len(data), **about})
        self._data.extend(data)
        return len(self._views) - 1

    def _add(self, array: np.ndarray, target: int, about: dict[str, Any]) -> int:
        component = {np.dtype(t): code for code, t in _TYPES.items()}[array.dtype]
        view = self.piece(np.ascontiguousarray(array).tobytes(), target=target)
        self._accessors.append({"bufferView": view, "componentType": component, "count": len(array), **about})
        return len(self._accessors) - 1

    def glb(self) -> bytes:
        self._data.extend(b"\0" * (-len(self._data) % 4))
        buffers = {
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._data)}],
        }
        return write_glb({**self._document, **buffers}, self._data, allow_nan=True)


def _is_plain(part: dict[str, Any]) -> bool:
    return part.get("mode", 4) == 4 and "indices" in part and not part.get("targets") and not part.get("extensions")


def _is_known(document: dict[str, Any]) -> bool:
    views = document.get("bufferViews", ())
    return (
        not document.get("animations")
        and not document.get("skins")
        and len(document.get("buffers", ())) == 1
        and not any("byteStride" in v or v.get("extensions") for v in views)
        and all(
            "sparse" not in a
            and "bufferView" in a
            and not a.get("byteOffset")
            and a["type"] in _WIDTHS
            and a["componentType"] in _TYPES
            for a in document.get("accessors", ())
        )
    )


def _view(document: dict[str, Any], binary: bytes, index: int) -> bytes:
    view = document["bufferViews"][index]
    start = view.get("byteOffset", 0)
    return binary[start : start + view["byteLength"]]


def _array(document: dict[str, Any], binary: bytes, index: int) -> np.ndarray:
    accessor = document["accessors"][index]
    width, kind = _WIDTHS[accessor["type"]], _TYPES[accessor["componentType"]]
    data = _view(document, binary, accessor["bufferView"])
    return np.frombuffer(data, kind, accessor["count"] * width).reshape(-1, width)
