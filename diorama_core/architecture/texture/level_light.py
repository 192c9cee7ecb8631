"""A floor's picture without the photo's light: reflections, glow and shadows go, the floor's material stays.

Two layers, as in Retinex (Land and McCann 1971; Horn 1974): light varies smoothly, a material has edges. What varies
more broadly than patterns of floors do is light. What varies as broadly as a pattern is light too where nothing finer
goes with it: boards, tiles and carpets have joints and threads, a blurred mirror image has none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32

from diorama_core.architecture.texture.quilting import broad_shading, wide_blur


@dataclass(frozen=True)
class LevelLightSettings:
    """How the photo's light is taken out of a floor."""

    fine_m: float = 0.03
    pattern_m: float = 0.25
    """Detail is finer than the first; what is broader than the second is light."""
    with_edges: float = 0.6
    """A pattern has at least so much fine detail, as a share of its own variation."""
    around_m: float = 0.3
    """Both are compared over about this length."""
    light_m: float = 0.8
    most_levels: float = 10.0
    """Light that varies more broadly than this is left, up to so many levels of 255: a room has a brighter
    side."""
    min_levels: float = 0.5


SETTINGS = LevelLightSettings()


def level_light(
    colours: Float32[np.ndarray, "h w 3"], is_plane: Bool[np.ndarray, "h w"], pixel_m: float
) -> Float32[np.ndarray, "h w 3"]:
    """The colours of a floor as even light shows them; meaningful where they are its own."""
    if not is_plane.any():
        return colours
    finer = broad_shading(colours, is_plane, SETTINGS.fine_m / pixel_m)
    broad = broad_shading(colours, is_plane, SETTINGS.pattern_m / pixel_m)
    main = np.median(colours[is_plane], axis=0).astype(np.float32)
    fine, pattern = colours - finer, finer - broad
    light = broad_shading(colours, is_plane, SETTINGS.light_m / pixel_m) - main
    light = SETTINGS.most_levels * np.tanh(light / SETTINGS.most_levels)
    kept = _share_of_material(fine, pattern, is_plane, SETTINGS.around_m / pixel_m)
    return np.asarray(main + light + fine + kept[..., None] * pattern, dtype=np.float32)


def _share_of_material(
    fine: Float32[np.ndarray, "h w 3"],
    pattern: Float32[np.ndarray, "h w 3"],
    is_plane: Bool[np.ndarray, "h w"],
    width_px: float,
) -> Float32[np.ndarray, "h w"]:
    """How much of what varies as broadly as a pattern is one, 0 to 1, by the fine detail around."""
    around = np.stack([(fine**2).mean(axis=-1), (pattern**2).mean(axis=-1)], axis=-1)
    weight = np.maximum(wide_blur(is_plane.astype(np.float32), width_px), 1e-4)
    energy = wide_blur(np.asarray(around * is_plane[..., None], dtype=np.float32), width_px) / weight[..., None]
    expected = SETTINGS.with_edges**2 * energy[..., 1] + SETTINGS.min_levels**2
    return np.asarray(np.minimum((energy[..., 0] + SETTINGS.min_levels**2) / expected, 1.0), dtype=np.float32)
