"""Colour differences as people see them: CIEDE2000 (Sharma, Wu and Dalal 2005)."""

from __future__ import annotations

import cv2
import numpy as np
from jaxtyping import Float

HALF_LIGHTNESS = 2.0
"""Parametric factor k_L at which a difference of lightness counts half: photographs are not evenly lit."""
_TWENTY_FIVE_7 = 25.0**7


def delta_e_2000(
    lab_1: Float[np.ndarray, "*n 3"], lab_2: Float[np.ndarray, "*n 3"], k_lightness: float = 1.0
) -> Float[np.ndarray, "*n"]:
    """CIEDE2000 of two arrays of CIELAB colours (L 0 to 100).

    Args:
        lab_1: colours.
        lab_2: as many colours.
        k_lightness: k_L of the formula; at `HALF_LIGHTNESS` lightness counts half.
    """
    (l1, a1, b1), (l2, a2, b2) = (np.moveaxis(np.asarray(lab, dtype=np.float64), -1, 0) for lab in (lab_1, lab_2))
    mean_chroma_7 = ((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2) ** 7
    stretch = 1 + 0.5 * (1 - np.sqrt(mean_chroma_7 / (mean_chroma_7 + _TWENTY_FIVE_7)))
    c1, c2 = np.hypot(a1 * stretch, b1), np.hypot(a2 * stretch, b2)
    h1, h2 = (np.degrees(np.arctan2(b, a * stretch)) % 360 for a, b in ((a1, b1), (a2, b2)))
    gray = c1 * c2 == 0
    turn = np.where(gray, 0.0, (h2 - h1 + 180) % 360 - 180)
    hue_difference = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn) / 2)
    hue = np.where(gray, h1 + h2, h1 + turn / 2)
    lightness, chroma = (l1 + l2) / 2, (c1 + c2) / 2
    t = 1 + sum(
        factor * np.cos(np.radians(times * hue + offset))
        for factor, times, offset in ((-0.17, 1, -30), (0.24, 2, 0), (0.32, 3, 6), (-0.20, 4, -63))
    )
    s_lightness = 1 + 0.015 * (lightness - 50) ** 2 / np.sqrt(20 + (lightness - 50) ** 2)
    s_chroma, s_hue = 1 + 0.045 * chroma, 1 + 0.015 * chroma * t
    rotation = 2 * np.sqrt(chroma**7 / (chroma**7 + _TWENTY_FIVE_7))
    rotation = -rotation * np.sin(np.radians(60 * np.exp(-((((hue % 360) - 275) / 25) ** 2))))
    of_lightness = (l2 - l1) / (k_lightness * s_lightness)
    of_chroma, of_hue = (c2 - c1) / s_chroma, hue_difference / s_hue
    return np.asarray(np.sqrt(of_lightness**2 + of_chroma**2 + of_hue**2 + rotation * of_chroma * of_hue))


def lab_of(srgb: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    """CIELAB (D65) of sRGB colours from 0 to 1."""
    flat = np.asarray(srgb, dtype=np.float32).reshape(-1, 1, 3)
    return np.asarray(cv2.cvtColor(flat, cv2.COLOR_RGB2Lab).reshape(np.shape(srgb)), dtype=np.float64)


def perceived_difference(
    srgb_1: Float[np.ndarray, "*n 3"], srgb_2: Float[np.ndarray, "*n 3"]
) -> Float[np.ndarray, "*n"]:
    """CIEDE2000 of sRGB colours from 0 to 1, with lightness at half weight."""
    return delta_e_2000(lab_of(srgb_1), lab_of(srgb_2), HALF_LIGHTNESS)
