"""Which of several colours of a surface is its material's: the lit one beside its shade, the bare one beside its gloss.

Shade scales all channels of a colour alike (Shafer's dichromatic reflection model, 1985), gloss adds the same to all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float

from diorama_core.io.srgb import srgb_to_linear


@dataclass(frozen=True)
class LitColourSettings:
    """Which of several colours of a surface is its material."""

    lighter_l: float = 14.0
    """Lightness by which the lighter of two colours is lighter at least."""
    same_chromaticity: float = 8.0
    """A shade's a and b differ by less from those of the darkened colour (CIELAB)."""
    neutral: float = 0.25
    """What gloss adds differs by less between channels, as a share of it."""
    more_chroma: float = 8.0
    """Gloss takes so much chroma from a colour at least, or it is none."""
    black_l: float = 16.0
    """Darkening moves a colour of CIELAB towards L = -16, a = b = 0: the cube root of its definition."""


SETTINGS = LitColourSettings()


def select_material_colour(
    colour: Float[np.ndarray, "3"], others: Sequence[Float[np.ndarray, "3"]]
) -> Float[np.ndarray, "3"]:
    """The colour of a material that shows in one colour, which speaks most for itself, and in others (CIELAB)."""
    lit = [other for other in others if is_shade(colour, other)]
    if lit:
        return max(lit, key=lambda other: float(other[0]))
    bare = [other for other in others if is_glossed(colour, other)]
    return min(bare, key=lambda other: float(other[0])) if bare else colour


def is_shade(dark: Float[np.ndarray, "3"], light: Float[np.ndarray, "3"]) -> bool:
    """Whether the first colour is what a shadow makes of the second."""
    darkened = light[1:] * ((dark[0] + SETTINGS.black_l) / (light[0] + SETTINGS.black_l))
    return bool(
        light[0] - dark[0] >= SETTINGS.lighter_l and (np.abs(darkened - dark[1:]) < SETTINGS.same_chromaticity).all()
    )


def is_glossed(light: Float[np.ndarray, "3"], dark: Float[np.ndarray, "3"]) -> bool:
    """Whether the first colour is the second with a mirror image of something white on it."""
    fades = np.hypot(*dark[1:]) - np.hypot(*light[1:]) >= SETTINGS.more_chroma
    added = _linear(light) - _linear(dark)
    even = float(np.ptp(added)) < SETTINGS.neutral * float(added.mean())
    return bool(light[0] - dark[0] >= SETTINGS.lighter_l and fades and even)


def _linear(lab: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    rgb = cv2.cvtColor(np.array([[lab]], np.float32), cv2.COLOR_Lab2RGB)[0, 0]
    return np.asarray(srgb_to_linear(rgb.astype(np.float64)))
