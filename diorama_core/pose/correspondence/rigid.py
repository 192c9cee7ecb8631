"""Similarity poses from what one object's picture and the views of one shape have in common: Umeyama's closed form for
many point sets at once, within RANSAC.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from diorama_core.models.gigapose import ScaleNetwork
from diorama_core.pose.correspondence.crops import PATCHES, PatchCrop, patch_pixels
from diorama_core.pose.correspondence.matching import Matches
from diorama_core.render.templates import Templates
from diorama_core.scene.types import yaw_rotation

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


POOLED_VIEWS = 5
"""Views whose matches are taken together: their points are all in the shape's one frame."""
_THRESHOLDS = (0.02, 0.05, 0.1)
"""Distances within which lifted matches agree, tightest first, as shares of the object's extent."""
_ENOUGH_INLIERS = 0.35
_MIN_MATCHES = 3


@dataclass(frozen=True, eq=False)
class Rigid:
    """A pose in the photo camera's frame, one scale, and how alike picture and views are."""

    R: Float[np.ndarray, "3 3"]
    t: Float[np.ndarray, "3"]
    scale: float
    similarity: float


@dataclass(frozen=True, eq=False)
class Compared:
    """One object's picture laid against every view of one shape."""

    crop: PatchCrop
    templates: Templates
    matches: Matches
    similarity: Float[np.ndarray, " v"]
    """How like the whole picture is to each view."""

    def lift_matches(self, view: int) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, "m 3"]]:
        """A view's matches on the shape and in the photo camera's frame, best first; those without depth left out."""
        count = int(self.matches.count[view])
        pixels = patch_pixels(self.templates.grid.size_px)[self.matches.template[view, :count]]
        source = self.templates.points_at(view, pixels).astype(float)
        target = self.crop.points_camera[self.matches.query[view, :count]].astype(float)
        known = np.isfinite(source).all(axis=1) & np.isfinite(target).all(axis=1)
        return source[known], target[known]

    @property
    def ranked_views(self) -> Int[np.ndarray, " v"]:
        """Views by the mean similarity of their matches and how many there are, best first."""
        believed = self.matches.mean_similarity * np.sqrt(self.matches.count)
        return np.argsort(-believed, kind="stable")


def from_matches(
    compared: Compared, views: Int[np.ndarray, " n"], scale_network: ScaleNetwork | None = None
) -> Rigid | None:
    """RANSAC-Umeyama over the lifted matches of the chosen views, the tightest tolerance first.

    With a scale network its pose from the best match competes: the one that more matches agree with is taken.
    """
    pairs = [compared.lift_matches(int(v)) for v in views]
    source, target = (np.concatenate(side) for side in zip(*pairs, strict=True))
    best = int(views[0])
    similarity = float(compared.matches.mean_similarity[best])
    coarse = from_view(compared, best, similarity)
    if not len(target):
        return coarse
    extent = float(np.linalg.norm(np.ptp(target, axis=0)))
    fitted = None
    for share in _THRESHOLDS:
        fit = ransac_umeyama(source, target, share * extent, seed=best)
        if fit is not None and (fit.inliers.mean() >= _ENOUGH_INLIERS or share == _THRESHOLDS[-1]):
            fitted = Rigid(fit.R, fit.t, fit.scale, similarity)
            break
    predicted = None if scale_network is None else from_one_match(compared, best, scale_network)
    options = [pose for pose in (fitted, predicted) if pose is not None]
    if not options:
        return coarse
    return max(options, key=lambda pose: _agreeing(pose, source, target, _THRESHOLDS[1] * extent))


def from_view(compared: Compared, view: int, similarity: float) -> Rigid | None:
    """The turn of one view; size and place from what the mask and the depth under it span."""
    crop, templates = compared.crop, compared.templates
    seen = crop.points_camera[np.isfinite(crop.points_camera).all(axis=1)].astype(float)
    shown = templates.points_at(view, patch_pixels(templates.grid.size_px)).astype(float)
    shown = shown[np.isfinite(shown).all(axis=1)]
    if len(seen) == 0 or len(shown) == 0:
        return None
    R = crop.R_camera_crop @ templates.grid.R_object_camera[view].T
    mask = templates.depth_codes[view] > 0
    z_seen = float(np.median(seen @ crop.R_camera_crop[:, 2]))
    z_shown = float(np.median(templates.depth_m(view)[mask]))
    span_seen = _span(crop.view.mask[0]) / crop.focal_px * z_seen
    span_shown = _span(mask) / templates.grid.intrinsics.fx * z_shown
    scale = float(span_seen / max(span_shown, 1e-9))
    return Rigid(R, np.median(seen, axis=0) - scale * R @ np.median(shown, axis=0), scale, similarity)


def from_one_match(compared: Compared, view: int, scale_network: ScaleNetwork | None = None) -> Rigid | None:
    """The turn of a view turned further in the picture's plane, hung on its best match.

    Relative size and in-plane turn come from the network, or from where the view's matches lie in the picture.
    """
    crop, templates, matches = compared.crop, compared.templates, compared.matches
    count = int(matches.count[view])
    query, patches = matches.query[view, :count], matches.template[view, :count]
    coarse = from_view(compared, view, float(matches.mean_similarity[view]))
    source, target = compared.lift_matches(view)
    if coarse is None or count < _MIN_MATCHES or len(target) == 0:
        return coarse
    if scale_network is None:
        size2d, angle = _plane_similarity(templates.grid.size_px, patches, query)
    else:
        size2d, angle = _predict_scale_and_turn(compared, view, scale_network)
    R = crop.R_camera_crop @ yaw_rotation(angle) @ templates.grid.R_object_camera[view].T
    z_seen = float(target[0] @ crop.R_camera_crop[:, 2])
    z_shown = float(templates.camera(view).to_camera(source[:1])[0, 2])
    scale = float(size2d * (z_seen / crop.focal_px) / (z_shown / templates.grid.intrinsics.fx))
    if not (np.isfinite(scale) and scale > 0):
        return coarse
    return Rigid(R, target[0] - scale * R @ source[0], scale, coarse.similarity)


def _plane_similarity(
    size_px: int, patches: Int[np.ndarray, " k"], query: Int[np.ndarray, " k"]
) -> tuple[float, float]:
    """Relative size and in-plane turn that carry a view's matched patches onto the picture's."""
    pixels = patch_pixels(size_px).astype(float)
    size2d, turn, _ = umeyama(_flat(pixels[patches]), _flat(pixels[query]))
    return float(size2d[0]), float(np.arctan2(turn[0, 1, 0], turn[0, 0, 0]))


def _predict_scale_and_turn(compared: Compared, view: int, network: ScaleNetwork) -> tuple[float, float]:
    """Size and turn from the best match alone, by the network."""
    pictures = [
        np.repeat(g[..., None], 3, axis=-1) for g in (compared.templates.gray[view], compared.crop.view.gray[0])
    ]
    template, photo = network.maps(pictures)
    cells = [
        np.array([[patch % PATCHES, patch // PATCHES]])
        for patch in (compared.matches.template[view, 0], compared.matches.query[view, 0])
    ]
    turns = network.turns(template, photo, *cells)
    return float(turns.scale[0]), float(turns.angle_rad[0])


def _agreeing(
    pose: Rigid, source: Float[np.ndarray, "n 3"], target: Float[np.ndarray, "n 3"], threshold_m: float
) -> int:
    """How many lifted matches a pose carries onto each other."""
    moved = pose.scale * source @ pose.R.T + pose.t
    near: Bool[np.ndarray, " n"] = np.linalg.norm(moved - target, axis=1) < threshold_m
    return int(near.sum())


def _flat(pixels: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, "1 n 3"]:
    return np.column_stack([pixels, np.zeros(len(pixels))])[None]


def _span(mask: np.ndarray) -> float:
    """The diagonal of a mask's box, pixels."""
    rows, columns = np.nonzero(mask)
    return float(np.hypot(np.ptp(rows) + 1, np.ptp(columns) + 1)) if len(rows) else 0.0
