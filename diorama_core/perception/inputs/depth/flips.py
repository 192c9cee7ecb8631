"""Maps that lie mirrored or upside down over their photo, told by the edges that both show."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, UInt8

WORKING_SIDE_PX = 192
MARGIN = 0.1
"""By which the edges of a turned map must agree better with the photo's, as correlations."""
MIN_AGREEMENT = 0.25
"""Correlation of a turned map with the photo: measured maps that lie right have 0.28 to 0.4, turned ones up to 0.24."""
_TURNS = {
    "mirrored": np.s_[:, ::-1],
    "upside down": np.s_[::-1, ::-1],
    "upside down and mirrored": np.s_[::-1, :],
}


def turned_over(
    values: Float[np.ndarray, "h w"], valid: Bool[np.ndarray, "h w"], rgb: UInt8[np.ndarray, "h2 w2 3"]
) -> str | None:
    """How a map lies over its photo, where that is clearly not as the photo; None otherwise.

    Args:
        values: of the map.
        valid: where it was measured.
        rgb: the photo, of the same proportions.
    """
    import cv2  # the editor opens without it

    scale = WORKING_SIDE_PX / max(rgb.shape[:2])
    size = max(8, round(rgb.shape[1] * scale)), max(8, round(rgb.shape[0] * scale))
    grey = cv2.cvtColor(cv2.resize(rgb, size, interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2GRAY).astype(np.float32)
    low, high = np.percentile(values[::4, ::4][valid[::4, ::4]], [2, 98])
    even = np.clip((np.where(valid, values, low) - low) / max(float(high - low), 1e-12), 0, 1).astype(np.float32)
    steps = cv2.resize(even, size, interpolation=cv2.INTER_AREA)
    seen = cv2.resize(valid.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0.99
    sure = cv2.erode(seen.astype(np.uint8), np.ones((5, 5))) > 0  # not where measured meets missing
    photo, depth = _edges(grey), _edges(steps)
    as_is = _agreement(photo, depth, sure)
    agreements = {name: _agreement(photo, depth[turn], sure[turn]) for name, turn in _TURNS.items()}
    best = max(agreements, key=lambda name: agreements[name])
    return best if agreements[best] > max(as_is + MARGIN, MIN_AGREEMENT) else None


def turned(values: Float[np.ndarray, "h w"], how: str) -> Float[np.ndarray, "h w"]:
    """A map as it lies over its photo, `how` being what `turned_over` said of it."""
    return np.ascontiguousarray(values[_TURNS[how]])


def _edges(picture: Float[np.ndarray, "h w"]) -> Float[np.ndarray, "h w"]:
    import cv2  # as above

    strength = np.hypot(*(cv2.Sobel(picture, cv2.CV_32F, dx, 1 - dx) for dx in (0, 1)))
    return np.asarray(cv2.GaussianBlur(np.sqrt(strength), (5, 5), 0))


def _agreement(one: Float[np.ndarray, "h w"], other: Float[np.ndarray, "h w"], sure: Bool[np.ndarray, "h w"]) -> float:
    """The correlation of two pictures of edges where the second one is sure."""
    if np.count_nonzero(sure) < 0.2 * sure.size:
        return 0.0
    a, b = one[sure] - one[sure].mean(), other[sure] - other[sure].mean()
    return float((a * b).sum() / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-12))
