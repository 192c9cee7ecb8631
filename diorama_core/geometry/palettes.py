"""Main colours of a masked crop and of a shape's materials, and how well they go together.

Colours are CIE Lab (L 0..100). Lightness counts less than hue: a photo's light is unknown.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

from diorama_core.geometry.shape_appearance import ShapeAppearance
from diorama_core.geometry.vectors import cells_of
from diorama_core.scene.values import ArrayValue


@dataclass(frozen=True)
class PaletteSettings:
    """How colours are grouped and compared."""

    lightness_weight: float = 0.5
    bin: float = 24.0
    max_pixels: int = 4000
    main_colours: int = 3
    tolerance: float = 25.0


SETTINGS = PaletteSettings()


@dataclass(frozen=True, eq=False)
class Palette(ArrayValue):
    """A few colours and the share of the surface that each covers (shares add up to 1, or nothing is known)."""

    lab: Float[np.ndarray, "k 3"]
    share: Float[np.ndarray, "k"]


NOTHING_KNOWN = Palette(np.zeros((0, 3)), np.zeros(0))


def _to_lab(rgb: UInt8[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    return cv2.cvtColor((rgb[None].astype(np.float32) / 255.0), cv2.COLOR_RGB2Lab)[0].astype(np.float64)


def _main_colours(lab: Float[np.ndarray, "n 3"], weight: Float[np.ndarray, "n"]) -> Palette:
    """Means of the fullest bins of a coarse colour grid."""
    label, _ = cells_of(np.floor(lab / SETTINGS.bin))
    mass = np.bincount(label, weight)
    fullest = np.argsort(-mass, kind="stable")[: SETTINGS.main_colours]
    sums = np.stack([np.bincount(label, weight * lab[:, c]) for c in range(3)], axis=1)
    return Palette(sums[fullest] / mass[fullest, None], mass[fullest] / mass[fullest].sum())


def palette_of_crop(rgb: UInt8[np.ndarray, "h w 3"], mask: Bool[np.ndarray, "h w"]) -> Palette:
    """The main colours under a mask; nothing known for an empty one."""
    rows = np.flatnonzero(mask.any(axis=1))
    if not len(rows):
        return NOTHING_KNOWN
    rows_of_mask = slice(rows[0], rows[-1] + 1)
    pixels = rgb[rows_of_mask][mask[rows_of_mask]]
    pixels = pixels[:: max(len(pixels) // SETTINGS.max_pixels, 1)]
    return _main_colours(_to_lab(pixels), np.ones(len(pixels)))


def palette_of_appearance(appearance: ShapeAppearance) -> Palette:
    """The main colours of a shape's materials, by surface area."""
    if not len(appearance.areas_m2):
        return NOTHING_KNOWN
    return _main_colours(_to_lab(appearance.colours_srgb), appearance.areas_m2)


def palette_agreement(seen: Palette, shape: Palette) -> float:
    """0 to 1: how near each seen colour has one among the shape's; 0.5 where either is unknown."""
    if not len(seen.share) or not len(shape.share):
        return 0.5
    scale = np.array([SETTINGS.lightness_weight, 1.0, 1.0])
    distance = np.linalg.norm((seen.lab[:, None] - shape.lab[None]) * scale, axis=-1)
    toward_shape = (seen.share * distance.min(axis=1)).sum()
    toward_seen = (shape.share * distance.min(axis=0)).sum()
    return float(np.exp(-(toward_shape + toward_seen) / 2 / SETTINGS.tolerance))
