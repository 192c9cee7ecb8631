"""Similarity transforms between point sets: Umeyama's closed form for many sets at once, and RANSAC around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

_SAMPLE = 4
_HYPOTHESES = 500


@dataclass(frozen=True, eq=False)
class Similarity:
    """target = scale R source + t."""

    scale: float
    R: Float[np.ndarray, "3 3"]
    t: Float[np.ndarray, "3"]
    inliers: Bool[np.ndarray, " n"]


def umeyama(
    source: Float[np.ndarray, "b n 3"], target: Float[np.ndarray, "b n 3"]
) -> tuple[Float[np.ndarray, " b"], Float[np.ndarray, "b 3 3"], Float[np.ndarray, "b 3"]]:
    """Least-squares scale, rotation and translation of every batch (Umeyama 1991); scale 1 for coincident points."""
    mean_s, mean_t = source.mean(axis=1), target.mean(axis=1)
    s, t = source - mean_s[:, None], target - mean_t[:, None]
    covariance = np.einsum("bni,bnj->bij", t, s) / source.shape[1]
    U, D, Vt = np.linalg.svd(covariance)
    sign = np.ones_like(D)
    sign[:, 2] = np.sign(np.linalg.det(U) * np.linalg.det(Vt))
    R = np.einsum("bij,bj,bjk->bik", U, sign, Vt)
    spread = (s**2).sum(axis=(1, 2)) / source.shape[1]
    scale = np.where(spread > 1e-12, (D * sign).sum(axis=1) / np.maximum(spread, 1e-12), 1.0)
    return scale, R, mean_t - scale[:, None] * np.einsum("bij,bj->bi", R, mean_s)


def ransac_umeyama(
    source: Float[np.ndarray, "n 3"],
    target: Float[np.ndarray, "n 3"],
    threshold: float,
    *,
    seed: int = 0,
    scales: tuple[float, float] = (0.2, 5.0),
) -> Similarity | None:
    """The similarity that most correspondences agree with.

    All hypotheses are computed and counted at once.

    Args:
        source: Points.
        target: The same points elsewhere; with some wrong ones.
        threshold: Distance in the target's units within which a pair agrees.
        seed: Of the samples.
        scales: Least and most scale believed.

    Returns:
        The refit over the inliers of the best hypothesis; None with fewer than four pairs or without agreement.
    """
    n = len(source)
    if n < _SAMPLE:
        return None
    rng = np.random.default_rng(seed)
    chosen = rng.random((_HYPOTHESES, n)).argpartition(_SAMPLE - 1, axis=1)[:, :_SAMPLE]
    scale, R, t = umeyama(source[chosen], target[chosen])
    moved = scale[:, None, None] * np.einsum("bij,nj->bni", R, source) + t[:, None]
    distance = np.linalg.norm(moved - target, axis=2)
    agree = (distance < threshold) & ((scale > scales[0]) & (scale < scales[1]))[:, None]
    quality = agree.sum(axis=1) - (np.minimum(distance, threshold).mean(axis=1) / threshold)
    best = int(np.where(agree.any(axis=1), quality, -np.inf).argmax())
    inliers = agree[best]
    if inliers.sum() < _SAMPLE:
        return None
    scale, R, t = umeyama(source[inliers][None], target[inliers][None])
    if not scales[0] < scale[0] < scales[1]:
        return None
    return Similarity(float(scale[0]), R[0], t[0], inliers)
