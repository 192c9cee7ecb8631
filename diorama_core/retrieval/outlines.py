"""Outlines with their small gaps filled: the masks of photos rarely tell the air between two slats from the slats."""

from __future__ import annotations

from functools import cache

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

from diorama_core.geometry.observed import Observed
from diorama_core.geometry.window import soft_iou
from diorama_core.retrieval.settings import SETTINGS, SimilaritySettings

_GAP_SHARE = 0.12
"""Share of an object's longer side: wider gaps stay open."""


def close_gaps(mask: Bool[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """The mask with narrow gaps and small holes closed."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return mask
    side = max(rows[-1] - rows[0], columns[-1] - columns[0]) + 1
    size = max(round(_GAP_SHARE * side), 1) | 1
    window = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    height, width = rows[-1] - rows[0] + 1, columns[-1] - columns[0] + 1
    padded = np.zeros((height + 2 * size, width + 2 * size), np.uint8)
    padded[size:-size, size:-size] = mask[window]
    closed = np.zeros_like(mask)
    closed[window] = cv2.morphologyEx(padded, cv2.MORPH_CLOSE, _ellipse(size))[size:-size, size:-size] > 0
    return closed


@cache
def _ellipse(size: int) -> UInt8[np.ndarray, "s s"]:
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size)), np.uint8)


def whole_outline(seen: Observed) -> Float[np.ndarray, " n"]:
    """An object's cells with the gaps of its mask filled."""
    side = seen.window.cells
    return np.maximum(seen.covered, close_gaps((seen.covered > 0.5).reshape(side, side)).ravel())


def open_share(mask_trust: float, settings: SimilaritySettings = SETTINGS.similarity) -> float:
    """How much the outline with its gaps counts beside the filled one: nothing for a doubtful mask."""
    return settings.max_open * float(np.clip((mask_trust - settings.doubtful) / (1 - settings.doubtful), 0.0, 1.0))


def outline_agreement(
    seen: Observed,
    whole: Float[np.ndarray, " n"],
    silhouettes: Bool[np.ndarray, "p n"],
    settings: SimilaritySettings = SETTINGS.similarity,
) -> Float[np.ndarray, " p"]:
    """Intersection over union with the mask, 0 to 1, with gaps as far as the mask may be trusted, and without.

    Args:
        seen: the object.
        whole: its `whole_outline`.
        silhouettes: of posed shapes, in the same cells.
        settings: numbers to work with.
    """
    side = round(np.sqrt(silhouettes.shape[1]))
    share = open_share(seen.mask_trust, settings)
    closed = np.stack([close_gaps(s.reshape(side, side)).ravel() for s in silhouettes]).astype(np.float64)
    return share * seen.agreement(silhouettes) + (1 - share) * soft_iou(whole, closed, seen.weight)
