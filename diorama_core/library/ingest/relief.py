"""The relief of a shape: how deep each of the six sides of its box lets one look in. A small, comparable picture.

Two shapes of one kind look alike from their six sides once both stand upright with their fronts the same way, so
comparing a model in each of its 24 orientations with shapes whose orientation is known tells its own. Turning a relief
by quarter turns only swaps and flips its pictures, so rays are cast once per model.
"""

from __future__ import annotations

import itertools
from functools import cache

import numpy as np
import trimesh
from jaxtyping import Float32, Int

SIDE = 24
"""Rays along each edge of the box."""
_OTHERS = ((1, 2), (0, 2), (0, 1))
"""The lattice axes of each axis' pictures, ascending."""

Relief = Float32[np.ndarray, "axis=3 end=2 n n"]
"""Depth seen along each axis from its low and its high end, 0 (at the box) to 1 (through); lattice axes ascending."""


def relief(mesh: trimesh.Trimesh) -> Relief:
    """The relief of a mesh in its own frame; the box is stretched to a cube first."""
    from diorama_core.geometry.open3d_import import o3d  # a second to load

    low, high = mesh.bounds
    unit = (np.asarray(mesh.vertices) - low) / np.maximum(high - low, 1e-12)
    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(unit.astype(np.float32), np.asarray(mesh.faces, dtype=np.uint32))
    hits = scene.cast_rays(o3d.core.Tensor.from_numpy(_rays()))["t_hit"].numpy()
    return np.clip(hits - 0.5, 0.0, 1.0).reshape(3, 2, SIDE, SIDE)


@cache
def _rays() -> Float32[np.ndarray, "r 6"]:
    steps = (np.arange(SIDE) + 0.5 + 0.013) / SIDE  # off the mesh's own symmetry lines
    a, b = np.meshgrid(steps, steps, indexing="ij")
    rays = np.zeros((3, 2, SIDE, SIDE, 6), np.float32)
    for axis, (j, k) in enumerate(_OTHERS):
        rays[axis, :, ..., j], rays[axis, :, ..., k] = a, b
        rays[axis, 0, ..., axis], rays[axis, 0, ..., 3 + axis] = -0.5, 1.0
        rays[axis, 1, ..., axis], rays[axis, 1, ..., 3 + axis] = 1.5, -1.0
    return rays.reshape(-1, 6)


def turned(pictures: Relief, R_to_from: Int[np.ndarray, "3 3"]) -> Relief:
    """The relief of the same shape after a turn by quarter turns (a signed permutation matrix)."""
    source = np.abs(R_to_from).argmax(axis=1)
    sign = R_to_from[np.arange(3), source]
    out = np.empty_like(pictures)
    for axis, (j, k) in enumerate(_OTHERS):
        both = pictures[source[axis]][:: sign[axis]]
        both = both if source[j] < source[k] else both.transpose(0, 2, 1)
        out[axis] = both[:, :: sign[j], :: sign[k]]
    return out


@cache
def quarter_turns() -> Int[np.ndarray, "24 3 3"]:
    """All rotations that map axes to axes; the identity first."""
    turns = []
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            R = np.zeros((3, 3), int)
            R[np.arange(3), order] = signs
            if np.linalg.det(R) > 0:
                turns.append(R)
    return np.array(sorted(turns, key=lambda R: -int(np.trace(R))))
