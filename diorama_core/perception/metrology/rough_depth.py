"""Depth that a small network sees, as evidence of objects' distances and of the camera's height."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diorama_core.artefacts import DetectedObject
from diorama_core.geometry.casting import camera_rays
from diorama_core.geometry.projection import NEAR_M
from diorama_core.models.seen_depth import SeenDepth
from diorama_core.perception.metrology.box_observations import SeenDepths
from diorama_core.perception.metrology.problem import UNTOLD, View
from diorama_core.perception.metrology.settings import SETTINGS, BoxObservationSettings
from diorama_core.scene.types import Camera


def seen_depths(
    seen: SeenDepth,
    objects: Sequence[DetectedObject],
    view: View,
    settings: BoxObservationSettings = SETTINGS.observed,
) -> SeenDepths | None:
    """The depths of objects over the camera's height; None where hardly anything below the camera is unmarked.

    Args:
        seen: depth and deviation of every pixel.
        objects: with masks of shape (h, w).
        view: intrinsics, and rotation from camera to world.
        settings: of what is observed.
    """
    if seen.log_sigma is None:
        raise ValueError("the depth is no rough one")
    log_depth = np.log(np.maximum(seen.depth_m, NEAR_M))
    pose = np.eye(4)
    pose[:3, :3] = view.R_world_camera
    below = -camera_rays(Camera(view.intrinsics, pose))[1][..., 2] * np.exp(log_depth)
    marked = np.logical_or.reduce([o.mask for o in objects]) if objects else np.zeros(log_depth.shape, bool)
    free = below[(below > 0) & ~marked]
    if len(free) < settings.least_free * log_depth.size:
        return None
    log_height = float(np.log(np.quantile(free, settings.floor_share)))
    outlined = [o.mask.any() for o in objects]
    depth = [np.median(log_depth[o.mask]) if known else 0.0 for o, known in zip(objects, outlined, strict=True)]
    sigma = [np.median(seen.log_sigma[o.mask]) if known else UNTOLD for o, known in zip(objects, outlined, strict=True)]
    return SeenDepths(log_height, seen.scale_log_sigma, np.array(depth) - log_height, np.array(sigma, dtype=float))
