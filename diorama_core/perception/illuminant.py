"""The colour of a room's light, and what surfaces show without it (colour constancy).

Several simple estimates are combined as Gaussians over the light's chromaticity, which is written as two logarithms:
warm against cold, and magenta against green. Statistics of all pixels (shades of grey, Finlayson and Trezzi 2004) and
of their edges (grey edge, van de Weijer et al. 2007) say little each; walls and ceilings, mostly painted about white,
say more. Cameras have balanced most photographs already, so the light is expected to be white, and lights that people
use vary from warm to cold rather than from magenta to green.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear

_EXPECTED_SIGMA = np.array([0.28, 0.06])
"""Spread of photographs' light, warm to cold and magenta to green."""
_STATISTICS_SIGMA, _WALLS_SIGMA = np.array([0.28, 0.15]), np.array([0.20, 0.10])
"""Deviations of estimates from all pixels, and from walls."""


@dataclass(frozen=True)
class IlluminantSettings:
    """How the colour of the light is estimated."""

    side_px: int = 160
    norm: float = 6.0
    """Power of the Minkowski means: bright pixels and strong edges say most."""
    dark: float = 0.02
    clipped: float = 0.97
    """Linear light outside these says nothing of colour."""
    min_pixels: int = 200
    bright_share: float = 0.5
    """Share of the walls' pixels, the brightest: the others are shaded or lit by what is beside them."""
    strange: float = 2.0
    """An estimate that many sigmas off the others counts less, as a Student's t would have it."""


SETTINGS = IlluminantSettings()


@dataclass(frozen=True)
class Illuminant:
    """The light of a photo, relative to the white of sRGB (D65)."""

    rgb: tuple[float, float, float] = (1.0, 1.0, 1.0)
    """Linear light that a white surface shows, of unit luminance."""

    def albedo(self, srgb: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
        """Colours (sRGB 0 to 1) as they would be in white light of the same strength."""
        return self._apply_gains(srgb, 1.0 / np.array(self.rgb))

    def illuminate(self, srgb: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
        """Colours (sRGB 0 to 1) of surfaces as this light shows them; the inverse of `albedo` unless clipped."""
        return self._apply_gains(srgb, np.array(self.rgb))

    def partly(self, share: float) -> Illuminant:
        """A light between white and this one: that share of its cast, as exposures go (in logarithms)."""
        return _from_chromaticity(share * _chromaticity(np.array(self.rgb)))

    def white_balance(self, picture: UInt8[np.ndarray, "h w 3"]) -> UInt8[np.ndarray, "h w 3"]:
        """A picture as white light would have it."""
        values = np.arange(256) / 255.0
        table = self.albedo(np.stack([values] * 3, axis=-1))
        return np.asarray(cv2.LUT(picture, np.rint(255 * table).astype(np.uint8)[None]), dtype=np.uint8)

    def _apply_gains(self, srgb: Float[np.ndarray, "*n 3"], gains: Float[np.ndarray, "3"]) -> Float[np.ndarray, "*n 3"]:
        return np.asarray(np.clip(linear_to_srgb(srgb_to_linear(np.asarray(srgb)) * gains), 0.0, 1.0))


def estimate_illuminant(rgb: UInt8[np.ndarray, "h w 3"], walls: Bool[np.ndarray, "h w"]) -> Illuminant:
    """The light of a photo of a room.

    Args:
        rgb: the photo, sRGB.
        walls: pixels of its walls and ceiling.
    """
    small, of_walls = _downscale(rgb, walls)
    light = srgb_to_linear(small / 255.0)
    usable = ((light > SETTINGS.dark).all(axis=-1)) & ((light < SETTINGS.clipped).all(axis=-1))
    if usable.sum() < SETTINGS.min_pixels:
        return Illuminant()
    votes = [(_chromaticity(_minkowski(light[usable])), _STATISTICS_SIGMA)]
    edges = np.abs(cv2.Laplacian(cv2.GaussianBlur(light, (0, 0), 1.0), cv2.CV_64F))
    votes.append((_chromaticity(_minkowski(edges[usable])), _STATISTICS_SIGMA))
    if (usable & of_walls).sum() >= SETTINGS.min_pixels:
        votes.append((_chromaticity(_bright_median(light[usable & of_walls])), _WALLS_SIGMA))
    return _from_chromaticity(_combine_votes(votes))


def _downscale(
    rgb: UInt8[np.ndarray, "h w 3"], walls: Bool[np.ndarray, "h w"]
) -> tuple[UInt8[np.ndarray, "a b 3"], Bool[np.ndarray, "a b"]]:
    scale = min(1.0, SETTINGS.side_px / max(rgb.shape[:2]))
    size = max(1, round(rgb.shape[1] * scale)), max(1, round(rgb.shape[0] * scale))
    small = cv2.resize(rgb, size, interpolation=cv2.INTER_AREA)
    share = cv2.resize(walls.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    return small, share > 0.99


def _minkowski(light: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "3"]:
    return np.asarray((light**SETTINGS.norm).mean(axis=0) ** (1.0 / SETTINGS.norm))


def _bright_median(light: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "3"]:
    luminance = light.mean(axis=1)
    return np.asarray(np.median(light[luminance >= np.quantile(luminance, 1.0 - SETTINGS.bright_share)], axis=0))


def _chromaticity(light: Float[np.ndarray, "3"]) -> Float[np.ndarray, "2"]:
    """Warm against cold, and magenta against green."""
    red, green, blue = np.log(np.maximum(light, 1e-6))
    return np.array([red - blue, (red + blue) / 2 - green])


def _from_chromaticity(chromaticity: Float[np.ndarray, "2"]) -> Illuminant:
    warm, magenta = chromaticity
    light = np.exp([warm / 2 + magenta, 0.0, magenta - warm / 2])
    red, green, blue = (float(c) for c in light / (light @ (0.2126, 0.7152, 0.0722)))
    return Illuminant((red, green, blue))


def _combine_votes(votes: list[tuple[Float[np.ndarray, "2"], Float[np.ndarray, "2"]]]) -> Float[np.ndarray, "2"]:
    """The posterior mean; estimates far from it are trusted less, step by step."""
    values, sigmas = (np.array(column) for column in zip(*votes, strict=True))
    mean = np.zeros(2)
    for _ in range(4):
        off = (values - mean) / np.hypot(sigmas, _EXPECTED_SIGMA)
        trust = 1.0 / (1.0 + (off / SETTINGS.strange) ** 2)
        precision = trust / sigmas**2
        mean = (precision * values).sum(axis=0) / (precision.sum(axis=0) + 1.0 / _EXPECTED_SIGMA**2)
    return np.asarray(mean)
