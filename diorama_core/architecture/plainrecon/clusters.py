"""Points of a room parted into planar pieces by their normals, as published (Diorama, supplement, "Plane
identification and fitting").

Where the publication names no number, the authors' public code does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import cKDTree
from sklearn.cluster import DBSCAN, KMeans

from diorama_core.io.large_libraries import o3d

GROWTH_COSINE = float(np.cos(np.deg2rad(10.0)))
MIN_POINTS = 200


@dataclass(frozen=True)
class PlaneClusterSettings:
    """How points are parted into planar pieces."""

    voxel_m: float = 0.05
    outlier_neighbours: int = 200
    outlier_deviations: float = 2.0
    seeds: int = 12
    dense_m: float = 0.1
    dense_points: int = 5


SETTINGS = PlaneClusterSettings()


def planar_clusters(
    points: Float[np.ndarray, "n 3"], normals: Float[np.ndarray, "n 3"], seed: int = 0
) -> Int[np.ndarray, "n"]:
    """The planar piece that each point belongs to, largest direction first; -1 everywhere when there is none."""
    if len(points) < MIN_POINTS:
        return np.full(len(points), -1)
    representatives, directions = _downsample(points, normals)
    labels = _grow_clusters(representatives, directions, seed)
    if (labels < 0).all():
        return np.full(len(points), -1)
    settled = labels >= 0
    nearest = cKDTree(representatives[settled]).query(points)[1]
    return np.asarray(labels[settled][nearest])


def _downsample(
    points: Float[np.ndarray, "n 3"], normals: Float[np.ndarray, "n 3"]
) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"]]:
    """One point a voxel, without statistical outliers."""
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
    cloud.normals = o3d.utility.Vector3dVector(normals)
    cloud = cloud.voxel_down_sample(SETTINGS.voxel_m)
    cloud = cloud.remove_statistical_outlier(SETTINGS.outlier_neighbours, SETTINGS.outlier_deviations)[0]
    directions = np.asarray(cloud.normals)
    lengths = np.linalg.norm(directions, axis=1)
    sound = lengths > 1e-6
    return np.asarray(cloud.points)[sound], directions[sound] / lengths[sound, None]


def _grow_clusters(
    points: Float[np.ndarray, "n 3"], normals: Float[np.ndarray, "n 3"], seed: int
) -> Int[np.ndarray, "n"]:
    """Seed normals from K-means; everything within the growth angle of one, parted where it is not connected."""
    labels = np.full(len(points), -1)
    if len(points) < MIN_POINTS:
        return labels
    means = KMeans(min(SETTINGS.seeds, len(np.unique(normals.round(6), axis=0))), n_init=3, random_state=seed).fit(
        normals
    )
    seeds = means.cluster_centers_ / np.maximum(np.linalg.norm(means.cluster_centers_, axis=1, keepdims=True), 1e-9)
    near = normals @ seeds.T > GROWTH_COSINE
    free, number = np.ones(len(points), dtype=bool), 0
    waiting = list(range(len(seeds)))
    while waiting and free.sum() >= MIN_POINTS:
        fullest = max(waiting, key=lambda k: int((near[:, k] & free).sum()))
        waiting.remove(fullest)
        member = near[:, fullest] & free
        for piece in _find_dense_clusters(points, member):
            labels[piece], number = number, number + 1
        free &= ~member
    return labels


def _find_dense_clusters(points: Float[np.ndarray, "n 3"], member: Bool[np.ndarray, "n"]) -> list[Int[np.ndarray, "_"]]:
    """Indices of the dense pieces of the members that are large enough, largest first."""
    chosen = np.flatnonzero(member)
    if len(chosen) < MIN_POINTS:
        return []
    parts = DBSCAN(eps=SETTINGS.dense_m, min_samples=SETTINGS.dense_points).fit_predict(points[chosen])
    pieces = [chosen[parts == k] for k in range(int(parts.max()) + 1)]
    return sorted((p for p in pieces if len(p) >= MIN_POINTS), key=lambda p: -len(p))
