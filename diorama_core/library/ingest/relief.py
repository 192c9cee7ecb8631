"""The relief of a shape: how deep each of the six sides of its box lets one look in. A small, comparable picture, which
also tells the turns about up that leave a shape looking the same.

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

from diorama_core.library.record import SymmetryFold

SIDE = 24
"""Rays along each edge of the box."""
_OTHERS = ((1, 2), (0, 2), (0, 1))
"""The lattice axes of each axis' pictures, ascending."""

Relief = Float32[np.ndarray, "axis=3 end=2 n n"]
"""Depth seen along each axis from its low and its high end, 0 (at the box) to 1 (through); lattice axes ascending."""


def relief(mesh: trimesh.Trimesh) -> Relief:
    """The relief of a mesh in its own frame; the box is stretched to a cube first."""
    from diorama_core.geometry.ray_scene import RayScene  # a second to load

    low, high = mesh.bounds
    unit = (np.asarray(mesh.vertices) - low) / np.maximum(high - low, 1e-12)
    hits = RayScene(unit, np.asarray(mesh.faces)).first_hits(_rays())
    return np.clip(hits.distance - 0.5, 0.0, 1.0).reshape(3, 2, SIDE, SIDE)


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


def turn(pictures: Relief, R_to_from: Int[np.ndarray, "3 3"]) -> Relief:
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


_SAME = 0.035
"""Mean difference of two reliefs below which they are one shape seen twice."""
_COINCIDES = 0.02
"""Share of the largest extent within which nearly all of a turned surface coincides with itself."""
_NEARLY_ALL = 0.98
_POINTS = 1000
_ODD_FOLDS: tuple[SymmetryFold, ...] = (3, 5)
_QUARTER = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])


def symmetry_fold(mesh: trimesh.Trimesh, pictures: Relief) -> SymmetryFold:
    """The fold of a mesh in its canonical frame, from its relief and from its turned surface; 36 means round."""
    if _differ(pictures, turn(pictures, _QUARTER @ _QUARTER)):
        return next((fold for fold in _ODD_FOLDS if coincides(mesh, fold)), 1)
    x, y, _ = mesh.extents
    if abs(x - y) > 0.03 * max(x, y) or _differ(pictures, turn(pictures, _QUARTER)):
        return 6 if coincides(mesh, 6) else 2
    if _differ(pictures, _turn_by(mesh, 30.0)) or _differ(pictures, _turn_by(mesh, 45.0)):
        return 8 if coincides(mesh, 8) else 4
    return 36


def coincides(mesh: trimesh.Trimesh, fold: int) -> bool:
    """Whether a mesh turned by one of so many equal turns about up lies where it lay before."""
    from diorama_core.geometry.ray_scene import RayScene  # a second to load

    points, _ = trimesh.sample.sample_surface(mesh, _POINTS, seed=0)
    moved = np.asarray(points) @ trimesh.transformations.rotation_matrix(2 * np.pi / fold, (0, 0, 1))[:3, :3].T
    away = RayScene(np.asarray(mesh.vertices), np.asarray(mesh.faces), threads=1).distances(moved)
    return bool(np.quantile(away, _NEARLY_ALL) < _COINCIDES * mesh.extents.max())


def _turn_by(mesh: trimesh.Trimesh, angle_deg: float) -> Relief:
    R = trimesh.transformations.rotation_matrix(np.radians(angle_deg), (0, 0, 1))[:3, :3]
    return relief(trimesh.Trimesh(np.asarray(mesh.vertices) @ R.T, mesh.faces, process=False))


def _differ(a: Relief, b: Relief) -> bool:
    return bool(np.abs(a - b).mean() > _SAME)
