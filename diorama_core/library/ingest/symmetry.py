"""Turns about up that leave a shape looking the same."""

from __future__ import annotations

import numpy as np
import trimesh

from diorama_core.library.ingest.relief import Relief, relief, turned
from diorama_core.library.record import SymmetryFold

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
    if _differ(pictures, turned(pictures, _QUARTER @ _QUARTER)):
        return next((fold for fold in _ODD_FOLDS if coincides(mesh, fold)), 1)
    x, y, _ = mesh.extents
    if abs(x - y) > 0.03 * max(x, y) or _differ(pictures, turned(pictures, _QUARTER)):
        return 6 if coincides(mesh, 6) else 2
    if _differ(pictures, _turned_by(mesh, 30.0)) or _differ(pictures, _turned_by(mesh, 45.0)):
        return 8 if coincides(mesh, 8) else 4
    return 36


def coincides(mesh: trimesh.Trimesh, fold: int) -> bool:
    """Whether a mesh turned by one of so many equal turns about up lies where it lay before."""
    from diorama_core.geometry.open3d_import import o3d  # a second to load

    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(np.asarray(mesh.vertices, np.float32), np.asarray(mesh.faces, np.uint32))
    points, _ = trimesh.sample.sample_surface(mesh, _POINTS, seed=0)
    moved = np.asarray(points) @ trimesh.transformations.rotation_matrix(2 * np.pi / fold, (0, 0, 1))[:3, :3].T
    away = scene.compute_distance(o3d.core.Tensor.from_numpy(moved.astype(np.float32)), nthreads=1).numpy()
    return bool(np.quantile(away, _NEARLY_ALL) < _COINCIDES * mesh.extents.max())


def _turned_by(mesh: trimesh.Trimesh, angle_deg: float) -> Relief:
    R = trimesh.transformations.rotation_matrix(np.radians(angle_deg), (0, 0, 1))[:3, :3]
    return relief(trimesh.Trimesh(np.asarray(mesh.vertices) @ R.T, mesh.faces, process=False))


def _differ(a: Relief, b: Relief) -> bool:
    return bool(np.abs(a - b).mean() > _SAME)
