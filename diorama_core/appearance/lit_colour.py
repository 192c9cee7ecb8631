"""Which of several colours of a surface is its material's: the lit one beside its shade, the bare one beside its gloss.

Shade scales all channels of a colour alike (Shafer's dichromatic reflection model, 1985), gloss adds the same to all.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from jaxtyping import Float

from diorama_core.io.srgb import srgb_to_linear

LIGHTER_L = 14.0
"""Of two colours the lighter one is so much lighter at least."""
SAME_CHROMATICITY = 8.0
"""A shade's a and b differ by less from those of the darkened colour (CIELAB)."""
NEUTRAL = 0.25
"""What gloss adds differs by less between channels, as a share of it."""
MORE_CHROMA = 8.0
"""Gloss takes so much chroma from a colour at least, or it is none."""
_BLACK_L = 16.0
"""Darkening moves a colour of CIELAB towards L = -16, a = b = 0: the cube root of its definition."""


def unveiled(colour: Float[np.ndarray, "3"], others: Sequence[Float[np.ndarray, "3"]]) -> Float[np.ndarray, "3"]:
    """The colour of a material that shows in one colour and in others (CIELAB).

    Args:
        colour: The one that speaks most for itself.
        others: What much of the surface shows too.
    """
    lit = [other for other in others if is_shade(colour, other)]
    if lit:
        return max(lit, key=lambda other: float(other[0]))
    bare = [other for other in others if is_glossed(colour, other)]
    return min(bare, key=lambda other: float(other[0])) if bare else colour


def is_shade(dark: Float[np.ndarray, "3"], light: Float[np.ndarray, "3"]) -> bool:
    """Whether the first colour is what a shadow makes of the second."""
    darkened = light[1:] * ((dark[0] + _BLACK_L) / (light[0] + _BLACK_L))
    return bool(light[0] - dark[0] >= LIGHTER_L and (np.abs(darkened - dark[1:]) < SAME_CHROMATICITY).all())


def is_glossed(light: Float[np.ndarray, "3"], dark: Float[np.ndarray, "3"]) -> bool:
    """Whether the first colour is the second with a mirror image of something white on it."""
    fades = np.hypot(*dark[1:]) - np.hypot(*light[1:]) >= MORE_CHROMA
    added = _linear(light) - _linear(dark)
    even = float(np.ptp(added)) < NEUTRAL * float(added.mean())
    return bool(light[0] - dark[0] >= LIGHTER_L and fades and even)


def _linear(lab: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    rgb = cv2.cvtColor(np.array([[lab]], np.float32), cv2.COLOR_Lab2RGB)[0, 0]
    return np.asarray(srgb_to_linear(rgb.astype(np.float64)))
