"""The focal length that a photo's own header states."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

FULL_FRAME_DIAGONAL_MM = float(np.hypot(36.0, 24.0))
PLAUSIBLE_FOCAL = (0.33, 4.0)
"""Focal length over the longer side: from a 12 mm ultra-wide to a 150 mm portrait lens, in full-frame terms."""

_MM_PER_UNIT = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}


@dataclass(frozen=True)
class ExifSettings:
    """Which focal lengths of a header are believed."""

    focal_length: int = 0x920A
    focal_length_35mm: int = 0xA405
    focal_plane_x_resolution: int = 0xA20E
    focal_plane_unit: int = 0xA210
    pixel_x: int = 0xA002
    pixel_y: int = 0xA003
    crop_tolerance: float = 0.02


SETTINGS = ExifSettings()


def focal_from_exif(tags: Mapping[int, Any], width: int, height: int) -> float | None:
    """Focal length in pixels of a `width` x `height` picture, or None where the header gives no trustworthy one.

    The 35 mm equivalent is taken by the diagonal (CIPA DCG-001); else the focal length in millimetres with the sensor's
    pixel pitch. A picture whose proportions differ from those in the header was cropped, and is not trusted.
    """
    if _was_cropped(tags, width, height):
        return None
    diagonal_px = float(np.hypot(width, height))
    focal_35mm = _positive(tags.get(SETTINGS.focal_length_35mm))
    focal = focal_35mm / FULL_FRAME_DIAGONAL_MM * diagonal_px if focal_35mm else _focal_from_pitch(tags, diagonal_px)
    if focal is None or not PLAUSIBLE_FOCAL[0] <= focal / max(width, height) <= PLAUSIBLE_FOCAL[1]:
        return None
    return focal


def _focal_from_pitch(tags: Mapping[int, Any], diagonal_px: float) -> float | None:
    """Millimetres over pixel pitch, carried over to the picture's present size by the diagonal."""
    focal_mm = _positive(tags.get(SETTINGS.focal_length))
    per_unit = _positive(tags.get(SETTINGS.focal_plane_x_resolution))
    unit_mm = _MM_PER_UNIT.get(int(_positive(tags.get(SETTINGS.focal_plane_unit)) or 2))
    pixel_x, pixel_y = _positive(tags.get(SETTINGS.pixel_x)), _positive(tags.get(SETTINGS.pixel_y))
    if focal_mm is None or per_unit is None or unit_mm is None or pixel_x is None or pixel_y is None:
        return None
    return focal_mm * per_unit / unit_mm * diagonal_px / float(np.hypot(pixel_x, pixel_y))


def _was_cropped(tags: Mapping[int, Any], width: int, height: int) -> bool:
    pixel_x, pixel_y = _positive(tags.get(SETTINGS.pixel_x)), _positive(tags.get(SETTINGS.pixel_y))
    if pixel_x is None or pixel_y is None:
        return False
    stated = max(pixel_x, pixel_y) / min(pixel_x, pixel_y)
    return abs(stated * min(width, height) / max(width, height) - 1.0) > SETTINGS.crop_tolerance


def _positive(value: Any) -> float | None:
    """A header's number, where it is one; headers hold anything, a fraction with denominator 0 included."""
    try:
        number = float(value)
    except (TypeError, ValueError, ZeroDivisionError):
        return None
    return number if np.isfinite(number) and number > 0 else None
