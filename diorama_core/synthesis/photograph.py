"""A camera: what a sensor behind a lens makes of light, so that a rendering has a photo's exposure, colours and noise.

The order is that of a camera: the lens darkens the corners, the exposure says how much light fills a pixel, photons
arrive one by one (Poisson) and reading them adds noise of its own (normal), the colour filters blur both a little, and
the camera's development balances white and bends the brightest light into what a display can show.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, UInt8
from scipy.ndimage import gaussian_filter

from diorama_core.io.srgb import linear_to_srgb
from diorama_core.scene.types import Intrinsics

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_DARKEST = 1e-4


@dataclass(frozen=True)
class CameraResponse:
    """A camera's character; the defaults are those of a good compact camera in a bright room."""

    mid_grey: float = 0.29
    """Linear brightness, of 1, that the exposure gives to the picture's middle tone."""
    vignetting: float = 0.5
    """Share of the natural fall-off (cosine to the fourth) that the camera leaves uncorrected, 0 to 1."""
    full_well_e: float = 20_000.0
    """Electrons in a pixel at brightness 1."""
    read_noise_e: float = 6.0
    """Standard deviation of reading a pixel, in electrons."""
    balance: float = 0.8
    """Share of the light's colour cast that the white balance removes, 0 to 1."""
    blur_px: float = 0.45
    """Standard deviation of what filters and development blur, in pixels."""
    contrast: float = 1.15
    """Power of brightness around the middle tone; 1 leaves it."""
    shoulder: float = 0.55
    """Brightness from which highlights are bent, 0 to 1."""


def photograph(
    radiance: Float[np.ndarray, "h w 3"],
    intrinsics: Intrinsics,
    white: Float[np.ndarray, "3"],
    camera: CameraResponse = CameraResponse(),
    *,
    seed: int = 0,
) -> UInt8[np.ndarray, "h w 3"]:
    """The photo that a camera takes of light.

    Args:
        radiance: Linear, any unit, at least 0.
        intrinsics: Of the same picture; say how far each pixel is off the axis.
        white: Linear colour of the light in the room, what the white balance aims at; any scale.
        camera: Its character.
        seed: Of the noise.

    Raises:
        ValueError: radiance is of another size than the intrinsics', or is not finite or negative.
    """
    if radiance.shape[:2] != (intrinsics.height, intrinsics.width):
        raise ValueError(f"radiance is {radiance.shape[:2]}, the intrinsics' {(intrinsics.height, intrinsics.width)}")
    if not np.isfinite(radiance).all() or radiance.min() < 0:
        raise ValueError("radiance must be finite and at least 0")
    light = radiance.astype(np.float64)
    exposed = light * (camera.mid_grey / middle_tone(light)) * falloff(intrinsics, camera.vignetting)[..., None]
    read = gaussian_filter(noisy(exposed, camera, seed), (camera.blur_px, camera.blur_px, 0))
    return develop(read * white_gains(white, camera.balance), camera)


def middle_tone(light: Float[np.ndarray, "h w 3"]) -> float:
    """What a light meter reads: the geometric mean of the luminance, so that a lamp or a window does not darken all."""
    return float(np.exp(np.log(np.maximum(light @ _LUMINANCE, _DARKEST * light.max() + 1e-12)).mean()))


def falloff(k: Intrinsics, share: float) -> Float[np.ndarray, "h w"]:
    """What a lens lets through at each pixel, 1 on the axis: the given share of the cosine to the fourth."""
    x = (np.arange(k.width) + 0.5 - k.cx) / k.fx
    y = (np.arange(k.height) + 0.5 - k.cy) / k.fy
    natural = (1.0 + x[None, :] ** 2 + y[:, None] ** 2) ** -2
    return 1.0 - share * (1.0 - natural)


def noisy(exposed: Float[np.ndarray, "h w 3"], camera: CameraResponse, seed: int) -> Float[np.ndarray, "h w 3"]:
    """Brightness as a sensor counts it: whole electrons, as many as chance gives, none above twice a full pixel."""
    rng = np.random.default_rng(seed)
    electrons = rng.poisson(np.minimum(exposed, 2.0) * camera.full_well_e)
    return (electrons + rng.normal(0.0, camera.read_noise_e, exposed.shape)) / camera.full_well_e


def white_gains(white: Float[np.ndarray, "3"], balance: float) -> Float[np.ndarray, "3"]:
    """What each colour is multiplied by so that the given share of a light's cast goes; luminance of white stays."""
    cast = white / float(white @ _LUMINANCE)
    gains = cast**-balance
    return gains / float((cast * gains) @ _LUMINANCE)


def develop(light: Float[np.ndarray, "h w 3"], camera: CameraResponse) -> UInt8[np.ndarray, "h w 3"]:
    """Display values of linear light: more contrast, and highlights bent towards 1, which they never reach."""
    toned = camera.mid_grey * (np.maximum(light, 0.0) / camera.mid_grey) ** camera.contrast
    rest = 1.0 - camera.shoulder
    bent = 1.0 - rest * np.exp(-np.maximum(toned - camera.shoulder, 0.0) / rest)
    shown = linear_to_srgb(np.where(toned > camera.shoulder, bent, toned))
    return np.rint(np.clip(shown, 0.0, 1.0) * 255).astype(np.uint8)
