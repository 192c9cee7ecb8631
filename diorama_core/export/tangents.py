"""Tangents for surfaces with a normal map, so that every program lights them alike."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32

from diorama_core.render.appearance import Surface


def tangents(surface: Surface) -> Float32[np.ndarray, "n 4"]:
    """Unit tangents along growing u, orthogonal to the normals, with the sign of the bitangent as fourth component.

    Sums over the faces at each vertex, after E. Lengyel, Foundations of Game Engine Development, volume 2, section 7.5.
    Where the texture coordinates say nothing, any direction along the surface is taken.
    """
    if surface.uv is None:
        raise ValueError("tangents follow texture coordinates; this surface has none")
    p, uv = surface.vertices[surface.faces].astype(np.float64), surface.uv[surface.faces] * [1.0, -1.0]
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    (x1, y1), (x2, y2) = (uv[:, 1] - uv[:, 0]).T, (uv[:, 2] - uv[:, 0]).T
    area = x1 * y2 - x2 * y1
    sign = np.sign(area)[:, None]
    along_u = sign * (e1 * y2[:, None] - e2 * y1[:, None])
    along_v = sign * (e2 * x1[:, None] - e1 * x2[:, None])
    total = [_sums(values, surface.faces, len(surface.vertices)) for values in (along_u, along_v)]
    n = surface.normals.astype(np.float64)
    t = total[0] - n * (n * total[0]).sum(axis=1, keepdims=True)
    length = np.linalg.norm(t, axis=1, keepdims=True)
    axis = np.eye(3)[np.abs(n).argmin(axis=1)]
    fallback = np.cross(n, axis)
    t = np.where(length > 1e-12, t / np.maximum(length, 1e-12), fallback / np.linalg.norm(fallback, axis=1)[:, None])
    hand = np.where((np.cross(n, t) * total[1]).sum(axis=1) < 0, -1.0, 1.0)
    return np.column_stack([t, hand]).astype(np.float32)


def _sums(values: np.ndarray, faces: np.ndarray, count: int) -> np.ndarray:
    out = np.zeros((count, 3))
    for corner in range(3):
        np.add.at(out, faces[:, corner], values)
    return out
