"""Measured depth maps as points and normals on the image grid."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float, Float32

from diorama_core.geometry.casting import pixel_centres
from diorama_core.geometry.planes import grid_normals
from diorama_core.scene.types import Intrinsics

SMOOTHING_PX = 5
AGREEMENT = 0.8
"""Normals whose neighbours agree less than this (length of their mean) are of an edge or of noise, and dropped."""


def points_camera(depth_m: Float32[np.ndarray, "h w"], intrinsics: Intrinsics) -> Float[np.ndarray, "h w 3"]:
    """Points in the camera frame through pixel centres; zero where depth is missing."""
    k = intrinsics
    pixels = pixel_centres(k.width, k.height)
    depth = depth_m.astype(np.float64)
    x = (pixels[..., 0] - k.cx) / k.fx
    y = (pixels[..., 1] - k.cy) / k.fy
    return np.stack([x * depth, y * depth, depth], axis=-1)


def smooth_normals_camera(
    depth_m: Float32[np.ndarray, "h w"], intrinsics: Intrinsics, step: int = 3
) -> Float[np.ndarray, "h w 3"]:
    """Normals of measured surfaces, toward the camera, averaged over a small window; zero where uncertain.

    Args:
        depth_m: Depth, 0 where missing.
        intrinsics: Of the depth map's grid.
        step: Half the span of the differences, pixels; grows with noise.
    """
    calm = cv2.medianBlur(np.ascontiguousarray(depth_m, dtype=np.float32), SMOOTHING_PX)
    calm = np.where(depth_m > 0, calm, 0.0).astype(np.float32)
    normals = grid_normals(points_camera(calm, intrinsics), step)
    known = (normals != 0).any(axis=-1)
    window = (2 * step + 1, 2 * step + 1)
    share = cv2.blur(known.astype(np.float64), window)
    mean = cv2.blur(normals, window) / np.maximum(share, 1e-9)[..., None]
    length = np.linalg.norm(mean, axis=-1)
    sure = known & (length > AGREEMENT)
    return np.where(sure[..., None], mean / np.maximum(length, 1e-9)[..., None], 0.0)


def reduce(
    depth_m: Float32[np.ndarray, "h w"], intrinsics: Intrinsics, max_side: int
) -> tuple[Float32[np.ndarray, "hs ws"], Intrinsics]:
    """The depth map at no more than `max_side` pixels a side, by picking pixels: depth must not be averaged."""
    height, width = depth_m.shape
    factor = min(1.0, max_side / max(height, width))
    if factor == 1.0:
        return depth_m, intrinsics
    size = (max(1, round(width * factor)), max(1, round(height * factor)))
    small = cv2.resize(np.ascontiguousarray(depth_m), size, interpolation=cv2.INTER_NEAREST)
    return small.astype(np.float32), intrinsics.resize(*size)
