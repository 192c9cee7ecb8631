"""Plane textures from several photos: every texel from the photo that sees it best.

Photos are first brought to one exposure where they show the same texels (a gain for each photo and channel, Brown and
Lowe 2007). Then light and shade are blended broadly between them, fine detail narrowly (two bands of Burt and Adelson
1983), so that neither steps of brightness nor double edges show. What no photo sees is continued as from one photo.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, UInt8

from diorama_core.architecture.texture.plane_textures import (
    PhotoView,
    PlaneView,
    RoomPicture,
    is_enough,
    plane_picture,
    texel_points,
)
from diorama_core.architecture.texture.quilting import broad_shading
from diorama_core.scene.types import Architecture


@dataclass(frozen=True)
class BestViewSettings:
    """How photos are weighted by how well they see a texel."""

    min_common: int = 200
    """Texels from which on two photos are compared."""
    enough_common: int = 4000
    """More than so many make a comparison no surer."""
    darkest: float = 12.0
    """Levels of 255: darker texels tell no ratio."""
    no_gain_weight: float = 0.02
    """Weight of every photo's own exposure beside a comparison with another photo."""
    max_gain: float = 2.0
    compared_m: float = 0.06
    """Colours are compared over about this length: walls of different photos lie a little beside each other."""
    rim_m: float = 0.08
    """Beside what hides a plane, a photo counts less."""
    detail_m: float = 0.03
    shade_m: float = 0.3
    """Over about these lengths one photo's detail and shading goes over into another's."""


SETTINGS = BestViewSettings()


def best_view_textures(
    pictures: Sequence[RoomPicture], architecture: Architecture, only: Collection[str] | None = None
) -> dict[str, UInt8[np.ndarray, "_ _ 3"]]:
    """RGB pictures of the planes that some photo sees well enough, by plane id.

    Args:
        pictures: The photos; the others are brought to the exposure of the first.
        architecture: The room, with its plain colours.
        only: Ids of the planes to make pictures of; all by default.
    """
    photos = [PhotoView(p) for p in pictures]
    planes = [p for p in architecture.planes if only is None or p.id in only]
    seen: dict[str, dict[int, PlaneView]] = {}
    for plane in planes:
        points, pixel_m = texel_points(plane)
        views_of_photos = {k: v.plane_view(plane, architecture.planes, points, pixel_m) for k, v in enumerate(photos)}
        seen[plane.id] = {k: v for k, v in views_of_photos.items() if v is not None}
    sizes = {p.id: texel_points(p)[1] for p in planes}
    gains = exposure_gains([(views, sizes[name]) for name, views in seen.items()], len(photos))
    sharpness = [p.camera.intrinsics.fx * p.camera.intrinsics.fy for p in pictures]
    textures: dict[str, np.ndarray] = {}
    for plane in planes:
        views, pixel_m = seen[plane.id], sizes[plane.id]
        if not views or not is_enough(np.any([v.shown for v in views.values()], axis=0), pixel_m, plane):
            continue
        chosen = [(views[k], gains[k], sharpness[k]) for k in sorted(views)]
        colours, owned, is_covered = _blend_views(chosen, pixel_m)
        if is_covered.any() and owned.any():
            sharp = np.any([v.sharp for v in views.values()], axis=0)
            textures[plane.id] = plane_picture(plane, colours, is_covered, pixel_m, owned, sharp)
    return textures


def exposure_gains(planes: Sequence[tuple[Mapping[int, PlaneView], float]], count: int) -> Float[np.ndarray, "c 3"]:
    """Factors on the colours of each photo that make common texels alike; the first photo's are 1.

    Args:
        planes: What photos, by number, show of each plane, and the size of its texels.
        count: Photos.
    """
    rows: list[tuple[int, int, float, np.ndarray]] = []
    for a, b in combinations(range(count), 2):
        ratios = [_ratios(views[a], views[b], m) for views, m in planes if a in views and b in views]
        joined = np.concatenate(ratios) if ratios else np.zeros((0, 3))
        if len(joined) >= SETTINGS.min_common:
            weight = float(np.sqrt(min(len(joined), SETTINGS.enough_common) / SETTINGS.enough_common))
            rows.append((a, b, weight, np.median(joined, 0)))
    A = np.zeros((len(rows) + count, count))
    target = np.zeros((len(rows) + count, 3))
    for row, (a, b, weight, ratio) in enumerate(rows):
        A[row, [a, b]] = weight, -weight
        target[row] = -weight * ratio
    A[len(rows) :] = np.sqrt(SETTINGS.no_gain_weight) * np.eye(count)
    logs = np.linalg.lstsq(A, target, rcond=None)[0]
    return np.asarray(np.clip(np.exp(logs - logs[:1]), 1.0 / SETTINGS.max_gain, SETTINGS.max_gain))


def _ratios(a: PlaneView, b: PlaneView, pixel_m: float) -> Float[np.ndarray, "n 3"]:
    """Logarithms of how many times as bright texels of one photo are as those of another."""
    both = a.own & b.own
    if not both.any():
        return np.zeros((0, 3))
    one, other = (broad_shading(v.colours, v.own, SETTINGS.compared_m / pixel_m)[both] for v in (a, b))
    light = (np.minimum(one, other) > SETTINGS.darkest).all(axis=1)
    return np.asarray(np.log(one[light] / other[light]), dtype=np.float64)


def _blend_views(
    views: Sequence[tuple[PlaneView, Float[np.ndarray, "3"], float]], pixel_m: float
) -> tuple[Float32[np.ndarray, "h w 3"], Bool[np.ndarray, "h w"], Bool[np.ndarray, "h w"]]:
    """Colours, which of them are the plane's own material, and where any photo sees it."""
    scores = np.stack([_score(view, pixel_m) * sharp for view, _, sharp in views])
    best, is_covered = scores.argmax(axis=0), scores.max(axis=0) > 0
    shape = is_covered.shape
    total = {m: np.zeros(shape, np.float32) for m in (SETTINGS.detail_m, SETTINGS.shade_m)}
    summed = {m: np.zeros((*shape, 3), np.float32) for m in (SETTINGS.detail_m, SETTINGS.shade_m)}
    owned = np.zeros(shape, dtype=bool)
    for k, (view, gain, _) in enumerate(views):
        if not view.seen.any():
            continue
        mine = (best == k) & view.seen
        owned |= mine & view.own
        colours = view.colours * gain.astype(np.float32)
        shade = broad_shading(colours, view.seen, SETTINGS.shade_m / pixel_m)
        for length_m, band in ((SETTINGS.shade_m, shade), (SETTINGS.detail_m, colours - shade)):
            weight = cv2.GaussianBlur(mine.astype(np.float32), (0, 0), max(length_m / pixel_m, 0.5))
            # A trace of every photo that sees a texel: where the best one's blur ends there must be some.
            weight = (weight + 1e-6) * view.seen
            total[length_m] += weight
            summed[length_m] += weight[..., None] * band
    colours = sum((summed[m] / np.maximum(total[m], 1e-12)[..., None] for m in summed), np.zeros(1, np.float32))
    return np.asarray(colours, dtype=np.float32).clip(0.0, 255.0), owned, is_covered


def _score(view: PlaneView, pixel_m: float) -> Float[np.ndarray, "h w"]:
    """How well a photo sees each texel: its pixels there, fewer near what hides the plane; 0 where it is not seen."""
    padded = cv2.copyMakeBorder(view.seen.astype(np.uint8), 1, 1, 1, 1, cv2.BORDER_REPLICATE)
    inside = cv2.distanceTransform(padded, cv2.DIST_L2, 3)[1:-1, 1:-1] * pixel_m
    return np.asarray(view.share * np.minimum(inside / SETTINGS.rim_m, 1.0) * view.seen, dtype=np.float64)
