"""Straight line segments of a picture."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

DETECTION_SIDE_PX = 800
"""Longest side at which segments are looked for; finer detail only adds texture."""


def line_segments_px(
    rgb: UInt8[np.ndarray, "h w 3"], min_length: float = 0.025, max_count: int = 500
) -> Float[np.ndarray, "n 4"]:
    """Straight segments of a picture, longest first (LSD, von Gioi et al. 2010).

    Args:
        rgb: The picture.
        min_length: Shorter segments are dropped; as a share of the picture's diagonal.
        max_count: At most this many, the longest, are kept.

    Returns:
        x1, y1, x2, y2 in pixels of `rgb`; segments that run along the picture's border are left out.
    """
    height, width = rgb.shape[:2]
    scale = min(1.0, DETECTION_SIDE_PX / max(height, width))
    grey = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)
    if scale < 1.0:
        grey = cv2.resize(grey, (round(width * scale), round(height * scale)), interpolation=cv2.INTER_AREA)
    if min(grey.shape) < 8:
        return np.zeros((0, 4))
    detected = cv2.createLineSegmentDetector(cv2.LSD_REFINE_STD).detect(grey)[0]
    if detected is None:
        return np.zeros((0, 4))
    rows, columns = grey.shape
    stretch = np.array([width / columns, height / rows])
    # The detector counts from pixel centres; pixels here are squares whose centre is at one half.
    segments = (detected.reshape(-1, 2, 2).astype(np.float64) + 0.5) * stretch
    lengths = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    keep = (lengths >= min_length * np.hypot(width, height)) & ~_lie_on_border(segments, width, height)
    order = np.argsort(-lengths[keep], kind="stable")[:max_count]
    return segments[keep][order].reshape(-1, 4)


def _lie_on_border(segments: Float[np.ndarray, "n 2 2"], width: int, height: int) -> Bool[np.ndarray, "n"]:
    """True for segments whose both ends lie within half a percent of the same side of the picture."""
    margin = 0.005 * max(width, height) + 1.0
    low = np.all(segments < margin, axis=1)
    high = np.all(segments > np.array([width, height]) - margin, axis=1)
    return low[:, 0] | low[:, 1] | high[:, 0] | high[:, 1]
