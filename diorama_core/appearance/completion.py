"""A picture that was seen in part made whole: by its symmetry where it has one, else as the room's planes are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float32, UInt8

from diorama_core.appearance.rectify import Rectified
from diorama_core.architecture.texture.continuation import completed

Picture = Float32[np.ndarray, "h w 3"]
Mirror = Callable[[np.ndarray], np.ndarray]
MIRRORS: tuple[Mirror, ...] = (
    lambda picture: picture[:, ::-1],
    lambda picture: picture[::-1, ::-1],
    lambda picture: picture[::-1],
)
"""Left to right, half a turn, top to bottom."""


@dataclass(frozen=True)
class CompletionSettings:
    """How a partly seen picture is completed."""

    min_overlap: float = 0.12
    """Share of a picture that must be seen together with its mirror image to tell whether they are alike."""
    alike: float = 0.35
    """Mean difference to the mirror image, as a share of the picture's own variation, at which it is symmetric."""
    max_levels: float = 16.0
    """Largest difference, in levels of 255."""
    completed_side_px: int = 224
    """Longer side at which what was not seen is made up."""
    wholly: float = 0.99
    """A reduced texel is known when so much of it was seen."""
    most: float = 0.75
    much_more: float = 2.0
    """What differs by more than so many times this quantile of all differences is not carried on."""
    rim_share: float = 0.006
    """Beside what is hidden so much of the longer side is given up: masks are a little small."""


SETTINGS = CompletionSettings()


def completed_picture(rectified: Rectified, pixel_m: float) -> UInt8[np.ndarray, "h w 3"]:
    """The whole picture.

    Args:
        rectified: At least something of it is seen.
        pixel_m: Size of a texel.
    """
    rim = round(SETTINGS.rim_share * max(rectified.seen.shape))
    seen = cv2.erode(rectified.seen.astype(np.uint8), np.ones((2 * rim + 1,) * 2, np.uint8), borderValue=1).astype(bool)
    if not seen.any():
        seen = rectified.seen
    colours, seen = mirrored(rectified.colours, seen)
    if seen.all():
        return colours.clip(0, 255).astype(np.uint8)
    behind = _continued(colours, seen, pixel_m)
    share = cv2.GaussianBlur(cv2.erode(seen.astype(np.float32), np.ones((3, 3))), (0, 0), 1.5)[..., None]
    mixed = share * seen[..., None]
    return (mixed * colours + (1.0 - mixed) * behind).clip(0, 255).astype(np.uint8)


def _continued(colours: Picture, seen: Bool[np.ndarray, "h w"], pixel_m: float) -> Picture:
    """The picture completed at a reduced size: what nobody saw needs no more than its material and its shade."""
    height, width = seen.shape
    factor = min(1.0, SETTINGS.completed_side_px / max(height, width))
    size = (max(4, round(width * factor)), max(4, round(height * factor)))
    weight = cv2.resize(seen.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    if weight.max() < SETTINGS.wholly:
        return np.broadcast_to(np.median(colours[seen], axis=0), colours.shape).astype(np.float32)
    small = cv2.resize(colours, size, interpolation=cv2.INTER_AREA)
    known = weight >= SETTINGS.wholly
    usual = _usual(small, known)
    red, green, blue = (float(c) / 255.0 for c in np.median(small[usual], axis=0))
    whole = completed(small, known, (red, green, blue), pixel_m / factor, usual, ground=True)
    return cv2.resize(whole, (width, height), interpolation=cv2.INTER_LINEAR).astype(np.float32)


def _usual(colours: Picture, known: Bool[np.ndarray, "h w"]) -> Bool[np.ndarray, "h w"]:
    """What is known without hems, creases and shadows: texels that differ much more than most from the median."""
    difference = np.abs(colours - np.median(colours[known], axis=0)).max(axis=-1)
    most = float(np.quantile(difference[known], SETTINGS.most))
    return np.asarray(known & (difference <= max(SETTINGS.much_more * most, SETTINGS.max_levels)))


def mirrored(colours: Picture, seen: Bool[np.ndarray, "h w"]) -> tuple[Picture, Bool[np.ndarray, "h w"]]:
    """What is hidden filled in from mirror images of the picture that it is alike."""
    smooth = None
    for mirror in MIRRORS:
        other, is_seen = mirror(colours), mirror(seen)
        both = seen & is_seen
        if not (is_seen & ~seen).any() or both.mean() < SETTINGS.min_overlap:
            continue
        smooth = _smoothed(colours) if smooth is None else smooth
        if not _alike(smooth[both], mirror(smooth)[both]):
            continue
        gained = is_seen & ~seen
        share = cv2.GaussianBlur(cv2.erode(seen.astype(np.float32), np.ones((3, 3))), (0, 0), 1.5)[..., None]
        blended = np.where(seen[..., None], colours, other)
        colours = np.where(both[..., None], share * colours + (1 - share) * other, blended).astype(np.float32)
        seen, smooth = seen | gained, None
    return colours, seen


def _smoothed(colours: Picture) -> Picture:
    return cv2.GaussianBlur(colours, (0, 0), max(1.0, 0.01 * max(colours.shape)))


def _alike(a: Float32[np.ndarray, "n 3"], b: Float32[np.ndarray, "n 3"]) -> bool:
    """Whether the smoothed colours of places and of their mirror images are nearly the same."""
    spread = float(a.std(axis=0).mean())
    difference = float(np.abs(a - b).mean())
    return difference < SETTINGS.max_levels and difference < SETTINGS.alike * max(spread, 1.0)
