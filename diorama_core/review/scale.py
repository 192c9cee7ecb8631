"""What a known length is worth: which thing's height is asked, and how many objects an unknown scale puts elsewhere."""

from __future__ import annotations

from math import erf, sqrt

import numpy as np

from diorama_core.library.taxonomy import UNKNOWN, category
from diorama_core.scene.types import Scene, SceneObject

SHARP_SHARE = 0.36
"""Share of the picture's height from which a thing's own height is known to 2 % of all others' (`KNOWN_LENGTH_SIGMA`):
its ends are known to .7 % of the picture, by 111 things of 24 rendered rooms."""
IN_PLACE_M = 0.2
"""An object no farther off is in its place (`evaluation.metrics.pose`)."""


def ruler(scene: Scene) -> SceneObject | None:
    """The thing by whose height all lengths are told best: it stands on the floor and is seen whole.

    Of those that are large in the picture it is one of the kind whose heights differ least, as of doors; else it is the
    largest in the picture. None where none is whole.
    """
    if scene.camera is None:
        return None
    height_px = scene.camera.intrinsics.height

    def order(item: SceneObject) -> tuple[float, float, str]:
        share = 0.0 if item.box_px is None else (item.box_px[3] - item.box_px[1]) / height_px
        return (0.0, _height_spread(item), item.id) if share >= SHARP_SHARE else (1.0, -share, item.id)

    return min((o for o in scene.objects if _is_whole(scene, o) and not o.locked), key=order, default=None)


def misplaced(scene: Scene, scale_sigma: float) -> float:
    """How many objects, right otherwise, are expected elsewhere since all lengths are wrong by one factor.

    Args:
        scene: with its camera, about which everything grows.
        scale_sigma: standard deviation of the logarithm of the factor.
    """
    if scene.camera is None or scale_sigma <= 0.0:
        return 0.0
    away = [(float(np.linalg.norm(o.pose.position - scene.camera.position)), o.belief) for o in scene.objects]
    return sum(b.right * (1.0 - erf(IN_PLACE_M / max(far * scale_sigma * sqrt(2.0), 1e-9))) for far, b in away if b)


def _is_whole(scene: Scene, item: SceneObject) -> bool:
    edge = scene.support_of(item.id)
    if scene.camera is None or item.box_px is None or item.belief is None or edge is None:
        return False
    k, (x1, y1, x2, y2) = scene.camera.intrinsics, item.box_px
    on_floor = item.category == "door" or (scene.has_plane(edge.parent) and scene.plane(edge.parent).role == "floor")
    margin_x, margin_y = 0.01 * k.width, 0.01 * k.height
    inside = x1 > margin_x and y1 > margin_y and x2 < k.width - margin_x and y2 < k.height - margin_y
    return on_floor and inside and item.category != UNKNOWN.name


def _height_spread(item: SceneObject) -> float:
    """Deviation of the logarithm of a kind's heights, all its modes together."""
    modes = category(item.category).priors
    medians, sigmas = (np.array([getattr(m, name)[2] for m in modes]) for name in ("log_median_xyz", "log_sigma_xyz"))
    return float(np.hypot(np.std(medians), np.mean(sigmas)))
