"""How alike two shapes are, and which group of objects the paper's tables would count one in."""

from __future__ import annotations

import hashlib

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial import cKDTree

from diorama_core.library.record import ShapeLibrary
from diorama_core.library.taxonomy import category

SAMPLES = 2000


def shape_points(library: ShapeLibrary, shape_id: str, count: int = SAMPLES) -> Float[np.ndarray, "n 3"]:
    """Points spread over a shape's surface, longest side 1, centred; always the same for the same shape."""
    return points_of(library.mesh(shape_id), shape_id, count)


def points_of(mesh: trimesh.Trimesh, seed: str, count: int = SAMPLES) -> Float[np.ndarray, "n 3"]:
    """Points spread over a mesh's surface, longest side 1, centred; always the same for the same words."""
    rng = np.random.default_rng(int.from_bytes(hashlib.sha256(seed.encode()).digest()[:4], "little"))
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.faces)]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    which = np.searchsorted(np.cumsum(area) / area.sum(), (np.arange(count) + rng.random(count)) / count)
    a, b = np.sort(rng.random((2, count)), axis=0)
    t = corners[np.minimum(which, len(corners) - 1)]
    points = t[:, 0] * a[:, None] + t[:, 1] * (b - a)[:, None] + t[:, 2] * (1 - b)[:, None]
    low, high = mesh.bounds
    return (points - (low + high) / 2) / (high - low).max()


def chamfer(a: Float[np.ndarray, "n 3"], b: Float[np.ndarray, "m 3"]) -> float:
    """Two-way chamfer distance: mean squared distance to the nearest point, one way plus the other."""
    forward, _ = cKDTree(b).query(a)
    back, _ = cKDTree(a).query(b)
    return float(np.mean(np.square(forward)) + np.mean(np.square(back)))


def shape_distance(library: ShapeLibrary, a: str, b: str) -> float:
    """The paper's retrieval distance: chamfer of normalised shapes, times 1000; 0 for the same shape."""
    return 0.0 if a == b else 1000.0 * chamfer(shape_points(library, a), shape_points(library, b))


def is_household(name: str) -> bool:
    """Whether a category is a small or mounted object rather than furniture."""
    return category(name).mount != "floor" or name in ("box", "basket", "trash can", "plant", "rug")
