"""Display values (sRGB) and linear light, IEC 61966-2-1."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

_LUMINANCE = (0.2126, 0.7152, 0.0722)


def srgb_to_linear(display: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
    """Linear light 0 to 1 of display values 0 to 1; what is beyond them continues the curve."""
    return np.where(display <= 0.04045, display / 12.92, ((np.maximum(display, 0.0) + 0.055) / 1.055) ** 2.4)


def linear_to_srgb(light: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
    """Display values 0 to 1 of linear light 0 to 1; what is beyond them continues the curve."""
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * np.maximum(light, 0.0) ** (1 / 2.4) - 0.055)


def luminance(light: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n"]:
    """Brightness of linear light in sRGB's primaries."""
    return np.asarray(light @ np.array(_LUMINANCE, light.dtype))
